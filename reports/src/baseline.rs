//! Baseline: the accuracy numbers of a study as last accepted, compared with those of a new run.
//!
//! Bounds in a scene state what must hold. A bug that changes a number by a thousandth satisfies them all,
//! but differs from the baseline.
//!
//! A baseline is a TOML file with the processor that computed it and a table for each run, with one line per
//! quantity. A history is one array. Times and memory are excluded.

mod compare;
mod tolerance;

use std::path::Path;

use records::store::write_text;
use records::{Numbers, Record, RecordError, numbers};
use serde::{Deserialize, Serialize};

pub use compare::{Change, Comparison};

/// Accepted numbers of a study, by run and quantity, SI.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Baseline {
    /// Kind of processor; the same kind gives bitwise equal numbers.
    pub processor: String,
    /// Numbers of each run, by a name with its case, method, settings and size.
    pub runs: Numbers,
}

impl Baseline {
    /// Collects the numbers of `records` that do not depend on the moment, computed on a `processor`.
    pub fn of(records: &[Record], processor: &str) -> Baseline {
        Baseline { processor: processor.into(), runs: numbers(records) }
    }

    /// Reads a baseline file.
    ///
    /// # Errors
    /// A file that cannot be read, or is not a baseline.
    pub fn load(path: &Path) -> Result<Baseline, RecordError> {
        let text = disk::read_text(path, disk::Kind::BASELINE)
            .map_err(|source| RecordError::Io { path: path.into(), source })?;
        toml::from_str(&text).map_err(|e| RecordError::Content { path: path.into(), reason: e.to_string() })
    }

    /// Writes a baseline file: one line for each quantity, with the fewest digits that preserve the bits of a
    /// number.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn save(&self, path: &Path) -> Result<(), RecordError> {
        let mut text = format!("{HEADER}processor = {}\n", quoted(&self.processor));
        for (run, numbers) in &self.runs {
            text += &format!("\n[runs.{}]\n", quoted(run));
            for (quantity, values) in numbers {
                let values: Vec<String> = values.iter().map(|v| format!("{v:e}")).collect();
                text += &format!("{} = [{}]\n", quoted(quantity), values.join(", "));
            }
        }
        write_text(path, text)
    }

    /// Total number of values.
    pub fn count(&self) -> usize {
        self.runs.values().flatten().map(|(_, values)| values.len()).sum()
    }
}

const HEADER: &str = "# Accepted numbers of a study's quick tier, SI. Made and compared by `cargo xtask baseline`; not to be edited by hand.\n";

/// Quotes a string for TOML. JSON escapes are valid in TOML, which requires one more character to be escaped.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string().replace('\u{7f}', "\\u007f")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blank::Blank as _;

    fn records() -> Vec<Record> {
        let record = |quantity: &str, step: Option<u64>, value| Record {
            case: "plates".into(),
            method: "tet4".into(),
            quantity: quantity.into(),
            step,
            value,
            ..Record::blank()
        };
        vec![
            record("rms", None, 0.1 + 0.2),
            record("tool-force", Some(10), 3.0),
            record("tool-force", Some(2), 2.0),
            record("time", None, 1.0),
        ]
    }

    #[test]
    fn a_baseline_is_read_as_it_was_written() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("baseline.toml");
        let mut records = records();
        records[1].value = f64::MIN_POSITIVE / 3.0;
        let made = Baseline::of(&records, "a \"processor\"");
        made.save(&path).unwrap();
        assert_eq!(Baseline::load(&path).unwrap(), made);
    }

    #[test]
    fn steps_are_in_order_and_times_left_out() {
        let made = Baseline::of(&records(), "p");
        let numbers = made.runs.values().next().unwrap();
        assert_eq!(numbers["tool-force by step [m]"], [2.0, 3.0]);
        assert_eq!((made.runs.len(), numbers.len(), made.count()), (1, 2, 3));
    }
}
