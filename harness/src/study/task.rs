//! One run of a study as a unit of work: what it is, what it leaves, and how it is stored.

use std::path::{Path, PathBuf};

use reports::{Failure as FailedRun, Machine, PlanEntry, Program, Record, SurfaceField, Warning};
use serde::{Deserialize, Serialize};

use crate::Failure;
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
    /// Surface displacement, where asked for.
    pub fields: Vec<SurfaceField>,
    /// Why it failed, with its exit code.
    pub failure: Option<(FailedRun, u8)>,
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
            fields: outcome.field.iter().cloned().collect(),
            failure: outcome.stalled.as_ref().map(|f| (stalled(outcome, f), f.exit_code())),
            counters: outcome.counters,
        }
    }

    /// Of a run that gave no numbers.
    pub fn failed(case: &str, method: &str, failure: &Failure) -> TaskResult {
        let run = FailedRun {
            case: case.into(),
            method: method.into(),
            reason: failure.to_string(),
            carried: None,
        };
        TaskResult { failure: Some((run, failure.exit_code())), ..TaskResult::default() }
    }

    /// Stored result under a key, if there is a readable one of a run that finished.
    pub fn load(folder: &Path, key: &str) -> Option<TaskResult> {
        let text = std::fs::read_to_string(file(folder, key)).ok()?;
        serde_json::from_str::<TaskResult>(&text).ok().filter(|r| r.failure.is_none())
    }

    /// Stores the result under a key; written beside and renamed, so that a stop leaves no half file.
    pub fn store(&self, folder: &Path, key: &str) -> std::io::Result<()> {
        std::fs::create_dir_all(folder)?;
        let partial = folder.join(format!("{key}.partial"));
        std::fs::write(&partial, serde_json::to_string(self)?)?;
        std::fs::rename(partial, file(folder, key))
    }
}

/// A path that ended early, among what failed; its numbers are kept beside.
pub fn stalled(outcome: &Outcome, failure: &Failure) -> FailedRun {
    FailedRun {
        case: outcome.identity.case.clone(),
        method: outcome.identity.method.clone(),
        reason: format!("{}: {failure}", outcome.status),
        carried: outcome.metric("load-carried").filter(|load| *load > 0.0),
    }
}

fn file(folder: &Path, key: &str) -> PathBuf {
    folder.join(format!("{key}.json"))
}

/// Hash of everything a run depends on: who runs it (see [`runner`]), the scene's text, the files it names, and what the study
/// changes of it.
pub fn key(runner: &str, scene_text: &str, files: &[PathBuf], what: &str) -> String {
    let mut hasher = blake3::Hasher::new();
    for part in [runner, scene_text, what] {
        hasher.update(&(part.len() as u64).to_le_bytes());
        hasher.update(part.as_bytes());
    }
    for path in files {
        hasher.update(path.to_string_lossy().as_bytes());
        hasher.update(&std::fs::read(path).unwrap_or_default());
    }
    hasher.finalize().to_hex()[..32].to_string()
}

/// The running program by its bytes, the processor and the number of threads: results of another build, and times of another
/// machine, are not taken for this one's. The load is none of it: a study is resumed at another moment.
pub fn runner(program: &Program, machine: &Machine) -> String {
    let bytes = std::env::current_exe().and_then(std::fs::read).unwrap_or_default();
    let Machine { cpu, instructions, threads, .. } = machine;
    format!("{program:?}, {}; {cpu}, {instructions}, {threads} threads", blake3::hash(&bytes).to_hex())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_program_machine_or_number_of_threads_runs_anew() {
        let (program, machine) = (Program::default(), Machine { threads: 2, ..Machine::default() });
        let key = |program: &Program, machine: &Machine| {
            super::key(&runner(program, machine), "scene", &[], "what")
        };
        let known = key(&program, &machine);
        assert_eq!(known, key(&program, &Machine { load: Some(3.0), quiet: Some(false), ..machine.clone() }));
        for other in [
            key(&Program { commit: "another".into(), ..program.clone() }, &machine),
            key(&Program { dirty: true, ..program.clone() }, &machine),
            key(&program, &Machine { threads: 1, ..machine.clone() }),
            key(&program, &Machine { cpu: "another".into(), ..machine.clone() }),
        ] {
            assert_ne!(known, other);
        }
    }
}
