//! Baseline: the accuracy numbers of a study as last accepted, compared with those of a new run.
//!
//! Bounds in a scene state requirements. A bug that changes a number by a thousandth meets all of them, but
//! is a difference from the baseline.
//!
//! A baseline is a folder with a TOML file for each case, in which each run has a table with one line per
//! number. Times and memory are excluded.

mod compare;
mod tolerance;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use records::store::{files_ending, make_dir, slug, write_text};
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

    /// Reads the files of a folder.
    ///
    /// # Errors
    /// A folder without files of a baseline, a file that is not part of a baseline, or files made by several
    /// processors.
    pub fn load(folder: &Path) -> Result<Baseline, RecordError> {
        let bad = |path: &Path, reason| RecordError::Content { path: path.into(), reason };
        let mut whole: Option<Baseline> = None;
        for path in files_ending(folder, &["toml"])? {
            let text = disk::read_text(&path, disk::Kind::BASELINE)
                .map_err(|source| RecordError::Io { path: path.clone(), source })?;
            let part: Baseline = toml::from_str(&text).map_err(|e| bad(&path, e.to_string()))?;
            match &mut whole {
                None => whole = Some(part),
                Some(whole) if whole.processor == part.processor => whole.runs.extend(part.runs),
                Some(whole) => {
                    let (one, other) = (&part.processor, &whole.processor);
                    let reason = format!("its processor is \"{one}\", that of other files \"{other}\"");
                    return Err(bad(&path, reason));
                }
            }
        }
        whole.ok_or_else(|| bad(folder, "the folder has no file of a baseline (CASE.toml)".into()))
    }

    /// Writes a file for each case, and removes files of a baseline whose case no longer exists. A number is
    /// written with the fewest digits that preserve its bits.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn save(&self, folder: &Path) -> Result<(), RecordError> {
        let mut texts: BTreeMap<PathBuf, String> = BTreeMap::new();
        for (run, numbers) in &self.runs {
            let case = run.split(' ').next().unwrap_or_default();
            let text = texts
                .entry(folder.join(file_name(case)))
                .or_insert_with(|| format!("{HEADER}processor = {}\n", quoted(&self.processor)));
            *text += &format!("\n[runs.{}]\n", quoted(run));
            for (quantity, values) in numbers {
                *text += &match values[..] {
                    [value] => format!("{} = [{value:e}]\n", quoted(quantity)),
                    _ => {
                        let lines: String = values.iter().map(|value| format!("    {value:e},\n")).collect();
                        format!("{} = [\n{lines}]\n", quoted(quantity))
                    }
                };
            }
        }
        make_dir(folder)?;
        for path in files_ending(folder, &["toml"])?.into_iter().filter(|path| !texts.contains_key(path)) {
            if is_own(&path) {
                disk::remove(&path).map_err(|source| RecordError::Unwritten { path, source })?;
            }
        }
        texts.into_iter().try_for_each(|(path, text)| write_text(&path, text))
    }

    /// Total number of values.
    pub fn count(&self) -> usize {
        self.runs.values().flatten().map(|(_, values)| values.len()).sum()
    }
}

/// First line of each file.
const HEADER: &str = "# Accepted numbers of a case in a study's quick tier, SI. Made and compared by `cargo xtask baseline`; not to be edited by hand.\n";

/// Returns the file name of a case. Cases whose names differ only in their end or in signs share a file.
fn file_name(case: &str) -> String {
    let name: String = slug(case).chars().take(100).collect();
    format!("{}.toml", if name.is_empty() { "unnamed" } else { &name })
}

/// Whether a file begins like a file of a baseline.
fn is_own(path: &Path) -> bool {
    disk::read_text(path, disk::Kind::BASELINE).is_ok_and(|text| text.starts_with(HEADER))
}

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
        let path = dir.path().join("baseline");
        let mut records = records();
        records[1].value = f64::MIN_POSITIVE / 3.0;
        let made = Baseline::of(&records, "a \"processor\"");
        made.save(&path).unwrap();
        assert_eq!(Baseline::load(&path).unwrap(), made);
        // A number has a line of its own, so that a change of one number is a change of one line.
        let text = std::fs::read_to_string(path.join("plates.toml")).unwrap();
        assert!(
            text.ends_with("\"tool-force by step [m]\" = [\n    2e0,\n    7.41691286169067e-309,\n]\n"),
            "{text}"
        );
    }

    #[test]
    fn a_case_that_no_longer_exists_loses_its_file_and_other_files_stay() {
        let dir = tempfile::tempdir().unwrap();
        let mut both = records();
        both[0].case = "beam".into();
        Baseline::of(&both, "p").save(dir.path()).unwrap();
        let (beam, other) = (dir.path().join("beam.toml"), dir.path().join("other.toml"));
        assert_eq!(Baseline::load(dir.path()).unwrap().runs.len(), 2);
        assert!(beam.exists());
        std::fs::write(&other, "key = 1\n").unwrap();
        assert!(Baseline::load(dir.path()).unwrap_err().to_string().contains("other.toml"));
        Baseline::of(&both[1..], "p").save(dir.path()).unwrap();
        assert!(!beam.exists() && other.exists());
        std::fs::remove_file(other).unwrap();
        Baseline::of(&both[..1], "q").save(&dir.path().join("q")).unwrap();
        std::fs::copy(dir.path().join("q/beam.toml"), &beam).unwrap();
        let bad = Baseline::load(dir.path()).unwrap_err().to_string();
        assert!(bad.contains("its processor is \"p\", that of other files \"q\""), "{bad}");
    }

    #[test]
    fn steps_are_in_order_and_times_left_out() {
        let made = Baseline::of(&records(), "p");
        let numbers = made.runs.values().next().unwrap();
        assert_eq!(numbers["tool-force by step [m]"], [2.0, 3.0]);
        assert_eq!((made.runs.len(), numbers.len(), made.count()), (1, 2, 3));
    }
}
