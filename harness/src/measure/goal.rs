//! A number of a solution whose error is traced.

use cases::scene::Goal;
use geometry::Point3;

use super::solved::Solved;
use crate::error::Failure;

/// The value of a number in a run, m or N. `probes`, m.
///
/// # Errors
/// The number has no value, because the run's procedure has no such number.
pub(crate) fn number(run: &Solved, goal: &Goal, probes: &[Point3]) -> Result<f64, Failure> {
    let Solved { setup, prepared, solution, .. } = *run;
    let none = || Failure::Run(format!("the run has no {goal}"));
    match *goal {
        Goal::ToolForce(tool) => {
            let last = solution.history.as_ref().map(|history| &history.last);
            last.and_then(|last| last.tools.get(tool)).map(|tool| tool.pushed).ok_or_else(none)
        }
        Goal::Reaction(support, axis) => {
            solution.support_forces().get(support).map(|support| support.force[axis]).ok_or_else(none)
        }
        Goal::Mean(face, axis) => {
            let weights = prepared.means(std::slice::from_ref(&setup.output.means[face]))?.swap_remove(0);
            Ok(weights.iter().map(|&(node, weight)| weight * solution.u[node as usize][axis]).sum())
        }
        Goal::Probe(probe, axis) => {
            let at = prepared.source.at_points(&probes[probe..=probe])?.0.rows().apply(&solution.u)[0];
            Ok(axis.map_or(at.norm(), |axis| at[axis]))
        }
    }
}
