//! Quantities of a run beside those that more shape functions on the same body predict.

use std::f64::consts::TAU;

use catalogue::metric;
use geometry::Point3;
use shape::Vector3;

use super::comparison::compared;
use super::modes::RIGID;
use super::request::Request;
use super::solved::{Field, Solved};
use super::strain_energy;
use crate::error::Failure;
use crate::outcome::{Estimated, Estimates};
use crate::procedure::Vibration;

/// Part of the forces within a body below which its resultants are rounding.
const ROUNDING: f64 = 1e-9;

/// Displacement, probes, forces of tools and supports, and energy, each beside its prediction.
pub(crate) fn estimates(
    run: &Solved,
    predicted: &Solved,
    field: &Field,
    request: &Request,
) -> Result<Estimates, Failure> {
    let at = |points: &[Point3]| -> Result<Vec<Vector3>, Failure> {
        Ok(predicted.prepared.source.at_points(points)?.0.rows().apply(&predicted.solution.u))
    };
    let points = compared(run, request).to_vec();
    let of = [metric::DISPLACEMENT_ESTIMATE.whole(), metric::DISPLACEMENT_SATURATION.whole()];
    let mut all = vec![Estimated::vectors(of, &field.values, &at(&points)?)];
    let probes = run.prepared.source.at_points(request.probes)?.0.rows().apply(&run.solution.u);
    for (k, (own, right)) in probes.into_iter().zip(at(request.probes)?).enumerate() {
        let of = [metric::PROBE_ESTIMATE.at(k), metric::PROBE_SATURATION.at(k)];
        all.push(Estimated::vectors(of, &[own], &[right]));
    }
    if let [Some(own), Some(right)] = [run, predicted].map(|run| run.solution.history.as_ref()) {
        for (k, (own, right)) in own.last.tools.iter().zip(&right.last.tools).enumerate() {
            let of = [metric::TOOL_FORCE_ESTIMATE.at(k), metric::TOOL_FORCE_SATURATION.at(k)];
            all.push(Estimated::value(of, metric::TOOL_FORCE_PREDICTED.at(k), own.pushed, right.pushed));
        }
    }
    if let (Some(own), Some(right)) = (strain_energy(run)?, strain_energy(predicted)?) {
        // A force that does the energy's work along the largest displacement.
        let size = field.values.iter().map(|u| u.norm()).fold(0.0, f64::max);
        all.extend(supports(run, predicted, right / size));
        let of = [metric::STRAIN_ENERGY_ESTIMATE.whole(), metric::STRAIN_ENERGY_SATURATION.whole()];
        all.push(Estimated::value(of, metric::STRAIN_ENERGY_PREDICTED.whole(), own, right));
    }
    Ok(Estimates { points, all })
}

/// Forces of the supports, with errors relative to the largest of them: many a support on rollers has none.
/// None if all are rounding beside `scale`, N.
fn supports(run: &Solved, predicted: &Solved, scale: f64) -> Vec<Estimated> {
    let [own, right] = [run, predicted].map(|run| run.solution.support_forces());
    let largest = right.iter().map(|support| support.force.norm()).fold(0.0, f64::max);
    if largest < ROUNDING * scale {
        return Vec::new();
    }
    let each = own.iter().zip(right).enumerate().map(|(k, (own, right))| {
        let of = [metric::REACTION_ESTIMATE.at(k), metric::REACTION_SATURATION.at(k)];
        Estimated::vectors(of, &[own.force], &[right.force]).relative_to(largest)
    });
    each.collect()
}

/// Frequencies of the reported modes, Hz. Rigid motions have none.
pub(crate) fn frequencies(run: &Vibration, predicted: Option<&Vibration>) -> Estimates {
    let right = predicted.iter().flat_map(|vibration| &vibration.modes.squared);
    let each = run.modes.squared.iter().zip(right).take(run.count).enumerate();
    let elastic = each.filter(|(_, (_, right))| **right > RIGID * RIGID * run.modes.scale);
    let all = elastic.map(|(k, (own, right))| {
        let [own, right] = [own, right].map(|squared| squared.max(0.0).sqrt() / TAU);
        let of = [metric::FREQUENCY_ESTIMATE.at(k), metric::FREQUENCY_SATURATION.at(k)];
        Estimated::value(of, metric::FREQUENCY_PREDICTED.at(k), own, right)
    });
    Estimates { points: Vec::new(), all: all.collect() }
}
