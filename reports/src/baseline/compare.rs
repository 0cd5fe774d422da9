//! Comparison of two baselines, run by run and quantity by quantity.

use records::{Paired, difference};

use super::Baseline;
use super::tolerance::close;

/// A difference in one run.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// A new run.
    Added {
        /// Name of the run.
        run: String,
    },
    /// A run that no longer exists.
    Removed {
        /// Name of the run.
        run: String,
    },
    /// A run with another name and the same numbers.
    Renamed {
        /// Name in the baseline.
        from: String,
        /// Current name.
        to: String,
    },
    /// A quantity that differs, is new or no longer exists.
    Number {
        /// Name of the run.
        run: String,
        /// Quantity with its unit.
        quantity: String,
        /// Accepted values; empty for a new quantity.
        before: Vec<f64>,
        /// Current values; empty for a quantity that no longer exists.
        now: Vec<f64>,
    },
}

/// Differences between a baseline and current numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Differences, in the order of their runs.
    pub changes: Vec<Change>,
    /// Whether equality was bitwise, because both are from the same kind of processor.
    pub bitwise: bool,
    /// Number of values compared.
    pub compared: usize,
}

impl Baseline {
    /// Compares accepted numbers with current ones. If `whole`, the current numbers are those of the whole
    /// study, and runs that only the baseline has are differences.
    pub fn compare(&self, now: &Baseline, whole: bool) -> Comparison {
        let bitwise = self.processor == now.processor;
        let found = difference(&self.runs, &now.runs);
        let mut changes = Vec::new();
        let mut renamed: Vec<&String> = Vec::new();
        for run in &found.only_after {
            let same = |from: &&String| self.runs[*from] == now.runs[run] && !renamed.contains(from);
            match found.only_before.iter().find(same) {
                Some(from) => {
                    renamed.push(from);
                    changes.push(Change::Renamed { from: from.clone(), to: run.clone() });
                }
                None => changes.push(Change::Added { run: run.clone() }),
            }
        }
        let lost = found.only_before.iter().filter(|run| whole && !renamed.contains(run));
        changes.extend(lost.map(|run| Change::Removed { run: run.clone() }));
        let differs = |paired: &&Paired| !is_same(paired, bitwise);
        changes.extend(found.paired.iter().filter(differs).map(|paired| Change::Number {
            run: paired.run.clone(),
            quantity: paired.quantity.clone(),
            before: paired.pairs.iter().filter_map(|pair| pair.before).collect(),
            now: paired.pairs.iter().filter_map(|pair| pair.after).collect(),
        }));
        let compared =
            found.paired.iter().flat_map(|paired| &paired.pairs).filter(|pair| pair.before.is_some());
        Comparison { changes, bitwise, compared: compared.count() }
    }

    /// Applies a change, with values of the current numbers.
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

/// Whether the numbers of a quantity are equal, bitwise or within the tolerance of two kinds of processors.
fn is_same(paired: &Paired, bitwise: bool) -> bool {
    let same = |a: f64, b: f64| {
        a.to_bits() == b.to_bits() || !bitwise && close(&paired.quantity, paired.scale, a, b)
    };
    paired.pairs.iter().all(|pair| pair.before.zip(pair.after).is_some_and(|(a, b)| same(a, b)))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    fn one(run: &str, quantity: &str, values: &[f64], processor: &str) -> Baseline {
        let numbers =
            BTreeMap::from([(quantity.to_string(), values.to_vec()), ("max [m]".into(), vec![1.0])]);
        Baseline { processor: processor.into(), runs: BTreeMap::from([(run.to_string(), numbers)]) }
    }

    #[test]
    fn any_name_is_read_as_it_was_written() {
        let name = "a \"b\" \\ \u{feff}\u{7f}\n\u{1}\u{200b} \u{e4}";
        let folder = tempfile::tempdir().unwrap();
        let written = one(name, name, &[1.5, -0.0], name);
        written.save(folder.path()).unwrap();
        assert_eq!(Baseline::load(folder.path()).unwrap(), written);
    }

    #[test]
    fn one_bit_is_a_difference_on_the_same_processor_and_none_on_another() {
        let before = one("a", "rms [m]", &[0.3], "p");
        let next = f64::from_bits(0.3f64.to_bits() + 1);
        assert_eq!(before.compare(&one("a", "rms [m]", &[next], "p"), true).changes.len(), 1);
        assert!(before.compare(&one("a", "rms [m]", &[next], "q"), true).changes.is_empty());
        assert_eq!(before.compare(&one("a", "rms [m]", &[0.3001], "q"), true).changes.len(), 1);
        // A resultant of rounding size has no significant digits; a larger one has all.
        let load = |newton: f64, processor: &str| one("a", "load-y [N]", &[newton], processor);
        assert!(load(1e-17, "p").compare(&load(-2e-17, "q"), true).changes.is_empty());
        assert_eq!(load(1e-3, "p").compare(&load(1.1e-3, "q"), true).changes.len(), 1);
        // Values of rounding size have no significant digits: 1e-12 of the run's largest length.
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
