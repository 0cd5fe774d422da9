//! Checks for tools that jumped over the surface or overlap the body, and the step length that prevents this.

use contact::{ContactError, ContactSurface, Drive, Stand, Tool};

use super::Newton;
use super::state::State;
use crate::nonlinear::error::StaticError;
use crate::nonlinear::problem::StaticProblem;
use crate::nonlinear::step::Step;

/// Fraction of the deepest penetration to which the travel of a tool in a step can always be reduced. At
/// first touch nothing has moved yet, and the travel of the tool is its penetration.
const SHORTEST: f64 = 0.125;

impl Newton<'_> {
    /// Returns `reached`, the result of a converged step from `start`, or an error if a tool has jumped over
    /// the surface in this step.
    pub fn checked(&self, start: &State, reached: (State, Step)) -> Result<(State, Step), StaticError> {
        let (state, step) = &reached;
        self.each_tool(|surface, k, tool| {
            let from = Stand { closure: start.closures[k], u: &start.u };
            let to = Stand { closure: state.closures[k], u: &state.u };
            surface.check_passage(tool, from, to, step.tools[k].active > 0)
        })?;
        Ok(reached)
    }

    /// Refuses a reported state, after `step`, in which a tool overlaps the body without a force. At the end
    /// of the loading the check is stricter, because no further point can come into contact.
    pub fn check_overlap(&self, state: &State, step: &Step, ends: bool) -> Result<(), StaticError> {
        self.each_tool(|surface, k, tool| {
            // A tool without a force to exert stays where it last touched.
            if self.equations.force(k, state.time) == Some(0.0) {
                return Ok(());
            }
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
        let Some(surface) = self.equations.problem.contact else { return Ok(()) };
        for (tool, driven) in self.equations.problem.tools.iter().enumerate() {
            check(surface, tool, driven.tool).map_err(|cause| StaticError::Contact { tool, cause })?;
        }
        Ok(())
    }
}

/// Returns the shortest time to which a step can always be reduced for the travel of the tools, the least over
/// all tools. The resolution of a path must not depend on the number of requested results.
pub(crate) fn shortest_travel(problem: &StaticProblem) -> f64 {
    let each = problem.tools.iter().enumerate().map(|(k, driven)| match driven.drive {
        Drive::Closure(full) if full != 0.0 => {
            let speed = full.abs() * problem.curves.tools.of(k).steepest();
            SHORTEST * driven.tool.deepest() / speed
        }
        Drive::Closure(_) | Drive::Force(_) => f64::INFINITY,
    });
    each.fold(f64::INFINITY, f64::min)
}
