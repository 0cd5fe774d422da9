//! The linear procedure: one stiffness matrix and one solution, by factorisation or by iterations.

use cases::scene::LinearSolver;
use statics::assemble;

use super::linear_solver::{serves, solved, tangents};
use super::problem::Problem;
use super::solution::Solution;
use super::stages::Stages;
use crate::discretise::Discretisation;
use crate::error::Failure;
use crate::outcome::timing::Meters;
use crate::prepare::ConditionForces;
use crate::scenario::setup::Setup;

/// Stages of the linear procedure in the plan.
pub(super) fn stages(method: &Discretisation, setup: &Setup, asked: LinearSolver) -> Stages {
    let (serves, why) = serves(method, setup, asked);
    let stiffness = (true, format!("linear static{}", setup.springs()));
    let factorisation = (true, format!("{} ({why})", serves.meaning()));
    // The error of a number is traced by a tangent.
    let (iterates, _) = tangents(method, setup, None);
    Stages { stiffness, factorisation, iterates, ..Stages::linear() }
}

/// Assembles, factors and solves, each timed separately.
pub(super) fn solve(
    problem: &Problem,
    asked: LinearSolver,
    meters: &mut Meters,
) -> Result<Solution, Failure> {
    let Problem { method, setup, prepared, .. } = *problem;
    let (loads, weak) = (prepared.loads(), prepared.weak());
    let system = prepared.problem(method.nodes(), setup, &loads, &weak);
    let assembled = meters.timings.time("assemble", || assemble(&system))?;
    meters.counters.assemblies += 1;
    let solved = solved(problem, assembled, asked, meters)?;
    let nodes = method.nodes();
    let reaction = solved.factored.reactions(&solved.solution, 1.0);
    let supports = prepared.support_forces(&ConditionForces {
        at: &|i| nodes[i],
        nodes: &reaction,
        rows: &solved.factored.forces_of_rows(nodes, &solved.solution),
        weak: &solved.factored.forces_of_weak(nodes, &solved.solution, 1.0),
        time: None,
    });
    let statics::Solution { u, info, .. } = solved.solution;
    // These diagnostics are not part of the solution: they are not timed and are computed once for all
    // repeats.
    if meters.needed_nitsche_factor.is_none() {
        meters.needed_nitsche_factor = solved.factored.needed_nitsche_factor()?;
    }
    if meters.digits.is_none() {
        meters.digits = solved.factored.digits(&info)?;
    }
    Ok(Solution {
        u,
        reaction,
        supports,
        dofs: info.dofs,
        residual: Some(info.residual),
        linear: Some(info),
        not_iterated: solved.not_iterated,
        needed_nitsche_factor: meters.needed_nitsche_factor,
        digits: meters.digits,
        ..Solution::default()
    })
}
