//! Summary of results: small enough for a repository, with enough data to distinguish a step from noise.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use catalogue::metric::{self, Kind, METRICS};
use records::store::write_text;
use records::{Machine, Numbers, Program, Record, RecordError, RunSet, Status};
use serde::{Deserialize, Serialize};

/// Summary of the results of a study or scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Summary {
    /// File name of the study or scene.
    pub source: String,
    /// Label given when the results were added, such as a version; empty without one.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub label: String,
    /// Number of checks that did not hold.
    pub checks_failed: usize,
    /// Program that computed the results.
    pub program: Program,
    /// Machine that ran the program.
    pub machine: Machine,
    /// Runs by case, method, settings and size.
    pub runs: BTreeMap<String, RunNumbers>,
}

/// Summary of one run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunNumbers {
    /// Case name.
    pub case: String,
    /// Method id.
    pub method: String,
    /// Number of nodes.
    pub nodes: u64,
    /// Refinement level.
    pub level: u32,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Errors at the end by quantity, SI.
    #[serde(default)]
    pub errors: BTreeMap<String, f64>,
    /// Times of each repeat by phase, s: CPU time if known, otherwise wall time.
    #[serde(default)]
    pub seconds: BTreeMap<String, Vec<f64>>,
}

/// Number of digits kept of an error, and of a time.
const ERROR_DIGITS: usize = 9;
const TIME_DIGITS: usize = 4;

fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits - 1).parse().unwrap_or(value)
}

impl Summary {
    /// Summarises the results of a run set.
    pub fn of(set: &RunSet) -> Summary {
        let mut runs: BTreeMap<String, RunNumbers> = BTreeMap::new();
        let mut wall: BTreeMap<(String, String), Vec<f64>> = BTreeMap::new();
        let errors = METRICS.iter().filter(|metric| metric.kind == Kind::Error);
        let errors: BTreeSet<&str> = errors.map(|metric| metric.name).collect();
        let at_end = |r: &&Record| r.step.is_none() && r.mode.is_none();
        for record in set.records.iter().filter(at_end) {
            let name = record.run_name();
            let run = runs.entry(name.clone()).or_insert_with(|| RunNumbers {
                case: record.case.clone(),
                method: record.method.clone(),
                nodes: record.nodes,
                level: record.level,
                poisson: record.poisson,
                ..RunNumbers::default()
            });
            let time = || rounded(record.value, TIME_DIGITS);
            match record.statistic.as_str() {
                "repeat" if record.is(&metric::CPU_TIME) => {
                    run.seconds.entry(record.phase.clone()).or_default().push(time());
                }
                "repeat" if record.is(&metric::TIME) => {
                    wall.entry((name, record.phase.clone())).or_default().push(time());
                }
                "value" if errors.contains(record.quantity.as_str()) => {
                    run.errors.insert(record.name(), rounded(record.value, ERROR_DIGITS));
                }
                _ => {}
            }
        }
        for ((name, phase), times) in wall {
            if let Some(run) = runs.get_mut(&name) {
                run.seconds.entry(phase).or_insert(times);
            }
        }
        runs.retain(|_, run| !run.errors.is_empty() || !run.seconds.is_empty());
        Summary {
            source: set.provenance.source.clone(),
            label: String::new(),
            checks_failed: set
                .checks
                .iter()
                .filter(|c| matches!(c.status, Status::Fail | Status::NotRun))
                .count(),
            program: set.provenance.program.clone(),
            machine: set.provenance.machine.clone(),
            runs,
        }
    }

    pub(super) fn load(path: &Path) -> Result<Summary, RecordError> {
        let text = disk::read_text(path, disk::Kind::HISTORY)
            .map_err(|source| RecordError::Io { path: path.into(), source })?;
        let content = |reason| RecordError::Content { path: path.into(), reason };
        let read: Summary = toml::from_str(&text).map_err(|bad| content(bad.to_string()))?;
        let numbers = |run: &RunNumbers| {
            let all = run.errors.values().chain(run.seconds.values().flatten());
            all.chain([&run.poisson]).all(|number| number.is_finite())
        };
        match read.runs.iter().find(|(_, run)| !numbers(run)) {
            Some((name, _)) => Err(content(format!("run '{name}' has a number that is not finite"))),
            None => Ok(read),
        }
    }

