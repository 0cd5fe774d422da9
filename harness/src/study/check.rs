//! Bounds on numbers: of one run, or of a family of runs at several levels.

use cases::scene::{Bound, Check};
use catalogue::metric::Needs;
use reports::{Check as Verdict, Family, Record, Status};

/// The SI value a check's metric names, among the records of one run.
pub fn value(metric: &str, records: &[Record]) -> Option<f64> {
    let own = |r: &&Record| r.family != Family::Interp;
    if let Some(phase) = metric.strip_prefix("time-") {
        let median = |r: &&Record| r.quantity == "time" && r.phase == phase && r.statistic == "median";
        return records.iter().filter(own).find(median).map(|r| r.value);
    }
    if metric == "transfer-rms" {
        // The worst of the schemes that the scene asks for.
        return records.iter().filter(|r| r.quantity == metric).map(|r| r.value).reduce(f64::max);
    }
    let quantity = if metric == "condition" { "condition-max" } else { metric };
    let plain = |r: &&Record| {
        let whole = r.phase.is_empty() && r.step.is_none() && r.mode.is_none();
        whole && r.quantity == quantity && r.statistic == "value"
    };
    records.iter().filter(own).find(plain).map(|r| r.value)
}

/// The observed order between the two finest levels of a family of runs, each given by its records; the quantity is
/// the metric without its prefix `order-`.
pub fn order(metric: &str, family: &[&[Record]]) -> Option<f64> {
    let quantity = metric.strip_prefix("order-")?;
    let mut points: Vec<(f64, f64)> =
        family.iter().filter_map(|run| Some((run.first()?.spacing, value(quantity, run)?))).collect();
    points.sort_by(|a, b| b.0.total_cmp(&a.0));
    reports::observed_order(&points)?.pairs.last().copied()
}

/// Whether the check is about a family of levels.
pub fn needs_levels(check: &Check) -> bool {
    check.metric.needs == Needs::Levels
}

/// The verdict on one value.
pub fn judge(check: &Check, case: &str, method: &str, value: Option<f64>) -> Verdict {
    let (bound, status, reason) = match (&check.bound, value) {
        (bound, None) => (text(bound), Status::NotRun, "this run gives no such number".to_string()),
        (Bound::Within { at_least, at_most }, Some(v)) => {
            // Written so that a NaN fails.
            let holds = at_least.is_none_or(|low| v >= low) && at_most.is_none_or(|high| v <= high);
            let reason = if holds { String::new() } else { format!("{v:.6e} is not {}", text(&check.bound)) };
            (text(&check.bound), if holds { Status::Pass } else { Status::Fail }, reason)
        }
        (Bound::KnownBand { low, high, reason }, Some(v)) => {
            if v >= *low && v <= *high {
                (text(&check.bound), Status::KnownFailure, reason.clone())
            } else {
                let away = format!("{v:.6e} left its known band ({}): {reason}", text(&check.bound));
                (text(&check.bound), Status::Fail, away)
            }
        }
    };
    Verdict {
        case: case.into(),
        method: method.into(),
        metric: check.metric.name.into(),
        value: value.filter(|v| v.is_finite()),
        bound,
        status,
        reason,
    }
}

fn text(bound: &Bound) -> String {
    match bound {
        Bound::Within { at_least: Some(low), at_most: Some(high) } => format!("from {low:e} to {high:e}"),
        Bound::Within { at_least: Some(low), at_most: None } => format!("at least {low:e}"),
        Bound::Within { at_least: None, at_most: Some(high) } => format!("at most {high:e}"),
        Bound::Within { at_least: None, at_most: None } => "any number".into(),
        Bound::KnownBand { low, high, .. } => format!("known to lie from {low:e} to {high:e}"),
    }
}
