//! Paired difference of two sets of numbers: each number before with the same number after.

use std::collections::{BTreeMap, BTreeSet};

use crate::record::Record;

/// Numbers by run and quantity, SI. The name of a quantity ends with its unit, as in `rms-x [m]` and
/// `tool-force by step [N]`.
pub type Numbers = BTreeMap<String, BTreeMap<String, Vec<f64>>>;

/// Collects the numbers of `records` that do not depend on the machine and the moment. Each history gives one
/// list.
pub fn numbers(records: &[Record]) -> Numbers {
    let mut by_index: BTreeMap<(String, String), BTreeMap<u64, f64>> = BTreeMap::new();
    for record in records.iter().filter(|r| !r.is_measured()) {
        let name = (record.run_name(), record.quantity_name());
        by_index.entry(name).or_default().insert(record.step_or_mode().unwrap_or(0), record.value);
    }
    let mut numbers = Numbers::new();
    for ((run, quantity), values) in by_index {
        numbers.entry(run).or_default().insert(quantity, values.into_values().collect());
    }
    numbers
}

/// A number before and after.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Value before; absent if it exists only after.
    pub before: Option<f64>,
    /// Value after; absent if it exists only before.
    pub after: Option<f64>,
}

/// A quantity of a run in both sets, with its numbers in order.
#[derive(Clone, Debug, PartialEq)]
pub struct Paired {
    /// Name of the run.
    pub run: String,
    /// Quantity with its unit.
    pub quantity: String,
    /// Largest number of this unit in the run before; numbers far below it are rounding. The scale is 1 for
    /// pure numbers, because an error of 1e-10 counts as exact in any run.
    pub scale: f64,
    /// Numbers of the quantity, one pair for each step or mode.
    pub pairs: Vec<Pair>,
}

/// The difference of two sets of numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Difference {
    /// Runs without numbers after, in the order of their names.
    pub only_before: Vec<String>,
    /// Runs without numbers before, in the order of their names.
    pub only_after: Vec<String>,
    /// Quantities of the runs in both sets, in the order of their names.
    pub paired: Vec<Paired>,
}

/// Pairs two sets of numbers by run, quantity and index in the list.
pub fn difference(before: &Numbers, after: &Numbers) -> Difference {
    let only = |of: &Numbers, other: &Numbers| -> Vec<String> {
        of.keys().filter(|run| !other.contains_key(*run)).cloned().collect()
    };
    let both = before.iter().filter_map(|(run, of)| Some((run, of, after.get(run)?)));
    Difference {
        only_before: only(before, after),
        only_after: only(after, before),
        paired: both.flat_map(|(run, before, after)| of_run(run, before, after)).collect(),
    }
}

/// Pairs the quantities of a run.
fn of_run(run: &str, before: &BTreeMap<String, Vec<f64>>, after: &BTreeMap<String, Vec<f64>>) -> Vec<Paired> {
    let mut scales: BTreeMap<&str, f64> = BTreeMap::new();
    for (quantity, values) in before {
        let unit = unit(quantity);
        let sizes = values.iter().map(|value| if unit == "1" { 1.0 } else { value.abs() });
        let scale = scales.entry(unit).or_default();
        *scale = sizes.fold(*scale, f64::max);
    }
    let quantities: BTreeSet<&String> = before.keys().chain(after.keys()).collect();
    let paired = |quantity: &String| {
        let values = |of: &BTreeMap<String, Vec<f64>>| of.get(quantity).cloned().unwrap_or_default();
        let (before, after) = (values(before), values(after));
        let indices = 0..before.len().max(after.len());
        let pair = |index| Pair { before: before.get(index).copied(), after: after.get(index).copied() };
        Paired {
            run: run.to_string(),
            quantity: quantity.clone(),
            scale: scales.get(unit(quantity)).copied().unwrap_or(0.0),
            pairs: indices.map(pair).collect(),
        }
    };
    quantities.into_iter().map(paired).collect()
}

/// Unit of a quantity by its name, `m` for `rms-x [m]`.
fn unit(quantity: &str) -> &str {
    quantity.rsplit_once('[').map_or("", |(_, unit)| unit.trim_end_matches(']'))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(all: &[(&str, &str, &[f64])]) -> Numbers {
        let mut numbers = Numbers::new();
        for (run, quantity, values) in all {
            numbers.entry((*run).into()).or_default().insert((*quantity).into(), values.to_vec());
        }
        numbers
    }

    #[test]
    fn numbers_are_paired_by_run_quantity_and_place() {
        let before = numbers(&[
            ("a", "rms [m]", &[0.1]),
            ("a", "force by step [N]", &[1.0, 2.0, -5.0]),
            ("gone", "rms [m]", &[0.3]),
        ]);
        let after = numbers(&[
            ("a", "rms [m]", &[0.2]),
            ("a", "force by step [N]", &[1.0, 2.5]),
            ("a", "l2 [1]", &[0.5]),
            ("new", "rms [m]", &[0.4]),
        ]);
        let found = difference(&before, &after);
        assert_eq!(
            (found.only_before, found.only_after),
            (vec!["gone".to_string()], vec!["new".to_string()])
        );
        let pairs = |all: &[(Option<f64>, Option<f64>)]| -> Vec<Pair> {
            all.iter().map(|&(before, after)| Pair { before, after }).collect()
        };
        let paired = |quantity: &str, scale, all: &[(Option<f64>, Option<f64>)]| Paired {
            run: "a".into(),
            quantity: quantity.into(),
            scale,
            pairs: pairs(all),
        };
        let expected = [
            paired(
                "force by step [N]",
                5.0,
                &[(Some(1.0), Some(1.0)), (Some(2.0), Some(2.5)), (Some(-5.0), None)],
            ),
            paired("l2 [1]", 0.0, &[(None, Some(0.5))]),
            paired("rms [m]", 0.1, &[(Some(0.1), Some(0.2))]),
        ];
        assert_eq!(found.paired, expected);
    }

    #[test]
    fn nothing_has_no_difference() {
        assert_eq!(difference(&Numbers::new(), &Numbers::new()), Difference::default());
    }
}
