//! The plan of a run: the stages it needs, the stages it does not, and why.

use cases::scene::ConstraintRows;
use explicit::KernelInfo;
use material::Material as _;

use crate::discretise::{Dilation, Discretisation, Efg, Essential, Functions, Integration};
use crate::in_time::InTimeParams;
use crate::outcome::Stage;
use crate::relaxation;
use crate::setup::Setup;

/// Whether the method's displacement is wanted elsewhere than at its own nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wants {
    /// Displacements at points that are not the method's nodes.
    pub targets: bool,
    /// Transfer schemes to compare.
    pub schemes: bool,
}

/// Below this Poisson's ratio a volumetric projection gains nothing worth its cost (kappa < 10 mu).
const NEARLY_INCOMPRESSIBLE: f64 = 0.45;

/// Stages that a run which ends before anything is solved does not come to.
const OF_SOLVING: [&str; 6] =
    ["stiffness", "factorisation", "contact search", "friction history", "transfer", "transfer schemes"];

/// Stages of a run, in order.
pub fn plan(method: &Discretisation, setup: &Setup, wants: Wants) -> Vec<Stage> {
    let mut stages = Vec::new();
    let mut add = |stage, ran, why: String| stages.push(Stage { stage, ran, why });
    let (dilation, cloud) = match method {
        Discretisation::Fem(fem) => (fem.dilation, None),
        Discretisation::Efg(efg) => (efg.dilation, Some(efg)),
    };
    let (refines, why) = match cloud.map(|efg| &efg.refine) {
        Some(Some(refine)) => {
            let times = if refine.steps == 1 { "once".into() } else { format!("{} times", refine.steps) };
            (true, format!("{times} by the error of the gradients, each after a solution"))
        }
        Some(None) => (false, "the cloud stays as it is".into()),
        None => (false, "the mesh stays as it is".into()),
    };
    add("refinement", refines, why);
    match cloud {
        Some(efg) => {
            let supports = match efg.followed {
                Some(_) => "ellipsoids that follow the cells, and neighbours",
                None => "radius and neighbours",
            };
            add("supports", true, format!("{supports} of {} nodes", efg.cloud.points.len()));
            let coupled = match efg.coupled() {
                Some(coupled) => format!(", coupled to {} nodes of finite elements", coupled.vertices.len()),
                None => String::new(),
            };
            add("shape functions", true, integration(efg) + &coupled);
        }
        None => {
            add("supports", false, "the elements' nodes are the neighbours".into());
            add("shape functions", true, "one row per Gauss point of each element".into());
        }
    }
    let poisson = setup.materials.iter().map(|m| m.poisson()).fold(f64::MIN, f64::max);
    match dilation {
        Dilation::Standard if poisson < NEARLY_INCOMPRESSIBLE => {
            add(
                "volumetric projection",
                false,
                format!("nu = {poisson} < {NEARLY_INCOMPRESSIBLE} does not lock"),
            );
        }
        Dilation::Standard => {
            add("volumetric projection", false, "the method asks for none (dilation = \"standard\")".into());
        }
        Dilation::Element => add("volumetric projection", true, "one dilation per cell".into()),
        Dilation::Nodal => add("volumetric projection", true, "one dilation per node".into()),
        Dilation::Mixed => {
            add("volumetric projection", true, "a pressure field, linear between the corners".into());
        }
    }
    let one = setup.materials.len() == 1;
    add(
        "elasticity tensor per region",
        !one,
        if one {
            "homogeneous material: one tensor".into()
        } else {
            format!("{} regions", setup.materials.len())
        },
    );
    let explicit = setup.explicit.as_ref();
    let in_time = setup.in_time.as_ref();
    let (mass, why) = match (&setup.modes, explicit, in_time) {
        (Some(modes), ..) => (true, modes.mass.name()),
        (_, Some(_), _) => (true, "lumped"),
        (_, _, Some(InTimeParams { density: Some(_), .. })) => (true, "consistent"),
        (_, _, Some(_)) => (false, "without inertia"),
        (None, None, None) => (false, "static"),
    };
    add("mass", mass, why.into());
    let steps = setup.statics.map(|params| params.steps).or(in_time.map(|params| params.time.steps));
    let stiffness = match (explicit.is_some(), steps.is_some()) {
        (true, _) => "explicit: forces alone",
        (_, true) => "the tangent of every iteration",
        (_, false) => "linear static",
    };
    add("stiffness", explicit.is_none(), stiffness.into());
    add(
        "time steps",
        explicit.is_some() || in_time.is_some(),
        match (explicit, in_time) {
            (None, None) => "static".into(),
            (None, Some(i)) => format!("{} s in at least {} steps", i.time.end, i.time.steps),
            (Some(e), _) => match e.step {
                Some(step) => format!("{} s in steps of {step:e} s", e.duration),
                None => format!("{} s in steps of {} of the critical one", e.duration, e.safety),
            },
        },
    );
    let (eliminated, why) = match cloud.map(|efg| &efg.essential) {
        _ if setup.held.is_empty() => (false, "no support in the scene"),
        None => (true, "the basis is Kronecker: nodal parameters are displacements"),
        Some(Essential::Elimination(ConstraintRows::Means)) => {
            (true, "mean displacements of the shares of nodes, by pivoted rows")
        }
        Some(Essential::Elimination(ConstraintRows::Points)) => {
            (true, "displacements at points, by pivoted rows")
        }
        Some(Essential::Coupling(_)) => (true, "parameters of finite-element nodes are displacements"),
        Some(_) => (false, "nodal parameters are not displacements"),
    };
    add("supports by elimination", eliminated, why.into());
    let weak = match cloud.map(|efg| &efg.essential) {
        _ if setup.held.is_empty() => (false, "no support in the scene".into()),
        None | Some(Essential::Elimination(_) | Essential::Coupling(_)) => {
            (false, "supports are eliminated".into())
        }
        Some(Essential::Nitsche(gamma)) => (true, format!("Nitsche, factor {gamma}")),
        Some(Essential::Penalty(factor)) => (true, format!("penalty, factor {factor}")),
        Some(Essential::Multipliers) => (true, "Lagrange multipliers".into()),
    };
    add("weak supports", weak.0, weak.1);
    match steps {
        None if explicit.is_some() => {
            add("factorisation", false, "explicit: the mass is diagonal".into());
            add("Newton iterations", false, "explicit".into());
        }
        None => {
            add("factorisation", true, "one, for all load levels".into());
            add("Newton iterations", false, "linear".into());
        }
        Some(steps) => {
            add("factorisation", true, "one for each iteration, analysed once".into());
            let kind = if in_time.is_some() { "time" } else { "load" };
            let steps = if steps == 1 { format!("1 {kind} step") } else { format!("{steps} {kind} steps") };
            let why = match (setup.laws.iter().all(|l| l.is_small_strain()), setup.tools.is_empty()) {
                (true, true) => format!("{steps}; law and loads are linear, so one each would do"),
                (false, true) => format!("{steps} of a law of large strain"),
                (_, false) => format!("{steps} with contact"),
            };
            add("Newton iterations", true, why);
        }
    }
    let (relaxes, why) = relaxation::possible(method, setup);
    add(relaxation::STAGE, relaxes, why.into());
    let tools: Vec<&str> = setup.tools.iter().map(|t| t.name.as_str()).collect();
    let rubbing = setup.tools.iter().any(|t| t.tool.law().friction() > 0.0);
    let (search, friction) = match (tools.is_empty(), rubbing) {
        (true, _) => ("no tool in the scene".into(), "no tool in the scene"),
        (false, true) => (tools.join(", "), "Coulomb friction, one slip per point and tool"),
        (false, false) => (tools.join(", "), "no tool has friction"),
    };
    add("contact search", !tools.is_empty(), search);
    add("friction history", rubbing, friction.into());
    match (cloud.is_some(), wants.targets) {
        (false, false) => add("transfer", false, "a Kronecker basis: nodal values are displacements".into()),
        (false, true) => add("transfer", true, "evaluated with the elements' shape functions".into()),
        (true, true) => add("transfer", true, "evaluated with the method's own shape functions".into()),
        (true, false) => add("transfer", true, "to the nodes, with the method's own shape functions".into()),
    }
    add(
        "transfer schemes",
        wants.schemes && cloud.is_some(),
        match (wants.schemes, cloud.is_some()) {
            (true, true) => "asked for, to compare them".into(),
            (true, false) => "the reference nodes are the elements' own".into(),
            (false, _) => "none asked for".into(),
        },
    );
    if setup.modes.is_some() {
        for stage in &mut stages {
            match stage.stage {
                "factorisation" => stage.why = "one, dense, into all modes".into(),
                "transfer" | "transfer schemes" => {
                    (stage.ran, stage.why) = (false, "modes are compared where they are integrated".into());
                }
                _ => {}
            }
        }
    }
    if setup.prepare_only {
        for stage in stages.iter_mut().filter(|stage| OF_SOLVING.contains(&stage.stage)) {
            (stage.ran, stage.why) = (false, "nothing is solved (kind = \"prepare\")".into());
        }
    }
    stages
}

