//! Tools that jumped over the surface or stand in it, and how short a step may become to prevent it.

use contact::{ContactError, ContactSurface, Drive, Stand, Tool};

use super::{Newton, State};
use crate::nonlinear::StaticError;
use crate::nonlinear::statics::{StaticProblem, Step};

/// Part of the deepest penetration that a tool may always be asked to travel in one step: at the touch, where nothing has moved
/// yet, its travel is its penetration.
const SHORTEST: f64 = 0.125;

impl Newton<'_> {
    /// The converged step from `start`, refused where a tool has jumped over the surface on the way.
    pub fn checked(&self, start: &State, reached: (State, Step)) -> Result<(State, Step), StaticError> {
        let (state, step) = &reached;
        self.each_tool(|surface, k, tool| {
            let from = Stand { closure: start.closures[k], u: &start.u };
            let to = Stand { closure: state.closures[k], u: &state.u };
            surface.check_passage(tool, from, to, step.tools[k].active > 0)
        })?;
        Ok(reached)
    }

    /// Refuses a state that is reported, after `step`, where a tool stands in the body without a force; at the end of the loading,
    /// where no way is left to the next contact point, however little.
    pub fn check_overlap(&self, state: &State, step: &Step, ends: bool) -> Result<(), StaticError> {
        self.each_tool(|surface, k, tool| {
            let stand = Stand { closure: state.closures[k], u: &state.u };
            match (step.tools[k].active, ends) {
                (0, true) => surface.check_end(tool, stand),
                (0, false) => surface.check_overlap(tool, stand),
                _ => Ok(()),
            }
        })
    }

    fn each_tool(
        &self,
        check: impl Fn(&ContactSurface, usize, &Tool) -> Result<(), ContactError>,
    ) -> Result<(), StaticError> {
        let Some(surface) = self.problem.contact else { return Ok(()) };
        for (tool, driven) in self.problem.tools.iter().enumerate() {
            check(surface, tool, driven.tool).map_err(|cause| StaticError::Contact { tool, cause })?;
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
