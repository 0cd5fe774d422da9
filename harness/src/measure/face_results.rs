//! Support forces and requested mean displacements of faces, at the end and in every recorded state.

use catalogue::metric;
use geometry::Vector3;

use super::solved::Solved;
use crate::discretise::place;
use crate::error::Failure;
use crate::outcome::{FaceMean, Metric, Outcome, SupportForce, push};

/// Adds support forces (N) and mean displacements (m) to the outcome, its metrics and its steps.
pub(crate) fn places(outcome: &mut Outcome, run: &Solved) -> Result<(), Failure> {
    let Solved { setup, prepared, solution, .. } = *run;
    let held = setup.supports.iter().zip(prepared.support_axes()).zip(solution.support_forces());
    outcome.supports = held
        .map(|((support, axes), &resultant)| SupportForce {
            name: place::words(&support.place),
            axes,
            resultant,
        })
        .collect();
    let rows = prepared.means(&setup.output.means)?;
    let means = |u: &[Vector3]| -> Vec<Vector3> {
        rows.iter().map(|row| row.iter().map(|&(node, weight)| u[node as usize] * weight).sum()).collect()
    };
    outcome.means = (setup.output.means.iter().zip(means(&solution.u)))
        .map(|(face, u)| FaceMean { name: place::words(face), u })
        .collect();
    if let Some(history) = &solution.history {
        for (step, u) in outcome.steps.iter_mut().zip(&history.fields) {
            step.means = means(u);
        }
    }
    for (index, support) in outcome.supports.iter().enumerate() {
        for axis in (0..3).filter(|&axis| support.axes[axis]) {
            push(
                &mut outcome.metrics,
                metric::REACTION.components()[axis].at(index),
                support.resultant.force[axis],
            );
        }
    }
    let founded = |m: &&Metric| std::ptr::eq(m.of.metric, &metric::FOUNDATION_FORCE);
    let forces: Vec<Metric> = match &solution.history {
        Some(history) => history.last.points.iter().filter(founded).cloned().collect(),
        None => prepared.foundation_forces(&solution.u, &[]),
    };
    outcome.metrics.extend(forces);
    for (index, face) in outcome.means.iter().enumerate() {
        for (axis, of) in metric::MEAN.components().into_iter().enumerate() {
            push(&mut outcome.metrics, of.at(index), face.u[axis]);
        }
    }
    Ok(())
}
