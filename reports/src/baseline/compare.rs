//! Two baselines against each other, run by run and quantity by quantity.

use std::collections::BTreeMap;

use super::tolerance::close;
use super::{Baseline, Numbers};

/// What is different in one run.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// The run is new.
    Added {
        /// Its name.
        run: String,
    },
    /// The run is no longer there.
    Removed {
        /// Its name.
        run: String,
    },
    /// The run has another name; its numbers are the same.
    Renamed {
        /// Name in the baseline.
        from: String,
        /// Name now.
        to: String,
    },
    /// A quantity of the run differs, is new or is no longer there.
    Number {
        /// The run.
        run: String,
        /// Quantity with its unit.
        quantity: String,
        /// Accepted values; empty where it is new.
        before: Vec<f64>,
        /// Values now; empty where it is no longer there.
        now: Vec<f64>,
    },
}

/// What is different between a baseline and the numbers now.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Differences, in the order of their runs.
    pub changes: Vec<Change>,
    /// Whether numbers had to be the same bits: both are of the same kind of processor.
    pub bitwise: bool,
    /// Numbers compared.
    pub compared: usize,
}

impl Baseline {
    /// Compares accepted numbers with those of now; runs that only the baseline has are differences if `whole`, as the
    /// numbers of now are those of the whole study.
    pub fn compare(&self, now: &Baseline, whole: bool) -> Comparison {
        let bitwise = self.processor == now.processor;
        let mut changes = Vec::new();
        let mut compared = 0;
        let gone: Vec<(&String, &Numbers)> =
            self.runs.iter().filter(|(run, _)| !now.runs.contains_key(*run)).collect();
        let mut renamed = Vec::new();
        for (run, numbers) in &now.runs {
            let Some(accepted) = self.runs.get(run) else {
                let same = gone.iter().find(|(from, old)| *old == numbers && !renamed.contains(from));
                changes.push(match same {
                    Some((from, _)) => {
                        renamed.push(*from);
                        Change::Renamed { from: from.to_string(), to: run.clone() }
                    }
                    None => Change::Added { run: run.clone() },
                });
                continue;
            };
            compared += accepted.values().map(Vec::len).sum::<usize>();
            changes.extend(differences(run, accepted, numbers, bitwise));
        }
        let lost = gone.iter().filter(|(run, _)| whole && !renamed.contains(run));
        changes.extend(lost.map(|(run, _)| Change::Removed { run: run.to_string() }));
        Comparison { changes, bitwise, compared }
    }

    /// Takes a change over from the numbers of now.
    pub fn accept(&mut self, change: &Change, now: &Baseline) {
        match change {
            Change::Added { run } => {
                self.runs.insert(run.clone(), now.runs[run].clone());
            }
            Change::Removed { run } => {
                self.runs.remove(run);
            }
            Change::Renamed { from, to } => {
                self.runs.remove(from);
                self.runs.insert(to.clone(), now.runs[to].clone());
            }
            Change::Number { run, quantity, now, .. } => {
                let numbers = self.runs.entry(run.clone()).or_default();
                if now.is_empty() {
                    numbers.remove(quantity);
                } else {
                    numbers.insert(quantity.clone(), now.clone());
                }
            }
        }
    }
}

fn differences(run: &str, before: &Numbers, now: &Numbers, bitwise: bool) -> Vec<Change> {
    let scales = scales(before);
    let same = |quantity: &str, a: &[f64], b: &[f64]| {
        let scale = scales.get(unit(quantity)).copied().unwrap_or(0.0);
        let alike =
            |(a, b): (&f64, &f64)| a.to_bits() == b.to_bits() || !bitwise && close(quantity, scale, *a, *b);
        a.len() == b.len() && a.iter().zip(b).all(alike)
    };
    let mut quantities: Vec<&String> = before.keys().chain(now.keys()).collect();
    quantities.sort();
    quantities.dedup();
    let values = |numbers: &Numbers, quantity: &str| numbers.get(quantity).cloned().unwrap_or_default();
    let change = |quantity: &String| {
        let (before, now) = (values(before, quantity), values(now, quantity));
        let change =
            |before, now| Change::Number { run: run.into(), quantity: quantity.clone(), before, now };
        (!same(quantity, &before, &now)).then(|| change(before, now))
    };
    quantities.into_iter().filter_map(change).collect()
}

