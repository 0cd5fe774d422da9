//! Records gathered into runs (one discretisation) and series (one approximation at several sizes).

use std::cmp::Ordering;
use std::collections::BTreeMap;

use crate::history::step;
use crate::record::Record;

/// All numbers of one discretisation of one case.
#[derive(Clone, Debug)]
pub(crate) struct Run<'a> {
    /// Any of its records: it carries the identity.
    pub(crate) is: &'a Record,
    name: &'a str,
    records: Vec<&'a Record>,
}

impl<'a> Run<'a> {
    /// A plain value, by quantity. Where records of one identity contradict each other, none of them is the value.
    pub(crate) fn value(&self, quantity: &str) -> Option<f64> {
        let mut values = self.plain(quantity).map(|r| r.value);
        let first = values.next()?;
        values.all(|v| (v - first).abs() <= 1e-9 * first.abs()).then_some(first)
    }

    /// Whether a quantity was recorded more than once with different values: the records don't tell two runs apart.
    pub(crate) fn contradicts(&self, quantity: &str) -> bool {
        self.value(quantity).is_none() && self.plain(quantity).next().is_some()
    }

    /// Everything recorded.
    pub(crate) fn records(&self) -> &[&'a Record] {
        &self.records
    }

    /// Records of a plain value; what was recorded step by step is a history, not a value.
    fn plain(&self, quantity: &str) -> impl Iterator<Item = &'a Record> {
        let fits = move |r: &&Record| r.quantity == quantity && r.statistic == "value" && step(r).is_none();
        self.records.iter().copied().filter(fits)
    }

    /// Unit of a plain value.
    pub(crate) fn unit(&self, quantity: &str) -> Option<&'a str> {
        self.plain(quantity).next().map(|r| r.unit.as_str())
    }

    /// A time in seconds by phase and statistic.
    pub(crate) fn time(&self, phase: &str, statistic: &str) -> Option<f64> {
        let fits = |r: &&&Record| r.quantity == "time" && r.phase == phase && r.statistic == statistic;
        self.records.iter().find(fits).map(|r| r.value)
    }

    /// Median time of the whole run: its `total`, or else the sum of its phases.
    pub(crate) fn total(&self) -> Option<f64> {
        self.time("total", "median").or_else(|| {
            let phases = ["refine", "prepare", "assemble", "factor", "solve", "transfer"];
            let times: Vec<f64> = phases.iter().filter_map(|p| self.time(p, "median")).collect();
            (!times.is_empty()).then(|| times.iter().sum())
        })
    }

    /// Whether it carried the whole load, as what knows no steps does.
    pub(crate) fn whole(&self) -> bool {
        self.value("load-carried").is_none_or(|load| load > 0.999_999)
    }

    /// Peak memory in bytes, however it was summarised.
    pub(crate) fn memory(&self) -> Option<f64> {
        self.records.iter().find(|r| r.quantity == "memory").map(|r| r.value)
    }

    /// The method id without an ending that only gives a node count.
    pub(crate) fn name(&self) -> &'a str {
        self.name
    }
}

/// Method ids that end in their node count, with what stands before it: `efg-83` where it has 83 nodes is `efg`, and stays so
/// where a study runs the same method at other sizes.
fn sized(records: &[Record]) -> BTreeMap<(&str, &str), &str> {
    let mut names = BTreeMap::new();
    for r in records {
        if let Some((name, size)) = r.method.rsplit_once('-')
            && size.parse() == Ok(r.nodes)
        {
            names.insert((r.case.as_str(), r.method.as_str()), name);
        }
    }
    names
}

/// One approximation, coarse to fine.
#[derive(Clone, Debug)]
pub(crate) struct Series<'a> {
    /// Method id without its size.
    pub(crate) name: &'a str,
    /// Its runs by falling spacing.
    pub(crate) runs: Vec<Run<'a>>,
}

