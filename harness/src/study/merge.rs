//! Merge of the shares of a study, each run into its own folder, into the results of the whole study.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use cases::scene::{self, SceneError};
use clap::Args;
use serde::{Deserialize, Serialize};

use super::args::VerifyArgs;
use super::filters::Filters;
use super::plan::StudyPlan;
use super::results::FinishedStudy;
use super::store;
use super::store::Share;
use super::task::TaskResult;
use crate::error::Failure;
use crate::outcome::provenance;
use crate::run::case_name;

/// File in a folder of results that records the study and the selection of its runs.
const NOTE: &str = "study.json";

/// Arguments of `merge`.
#[derive(Args)]
pub struct MergeArgs {
    /// Folder for the results of the whole study
    pub out: PathBuf,
    /// Folders of the shares
    #[arg(required = true)]
    pub shares: Vec<PathBuf>,
    /// Study file, if its path has changed
    #[arg(long, value_name = "FILE")]
    pub study: Option<PathBuf>,
}

/// Selection of a study's runs, without the share.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Note {
    /// Study file.
    pub(super) study: PathBuf,
    quick: bool,
    filter: Option<String>,
    #[serde(default)]
    filters: Filters,
}

impl Note {
    /// Selection by the arguments of the study in a file.
    pub(super) fn new(args: &VerifyArgs, study: PathBuf) -> Note {
        Note { study, quick: args.quick, filter: args.filter.clone(), filters: args.filters.clone() }
    }

    /// Reads the study and its selected runs, whose results are in the folder `out`.
    pub(super) fn plan(self, out: PathBuf) -> Result<(StudyPlan, VerifyArgs), Vec<SceneError>> {
        let Note { study, quick, filter, filters } = self;
        let mut plan = scene::load_study(&study).and_then(StudyPlan::new)?;
        let args = VerifyArgs { quick, filter, filters, out, ..VerifyArgs::of(&study) };
        plan.select(&args);
        Ok((plan, args))
    }
}

/// Reason why shares cannot be merged.
pub(crate) enum Unmerged {
    Scenes(Vec<SceneError>),
    Other(Failure),
}

/// Merged results of the shares.
pub(crate) struct Merged {
    pub(crate) finished: FinishedStudy,
    /// Labels of the runs that no share has.
    pub(crate) missing: Vec<String>,
    /// Number of different machines on which the results were made.
    pub(crate) machines: usize,
}

/// Records in a folder of results which study the results belong to.
pub(crate) fn note(args: &VerifyArgs, study: &Path) -> Result<(), Failure> {
    let study = study.canonicalize().unwrap_or_else(|_| study.into());
    let note = Note::new(args, study);
    let text = serde_json::to_string_pretty(&note).map_err(|bad| Failure::Run(bad.to_string()))?;
    records::write_text(&args.out.join(NOTE), text + "\n").map_err(|bad| Failure::Run(bad.to_string()))
}

pub(super) fn noted(share: &Path) -> Result<Note, Failure> {
    let wrong = |bad: String| {
        let path = share.join(NOTE);
        Failure::Input(format!("{}: {bad}; give folders written by `tissuebench verify`", path.display()))
    };
    let text =
        disk::read_text(&share.join(NOTE), disk::Kind::MESSAGE).map_err(|bad| wrong(bad.to_string()))?;
    serde_json::from_str(&text).map_err(|bad| wrong(bad.to_string()))
}

fn is_same(one: &Path, other: &Path) -> bool {
    disk::Identity::of(one).is_some_and(|one| disk::Identity::of(other) == Some(one))
}

/// Reads the study of the shares, with its runs and arguments.
pub(crate) fn plan(args: &MergeArgs) -> Result<(PathBuf, StudyPlan, VerifyArgs), Unmerged> {
    let other = Unmerged::Other;
    if let Some(share) = args.shares.iter().find(|share| is_same(share, &args.out)) {
        let problem =
            format!("{}: is one of the shares; give the merged results their own folder", share.display());
        return Err(other(Failure::Input(problem)));
    }
    let mut notes = Vec::new();
    for share in &args.shares {
        notes.push(noted(share).map_err(other)?);
    }
    let same = |a: &Note, b: &Note| {
        (a.study.file_name(), a.quick, &a.filter, &a.filters)
            == (b.study.file_name(), b.quick, &b.filter, &b.filters)
    };
    if let Some(at) = notes.iter().position(|note| !same(note, &notes[0])) {
        let (a, b) = (args.shares[0].display(), args.shares[at].display());
        return Err(other(Failure::Input(format!("{a} and {b} belong to different studies or selections"))));
    }
    let mut note = notes.swap_remove(0);
    note.study = args.study.clone().unwrap_or(note.study);
    let study = note.study.clone();
    let (plan, verify) = note.plan(args.out.clone()).map_err(Unmerged::Scenes)?;
    Ok((study, plan, verify))
}

impl StudyPlan {
    /// Takes every result from the first share that has it, and copies it to the folder of the whole study.
    pub(crate) fn merge(&self, args: &VerifyArgs, shares: &[PathBuf]) -> Result<Merged, Failure> {
        let unwritten = |bad: records::RecordError| Failure::Run(bad.to_string());
        let mut found = Share::default();
        let mut results: BTreeMap<usize, TaskResult> = BTreeMap::new();
        let mut missing = Vec::new();
        for (index, task) in self.tasks.iter().enumerate() {
            let key = self.key(index, args);
            match shares.iter().find_map(|share| found.take(share, &key)) {
                Some(Ok((text, result))) => {
                    store::keep(&args.out, &key, &text).map_err(unwritten)?;
                    results.insert(index, result);
                }
                Some(Err(problem)) => return Err(Failure::Input(problem)),
                None => {
                    let level = if task.level > 0 { format!(" level {}", task.level) } else { String::new() };
                    missing.push(format!(
                        "{} {}{level}",
                        case_name(&self.scenes[task.scene].2),
                        task.method.id
                    ));
                }
            }
        }
        let machine = shares.iter().find_map(|share| records::provenance_of(share));
        let machine = machine.map_or_else(provenance::machine, |from| from.machine);
        Ok(Merged { finished: self.collect(results, machine), missing, machines: found.machines.len() })
    }
}
