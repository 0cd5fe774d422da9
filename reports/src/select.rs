//! Selection of records: runs (one discretisation) and series (one approximation at several sizes).

use std::cmp::Ordering;

use catalogue::element;
use catalogue::metric::{self, Address, Metric};
use records::text::ratio;
use records::{Family, Purpose, Record};

use crate::seconds::Seconds;

/// All numbers of one discretisation of one case.
#[derive(Clone, Debug)]
pub(crate) struct Run<'a> {
    /// A record of the run, which identifies it.
    pub(crate) is: &'a Record,
    /// Kind of time by which the run is compared.
    pub(crate) by: Seconds,
    records: Vec<&'a Record>,
}

impl<'a> Run<'a> {
    /// Plain value of a quantity, which is not part of a history.
    pub(crate) fn value(&self, of: impl Into<Address>) -> Option<f64> {
        let of = of.into();
        let fits = |r: &&&Record| r.is(of) && r.statistic == "value" && r.step_or_mode().is_none();
        self.records.iter().find(fits).map(|r| r.value)
    }

    /// Error of the reference itself in a quantity, if known. Smaller errors of the run are not significant.
    pub(crate) fn band(&self, of: impl Into<Address>) -> Option<f64> {
        let of = of.into();
        self.records.iter().find(|r| r.is(of) && r.statistic == "band").map(|r| r.value)
    }

    /// All records of the run.
    pub(crate) fn records(&self) -> &[&'a Record] {
        &self.records
    }

    /// Statistic of the wall or CPU time of a phase, s.
    pub(crate) fn timed(&self, kind: &'static Metric, phase: &str, statistic: &str) -> Option<f64> {
        let fits = |r: &&&Record| r.is(kind) && r.phase == phase && r.statistic == statistic;
        self.records.iter().find(fits).map(|r| r.value)
    }

    /// Time of a phase by statistic, s. If runs are not compared by median wall time, the `median` is the
    /// time of the comparison, and there is no `spread`.
    pub(crate) fn time(&self, phase: &str, statistic: &str) -> Option<f64> {
        let wall = |statistic| self.timed(&metric::TIME, phase, statistic);
        match (self.by, statistic) {
            (Seconds::Cpu, "median") => {
                self.timed(&metric::CPU_TIME, phase, statistic).or_else(|| wall(statistic))
            }
            (Seconds::Least, "median") => wall("min").or_else(|| wall(statistic)),
            (Seconds::Cpu | Seconds::Least, "spread") => None,
            _ => wall(statistic),
        }
    }

    /// Rates of the loop in real time, frames per second, ascending as in the scene.
    pub(crate) fn rates(&self) -> Vec<u64> {
        let mut rates = Vec::new();
        for record in self.records() {
            if let Some(Ok(rate)) = record.phase.strip_prefix("loop-").map(str::parse)
                && !rates.contains(&rate)
            {
                rates.push(rate);
            }
        }
        rates.sort_unstable();
        rates
    }

    /// Wall time of the first pass, s, if it was discarded because it used its memory for the first time.
    pub(crate) fn first_use(&self) -> Option<f64> {
        self.timed(&metric::TIME, "first-use", "value")
    }

    /// Median time of the whole run, s: its `total`, or else the sum of its phases.
    pub(crate) fn total(&self) -> Option<f64> {
        self.time("total", "median").or_else(|| {
            let phases = ["refine", "prepare", "assemble", "factor", "solve", "transfer"];
            let times: Vec<f64> = phases.iter().filter_map(|p| self.time(p, "median")).collect();
            (!times.is_empty()).then(|| times.iter().sum())
        })
    }

    /// Whether the run reached the whole load; true for a run without load steps.
    pub(crate) fn whole(&self) -> bool {
        self.value(&metric::LOAD_CARRIED).is_none_or(|load| load > 0.999_999)
    }

