//! One run of a study as a unit of work: what it is, what it leaves, and how it is stored.

use std::path::PathBuf;

use cases::scene;
use reports::{Failure as FailedRun, PlanEntry, Record, Reference, SurfaceField, Warning};
use serde::{Deserialize, Serialize};

use crate::Failure;
use crate::adapter;
use crate::outcome::{Counters, Outcome};

/// What one run leaves.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct TaskResult {
    /// Numbers; empty if it failed, those of the load it carried if it stalled.
    pub records: Vec<Record>,
    /// Stages run and skipped.
    pub plans: Vec<PlanEntry>,
    /// What is to be said against its numbers.
    pub warnings: Vec<Warning>,
    /// The reference of the numbers.
    #[serde(default)]
    pub reference: Option<Reference>,
    /// Surface displacement, where asked for.
    pub fields: Vec<SurfaceField>,
    /// Why it failed, with its exit code.
    pub failure: Option<(FailedRun, u8)>,
    /// Seconds that it took, all repeats included and without its reference; 0 where they are not known.
    #[serde(default)]
    pub seconds: f64,
    /// What was done for it now: nothing where it was stored.
    #[serde(skip)]
    pub counters: Counters,
}

impl TaskResult {
    /// Of a finished run.
    pub fn finished(outcome: &Outcome) -> TaskResult {
        TaskResult {
            records: outcome.records(),
            plans: outcome.plan_entries(),
            warnings: outcome.warning_rows(),
            reference: outcome.reference.clone(),
            fields: outcome.field.iter().cloned().collect(),
            failure: outcome.stalled.as_ref().map(|f| (stalled(outcome, f), f.exit_code())),
            seconds: 0.0,
            counters: outcome.counters,
        }
    }

    /// Of a run that gave no numbers.
    pub fn failed(case: &str, method: &scene::Method, failure: &Failure) -> TaskResult {
        let run = failed(case, method, failure);
        TaskResult { failure: Some((run, failure.exit_code())), ..TaskResult::default() }
    }
}

/// A run that gave no numbers, among what failed.
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

/// A path that ended early, among what failed; its numbers are kept beside.
pub fn stalled(outcome: &Outcome, failure: &Failure) -> FailedRun {
    FailedRun {
        case: outcome.identity.case.clone(),
        method: outcome.identity.method.clone(),
        reason: format!("{}: {failure}", outcome.status),
        carried: outcome.metric("load-carried").filter(|load| *load > 0.0),
        status: outcome.status.into(),
        adapter: outcome.identity.adapter.clone().unwrap_or_default(),
        at: failure.place(),
    }
}

/// Hash of everything a run depends on but who runs it: the scene's text, the files it names, and what the study changes of it. It is
/// the same wherever the folder of the study is.
pub fn key(scene_text: &str, files: &[PathBuf], what: &str) -> String {
    let name = |path: &&PathBuf| path.file_name().map(|name| name.to_string_lossy().into_owned());
    let mut files: Vec<&PathBuf> = files.iter().collect();
    files.sort_by_key(name);
    let what = files.iter().fold(what.to_string(), |what, path| {
        what.replace(&format!("{path:?}"), &name(path).unwrap_or_default())
    });
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
            key("scene", std::slice::from_ref(&path), &format!("size {path:?}"))
        };
        let known = of(&here, "nodes");
        assert_eq!(known, of(&there, "nodes"));
        assert_ne!(known, of(&there, "other nodes"));
        assert_ne!(known, key("scene", &[], "size a.msh"));
    }
}
