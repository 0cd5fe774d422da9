//! Summary of each run, for uses that count runs rather than metrics.

use std::path::PathBuf;

use cases::scene::{ErrorKind, Scene};
use catalogue::metric;
use records::{Check, Record};

use super::plan::{StudyPlan, label};
use super::task::TaskResult;
use super::tasks::Task;
use crate::run::case_name;

/// Summary of one run of a study, or of the checks of several runs together.
#[derive(Clone, Debug)]
pub struct RunSummary {
    /// Name of the case.
    pub case: String,
    /// File of the scene.
    pub file: PathBuf,
    /// Method id, with the settings that distinguish the run from others of the method.
    pub label: String,
    /// Time of one pass, s.
    pub seconds: f64,
    /// Location (`file:line`) of the method, or of the key that caused the failure.
    pub at: String,
    /// Reason for an unexpected failure or early end; `None` for a complete or an expected result.
    pub failure: Option<String>,
    /// Checks of the run.
    pub checks: Vec<Check>,
}

/// Time of one pass over a run (s): the median of its repeats.
pub(super) fn seconds(result: &TaskResult) -> f64 {
    let total = |r: &&Record| r.is(&metric::TIME) && r.phase == "total" && r.statistic == "median";
    result.records.iter().find(total).map_or(0.0, |r| r.value)
}

/// Location (`file:line`) of a method in the scene or in the included file that defines it.
fn method_place(scene: &Scene, id: &str) -> String {
    let index = scene.methods.iter().position(|method| method.id == id).unwrap_or_default();
    let place = scene.error(ErrorKind::Invalid, &format!("method[{index}]"), "", None);
    format!("{}:{}", place.file, place.line)
}

impl StudyPlan {
    /// Summary of a run with its checks. The failure is added later, if it was not expected.
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

    /// Summary of a check of several runs together.
    pub(super) fn together(&self, check: &Check) -> RunSummary {
        // Along an axis, the name of the axis follows the name of the case.
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