    /// Whether the run recorded a quantity, as a plain value or in a history.
    pub(crate) fn has(&self, of: impl Into<Address>) -> bool {
        let of = of.into();
        self.records.iter().any(|r| r.is(of))
    }

    /// Whether the run is the reference of the others, with an error of zero. An exact solution is not a run.
    pub(crate) fn is_reference(&self) -> bool {
        self.value(&metric::RELATIVE_RMS) == Some(0.0) && self.value(&metric::L2).is_none()
    }

    /// Peak memory of the method in excess of its input, bytes.
    pub(crate) fn memory(&self) -> Option<f64> {
        self.memory_of("")
    }

    /// Peak memory of the whole process, bytes.
    pub(crate) fn memory_of_process(&self) -> Option<f64> {
        self.memory_of("process")
    }

    fn memory_of(&self, phase: &str) -> Option<f64> {
        self.records.iter().find(|r| r.is(&metric::MEMORY) && r.phase == phase).map(|r| r.value)
    }

    /// Name of the series.
    pub(crate) fn name(&self) -> &'a str {
        &self.is.series
    }
}

/// An approximation at several sizes, from coarse to fine.
#[derive(Clone, Debug)]
pub(crate) struct Series<'a> {
    /// Runs by decreasing spacing.
    pub(crate) runs: Vec<Run<'a>>,
}

impl<'a> Series<'a> {
    /// A record of the series. Case, family, variant, settings and Poisson's ratio are the same in all its
    /// records.
    pub(crate) fn is(&self) -> &'a Record {
        self.runs[0].is
    }

    /// Common name of the sizes.
    pub(crate) fn name(&self) -> &'a str {
        &self.is().series
    }

    /// The finest run.
    pub(crate) fn finest(&self) -> &Run<'a> {
        &self.runs[self.runs.len() - 1]
    }

    /// `(spacing, value)` of a quantity, from coarse to fine, for positive spacings and values.
    pub(crate) fn points(&self, of: impl Into<Address>) -> Vec<(f64, f64)> {
        let of = of.into();
        let point = |run: &Run| run.value(of).map(|v| (run.is.spacing, v));
        self.runs.iter().filter_map(point).filter(|(h, v)| *h > 0.0 && *v > 0.0).collect()
    }

    /// Theoretical order of the error for a smooth solution: p + 1 for displacement, p for energy.
    pub(crate) fn theory(&self, error: &Metric) -> Option<f64> {
        let degree =
            degree(self.is()).filter(|_| matches!(self.is().purpose, Purpose::Patch | Purpose::Smooth))?;
        let is_displacement = [&metric::L2, &metric::RMS].contains(&error);
        let order = if is_displacement { degree + 1.0 } else { degree };
        (is_displacement || *error == metric::ENERGY).then_some(order)
    }
}

/// Polynomial degree to which the approximation is complete.
fn degree(record: &Record) -> Option<f64> {
    match (record.family, record.variant.as_str(), record.basis.as_deref()) {
        (Family::Fem | Family::External, name, _) => element::find(name).map(|element| element.degree as f64),
        (Family::Efg, _, Some("linear")) => Some(1.0),
        (Family::Efg, _, Some("quadratic")) => Some(2.0),
        _ => None,
    }
}

/// Sort key of methods: elements in their usual order, then meshfree methods, then transfer schemes.
fn rank(record: &Record) -> (Family, usize) {
    let known = element::ELEMENTS.iter().position(|known| known.name == record.variant);
    (record.family, known.unwrap_or(element::ELEMENTS.len()))
}

/// Order of runs in tables and figures: by case, Poisson's ratio and family, elements before clouds, then by
/// settings and size.
fn shown(a: &Record, b: &Record) -> Ordering {
    type Who<'a> = (&'a str, &'a str, Vec<(&'static str, String)>, u64, u32, u64, &'a str, &'a str);
    fn who(r: &Record) -> Who<'_> {
        (&r.series, &r.variant, r.settings(), r.seed, r.level, r.nodes, &r.method, &r.run)
    }
    (a.case.cmp(&b.case))
        .then(a.poisson.total_cmp(&b.poisson))
        .then(rank(a).cmp(&rank(b)))
        .then_with(|| who(a).cmp(&who(b)))
}