impl<'a> Series<'a> {
    /// Any of its records: case, family, variant, settings and Poisson's ratio are the same in all.
    pub(crate) fn is(&self) -> &'a Record {
        self.runs[0].is
    }

    /// The finest run.
    pub(crate) fn finest(&self) -> &Run<'a> {
        &self.runs[self.runs.len() - 1]
    }

    /// `(spacing, value)` of a quantity, coarse to fine, where both are positive.
    pub(crate) fn points(&self, quantity: &str) -> Vec<(f64, f64)> {
        let point = |run: &Run| run.value(quantity).map(|v| (run.is.spacing, v));
        self.runs.iter().filter_map(point).filter(|(h, v)| *h > 0.0 && *v > 0.0).collect()
    }

    /// The order theory promises for a smooth solution's error: displacement p + 1, energy p.
    pub(crate) fn theory(&self, quantity: &str) -> Option<f64> {
        let degree = degree(self.is()).filter(|_| !ROUGH.iter().any(|case| self.is().case.contains(case)))?;
        match quantity {
            "l2" | "rms" | "rms-x" | "rms-y" | "rms-z" => Some(degree + 1.0),
            "energy" => Some(degree),
            _ => None,
        }
    }
}

/// In the names of cases whose solution is not smooth, of which no order is promised: the kidney's pressed footprints end in a
/// jump of the load, a wave has a front, and a bonded rim a singularity.
const ROUGH: [&str; 3] = ["kidney", "bar-wave", "bonded"];

/// Polynomial degree that the approximation holds completely.
fn degree(record: &Record) -> Option<f64> {
    match (record.family.as_str(), record.variant.as_str(), record.parameter("basis")) {
        ("fem", "tet4" | "hex8", _) | ("efg", _, Some("linear")) => Some(1.0),
        ("fem", "tet10" | "hex20", _) | ("efg", _, Some("quadratic")) => Some(2.0),
        _ => None,
    }
}

/// Keys in `parameters` that only say how large a run is.
const SIZES: [&str; 6] = ["cells", "file", "level", "nodes", "size", "spacing"];

fn settings(record: &Record) -> Vec<&str> {
    let is_size = |pair: &&str| SIZES.contains(&pair.split('=').next().unwrap_or_default());
    record.parameters.split(';').filter(|p| !p.is_empty() && !is_size(p)).collect()
}

/// Elements first, in the order people know them, then meshfree methods, then transfer schemes.
fn rank(record: &Record) -> (usize, usize) {
    let place = |list: &[&str], name: &str| list.iter().position(|n| *n == name).unwrap_or(list.len());
    (place(&["fem", "efg"], &record.family), place(&["tet4", "tet10", "hex8", "hex20"], &record.variant))
}

/// A record with its sizeless name.
type Named<'a> = (&'a str, &'a Record);

fn same_run(left: &Named, right: &Named) -> Ordering {
    fn text<'r>((name, r): &Named<'r>) -> ((&'r str, &'r str, &'r str, u64), u32, u64, &'r str) {
        ((name, &r.variant, &r.parameters, r.seed), r.level, r.nodes, &r.method)
    }
    let (a, b) = (left.1, right.1);
    a.case
        .cmp(&b.case)
        .then(a.poisson.total_cmp(&b.poisson))
        .then(rank(a).cmp(&rank(b)))
        .then_with(|| a.family.cmp(&b.family))
        .then_with(|| text(left).cmp(&text(right)))
        .then(a.spacing.total_cmp(&b.spacing))
}

fn named<'a>(names: &BTreeMap<(&str, &str), &'a str>, r: &'a Record) -> Named<'a> {
    (names.get(&(r.case.as_str(), r.method.as_str())).copied().unwrap_or(&r.method), r)
}

