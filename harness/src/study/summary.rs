//! What became of each run, for whoever counts runs rather than numbers.

use std::path::PathBuf;

use cases::scene::{ErrorKind, Scene};
use reports::{Check, Record};

use super::task::TaskResult;
use super::tasks::Task;
use super::{Plan, label};
use crate::run::case_name;

/// One run of a study, or the checks of several of its runs together.
#[derive(Clone, Debug)]
pub struct RunSummary {
    /// Its case.
    pub case: String,
    /// The scene's file.
    pub file: PathBuf,
    /// The method, with what distinguishes the run from others of it.
    pub label: String,
    /// What one pass took, s.
    pub seconds: f64,
    /// Its method's place, `file:line`, or that of the key which failed.
    pub at: String,
    /// Why it has no numbers, or those of a part of its load, where nobody expected that.
    pub failure: Option<String>,
    /// Its checks.
    pub checks: Vec<Check>,
}

/// Seconds of one pass over a run: the median of its repeats.
pub(super) fn seconds(result: &TaskResult) -> f64 {
    let total = |r: &&Record| r.quantity == "time" && r.phase == "total" && r.statistic == "median";
    result.records.iter().find(total).map_or(0.0, |r| r.value)
}

/// `file:line` of a method in the scene or in the file that it is taken from.
fn method_place(scene: &Scene, id: &str) -> String {
    let index = scene.methods.iter().position(|method| method.id == id).unwrap_or_default();
    let place = scene.error(ErrorKind::Invalid, &format!("method[{index}]"), "", None);
    format!("{}:{}", place.file, place.line)
}

impl Plan {
    /// A run with its checks, before it is known whether anybody expected its failure.
    pub(super) fn summary(&self, task: &Task, result: &TaskResult, checks: &[Check]) -> RunSummary {
        let (file, _, scene) = &self.scenes[task.scene];
        RunSummary {
            case: case_name(scene),
            file: file.clone(),
            at: method_place(scene, &task.method.id),
            label: label(task, &result.records, self.is_one_of_many(task)),
            seconds: seconds(result),
            failure: None,
            checks: checks.to_vec(),
        }
    }

    /// A check of several runs together, beside the runs.
    pub(super) fn together(&self, check: &Check) -> RunSummary {
        // Along an axis the case has its name behind it.
        let own = |(_, _, scene): &&(PathBuf, String, Scene)| {
            let behind = check.case.strip_prefix(&case_name(scene));
            behind.is_some_and(|text| text.is_empty() || text.starts_with(" along "))
        };
        RunSummary {
            case: check.case.clone(),
            file: self.scenes.iter().find(own).map(|(file, ..)| file.clone()).unwrap_or_default(),
            at: check.at.clone(),
            label: format!("{} {}", check.method, check.metric),
            seconds: 0.0,
            failure: None,
            checks: vec![check.clone()],
        }
    }
}
