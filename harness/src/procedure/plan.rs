//! The plan of a run: the stages that it needs, the stages that it skips, and why.

use cases::scene::{ConstraintRows, Dilation, Goal, Pod, Procedure};

use super::frames::Sweeps;
use super::solution::Solution;
use super::stages::Stages;
use super::{explicit, external, frames, implicit_dynamic, linear, modes, statics};
use crate::discretise::enriched::NEARLY_INCOMPRESSIBLE;
use crate::discretise::{Adapt, Discretisation, Essential};
use crate::outcome::{Counters, Plan, StageName};
use crate::scenario::setup::Setup;

/// Requests for the method's displacement at points other than its own nodes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Wanted {
    /// Whether displacements are requested at targets, which need not be the method's nodes.
    pub(crate) targets: bool,
    pub(crate) schemes: Schemes,
}

/// Whether transfer schemes are to be compared, and why not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Schemes {
    #[default]
    NotRequested,
    /// The targets are the nodes of a method whose nodal values are displacements.
    OwnNodes,
    /// The run is the reference of the others.
    OfReference,
    Compared,
}

/// Stages of a run, in order.
pub(crate) fn plan(method: &Discretisation, setup: &Setup, wanted: Wanted) -> Plan {
    let stages = stages_of(method, setup);
    let mut plan = Plan::default();
    plan.iterates = stages.iterates;
    let mut add = |stage, (runs, why): (bool, String)| plan.add(stage, runs, why);
    add(StageName::Refinement, refinement(method));
    add(StageName::Supports, supports(method));
    add(StageName::ShapeFunctions, (true, method.shape_functions.clone()));
    add(StageName::Projection, projection(method, setup));
    add(StageName::Tensors, tensors(setup));
    add(StageName::Mass, stages.mass);
    add(StageName::Stiffness, stages.stiffness);
    add(StageName::TimeSteps, stages.time_steps);
    add(StageName::Elimination, elimination(method, setup));
    add(StageName::WeakSupports, weak_supports(method, setup));
    add(StageName::Factorisation, stages.factorisation);
    if let Some(pod) = &setup.pod {
        add(StageName::Training, training(setup, pod));
    }
    add(StageName::Newton, stages.newton);
    add(StageName::Relaxation, stages.relaxation);
    add(StageName::Contact, contact(setup));
    add(StageName::Friction, friction(setup));
    add(StageName::Transfer, transfer(method, wanted));
    add(StageName::Schemes, schemes(wanted));
    if setup.output.estimate {
        add(StageName::Estimate, estimate(method));
    }
    if let Some(goal) = &setup.output.error_of {
        add(StageName::Trace, trace(method, goal));
    }
    if setup.output.bounds {
        let why = "a displacement field and a stress field in equilibrium on tetrahedra of the same body";
        add(StageName::Bounds, (true, why.into()));
    }
    if let Some(why) = stages.no_transfer {
        plan.skip(StageName::Transfer, why);
        plan.skip(StageName::Schemes, why);
    }
    if let Some(why) = stages.no_contact {
        plan.skip(StageName::Contact, why);
        plan.skip(StageName::Friction, why);
    }
    plan
}

/// Completes the plan of a finished run. It states how the internal forces were evaluated, because a plain
/// loop takes 3 to 10 times as long, and that a load path without a limit point needed no relaxation.
pub(crate) fn conclude(plan: &mut Plan, solution: &Solution, counters: &Counters) {
    let forces = solution.forces;
    if solution.not_iterated {
        plan.explain(StageName::Factorisation, |why| {
            format!("direct, because the intended solver did not converge ({why})")
        });
    }
    if let Some(forces) = forces {
        let how = match forces.path {
            Some(path) => format!("{} kernel in {} lanes on all threads", forces.name(), path.name()),
            None => "plain loop on one thread: no lanes for this law and dilation".into(),
        };
        for stage in [StageName::TimeSteps, StageName::Relaxation] {
            if plan.runs(stage) {
                plan.explain(stage, |why| format!("{why}; internal forces: {how}"));
            }
        }
    }
    if plan.runs(StageName::Relaxation) && counters.relaxation_steps == 0 {
        plan.skip(StageName::Relaxation, "Newton's method reached the full load");
    }
}

/// Stages that depend on the procedure.
fn stages_of(method: &Discretisation, setup: &Setup) -> Stages {
    if let Some(outside) = &method.outside {
        return external::stages(outside);
    }
    match &setup.procedure {
        Procedure::Prepare => Stages::prepare(),
        Procedure::Linear { solver } => linear::stages(method, setup, *solver),
        Procedure::Modes { .. } => modes::stages(setup),
        Procedure::Static(asked) => statics::stages(method, setup, asked),
        Procedure::Explicit(asked) => explicit::stages(setup, asked),
        Procedure::ImplicitDynamic(asked) => implicit_dynamic::stages(setup, asked),
        Procedure::Vbd(asked) => frames::stages(setup, asked, Sweeps::VertexDescent),
        Procedure::Xpbd(asked) => frames::stages(setup, asked, Sweeps::Constraints),
        Procedure::ImplicitCg(asked) => {
            let kind = Sweeps::ConjugateGradients { tolerance: asked.tolerance };
            frames::stages(setup, &asked.frames(), kind)
        }
    }
}

