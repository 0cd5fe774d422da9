//! Numbers recorded step by step or mode by mode, and curves of one quantity against another.

use std::collections::BTreeMap;

use catalogue::metric::{self, Address, Metric};
use records::{Family, Record};

use crate::select::Run;

/// Values of a quantity by step, for one statistic.
fn by_step(run: &Run, of: impl Into<Address>, statistic: &str) -> BTreeMap<u64, f64> {
    let of = of.into();
    let fits = |r: &&&Record| r.is(of) && r.statistic == statistic;
    run.records().iter().filter(fits).filter_map(|r| Some((r.step_or_mode()?, r.value))).collect()
}

/// `(x, y)` at every step that has both, in the order of the steps.
pub(crate) fn curve(run: &Run, x: &'static Metric, y: &'static Metric) -> Vec<(f64, f64)> {
    let along = by_step(run, x, "value");
    by_step(run, y, "value").into_iter().filter_map(|(step, y)| Some((*along.get(&step)?, y))).collect()
}

/// `(x, low, high)` at every step that has both bounds of an uncertainty.
pub(crate) fn band(run: &Run, x: &'static Metric, y: &'static Metric) -> Vec<(f64, f64, f64)> {
    let (along, high) = (by_step(run, x, "value"), by_step(run, y, "high"));
    let low = by_step(run, y, "low").into_iter();
    low.filter_map(|(step, low)| Some((*along.get(&step)?, low, *high.get(&step)?))).collect()
}

/// The run with which the others of a case are compared. It is the recorded reference, or else the method
/// whose tool force has an error of zero at every step and which therefore is the reference.
pub(crate) fn reference<'r, 'a>(case: &'r [Run<'a>]) -> Option<&'r Run<'a>> {
    let itself = |r: &&Run| {
        let errors = by_step(r, &metric::TOOL_FORCE_ERROR, "value");
        !errors.is_empty() && errors.values().all(|e| *e == 0.0)
    };
    case.iter().find(|r| r.is.family == Family::Reference).or_else(|| case.iter().find(itself))
}

/// Linear interpolation of a line at `x`; `None` beyond its ends.
pub(crate) fn between(line: &[(f64, f64)], x: f64) -> Option<f64> {
    // Two methods with the same prescribed travel may end a rounding error apart.
    let near = |a: f64| (a - x).abs() <= 1e-9 * x.abs();
    if let Some(met) = line.iter().find(|p| near(p.0)) {
        return Some(met.1);
    }
    let ends = line.windows(2).find(|w| (w[0].0..=w[1].0).contains(&x))?;
    Some(ends[0].1 + (x - ends[0].0) / (ends[1].0 - ends[0].0) * (ends[1].1 - ends[0].1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blank::Blank as _;
    use crate::select::runs;

    #[test]
    fn a_line_is_straight_between_its_points_and_ends_with_them() {
        let line = [(0.0, 0.0), (1.0, 2.0), (2.0, 6.0)];
        assert_eq!([0.5, 1.0, 1.5].map(|x| between(&line, x)), [Some(1.0), Some(2.0), Some(4.0)]);
        assert_eq!(
            (between(&line, 2.0 + 1e-12), between(&line, 2.1), between(&[], 1.0)),
            (Some(6.0), None, None)
        );
    }

    fn at(step: u64, quantity: &str, statistic: &str, value: f64) -> Record {
        Record {
            case: "grasp".into(),
            method: "measured".into(),
            family: Family::Reference,
            step: (step > 0).then_some(step),
            statistic: statistic.into(),
            value,
            ..Record::blank()
        }
        .named(quantity)
        .of_its_run()
    }

    #[test]
    fn steps_join_by_number_and_leave_plain_values_alone() {
        let records = [
            at(10, "closure", "value", 3.0),
            at(10, "tool-force", "value", 30.0),
            at(9, "tool-force", "value", 20.0),
            at(9, "closure", "value", 2.0),
            at(9, "tool-force", "low", 19.0),
            at(9, "tool-force", "high", 22.0),
            // No force at this step, and a bound without its counterpart.
            at(11, "closure", "value", 4.0),
            at(10, "tool-force", "low", 28.0),
            at(0, "strain-energy", "value", 7.0),
            at(9, "strain-energy", "value", 5.0),
        ];
        let runs = runs(&records);
        assert_eq!(runs.len(), 1);
        assert_eq!(curve(&runs[0], &metric::CLOSURE, &metric::TOOL_FORCE), [(2.0, 20.0), (3.0, 30.0)]);
        assert_eq!(band(&runs[0], &metric::CLOSURE, &metric::TOOL_FORCE), [(2.0, 19.0, 22.0)]);
        assert_eq!(
            (runs[0].value(&metric::STRAIN_ENERGY), runs[0].value(&metric::CLOSURE)),
            (Some(7.0), None)
        );
    }

    #[test]
    fn a_recorded_reference_comes_before_the_method_that_has_no_error() {
        let mut itself = at(1, "tool-force-error", "value", 0.0);
        (itself.family, itself.method) = (Family::Fem, "tet10".into());
        let itself = itself.of_its_run();
        let mut other = Record { method: "tet4".into(), value: 0.4, ..itself.clone() }.of_its_run();
        other.step = Some(2);
        let mut records = vec![itself.clone(), Record { value: 0.0, ..other.clone() }, other];
        records[1].step = Some(1);
        assert_eq!(reference(&runs(&records)).map(|r| r.is.method.as_str()), Some("tet10"));
        assert!(reference(&runs(&records[1..])).is_none());
        records.push(at(1, "tool-force", "value", 1.0));
        assert_eq!(reference(&runs(&records)).map(|r| r.is.method.as_str()), Some("measured"));
    }
}
