//! Comparison of the numbers that do not depend on the moment, by a tolerance.

use catalogue::metric;
use records::{Pair, Paired, RunSet, difference, numbers};
use serde::Serialize;

/// Result of a comparison of numbers.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Numbers {
    /// Relative difference above which a number has changed.
    pub tolerance: f64,
    /// Number of values compared.
    pub compared: usize,
    /// Runs that exist only in the results before.
    pub only_before: Vec<String>,
    /// Runs that exist only in the results after.
    pub only_after: Vec<String>,
    /// Changed numbers, the largest change first.
    pub changes: Vec<NumberChange>,
}

/// A changed number.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NumberChange {
    /// Name of the run: case, method, settings and size.
    pub run: String,
    /// Quantity with its unit; a history is represented by the step with the largest change.
    pub quantity: String,
    /// Value before, SI; absent if it exists only after.
    pub before: Option<f64>,
    /// Value after, SI; absent if it exists only before.
    pub after: Option<f64>,
    /// Difference over the larger of the two; 1 if either is absent.
    pub relative: f64,
    /// `better` or `worse` for errors, `differs` for other results.
    pub verdict: &'static str,
}

impl Numbers {
    pub(super) fn of(before: &RunSet, after: &RunSet, tolerance: f64) -> Numbers {
        let found = difference(&numbers(&before.records), &numbers(&after.records));
        let mut changes: Vec<NumberChange> =
            found.paired.iter().filter_map(|paired| change(paired, tolerance)).collect();
        changes.sort_by(|a, b| b.relative.total_cmp(&a.relative));
        Numbers {
            tolerance,
            compared: found.paired.iter().map(|paired| paired.pairs.len()).sum(),
            only_before: found.only_before,
            only_after: found.only_after,
            changes,
        }
    }

    pub(super) fn is_same(&self) -> bool {
        self.changes.is_empty() && self.only_before.is_empty() && self.only_after.is_empty()
    }
}

/// Fraction of the largest number of the same unit in a run below which a number is rounding.
const ROUNDING: f64 = 1e-9;

/// The largest change among the steps of a quantity, if it exceeds the tolerance.
fn change(paired: &Paired, tolerance: f64) -> Option<NumberChange> {
    let relative = |pair: &Pair| match (pair.before, pair.after) {
        (Some(a), Some(b)) if (a - b).abs() <= ROUNDING * paired.scale => 0.0,
        (Some(a), Some(b)) => (a - b).abs() / a.abs().max(b.abs()),
        _ => 1.0,
    };
    let Pair { before, after } = *paired.pairs.iter().max_by(|a, b| relative(a).total_cmp(&relative(b)))?;
    let relative = relative(&Pair { before, after });
    let name = paired.quantity.split(' ').next().unwrap_or(&paired.quantity);
    let verdict = match (metric::find(name).is_some_and(|of| of.metric.lower_is_better()), before, after) {
        (true, Some(a), Some(b)) if b > a => "worse",
        (true, Some(_), Some(_)) => "better",
        _ => "differs",
    };
    let (run, quantity) = (paired.run.clone(), paired.quantity.clone());
    (relative > tolerance).then_some(NumberChange { run, quantity, before, after, relative, verdict })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blank::Blank as _;
    use records::Record;

    fn set(numbers: &[(&str, &str, Option<u64>, f64)]) -> RunSet {
        let record = |&(method, quantity, step, value): &(&str, &str, Option<u64>, f64)| {
            let (case, method) = ("block".into(), method.to_string());
            Record { case, method, step, value, ..Record::blank() }.named(quantity)
        };
        RunSet { records: numbers.iter().map(record).collect(), ..RunSet::default() }
    }

    #[test]
    fn a_change_beyond_the_tolerance_is_one_and_says_which_way() {
        let before = set(&[("tet4", "rms", None, 1.0), ("tet4", "max-z", None, 2.0)]);
        let after = set(&[("tet4", "rms", None, 1.02), ("tet4", "max-z", None, 2.001)]);
        let found = |tolerance| Numbers::of(&before, &after, tolerance);
        assert!(found(0.05).is_same());
        let one = found(0.01);
        assert_eq!((one.changes.len(), one.changes[0].verdict, one.compared), (1, "worse", 2));
        assert!((one.changes[0].relative - 0.02 / 1.02).abs() < 1e-12);
        let all: Vec<&str> = found(1e-6).changes.iter().map(|c| c.verdict).collect();
        assert_eq!(all, ["worse", "differs"]);
        assert_eq!(Numbers::of(&after, &before, 0.01).changes[0].verdict, "better");
    }

    #[test]
    fn rounding_is_no_change_and_a_history_is_one() {
        let before =
            set(&[("a", "rms", None, 1e-12), ("a", "max-z", None, 1.0), ("a", "closure", Some(1), 0.1)]);
        let after =
            set(&[("a", "rms", None, 3e-12), ("a", "max-z", None, 1.0), ("a", "closure", Some(1), 0.2)]);
        let found = Numbers::of(&before, &after, 1e-6);
        assert_eq!(found.changes.len(), 1, "{found:?}");
        assert_eq!((found.changes[0].before, found.changes[0].after), (Some(0.1), Some(0.2)));
    }

    #[test]
    fn a_small_number_beside_a_large_one_changes_above_rounding() {
        let at = |small: f64| set(&[("a", "max-z", None, 1.0), ("a", "max-x", None, small)]);
        let changes = |small: f64| Numbers::of(&at(1e-3), &at(small), 1e-6).changes.len();
        assert_eq!((changes(1e-3 + 5e-10), changes(1e-3 + 2e-9), changes(1e-3 + 1e-7)), (0, 1, 1));
    }

    #[test]
    fn what_is_missing_is_named() {
        let before = set(&[("a", "rms", None, 1.0), ("a", "max-z", None, 1.0)]);
        let after = set(&[("a", "rms", None, 1.0), ("b", "rms", None, 1.0)]);
        let found = Numbers::of(&before, &after, 1e-6);
        assert!(found.only_before.is_empty() && found.only_after.len() == 1 && !found.is_same());
        assert_eq!((found.changes[0].after, found.changes[0].verdict), (None, "differs"));
    }
}