fn refinement(method: &Discretisation) -> (bool, String) {
    if let Some(Adapt { by, error, rounds, .. }) = &method.adapt {
        let percent = 100.0 * error;
        let why =
            format!("where the error of {by} comes from, until it is {percent} %, {rounds} meshes at most");
        return (true, why);
    }
    match &method.refine {
        Some(refine) => {
            let times = if refine.steps == 1 { "once".into() } else { format!("{} times", refine.steps) };
            (true, format!("{times} by the error of the gradients, after a solution each time"))
        }
        None if method.supports.is_some() => (false, "no refinement of the cloud".into()),
        None => (false, "no refinement of the mesh".into()),
    }
}

fn supports(method: &Discretisation) -> (bool, String) {
    match &method.supports {
        Some(how) => (true, how.clone()),
        None => (false, "the nodes of an element are its neighbours".into()),
    }
}

fn projection(method: &Discretisation, setup: &Setup) -> (bool, String) {
    let poisson = setup.materials.iter().map(|m| m.poisson()).fold(f64::MIN, f64::max);
    match method.dilation {
        Dilation::Standard if poisson < NEARLY_INCOMPRESSIBLE => {
            (false, format!("nu = {poisson} < {NEARLY_INCOMPRESSIBLE} does not lock"))
        }
        Dilation::Standard => (false, "none requested (dilation = \"standard\")".into()),
        Dilation::ElementMean => (true, "one dilation per cell".into()),
        Dilation::NodalMean => (true, "one dilation per node".into()),
        Dilation::NodalNear => {
            (true, "one dilation per node, with each point shared among four nodes".into())
        }
        Dilation::Mixed if method.interpolates => (true, "a pressure field, linear between corners".into()),
        Dilation::Mixed => (true, "a pressure field on a third of the nodes".into()),
    }
}

fn tensors(setup: &Setup) -> (bool, String) {
    match setup.materials.len() {
        1 => (false, "homogeneous material: one tensor".into()),
        count => (true, format!("{count} regions")),
    }
}

fn elimination(method: &Discretisation, setup: &Setup) -> (bool, String) {
    let (eliminated, why) = match &method.essential {
        _ if setup.supports.is_empty() => (false, "no support in the scene"),
        Essential::Nodal => (true, "Kronecker basis: nodal parameters are displacements"),
        Essential::Elimination(ConstraintRows::Means) => {
            (true, "mean displacements of nodal patches, by pivoted rows")
        }
        Essential::Elimination(ConstraintRows::Points) => (true, "displacements at points, by pivoted rows"),
        Essential::Coupling(_) => (true, "parameters of finite-element nodes are displacements"),
        Essential::Nitsche(_) | Essential::Penalty(_) | Essential::Multipliers => {
            (false, "nodal parameters are not displacements")
        }
    };
    (eliminated, why.into())
}

fn weak_supports(method: &Discretisation, setup: &Setup) -> (bool, String) {
    match &method.essential {
        _ if setup.supports.is_empty() => (false, "no support in the scene".into()),
        Essential::Nodal | Essential::Elimination(_) | Essential::Coupling(_) => {
            (false, "supports are eliminated".into())
        }
        Essential::Nitsche(gamma) => (true, format!("Nitsche, factor {gamma}")),
        Essential::Penalty(factor) => (true, format!("penalty, factor {factor}")),
        Essential::Multipliers => (true, "Lagrange multipliers".into()),
    }
}

fn contact(setup: &Setup) -> (bool, String) {
    let tools: Vec<&str> = setup.tools.iter().map(|t| t.name.as_str()).collect();
    if tools.is_empty() { (false, "no tool in the scene".into()) } else { (true, tools.join(", ")) }
}

fn friction(setup: &Setup) -> (bool, String) {
    let why = match (setup.tools.is_empty(), setup.has_friction()) {
        (true, _) => "no tool in the scene",
        (false, true) => "Coulomb friction, one slip per point and tool",
        (false, false) => "no tool has friction",
    };
    (setup.has_friction(), why.into())
}

fn estimate(method: &Discretisation) -> (bool, String) {
    match &method.outside {
        None => (true, "a linear system of quadratic elements on the same body".into()),
        Some(_) => (false, "the equilibrium is that of another program".into()),
    }
}

fn training(setup: &Setup, pod: &Pod) -> (bool, String) {
    let cells =
        pod.cells.map_or("all cells".into(), |part| format!("at most {} % of the cells", 100.0 * part));
    (true, format!("{} deformations from {} runs, forces in {cells}", pod.modes, setup.training.len()))
}

fn trace(method: &Discretisation, goal: &Goal) -> (bool, String) {
    match &method.outside {
        None => (true, format!("unbalanced forces in quadratic elements and their influence on {goal}")),
        Some(_) => (false, "the equilibrium is that of another program".into()),
    }
}

fn transfer(method: &Discretisation, wanted: Wanted) -> (bool, String) {
    let (runs, why) = match (!method.interpolates, wanted.targets) {
        (false, false) => (false, "Kronecker basis: nodal values are displacements"),
        (false, true) => (true, "evaluated with the elements' shape functions"),
        (true, true) => (true, "evaluated with the method's own shape functions"),
        (true, false) => (true, "to the nodes, with the method's own shape functions"),
    };
    (runs, why.into())
}

fn schemes(wanted: Wanted) -> (bool, String) {
    let why = match wanted.schemes {
        Schemes::NotRequested => "none requested",
        Schemes::OwnNodes => "the targets are the nodes of the elements",
        Schemes::OfReference => {
            "this run is the reference, with which transferred displacements are compared"
        }
        Schemes::Compared => "requested, for a comparison",
    };
    (wanted.schemes == Schemes::Compared, why.into())
}