/// Gathers records into runs, in the order of tables and figures.
pub(crate) fn runs<'r>(records: impl IntoIterator<Item = &'r Record>) -> Vec<Run<'r>> {
    let mut sorted: Vec<&Record> = records.into_iter().collect();
    sorted.sort_by_key(|r| r.key());
    let by_run = sorted.chunk_by(|a, b| a.run == b.run);
    let mut runs: Vec<Run> =
        by_run.map(|chunk| Run { is: chunk[0], by: Seconds::Wall, records: chunk.to_vec() }).collect();
    runs.sort_by(|a, b| shown(a.is, b.is));
    runs
}

/// Kernel that is shown if several kernels are compared: that of the publication.
const USUAL_KERNEL: &str = "cubic-spline";

/// Returns the series of a case without meshfree series that only vary the kernel, and all series of the
/// methods with such variations.
///
/// A method counts as compared if its name occurs with three or more kernels, including the usual one.
pub(crate) fn kernels<'a>(all: &[Series<'a>]) -> (Vec<Series<'a>>, Vec<Series<'a>>) {
    let compared = |s: &Series| {
        let mut tried: Vec<&str> = all
            .iter()
            .filter(|o| o.name() == s.name() && o.is().family == s.is().family)
            .map(|o| o.is().variant.as_str())
            .collect();
        tried.sort();
        tried.dedup();
        s.is().family == Family::Efg && tried.len() > 2 && tried.contains(&USUAL_KERNEL)
    };
    let usual = |s: &&Series| !compared(s) || s.is().variant == USUAL_KERNEL;
    (all.iter().filter(usual).cloned().collect(), all.iter().filter(|s| compared(s)).cloned().collect())
}

/// Runs of solvers, without transfer schemes.
pub(crate) fn solved<'a>(runs: &[Run<'a>]) -> Vec<Run<'a>> {
    runs.iter().filter(|r| r.is.family != Family::Interp).cloned().collect()
}

/// Runs grouped by case, without cases that only test exactness, for which speed and locking have no meaning.
/// The runs of a case must be adjacent.
pub(crate) fn competing<'a, 'r>(runs: &'a [Run<'r>]) -> impl Iterator<Item = &'a [Run<'r>]> {
    by_case(runs).filter(|case| case[0].is.purpose != Purpose::Patch)
}

/// Solver runs of every case except patch tests, with titles, at the Poisson's ratios closest to 0.3 and
/// 0.495.
pub(crate) fn chosen<'a, 'r>(runs: &'a [Run<'r>]) -> Vec<(String, &'a [Run<'r>])> {
    let mut out = Vec::new();
    for case in competing(runs) {
        let name = &case[0].is.case;
        let several = case.iter().any(|r| r.is.poisson != case[0].is.poisson);
        let compressible = representative(case, 0.3);
        let tissue = representative(case, 0.495);
        for group in [compressible, tissue] {
            let poisson = group[0].is.poisson;
            let title = if several { format!("{name}, ν = {}", ratio(poisson)) } else { name.clone() };
            if out.iter().all(|(t, _)| *t != title) {
                out.push((title, group));
            }
        }
    }
    out
}

/// Runs of a case at the Poisson's ratio closest to the given one.
pub(crate) fn representative<'a, 'r>(case: &'a [Run<'r>], poisson: f64) -> &'a [Run<'r>] {
    let off = |g: &&[Run]| (g[0].is.poisson - poisson).abs();
    groups(case, |r| r.is.poisson.to_bits())
        .into_iter()
        .min_by(|a, b| off(a).total_cmp(&off(b)))
        .unwrap_or(case)
}

