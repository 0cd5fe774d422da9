//! Trials of the methods along the axes of a study.

use cases::scene::{self, Bound, Check};
use catalogue::metric;
use records::{Axis, Check as Verdict, Ended, Trial};

use super::check;
use super::task::TaskResult;

/// Axis value at which the scene itself is refused, so that none of its methods runs.
pub(super) struct RefusedScene {
    /// Index of the run table in the study.
    pub(super) run: usize,
    pub(super) value: f64,
    pub(super) reason: String,
}

/// Axis of a run table, without its trials.
pub(super) fn empty(case: &str, axis: &scene::Axis) -> Axis {
    Axis {
        case: case.into(),
        name: axis.name.clone(),
        unit: axis.unit.clone(),
        values: axis.values.clone(),
        base: axis.base,
        judge: axis.judge.to_string(),
        wrong: axis.wrong,
        trials: Vec::new(),
    }
}

/// Trial of one method at one value of an axis.
pub(super) fn trial(method: &str, value: f64, axis: &scene::Axis, result: &TaskResult) -> Trial {
    let (ended, reason) = match &result.failure {
        None => (Ended::Whole, String::new()),
        Some((failure, _)) if result.records.is_empty() => (Ended::Refused, failure.reason.clone()),
        Some((failure, _)) => (Ended::Early, failure.reason.clone()),
    };
    Trial {
        method: method.into(),
        value,
        ended,
        error: check::value(axis.judge, &result.records),
        warnings: result.warnings.iter().map(|w| w.code.clone()).collect(),
        reason,
    }
}

/// Trial of a method whose scene is refused.
pub(super) fn refused(method: &str, refused: &RefusedScene) -> Trial {
    Trial {
        method: method.into(),
        value: refused.value,
        ended: Ended::Refused,
        error: None,
        warnings: Vec::new(),
        reason: refused.reason.clone(),
    }
}

/// Checks, one per method, that no run is wrong without a warning.
pub(super) fn verdicts(axis: &Axis) -> Vec<Verdict> {
    let check = Check {
        address: metric::SILENT_WRONG.whole(),
        methods: Vec::new(),
        at: String::new(),
        bound: Bound::Within { at_least: None, at_most: Some(0.0) },
    };
    let each = axis.methods().into_iter().map(|method| {
        let case = format!("{} along {}", axis.case, axis.name);
        let mut verdict = check::judge(&check, &case, method, Some(axis.silent(method) as f64), None);
        let silent = |t: &&Trial| t.method == method && axis.verdict(t) == records::AxisVerdict::Silent;
        if let Some(first) = axis.trials.iter().find(silent) {
            let error = first.error.map_or("no".into(), |e| format!("{e:.3}"));
            verdict.reason = format!("at {} {}: {} {error}, no warning", first.value, axis.unit, axis.judge);
        }
        verdict
    });
    each.collect()
}
