//! Solution procedures: one file for each procedure, with its stages in the plan and its entry point.

mod explicit;
pub(crate) mod external;
mod frames;
mod implicit_dynamic;
mod linear;
mod linear_solver;
mod loading;
mod modes;
mod paced;
mod plan;
mod problem;
mod refine;
mod relaxation;
mod solution;
mod stages;
mod statics;
mod traced;
mod training;

use cases::scene::Procedure;

use crate::error::Failure;
use crate::outcome::timing::Meters;
use frames::Sweeps;

pub(crate) use paced::{Advance, FrameEnd, Loop};
pub(crate) use plan::{Schemes, Wanted, conclude, plan};
pub(crate) use problem::Problem;
pub(crate) use refine::refined;
pub(crate) use solution::{Carried, Solution, StepHistory, Vibration};
pub(crate) use statics::{in_frames, solves, with_static_problem};
pub(crate) use traced::{traced, unbalanced};
pub(crate) use training::reduced;

/// Predicts the modes of another method.
pub(crate) fn predict_modes(problem: &Problem, meters: &mut Meters) -> Result<Solution, Failure> {
    let Procedure::Modes { count } = problem.setup.procedure else { return Ok(Solution::default()) };
    modes::predicted(problem, count, meters)
}

/// Predicts the solution near that of another method. The linear procedure gives the solution itself.
pub(crate) fn predict(
    problem: &Problem,
    carried: &Carried,
    meters: &mut Meters,
) -> Result<Solution, Failure> {
    match (&problem.setup.procedure, &problem.prepared.volume.pressure) {
        (Procedure::Linear { .. }, None) => solve(problem, meters),
        _ => statics::predicted(problem, carried),
    }
}

/// Solves the problem by the setup's procedure, or by an external solver.
pub(crate) fn solve(problem: &Problem, meters: &mut Meters) -> Result<Solution, Failure> {
    if let Some(outside) = &problem.method.outside {
        return external::solve(problem, outside, meters);
    }
    match &problem.setup.procedure {
        Procedure::Prepare => Ok(Solution::default()),
        Procedure::Linear { solver } => linear::solve(problem, *solver, meters),
        Procedure::Modes { count } => modes::solve(problem, *count, meters),
        Procedure::Static(asked) => statics::solve(problem, asked, meters),
        Procedure::Explicit(asked) => explicit::solve(problem, asked, meters),
        Procedure::ImplicitDynamic(asked) => implicit_dynamic::solve(problem, asked, meters),
        Procedure::Vbd(asked) => frames::solve(problem, asked, Sweeps::VertexDescent, meters),
        Procedure::Xpbd(asked) => frames::solve(problem, asked, Sweeps::Constraints, meters),
        Procedure::ImplicitCg(asked) => {
            let kind = Sweeps::ConjugateGradients { tolerance: asked.tolerance };
            frames::solve(problem, &asked.frames(), kind, meters)
        }
    }
}
