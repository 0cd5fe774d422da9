//! The files of a job in the folder of a study: its runs, and the events of their execution.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::Duration;

use records::{Machine, RecordError};
use serde::{Deserialize, Serialize};

use super::super::merge::Note;

/// Folder of the files of jobs, relative to the folder of results.
const JOBS: &str = "jobs";

/// Runs that one job executes.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Bundle {
    /// Study and selection of its runs.
    pub(super) note: Note,
    /// Runs in the order of the study.
    pub(super) runs: Vec<BundledRun>,
    /// Memory of the job, bytes.
    pub(super) bytes: f64,
    /// Time of the job, s.
    pub(super) limit: f64,
    /// Whether each run has a process of its own, with its limits.
    pub(super) isolate: bool,
    pub(super) time_limit: Option<Duration>,
    pub(super) memory_limit: Option<u64>,
    /// Number of times that an isolated run is repeated.
    pub(super) retries: u8,
}

/// Run of a bundle.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct BundledRun {
    /// Index in the study's selected runs.
    pub(super) index: usize,
    /// Key of the stored result.
    pub(super) key: String,
    /// Expected time, s.
    pub(super) seconds: f64,
}

/// Paths of the files of one job.
#[derive(Clone, Debug)]
pub(super) struct Files(PathBuf);

impl Files {
    /// Files of the job of this number.
    pub(super) fn new(out: &Path, number: usize) -> Files {
        Files(out.join(JOBS).join(format!("{number}.json")))
    }

    /// Files of the job with this bundle.
    pub(super) fn of(bundle: PathBuf) -> Files {
        Files(bundle)
    }

    /// The bundle.
    pub(super) fn bundle(&self) -> &Path {
        &self.0
    }

    /// Stdout and stderr of the job.
    pub(super) fn log(&self) -> PathBuf {
        self.0.with_extension("log")
    }

    /// Events of the job's runs, numbered as in the bundle.
    pub(super) fn events(&self) -> PathBuf {
        self.0.with_extension("events")
    }

    /// Machine on which the job runs.
    fn machine(&self) -> PathBuf {
        self.0.with_extension("machine")
    }

    /// Number of the job.
    pub(super) fn number(&self) -> usize {
        self.0.file_stem().and_then(|stem| stem.to_str()?.parse().ok()).unwrap_or_default()
    }

    /// Folder of the study's results.
    pub(super) fn out(&self) -> PathBuf {
        self.0.parent().and_then(Path::parent).map(PathBuf::from).unwrap_or_default()
    }

    /// Reads the bundle.
    pub(super) fn read(&self) -> Result<Bundle, String> {
        let path = self.bundle();
        let text = disk::read_text(path, disk::Kind::RESULTS);
        let text = text.map_err(|bad| format!("{}: {bad}", path.display()))?;
        serde_json::from_str(&text).map_err(|bad| format!("{}: {bad}", path.display()))
    }

    /// Writes the bundle.
    pub(super) fn write(&self, bundle: &Bundle) -> Result<(), RecordError> {
        let unwritten = |source| RecordError::Unwritten { path: self.0.clone(), source };
        let folder = self.0.parent().unwrap_or(Path::new(""));
        std::fs::create_dir_all(folder).map_err(unwritten)?;
        let text = serde_json::to_string(bundle).map_err(|bad| unwritten(bad.into()))?;
        records::write_text(&self.0, text)
    }

    /// Records the machine on which the job runs.
    pub(super) fn note_machine(&self, machine: &Machine) -> Result<(), RecordError> {
        let path = self.machine();
        let text = serde_json::to_string(machine);
        let text = text.map_err(|bad| RecordError::Unwritten { path: path.clone(), source: bad.into() })?;
        records::write_text(&path, text)
    }

    /// Machine on which the job ran; `None` if the job has not started.
    pub(super) fn machine_of(&self) -> Option<Machine> {
        let text = disk::read_text(&self.machine(), disk::Kind::MESSAGE).ok()?;
        serde_json::from_str(&text).ok()
    }

    /// Last line of the job's log; empty if there is none.
    pub(super) fn last_words(&self) -> String {
        let text = disk::read_text(&self.log(), disk::Kind::RESULTS).unwrap_or_default();
        text.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or_default().trim().into()
    }
}

/// Files of all jobs of a study, in the order of their numbers.
pub(super) fn all(out: &Path) -> Vec<Files> {
    let entries = std::fs::read_dir(out.join(JOBS)).into_iter().flatten().flatten();
    let bundles =
        entries.map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|e| e == "json"));
    let mut found: Vec<Files> = bundles.map(Files::of).collect();
    found.sort_by_key(Files::number);
    found
}

/// Removes the files of the jobs of an earlier study. Call it only if no other process uses the folder.
pub(crate) fn remove(out: &Path) {
    for entry in std::fs::read_dir(out.join(JOBS)).into_iter().flatten().flatten() {
        let _ = disk::remove(&entry.path());
    }
}

/// Runs of a job that have begun and ended, by their number in the bundle.
#[derive(Debug, Default)]
pub(super) struct Heard {
    pub(super) begun: BTreeSet<usize>,
    pub(super) ended: BTreeSet<usize>,
}

#[derive(Deserialize)]
struct Line {
    event: String,
    #[serde(default)]
    run: usize,
}

impl Heard {
    /// Reads the events of a job. A line that is not complete yet is ignored.
    pub(super) fn of(files: &Files) -> Heard {
        let text = disk::read_text(&files.events(), disk::Kind::RESULTS).unwrap_or_default();
        let mut heard = Heard::default();
        for Line { event, run } in text.lines().filter_map(|line| serde_json::from_str(line).ok()) {
            match event.as_str() {
                "start" => drop(heard.begun.insert(run)),
                "done" | "failed" => drop(heard.ended.insert(run)),
                _ => {}
            }
        }
        heard
    }

    /// Runs that have begun and not ended.
    pub(super) fn current(&self) -> impl Iterator<Item = usize> {
        self.begun.difference(&self.ended).copied()
    }
}
