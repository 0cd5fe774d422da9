//! Estimated errors: the distance of a run from the solution that more shape functions on the same body
//! predict.

use catalogue::metric;
use geometry::Point3;
use shape::Vector3;

use super::comparison::compared;
use super::norms::relative;
use super::request::Request;
use super::solved::{Field, Solved};
use super::strain_energy;
use crate::error::Failure;
use crate::outcome::{Metric, push};

/// Part of the forces within a body below which its resultants are rounding.
const ROUNDING: f64 = 1e-9;

/// Adds the estimated errors of displacements, probes, tools, supports and energy, relative to the predicted
/// values, and the predicted values of forces and energy.
pub(crate) fn estimates(
    metrics: &mut Vec<Metric>,
    run: &Solved,
    predicted: &Solved,
    field: &Field,
    request: &Request,
) -> Result<(), Failure> {
    let at = |points: &[Point3]| -> Result<Vec<Vector3>, Failure> {
        Ok(predicted.prepared.source.at_points(points)?.0.rows().apply(&predicted.solution.u))
    };
    let targets = compared(run, request);
    if let Some(distance) = relative(&field.values, &at(targets)?) {
        push(metrics, &metric::DISPLACEMENT_ESTIMATE, distance.rms);
    }
    let probes = run.prepared.source.at_points(request.probes)?.0.rows().apply(&run.solution.u);
    for (index, (own, right)) in probes.iter().zip(at(request.probes)?).enumerate() {
        apart(metrics, metric::PROBE_ESTIMATE.at(index), (own - right).norm(), right.norm());
    }
    if let [Some(own), Some(right)] = [run, predicted].map(|run| run.solution.history.as_ref()) {
        for (index, (own, right)) in own.last.tools.iter().zip(&right.last.tools).enumerate() {
            apart(metrics, metric::TOOL_FORCE_ESTIMATE.at(index), own.pushed - right.pushed, right.pushed);
            push(metrics, metric::TOOL_FORCE_PREDICTED.at(index), right.pushed);
        }
    }
    if let (Some(own), Some(right)) = (strain_energy(run)?, strain_energy(predicted)?) {
        // A force that does the energy's work along the largest displacement.
        let size = field.values.iter().map(|u| u.norm()).fold(0.0, f64::max);
        supports(metrics, run, predicted, right / size);
        apart(metrics, (&metric::STRAIN_ENERGY_ESTIMATE).into(), own - right, right);
        push(metrics, &metric::STRAIN_ENERGY_PREDICTED, right);
    }
    Ok(())
}

/// Adds the distances of the supports' forces, relative to the largest of these forces: many a support on
/// rollers has none. Nothing is added if all are rounding beside `scale`, N.
fn supports(metrics: &mut Vec<Metric>, run: &Solved, predicted: &Solved, scale: f64) {
    let [own, right] = [run, predicted].map(|run| run.solution.support_forces());
    let largest = right.iter().map(|support| support.force.norm()).fold(0.0, f64::max);
    if largest < ROUNDING * scale {
        return;
    }
    for (index, (own, right)) in own.iter().zip(right).enumerate() {
        apart(metrics, metric::REACTION_ESTIMATE.at(index), (own.force - right.force).norm(), largest);
    }
}

/// Adds a distance relative to a value, unless the value is zero.
fn apart(metrics: &mut Vec<Metric>, of: metric::Address, distance: f64, value: f64) {
    let relative = (distance / value).abs();
    if relative.is_finite() {
        push(metrics, of, relative);
    }
}