    pub(super) fn save(&self, path: &Path) -> Result<(), RecordError> {
        let text = toml::to_string(self)
            .map_err(|e| RecordError::Content { path: path.into(), reason: e.to_string() })?;
        write_text(path, text)
    }

    /// Errors by run and quantity.
    pub(super) fn errors(&self) -> Numbers {
        let listed = |(quantity, error): (&String, &f64)| (quantity.clone(), vec![*error]);
        let of = |run: &RunNumbers| run.errors.iter().map(listed).collect();
        self.runs.iter().map(|(name, run)| (name.clone(), of(run))).collect()
    }

    /// The times as records of a run set, for comparisons.
    pub(super) fn times(&self) -> RunSet {
        let records = self.runs.iter().flat_map(|(name, run)| {
            let own = Record {
                run: name.clone(),
                case: run.case.clone(),
                method: run.method.clone(),
                nodes: run.nodes,
                level: run.level,
                poisson: run.poisson,
                statistic: "repeat".into(),
                ..Record::default()
            }
            .with(&metric::CPU_TIME);
            run.seconds.iter().flat_map(move |(phase, times)| {
                let phase = Record { phase: phase.clone(), ..own.clone() };
                let of = move |(repeat, &value): (u64, &f64)| Record {
                    repeat: Some(repeat),
                    value,
                    ..phase.clone()
                };
                (1..).zip(times).map(of)
            })
        });
        RunSet { records: records.collect(), ..RunSet::default() }
    }

    /// Time of a run, s: its shortest repeat.
    pub(super) fn total(&self, run: &str) -> Option<f64> {
        let times = self.runs.get(run)?.seconds.get("total")?;
        times.iter().copied().reduce(f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(quantity: &str, statistic: &str, phase: &str, repeat: Option<u64>, value: f64) -> Record {
        let (quantity, statistic, phase) = (quantity.into(), statistic.into(), phase.into());
        Record {
            case: "block".into(),
            method: "tet4".into(),
            quantity,
            statistic,
            phase,
            repeat,
            value,
            ..Record::default()
        }
    }

    #[test]
    fn errors_and_repeats_of_processor_times_are_kept_and_read_again() {
        let set = RunSet {
            records: vec![
                record("rms", "value", "", None, 0.123_456_789_012),
                record("max-z", "value", "", None, 3.0),
                record("time", "repeat", "total", Some(1), 9.0),
                record("cpu-time", "repeat", "total", Some(1), 2.0),
                record("cpu-time", "repeat", "total", Some(2), 1.000_04),
                record("time", "repeat", "solve", Some(1), 0.5),
                record("cpu-time", "median", "total", None, 1.5),
            ],
            ..RunSet::default()
        };
        let made = Summary::of(&set);
        let run = made.runs.values().next().unwrap();
        assert_eq!(run.errors, BTreeMap::from([("rms".to_string(), 0.123_456_789)]));
        assert_eq!(run.seconds["total"], [2.0, 1.0]);
        assert_eq!(run.seconds["solve"], [0.5]);
        assert_eq!(made.total(made.runs.keys().next().unwrap()), Some(1.0));
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("0001-a.toml");
        made.save(&path).unwrap();
        assert_eq!(Summary::load(&path).unwrap(), made);
        let text = std::fs::read_to_string(&path).unwrap();
        for (bad, says) in
            [(text.replace("0.123456789", "nan"), "not finite"), ("source = 3".into(), "0001-a.toml")]
        {
            std::fs::write(&path, bad).unwrap();
            let error = Summary::load(&path).unwrap_err().to_string();
            assert!(error.contains(says), "{error}");
        }
    }
}
