//! Paired difference of two sets of numbers: each number before with the same number after.

use std::collections::BTreeMap;

use polars::prelude::*;

use crate::error::RecordError;
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
///
/// # Errors
/// A frame that cannot be joined.
pub fn difference(before: &Numbers, after: &Numbers) -> Result<Difference, RecordError> {
    let keys = || [col("run"), col("quantity"), col("unit"), col("index")];
    let in_full = JoinArgs::new(JoinType::Full).with_coalesce(JoinCoalesce::CoalesceColumns);
    let run = || [col("run")];
    let joined = frame(before, "before")?
        .join(frame(after, "after")?, keys(), keys(), in_full)
        .with_columns([
            col("before size").max().over([col("run"), col("unit")])?.fill_null(lit(0.0)).alias("scale"),
            col("before").count().over(run())?.alias("befores"),
            col("after").count().over(run())?.alias("afters"),
        ])
        .sort(["run", "quantity", "index"], SortMultipleOptions::default())
        .collect()?;
    let (names, quantities) = (joined.column("run")?.str()?, joined.column("quantity")?.str()?);
    let [values, others, scales] =
        [column(&joined, "before")?, column(&joined, "after")?, column(&joined, "scale")?];
    let (befores, afters) = (joined.column("befores")?.u32()?, joined.column("afters")?.u32()?);
    let mut found = Difference::default();
    for row in 0..joined.height() {
        let (Some(run), Some(quantity)) = (names.get(row), quantities.get(row)) else { continue };
        let alone = match (befores.get(row), afters.get(row)) {
            (_, Some(0)) => Some(&mut found.only_before),
            (Some(0), _) => Some(&mut found.only_after),
            _ => None,
        };
        if let Some(runs) = alone {
            if runs.last().is_none_or(|last| last != run) {
                runs.push(run.to_string());
            }
            continue;
        }
        let pair = Pair { before: values.get(row), after: others.get(row) };
        match found.paired.last_mut() {
            Some(last) if last.run == run && last.quantity == quantity => last.pairs.push(pair),
            _ => found.paired.push(Paired {
                run: run.to_string(),
                quantity: quantity.to_string(),
                scale: scales.get(row).unwrap_or(0.0),
                pairs: vec![pair],
            }),
        }
    }
    Ok(found)
}

fn column<'f>(frame: &'f DataFrame, name: &str) -> PolarsResult<&'f Float64Chunked> {
    frame.column(name)?.f64()
}

/// Returns a frame with one row for each number: run, quantity, unit, index in its list, the number under the
/// given name, and its magnitude (1 for pure numbers).
fn frame(numbers: &Numbers, name: &str) -> PolarsResult<LazyFrame> {
    let rows: Vec<(&str, &str, u32, f64)> = numbers
        .iter()
        .flat_map(|(run, quantities)| {
            quantities.iter().flat_map(move |(quantity, values)| {
                (0..).zip(values).map(move |(index, value)| (run.as_str(), quantity.as_str(), index, *value))
            })
        })
        .collect();
    let texts = |name: &str, of: fn(&(_, _, u32, f64)) -> &str| {
        Column::new(name.into(), rows.iter().map(of).collect::<Vec<_>>())
    };
    let size = |row: &(&str, &str, u32, f64)| if unit(row.1) == "1" { 1.0 } else { row.3.abs() };
    let columns = vec![
        texts("run", |row| row.0),
        texts("quantity", |row| row.1),
        texts("unit", |row| unit(row.1)),
        Column::new("index".into(), rows.iter().map(|row| row.2).collect::<Vec<_>>()),
        Column::new(format!("{name} size").into(), rows.iter().map(size).collect::<Vec<_>>()),
        Column::new(name.into(), rows.iter().map(|row| row.3).collect::<Vec<_>>()),
    ];
    Ok(DataFrame::new(rows.len(), columns)?.lazy())
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
        let found = difference(&before, &after).unwrap();
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
        assert_eq!(difference(&Numbers::new(), &Numbers::new()).unwrap(), Difference::default());
    }
}