/// Gathers runs into series, whose members differ only in size.
pub(crate) fn series<'a>(runs: &[Run<'a>]) -> Vec<Series<'a>> {
    let mut all: Vec<Series<'a>> = Vec::new();
    for run in runs {
        let found = all.iter_mut().find(|s| {
            let is = s.is();
            s.name() == run.name()
                && (&is.case, &is.family, &is.variant) == (&run.is.case, &run.is.family, &run.is.variant)
                && is.poisson.total_cmp(&run.is.poisson) == Ordering::Equal
                && is.seed == run.is.seed
                && is.settings() == run.is.settings()
        });
        match found {
            Some(series) => series.runs.push(run.clone()),
            None => all.push(Series { runs: vec![run.clone()] }),
        }
    }
    for series in &mut all {
        series.runs.sort_by(|a, b| b.is.spacing.total_cmp(&a.is.spacing).then(a.is.nodes.cmp(&b.is.nodes)));
    }
    all
}

/// Labels of records: the name of the series and, for repeated names, the settings that differ.
pub(crate) fn labels<'r>(records: impl IntoIterator<Item = &'r Record>) -> Vec<String> {
    let all: Vec<_> = records.into_iter().map(|r| (r, r.settings())).collect();
    let label = |(record, settings): &(&Record, Vec<(&str, String)>)| {
        let namesakes: Vec<_> = all.iter().filter(|(r, _)| r.series == record.series).collect();
        let mut extra = Vec::new();
        if namesakes.iter().any(|(r, _)| r.variant != record.variant) {
            extra.push(record.variant.clone());
        }
        for setting in settings.iter().filter(|s| namesakes.iter().any(|(_, others)| !others.contains(s))) {
            extra.push(format!("{} {}", setting.0, setting.1));
        }
        if namesakes.iter().any(|(r, _)| r.seed != record.seed) {
            extra.push(format!("seed {}", record.seed));
        }
        match extra.is_empty() {
            true => record.series.clone(),
            false => format!("{} ({})", record.series, extra.join(", ")),
        }
    };
    all.iter().map(label).collect()
}

/// Runs, each with a label that is unique within its case and Poisson's ratio.
pub(crate) fn labelled<'a, 'r>(runs: &'a [Run<'r>]) -> Vec<(&'a Run<'r>, String)> {
    let mut out = Vec::new();
    for group in by_material(runs) {
        out.extend(group.iter().zip(labels(group.iter().map(|r| r.is))));
    }
    out
}

/// Runs of each case, named `case` or `case at ν = 0.3`, without patch tests.
pub(crate) fn named_cases<'a, 'r>(runs: &'a [Run<'r>]) -> Vec<(String, &'a [Run<'r>])> {
    let mut out = Vec::new();
    for case in competing(runs) {
        let by_ratio = groups(case, |r| r.is.poisson.to_bits());
        for group in &by_ratio {
            let is = group[0].is;
            let name = if by_ratio.len() > 1 {
                format!("{} at ν = {}", is.case, ratio(is.poisson))
            } else {
                is.case.clone()
            };
            out.push((name, *group));
        }
    }
    out
}

/// Adjacent runs grouped by case.
pub(crate) fn by_case<'a, 'r>(runs: &'a [Run<'r>]) -> impl Iterator<Item = &'a [Run<'r>]> {
    runs.chunk_by(|a, b| a.is.case == b.is.case)
}

/// Adjacent runs grouped by case and Poisson's ratio.
pub(crate) fn by_material<'a, 'r>(runs: &'a [Run<'r>]) -> impl Iterator<Item = &'a [Run<'r>]> {
    runs.chunk_by(|a, b| a.is.case == b.is.case && a.is.poisson.to_bits() == b.is.poisson.to_bits())
}

/// Splits items into adjacent groups with equal keys, in order.
pub(crate) fn groups<T, K: PartialEq>(items: &[T], key: impl Fn(&T) -> K) -> Vec<&[T]> {
    items.chunk_by(|a, b| key(a) == key(b)).collect()
}