/// The largest number of each unit; 1 for pure numbers, errors of which are relative to 1.
fn scales(numbers: &Numbers) -> BTreeMap<&str, f64> {
    let mut scales = BTreeMap::new();
    for (quantity, values) in numbers {
        let largest = values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        let scale = scales.entry(unit(quantity)).or_insert(0.0_f64);
        *scale = if unit(quantity) == "1" { 1.0 } else { scale.max(largest) };
    }
    scales
}

fn unit(quantity: &str) -> &str {
    quantity.rsplit_once('[').map_or("", |(_, unit)| unit.trim_end_matches(']'))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(run: &str, quantity: &str, values: &[f64], processor: &str) -> Baseline {
        let numbers = Numbers::from([(quantity.to_string(), values.to_vec()), ("max [m]".into(), vec![1.0])]);
        Baseline { processor: processor.into(), runs: BTreeMap::from([(run.to_string(), numbers)]) }
    }

    #[test]
    fn any_name_is_read_as_it_was_written() {
        let name = "a \"b\" \\ \u{feff}\u{7f}\n\u{1}\u{200b} \u{e4}";
        let file = std::env::temp_dir().join(format!("tissuebench-names-{}.toml", std::process::id()));
        let written = one(name, name, &[1.5, -0.0], name);
        written.save(&file).unwrap();
        let read = Baseline::load(&file);
        std::fs::remove_file(&file).unwrap();
        assert_eq!(read.unwrap(), written);
    }

    #[test]
    fn one_bit_is_a_difference_on_the_same_processor_and_none_on_another() {
        let before = one("a", "rms [m]", &[0.3], "p");
        let next = f64::from_bits(0.3f64.to_bits() + 1);
        assert_eq!(before.compare(&one("a", "rms [m]", &[next], "p"), true).changes.len(), 1);
        assert!(before.compare(&one("a", "rms [m]", &[next], "q"), true).changes.is_empty());
        assert_eq!(before.compare(&one("a", "rms [m]", &[0.3001], "q"), true).changes.len(), 1);
        // A resultant that is rounding has no digits, one that is not has all.
        let load = |newton: f64, processor: &str| one("a", "load-y [N]", &[newton], processor);
        assert!(load(1e-17, "p").compare(&load(-2e-17, "q"), true).changes.is_empty());
        assert_eq!(load(1e-3, "p").compare(&load(1.1e-3, "q"), true).changes.len(), 1);
        // Rounding has no digits: 1e-12 of the run's largest length.
        let before = one("a", "rms [m]", &[1e-12], "p");
        assert!(before.compare(&one("a", "rms [m]", &[3e-12], "q"), true).changes.is_empty());
    }

    #[test]
    fn a_run_under_another_name_is_renamed_and_each_change_can_be_accepted() {
        let mut before = one("a", "rms [m]", &[0.3], "p");
        let now = one("b", "rms [m]", &[0.3], "p");
        let changes = before.compare(&now, true).changes;
        assert_eq!(changes, [Change::Renamed { from: "a".into(), to: "b".into() }]);
        before.accept(&changes[0], &now);
        assert_eq!(before, now);
        let other = one("b", "l2 [1]", &[0.1, 0.2], "p");
        let changes = before.compare(&other, true).changes;
        assert_eq!(changes.len(), 2);
        for change in &changes {
            before.accept(change, &other);
        }
        assert_eq!(before, other);
    }

    #[test]
    fn a_part_of_a_study_misses_no_run() {
        let mut before = one("a", "rms [m]", &[0.3], "p");
        before.runs.extend(one("b", "rms [m]", &[0.4], "p").runs);
        let part = one("a", "rms [m]", &[0.3], "p");
        assert!(before.compare(&part, false).changes.is_empty());
        assert_eq!(before.compare(&part, true).changes, [Change::Removed { run: "b".into() }]);
    }
}
