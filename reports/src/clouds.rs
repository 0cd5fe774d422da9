//! Runs that differ only in the seed of their cloud, which show how results depend on node placement.

use catalogue::metric::Metric;

use crate::select::Run;

/// Runs of one method on many clouds, with ascending seeds.
pub(crate) type Clouds<'a> = Vec<Run<'a>>;

/// Splits runs into those shown elsewhere, one cloud per method, and the groups of several clouds.
pub(crate) fn part<'a>(runs: &[Run<'a>]) -> (Vec<Run<'a>>, Vec<Clouds<'a>>) {
    let mut groups: Vec<Clouds> = Vec::new();
    for run in runs {
        match groups.iter_mut().find(|g| same_but_seed(&g[0], run)) {
            Some(group) => group.push(run.clone()),
            None => groups.push(vec![run.clone()]),
        }
    }
    for group in &mut groups {
        group.sort_by_key(|run| run.is.seed);
    }
    let shown = groups.iter().map(|group| group[0].clone()).collect();
    groups.retain(|group| group.len() > 1);
    (shown, groups)
}

fn same_but_seed(a: &Run, b: &Run) -> bool {
    let (x, y) = (a.is, b.is);
    x.seed != y.seed
        && (&x.case, &x.method, &x.family, &x.variant) == (&y.case, &y.method, &y.family, &y.variant)
        && (x.level, x.nodes) == (y.level, y.nodes)
        && x.settings() == y.settings()
        && x.poisson.total_cmp(&y.poisson).is_eq()
}

/// Minimum, lower quartile, median, upper quartile and maximum of a quantity over the clouds that have it,
/// and their number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Spread {
    pub(crate) count: usize,
    pub(crate) quantiles: [f64; 5],
}

impl Spread {
    /// Computes the quantiles over the runs that reached their whole load; `None` without any.
    pub(crate) fn of(clouds: &[Run], of: &'static Metric) -> Option<Spread> {
        let mut values: Vec<f64> =
            clouds.iter().filter(|run| run.whole()).filter_map(|run| run.value(of)).collect();
        values.sort_by(f64::total_cmp);
        let last = values.len().checked_sub(1)?;
        // Linear interpolation between sorted values, as in R by default (Hyndman & Fan 1996, type 7).
        let quantile = |part: f64| {
            let at = part * last as f64;
            let below = at.floor() as usize;
            values[below] + (at - below as f64) * (values[last.min(below + 1)] - values[below])
        };
        Some(Spread { count: values.len(), quantiles: [0.0, 0.25, 0.5, 0.75, 1.0].map(quantile) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blank::Blank as _;
    use crate::select::runs;
    use catalogue::metric;
    use records::{Family, Record};

    fn record(method: &str, seed: u64, quantity: &str, value: f64) -> Record {
        Record {
            case: "block".into(),
            method: method.into(),
            series: method.into(),
            family: Family::Efg,
            nodes: 83,
            seed,
            value,
            ..Record::blank()
        }
        .named(quantity)
        .of_its_run()
    }

    #[test]
    fn one_cloud_is_shown_and_all_are_counted() {
        let mut records: Vec<Record> = [5.0, 1.0, 4.0, 2.0]
            .iter()
            .zip([3, 1, 4, 2])
            .map(|(&v, seed)| record("efg", seed, "l2", v))
            .collect();
        records.push(record("other", 7, "l2", 9.0));
        // Errors of a cloud that reached only a part of its load refer to that part.
        records.push(record("efg", 3, "load-carried", 0.5));
        let all = runs(&records);
        let (shown, clouds) = part(&all);
        assert_eq!(
            shown.iter().map(|r| (r.name(), r.is.seed)).collect::<Vec<_>>(),
            [("efg", 1), ("other", 7)]
        );
        assert_eq!(clouds.len(), 1);
        assert_eq!(clouds[0].iter().map(|r| r.is.seed).collect::<Vec<_>>(), [1, 2, 3, 4]);
        let spread = Spread::of(&clouds[0], &metric::L2).unwrap();
        assert_eq!(spread, Spread { count: 3, quantiles: [1.0, 1.5, 2.0, 3.0, 4.0] });
        assert_eq!(Spread::of(&clouds[0], &metric::ENERGY), None);
    }
}
