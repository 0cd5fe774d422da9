//! The baseline: every accuracy number of a study as it was when it was last accepted, to be compared with what is found now.
//!
//! Bounds in a scene say what must hold; a fault that changes a number by a thousandth holds them all. The baseline sees it.
//!
//! A baseline is a TOML file: the processor it was made on, and a table for each run with one line for each quantity. What is
//! recorded step by step is one array. Times and memory are left out.

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
    /// The kind of processor: numbers are the same bits on the same kind.
    pub processor: String,
    /// Numbers of each run; its name says case, method, settings and size.
    pub runs: Numbers,
}

impl Baseline {
    /// The numbers of `records` that do not depend on the moment, found on a `processor`.
    pub fn of(records: &[Record], processor: &str) -> Baseline {
        Baseline { processor: processor.into(), runs: numbers(records) }
    }

    /// Reads a baseline file.
    pub fn load(path: &Path) -> Result<Baseline, RecordError> {
        let text = disk::read_text(path, disk::Kind::BASELINE)
            .map_err(|source| RecordError::Io { path: path.into(), source })?;
        toml::from_str(&text).map_err(|e| RecordError::Content { path: path.into(), reason: e.to_string() })
    }

    /// Writes a baseline file: one line for each quantity, numbers with the fewest digits that give the same bits again.
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

    /// Number of numbers.
    pub fn count(&self) -> usize {
        self.runs.values().flatten().map(|(_, values)| values.len()).sum()
    }
}

const HEADER: &str = "# Accepted numbers of a study's quick tier, SI. Made and compared by `cargo xtask baseline`; not to be edited by hand.\n";

/// A string of TOML: the escapes of JSON are among its own, and it has one more character that needs one.
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
