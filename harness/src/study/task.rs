//! A run of a study as a unit of work: its key, its result and the form in which the result is stored.

use std::path::PathBuf;

use cases::scene;
use catalogue::metric;
use records::{
    Failure as FailedRun, Fit, PlanEntry, Record, Reference, SampleResults, SurfaceField, Warning,
};
use serde::{Deserialize, Serialize};

use crate::adapter;
use crate::error::Failure;
use crate::outcome::{Counters, Outcome};

/// Result of one run.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct TaskResult {
    /// Rows of the long table; empty if the run failed. If the run stalled, they are those of the load that
    /// it reached.
    pub records: Vec<Record>,
    /// Stages run and skipped.
    pub plans: Vec<PlanEntry>,
    /// Warnings about the results.
    pub warnings: Vec<Warning>,
    /// Reference that the run is compared with.
    #[serde(default)]
    pub reference: Option<Reference>,
    /// Results of a sample of uncertain inputs, which replace all other records.
    #[serde(default)]
    pub sample: Option<SampleResults>,
    /// Fit of constants, which has no other records.
    #[serde(default)]
    pub fit: Option<Fit>,
    /// Surface displacement, if requested.
    pub fields: Vec<SurfaceField>,
    /// Failure of the run, with its exit code.
    pub failure: Option<(FailedRun, u8)>,
    /// Time of the run, all repeats included and without its reference, s; 0 if unknown.
    #[serde(default)]
    pub seconds: f64,
    /// Counters of this execution; zero for a stored result.
    #[serde(skip)]
    pub counters: Counters,
}

impl TaskResult {
    /// Result of a finished run.
    pub fn finished(outcome: &Outcome) -> TaskResult {
        TaskResult {
            records: outcome.records(),
            plans: outcome.plan_entries(),
            warnings: outcome.warning_rows(),
            reference: outcome.reference.clone(),
            sample: None,
            fit: None,
            fields: outcome.field.iter().cloned().collect(),
            failure: outcome.stalled.as_ref().map(|f| (stalled(outcome, f), f.exit_code())),
            seconds: 0.0,
            counters: outcome.counters,
        }
    }

    /// Result of a run that failed.
    pub fn failed(case: &str, method: &scene::Method, failure: &Failure) -> TaskResult {
        let run = failed(case, method, failure);
        TaskResult { failure: Some((run, failure.exit_code())), ..TaskResult::default() }
    }
}

/// Row of the failures for a run that gave no results.
pub fn failed(case: &str, method: &scene::Method, failure: &Failure) -> FailedRun {
    let adapter = match &method.family {
        scene::Family::External(external) => adapter::label(&external.adapter, &external.settings),
        _ => String::new(),
    };
    FailedRun {
        case: case.into(),
        method: method.id.clone(),
        reason: failure.to_string(),
        carried: None,
        status: failure.status().into(),
        adapter,
        at: failure.place(),
    }
}

/// Row of the failures for a load path that ended early. Its results are kept separately.
pub fn stalled(outcome: &Outcome, failure: &Failure) -> FailedRun {
    FailedRun {
        case: outcome.identity.case.clone(),
        method: outcome.identity.method.clone(),
        reason: format!("{}: {failure}", outcome.status),
        carried: outcome.value(&metric::LOAD_CARRIED).filter(|load| *load > 0.0),
        status: outcome.status.into(),
        adapter: outcome.identity.adapter.clone().unwrap_or_default(),
        at: failure.place(),
    }
}

/// Hash of everything that a run depends on, except the program and the machine: the scene's text, the
/// contents of the files it names, and the changes by the study (`what`). The hash does not depend on the
/// folder of the study.
pub fn key(scene_text: &str, files: &[PathBuf], what: &str) -> String {
    let name = |path: &&PathBuf| path.file_name().map(|name| name.to_string_lossy().into_owned());
    let mut files: Vec<&PathBuf> = files.iter().collect();
    files.sort_by_key(name);
    let mut hasher = blake3::Hasher::new();
    let mut add = |part: &[u8]| {
        hasher.update(&(part.len() as u64).to_le_bytes());
        hasher.update(part);
    };
    add(scene_text.as_bytes());
    add(what.as_bytes());
    files.iter().for_each(|path| add(&disk::read(path, disk::Kind::MESH).unwrap_or_default()));
    hasher.finalize().to_hex()[..32].to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_is_of_the_content_of_files_and_of_no_folder() {
        let [here, there] = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
        let of = |dir: &tempfile::TempDir, content: &str| {
            let path = dir.path().join("a.msh");
            std::fs::write(&path, content).unwrap();
            key("scene", std::slice::from_ref(&path), "run")
        };
        let known = of(&here, "nodes");
        assert_eq!(known, of(&there, "nodes"));
        assert_ne!(known, of(&there, "other nodes"));
        assert_ne!(known, key("scene", &[], "run"));
    }
}
