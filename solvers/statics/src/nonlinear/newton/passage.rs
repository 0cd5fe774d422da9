//! Steps too long for the tools: jumped over in a converged step, and how short a step may become to prevent it.

use contact::{Drive, Stand};

use super::{Newton, State};
use crate::nonlinear::StaticError;
use crate::nonlinear::statics::{StaticProblem, Step};

/// Part of the deepest penetration that a tool may always be asked to travel in one step: at the touch, where nothing has moved
/// yet, its travel is its penetration.
const SHORTEST: f64 = 0.125;

impl Newton<'_> {
    /// The converged step from `start`, refused where a tool has jumped over the surface on the way, or stands in the body
    /// without a force in the end.
    pub fn checked(&self, start: &State, reached: (State, Step)) -> Result<(State, Step), StaticError> {
        let Some(surface) = self.problem.contact else { return Ok(reached) };
        let (state, step) = &reached;
        for (k, driven) in self.problem.tools.iter().enumerate() {
            let from = Stand { closure: start.closures[k], u: &start.u };
            let to = Stand { closure: state.closures[k], u: &state.u };
            let checked = surface.check_step(driven.tool, from, to, step.tools[k].active > 0);
            checked.map_err(|cause| StaticError::Contact { tool: k, cause })?;
        }
        Ok(reached)
    }

    /// Refuses the last state, after `step`, where a tool stands in the body without a force.
    pub fn check_end(&self, state: &State, step: &Step) -> Result<(), StaticError> {
        let Some(surface) = self.problem.contact else { return Ok(()) };
        for (k, driven) in self.problem.tools.iter().enumerate().filter(|(k, _)| step.tools[*k].active == 0) {
            let stand = Stand { closure: state.closures[k], u: &state.u };
            let checked = surface.check_end(driven.tool, stand);
            checked.map_err(|cause| StaticError::Contact { tool: k, cause })?;
        }
        Ok(())
    }
}

/// The part of its full closure that a tool has to be able to travel in a step, the least of all tools: how finely a path can be
/// stepped must not hang on how many results of it are wanted.
pub(crate) fn shortest_travel(problem: &StaticProblem) -> f64 {
    let each = problem.tools.iter().map(|driven| match driven.drive {
        Drive::Closure(full) if full != 0.0 => SHORTEST * driven.tool.deepest() / full.abs(),
        Drive::Closure(_) | Drive::Force(_) => f64::INFINITY,
    });
    each.fold(f64::INFINITY, f64::min)
}