/// Says in the plan of a finished run what evaluated the internal forces: a plain loop takes 3 to 10 times as long.
pub(crate) fn say_what_ran(stages: &mut [Stage], forces: KernelInfo) {
    let how = match forces.path {
        Some(path) => format!("{} kernel in {} lanes on all threads", forces.kernel.name(), path.name()),
        None => "plain loop on one thread: no lanes for this law and dilation".into(),
    };
    let of_forces =
        |stage: &&mut Stage| stage.ran && ["time steps", relaxation::STAGE].contains(&stage.stage);
    for stage in stages.iter_mut().filter(of_forces) {
        stage.why += &format!("; internal forces: {how}");
    }
}

fn integration(efg: &Efg) -> String {
    let functions = match efg.functions {
        Functions::MovingLeastSquares { .. } => "moving least squares",
        Functions::MaximumEntropy { .. } => "maximum entropy",
    };
    match efg.integration {
        Integration::Gauss { points } => {
            format!("{functions} at {points} points per background cell")
        }
        Integration::Grid { points, .. } => {
            format!("{functions} at {points}^3 points per grid cell")
        }
        Integration::CellSmoothed { smoothing, face_points } => {
            let gradients = match smoothing {
                efg::Smoothing::Constant => "constant",
                efg::Smoothing::Linear => "linear",
            };
            format!(
                "{functions} at {face_points} points per face, smoothed to {gradients} gradients per cell"
            )
        }
        Integration::NodeSmoothed { stabilisation, face_points } => {
            let cells = match stabilisation {
                0.0 => String::new(),
                share => format!(", cells with {share} of the weight"),
            };
            format!(
                "{functions} at {face_points} points per face, smoothed to one gradient per vertex{cells}"
            )
        }
    }
}
