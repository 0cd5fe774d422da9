//! The hidden command `job`: executes the runs of one bundle and stores their results.

use std::path::PathBuf;

use clap::Args;

use super::super::args::{ApartArgs, VerifyArgs};
use super::super::events::Events;
use super::super::folder;
use super::super::plan::StudyPlan;
use super::bundle::{Bundle, Files};
use crate::error::Failure;
use crate::outcome::provenance;
use crate::process::group;

/// Arguments of the hidden command `job`.
#[derive(Args)]
pub struct JobArgs {
    /// File of the bundle
    pub bundle: PathBuf,
    /// Id of the parent process, with which this process ends
    #[arg(long)]
    pub parent: Option<u32>,
}

/// Executes the runs of a bundle.
pub(crate) fn job(args: &JobArgs) -> Result<(), Failure> {
    let failed = |bad: String| Failure::Run(bad);
    if let Some(parent) = args.parent {
        group::limit(parent, None).map_err(|bad| failed(bad.to_string()))?;
    }
    let files = Files::of(args.bundle.clone());
    let bundle = files.read().map_err(Failure::Input)?;
    let study = bundle.note.study.clone();
    // Another process may use the folder already; nothing in it is removed.
    let folder = folder::join(&study, &files.out(), || ())?;
    files.note_machine(&provenance::machine()).map_err(|bad| failed(bad.to_string()))?;
    let events = Events::to(&files.events()).map_err(|bad| failed(bad.to_string()))?;
    let (plan, verify) = planned(bundle, files.out())?;
    plan.worked(&verify, Some(&events));
    folder.close(|| ());
    Ok(())
}

/// Reads the study, with only the runs of the bundle.
fn planned(bundle: Bundle, out: PathBuf) -> Result<(StudyPlan, VerifyArgs), Failure> {
    let Bundle { note, runs, isolate, time_limit, memory_limit, retries, .. } = bundle;
    let unreadable = |errors: Vec<cases::scene::SceneError>| {
        Failure::Input(errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))
    };
    let (mut plan, mut verify) = note.plan(out).map_err(unreadable)?;
    let changed =
        |run| plan.len() <= run || runs.iter().any(|r| r.index == run && plan.key(run, &verify) != r.key);
    if runs.iter().any(|run| changed(run.index)) {
        return Err(Failure::Input("a scene has changed since the study began".into()));
    }
    let mut index = 0..;
    plan.tasks
        .retain(|_| index.next().is_some_and(|index| runs.binary_search_by_key(&index, |r| r.index).is_ok()));
    verify.join = true;
    verify.quiet = true;
    verify.on.retries = Some(retries);
    verify.apart = ApartArgs { isolate, time_limit, memory_limit };
    Ok((plan, verify))
}
