//! State of a study in a folder of results: how many runs are done, running and failed, and the time left.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use clap::Args;

use super::super::merge::{Unmerged, noted};
use super::super::store::{Accept, Machines, Store};
use super::bundle::{self, Files};
use crate::run::case_name;

/// Arguments of `status`.
#[derive(Args)]
pub struct StatusArgs {
    /// Folder of results of a study
    pub results: PathBuf,
}

/// State of a study.
pub(crate) struct Status {
    /// Number of runs of the study.
    pub(crate) runs: usize,
    /// Number of runs with a result, failed ones included.
    pub(crate) done: usize,
    /// Names of the runs that processes execute now, which is known for --on and --join.
    pub(crate) running: Vec<String>,
    /// Runs that failed, with the reason.
    pub(crate) failed: Vec<(String, String)>,
    /// Jobs with runs that have no result.
    pub(crate) jobs: Vec<JobStatus>,
    /// Expected time until all runs have a result, s.
    pub(crate) seconds_left: f64,
    /// Run without a result that takes longest, with its expected time, s.
    pub(crate) worst: Option<(String, f64)>,
}

/// State of one job.
pub(crate) struct JobStatus {
    pub(crate) number: usize,
    pub(crate) runs: usize,
    /// Number of runs without a result.
    pub(crate) left: usize,
    /// Whether a process of the job executes a run now.
    pub(crate) is_running: bool,
    /// Expected time of the runs without a result, s.
    pub(crate) seconds_left: f64,
}

impl Status {
    /// Reads the state of the study in a folder of results.
    pub(crate) fn of(out: &Path) -> Result<Status, Unmerged> {
        let note = noted(out).map_err(Unmerged::Other)?;
        let (plan, args) = note.plan(out.into()).map_err(Unmerged::Scenes)?;
        let costs = plan.foreseen_from(&args, Some(out), Machines::Any);
        let store = Store::of(&args);
        let name = |index: usize| {
            let task = &plan.tasks[index];
            format!("{} {}", case_name(&plan.scenes[task.scene].2), task.method.id)
        };
        let (mut failed, mut left, mut claimed) = (Vec::new(), BTreeMap::new(), BTreeSet::new());
        for index in 0..plan.len() {
            let key = plan.key(index, &args);
            match store.load(&key, Accept::AnyBuild).ok().flatten() {
                Some(result) => {
                    failed.extend(result.failure.map(|(failure, _)| (name(index), failure.reason)));
                }
                None => {
                    left.insert(index, costs.of(index));
                    claimed.extend(store.is_claimed(&key).then_some(index));
                }
            }
        }
        let jobs = jobs(out, &left, &claimed);
        let busy = jobs.iter().filter(|job| job.is_running).count();
        let workers = if busy > 0 { busy } else { claimed.len() };
        let worst = left.iter().max_by(|a, b| a.1.total_cmp(b.1));
        Ok(Status {
            runs: plan.len(),
            done: plan.len() - left.len(),
            running: claimed.iter().map(|&index| name(index)).collect(),
            failed,
            jobs,
            // A sum of nothing is -0.
            seconds_left: left.values().fold(0.0, |sum, seconds| sum + seconds) / workers.max(1) as f64,
            worst: worst.map(|(&index, &seconds)| (name(index), seconds)),
        })
    }
}

/// Jobs of the runs without a result (with their expected times). A repeated run belongs to its last job.
fn jobs(out: &Path, left: &BTreeMap<usize, f64>, claimed: &BTreeSet<usize>) -> Vec<JobStatus> {
    let mut taken = BTreeSet::new();
    let mut found = Vec::new();
    for files in bundle::all(out).iter().rev() {
        let Ok(bundle) = files.read() else { continue };
        let runs = bundle.runs.iter().map(|run| run.index);
        let own: Vec<usize> = runs.filter(|run| left.contains_key(run) && taken.insert(*run)).collect();
        if !own.is_empty() {
            found.push(JobStatus {
                number: Files::number(files),
                runs: bundle.runs.len(),
                left: own.len(),
                is_running: own.iter().any(|run| claimed.contains(run)),
                seconds_left: own.iter().map(|run| left[run]).sum(),
            });
        }
    }
    found.reverse();
    found
}
