//! What became of each run, for whoever counts runs rather than numbers.

use std::path::PathBuf;

use reports::{Check, Record};

use super::task::TaskResult;

/// One run of a study, or the checks of several of its runs together.
#[derive(Clone, Debug)]
pub struct RunSummary {
    /// Its case.
    pub case: String,
    /// The scene's file.
    pub file: PathBuf,
    /// The method, with what tells the run from others of it.
    pub label: String,
    /// What one pass took, s.
    pub seconds: f64,
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