/// Gathers records into runs: by case, Poisson's ratio and family, elements before clouds.
pub(crate) fn runs(records: &[Record]) -> Vec<Run<'_>> {
    let names = sized(records);
    let mut sorted: Vec<Named> = records.iter().map(|r| named(&names, r)).collect();
    sorted.sort_by(|a, b| same_run(a, b).then_with(|| a.1.order(b.1)));
    sorted
        .chunk_by(|a, b| same_run(a, b) == Ordering::Equal)
        .map(|chunk| Run { is: chunk[0].1, name: chunk[0].0, records: chunk.iter().map(|n| n.1).collect() })
        .collect()
}

/// The kernel shown where several are compared: the published one.
const USUAL_KERNEL: &str = "cubic-spline";

/// Series of a case without the meshfree ones that only try another kernel, and all series of the methods that do.
///
/// A method counts as compared where its name comes with three kernels or more, one of them the usual one.
pub(crate) fn kernels<'a>(all: &[Series<'a>]) -> (Vec<Series<'a>>, Vec<Series<'a>>) {
    let compared = |s: &Series| {
        let mut tried: Vec<&str> = all
            .iter()
            .filter(|o| o.name == s.name && o.is().family == s.is().family)
            .map(|o| o.is().variant.as_str())
            .collect();
        tried.sort();
        tried.dedup();
        s.is().family == "efg" && tried.len() > 2 && tried.contains(&USUAL_KERNEL)
    };
    let usual = |s: &&Series| !compared(s) || s.is().variant == USUAL_KERNEL;
    (all.iter().filter(usual).cloned().collect(), all.iter().filter(|s| compared(s)).cloned().collect())
}

/// Whether a case checks exactness only: its solution lies in every method's space, so that speed and locking mean nothing there.
pub(crate) fn is_patch(case: &str) -> bool {
    case.contains("patch") || case.contains("rigid")
}

/// Gathers runs into series: everything equal but the size.
pub(crate) fn series<'a>(runs: &[Run<'a>]) -> Vec<Series<'a>> {
    let mut all: Vec<Series<'a>> = Vec::new();
    for run in runs {
        let found = all.iter_mut().find(|s| {
            let is = s.is();
            s.name == run.name()
                && (&is.case, &is.family, &is.variant) == (&run.is.case, &run.is.family, &run.is.variant)
                && is.poisson.total_cmp(&run.is.poisson) == Ordering::Equal
                && is.seed == run.is.seed
                && settings(is) == settings(run.is)
        });
        match found {
            Some(series) => series.runs.push(run.clone()),
            None => all.push(Series { name: run.name(), runs: vec![run.clone()] }),
        }
    }
    for series in &mut all {
        series.runs.sort_by(|a, b| b.is.spacing.total_cmp(&a.is.spacing).then(a.is.nodes.cmp(&b.is.nodes)));
    }
    all
}

/// One label per record: the given name, and where names repeat also the settings that differ.
pub(crate) fn labels(named: &[(&str, &Record)]) -> Vec<String> {
    named
        .iter()
        .map(|(name, record)| {
            let namesakes: Vec<&Record> = named.iter().filter(|(n, _)| n == name).map(|(_, r)| *r).collect();
            let mut extra = Vec::new();
            if namesakes.iter().any(|r| r.variant != record.variant) {
                extra.push(record.variant.clone());
            }
            for setting in settings(record) {
                if namesakes.iter().any(|r| !settings(r).contains(&setting)) {
                    extra.push(setting.replace('=', " "));
                }
            }
            if namesakes.iter().any(|r| r.seed != record.seed) {
                extra.push(format!("seed {}", record.seed));
            }
            if extra.is_empty() { name.to_string() } else { format!("{name} ({})", extra.join(", ")) }
        })
        .collect()
}

/// Splits into neighbouring groups that agree in a key, keeping the order.
pub(crate) fn groups<T, K: PartialEq>(items: &[T], key: impl Fn(&T) -> K) -> Vec<&[T]> {
    items.chunk_by(|a, b| key(a) == key(b)).collect()
}
