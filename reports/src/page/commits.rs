//! View of a study over commits.

use records::Family;
use serde::Serialize;

use super::methods::Methods;
use crate::commits::{Point, Step, Trend};

/// Largest number of changes of a kind that are named; the others are counted.
const NAMED: usize = 5;

/// View of a study on one machine.
#[derive(Serialize)]
pub(super) struct TrendView {
    label: usize,
    commits: Vec<CommitView>,
}

#[derive(Serialize)]
struct CommitView {
    name: String,
    quiet: Option<bool>,
    runs: usize,
    seconds: f64,
    /// Ratio to the time of the first commit.
    time: Option<f64>,
    error: Option<f64>,
    errors_moved: bool,
    times_moved: bool,
    /// Numbers of significant changes of errors and times; empty without any.
    moved: String,
    /// Descriptions of these changes.
    changes: Vec<String>,
}

impl TrendView {
    pub(super) fn new(trend: &Trend, methods: &mut Methods) -> TrendView {
        TrendView {
            label: methods.label(&trend.label(), Family::Fem),
            commits: trend.points.iter().map(commit).collect(),
        }
    }
}

fn commit(point: &Point) -> CommitView {
    CommitView {
        name: point.name(),
        quiet: point.quiet,
        runs: point.runs,
        seconds: point.seconds,
        time: point.seconds_ratio,
        error: point.error_ratio,
        errors_moved: point.errors_moved(),
        times_moved: point.times_moved(),
        moved: point.moved(),
        changes: point.step.as_ref().map(changes).unwrap_or_default(),
    }
}

fn changes(step: &Step) -> Vec<String> {
    let (slower, faster): (Vec<_>, Vec<_>) = step.called.iter().partition(|ratio| ratio.ratio > 1.0);
    let mut out = some("worse", &step.worse);
    out.extend(some("better", &step.better));
    out.extend(some("slower", &slower));
    out.extend(some("faster", &faster));
    out
}

fn some<T: ToString>(how: &str, all: &[T]) -> Vec<String> {
    let named = all.iter().take(NAMED).map(|one| format!("{how}: {}", one.to_string()));
    let rest = all.len().saturating_sub(NAMED);
    named.chain((rest > 0).then(|| format!("{how}: {rest} more"))).collect()
}
