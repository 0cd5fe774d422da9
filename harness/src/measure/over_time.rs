//! The largest displacement of a motion over all its recorded states.

use catalogue::metric;
use geometry::Vector3;

use super::request::Request;
use super::solved::Solved;
use crate::error::Failure;
use crate::outcome::{LoadStep, Metric, Plan, StageName};

/// Largest displacement (m) over time at the points where runs are compared, and its time (s); empty for a
/// procedure without time.
pub(crate) fn over_time(
    run: &Solved,
    plan: &Plan,
    request: &Request,
    steps: &[LoadStep],
) -> Result<Vec<Metric>, Failure> {
    let Some(history) = &run.solution.history else { return Ok(Vec::new()) };
    let points = if request.targets.is_empty() { run.method.nodes() } else { request.targets };
    let largest = |field: &[Vector3]| field.iter().fold(0.0, |largest: f64, u| largest.max(u.norm()));
    // Without a transfer in the plan, nodal parameters are displacements.
    let rows = match plan.runs(StageName::Transfer) {
        true => Some(run.prepared.source.at_points(points)?.0),
        false => None,
    };
    let mut found: Option<(f64, f64)> = None;
    for (step, u) in steps.iter().zip(&history.fields) {
        let Some(time) = step.time() else { continue };
        let here = rows.as_ref().map_or_else(|| largest(u), |rows| largest(&rows.rows().apply(u)));
        if found.is_none_or(|(most, _)| here > most) {
            found = Some((here, time));
        }
    }
    Ok(found.map_or_else(Vec::new, |(most, time)| {
        vec![Metric::new(&metric::MAX_OVER_TIME, most), Metric::new(&metric::TIME_OF_MAX, time)]
    }))
}
