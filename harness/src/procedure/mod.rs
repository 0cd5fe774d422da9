//! Solution procedures: one file for each procedure, with its stages in the plan and its entry point.

mod explicit;
pub(crate) mod external;
mod implicit_dynamic;
mod linear;
mod linear_solver;
mod modes;
mod plan;
mod refine;
mod relaxation;
mod solution;
mod statics;

use cases::scene::Procedure;
use geometry::Point3;
use material::Material as _;

use crate::Failure;
use crate::discretise::Discretisation;
use crate::outcome::{Meters, Plan, Watch};
use crate::prepare::Prepared;
use crate::scenario::setup::Setup;

pub(crate) use modes::Vibration;
pub(crate) use plan::{Wanted, conclude, plan};
pub(crate) use refine::refined;
pub(crate) use solution::{Solution, StepHistory};
pub(crate) use statics::{solves, static_params, with_static_problem};

/// Problem that a procedure solves: the tables of one method under one setup.
pub(crate) struct Problem<'a> {
    pub(crate) method: &'a Discretisation,
    pub(crate) setup: &'a Setup,
    pub(crate) prepared: &'a Prepared,
    pub(crate) plan: &'a Plan,
    /// Observer of the run.
    pub(crate) watch: Option<&'a Watch>,
    /// Probe positions, m.
    pub(crate) probes: &'a [Point3],
}

impl Problem<'_> {
    /// Number of unknowns after elimination of the supports, without those of a pressure field.
    fn free_dofs(&self) -> usize {
        let fixed: std::collections::BTreeSet<(u32, u8)> =
            self.prepared.fixed().iter().map(|f| (f.node, f.axis)).collect();
        3 * self.method.nodes().len() - fixed.len()
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
    }
}

/// Stages that depend on the procedure: whether each of them runs, and why.
struct Stages {
    mass: (bool, String),
    stiffness: (bool, String),
    time_steps: (bool, String),
    factorisation: (bool, String),
    newton: (bool, String),
    relaxation: (bool, String),
    /// Reason why no displacement is transferred to other points, if that is so.
    no_transfer: Option<&'static str>,
    /// Reason why there is no contact, if that is so.
    no_contact: Option<&'static str>,
}

impl Stages {
    /// Stages of a linear solution. Other procedures state their differences.
    fn linear() -> Stages {
        Stages {
            mass: (false, "static".into()),
            stiffness: (true, "linear static".into()),
            time_steps: (false, "static".into()),
            factorisation: (true, "one, for all load levels".into()),
            newton: (false, "linear".into()),
            relaxation: (false, "no static path that could stall".into()),
            no_transfer: None,
            no_contact: None,
        }
    }

    /// Stages of a run that only fills the tables.
    fn prepare() -> Stages {
        const NOTHING: &str = "nothing is solved (kind = \"prepare\")";
        Stages {
            mass: (false, NOTHING.into()),
            stiffness: (false, NOTHING.into()),
            time_steps: (false, NOTHING.into()),
            factorisation: (false, NOTHING.into()),
            newton: (false, NOTHING.into()),
            relaxation: (false, NOTHING.into()),
            no_transfer: Some(NOTHING),
            no_contact: Some(NOTHING),
        }
    }

    fn of(method: &Discretisation, setup: &Setup) -> Stages {
        if let Some(outside) = &method.outside {
            return external::stages(outside);
        }
        match &setup.procedure {
            Procedure::Prepare => Stages::prepare(),
            Procedure::Linear { solver } => linear::stages(method, setup, *solver),
            Procedure::Modes { .. } => modes::stages(setup),
            Procedure::Static(asked) => statics::stages(method, setup, asked),
            Procedure::Explicit(asked) => explicit::stages(asked),
            Procedure::ImplicitDynamic(asked) => implicit_dynamic::stages(setup, asked),
        }
    }
}

/// Reason in the plan why Newton's method iterates.
fn newton_reason(setup: &Setup, steps: usize, kind: &str) -> String {
    let steps = if steps == 1 { format!("1 {kind} step") } else { format!("{steps} {kind} steps") };
    match (setup.laws.iter().all(|law| law.is_small_strain()), setup.tools.is_empty()) {
        (true, true) => format!("{steps}; law and loads are linear, so one iteration per step would suffice"),
        (false, true) => format!("{steps} with a law of large strain"),
        (_, false) => format!("{steps} with contact"),
    }
}
