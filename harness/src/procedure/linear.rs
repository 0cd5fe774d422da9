//! The linear procedure: one stiffness matrix, one factor, one solve.

use statics::assemble;

use super::{Problem, Solution};
use crate::Failure;
use crate::outcome::Meters;

/// Assembles, factors and solves, each timed apart.
pub(super) fn solve(problem: &Problem, meters: &mut Meters) -> Result<Solution, Failure> {
    let Problem { method, setup, prepared, .. } = *problem;
    let (loads, weak) = (prepared.loads(), prepared.weak());
    let system = prepared.problem(method.nodes(), setup, &loads, &weak);
    let Meters { timings, counters, .. } = meters;
    let assembled = timings.time("assemble", || assemble(&system))?;
    counters.assemblies += 1;
    let factored = timings.time("factor", || prepared.factor(assembled))?;
    counters.factorisations += 1;
    let statics::Solution { u, info, .. } = timings.time("solve", || factored.solve(1.0))?;
    counters.solves += 1;
    // Untimed, and once for all repeats: diagnoses, not a part of the solution.
    if meters.needed_nitsche_factor.is_none() {
        meters.needed_nitsche_factor = factored.needed_nitsche_factor()?;
    }
    if meters.digits.is_none() {
        meters.digits = Some(factored.digits(&info)?);
    }
    let (dofs, residual, needed) = (info.dofs, Some(info.residual), meters.needed_nitsche_factor);
    Ok(Solution {
        u,
        dofs,
        residual,
        linear: Some(info),
        needed_nitsche_factor: needed,
        digits: meters.digits,
        ..Solution::default()
    })
}
