//! How a scene is solved: the procedures, the keys of each, and how keys become values.

use catalogue::Problem;
use schemars::JsonSchema;
use serde::Deserialize;

use super::report::Report;
use super::units::{Length, Q, Rate, Time};
use super::words::words;

/// Kinds of procedures; what each is and takes is said at its keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProcedureKind {
    /// Tables only.
    Prepare,
    /// One linear solve.
    Linear,
    /// Free vibrations.
    Modes,
    /// Quasi-static load steps.
    Static,
    /// Explicit dynamics.
    Explicit,
    /// Implicit dynamics.
    ImplicitDynamic,
}

impl ProcedureKind {
    /// Whether there is one solution only, or none: no load steps and no time axis.
    pub(crate) fn has_no_steps(self) -> bool {
        matches!(self, ProcedureKind::Prepare | ProcedureKind::Linear | ProcedureKind::Modes)
    }

    /// The problem with a request for displacements, and help; `None` if the procedure solves for them.
    pub(crate) fn lacks_displacements(self) -> Option<(&'static str, &'static str)> {
        match self {
            ProcedureKind::Prepare => Some((
                "is of a displacement, and kind = \"prepare\" solves for none",
                "leave it out, or take [procedure] kind = \"linear\"",
            )),
            ProcedureKind::Modes => Some((
                "has no part in free vibrations",
                "leave it out: vibrations are compared with an exact solution of them, or with none",
            )),
            _ => None,
        }
    }

    /// The name in files and tables.
    pub fn name(self) -> &'static str {
        match self {
            ProcedureKind::Prepare => "prepare",
            ProcedureKind::Linear => "linear",
            ProcedureKind::Modes => "modes",
            ProcedureKind::Static => "static",
            ProcedureKind::Explicit => "explicit",
            ProcedureKind::ImplicitDynamic => "implicit-dynamic",
        }
    }
}

words! {
    /// What follows if a static path finds no equilibrium.
    pub enum OnStall {
        /// The path ends there; used unless given.
        Stop = "stop",
        /// Dynamic relaxation to the ends of the remaining load steps: from a limit point tissue slips or snaps to its next
        /// rest. Finite elements without a pressure field only; a cloud stops.
        Relax = "relax",
    }
}

words! {
    /// What solves the equations of a linear procedure.
    pub enum LinearSolver {
        /// By size, Poisson's ratio and supports, as the plan says; used unless given.
        Auto = "auto",
        /// A factor, sparse or dense.
        Direct = "direct",
        /// Conjugate gradients with algebraic multigrid, to a relative residual of 1e-8. Not with multipliers or elimination.
        Amg = "amg",
    }
}

/// How the scene is solved: one procedure, with what it alone takes. In a static procedure loads, prescribed displacements and
/// drives of tools grow in proportion over its steps, in dynamics over its duration or a time of their own, and a tool over that
/// of its drive; loads are dead loads, per undeformed area and volume and of fixed direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Procedure {
    /// Tables only; nothing is solved.
    Prepare,
    /// One linear solve; what a file without `[procedure]` means.
    Linear {
        /// What solves the equations.
        solver: LinearSolver,
    },
    /// Free vibrations.
    Modes {
        /// Lowest modes that are reported and compared.
        count: usize,
    },
    /// Quasi-static load steps.
    Static(Static),
    /// Explicit dynamics.
    Explicit(Explicit),
    /// Implicit dynamics.
    ImplicitDynamic(Implicit),
}

impl Procedure {
    /// Its kind.
    pub fn kind(&self) -> ProcedureKind {
        match self {
            Procedure::Prepare => ProcedureKind::Prepare,
            Procedure::Linear { .. } => ProcedureKind::Linear,
            Procedure::Modes { .. } => ProcedureKind::Modes,
            Procedure::Static(_) => ProcedureKind::Static,
            Procedure::Explicit(_) => ProcedureKind::Explicit,
            Procedure::ImplicitDynamic(_) => ProcedureKind::ImplicitDynamic,
        }
    }

    /// Whether masses are accelerated: in vibrations, and in dynamics except with `inertia = false`.
    pub(crate) fn has_inertia(&self) -> bool {
        match self {
            Procedure::Modes { .. } | Procedure::Explicit(_) => true,
            Procedure::ImplicitDynamic(implicit) => implicit.inertia,
            Procedure::Prepare | Procedure::Linear { .. } | Procedure::Static(_) => false,
        }
    }

    /// The time axis, where there is one.
    pub fn ramp(&self) -> Option<Ramp> {
        match self {
            Procedure::Explicit(explicit) => Some(explicit.ramp),
            Procedure::ImplicitDynamic(implicit) => Some(implicit.ramp),
            _ => None,
        }
    }

    /// End of the time axis in seconds, where there is one.
    pub fn duration(&self) -> Option<f64> {
        self.ramp().map(|ramp| ramp.duration)
    }
}

/// A quasi-static path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Static {
    /// Equal load steps at whose ends results are reported; one that fails is halved on the way.
    pub steps: usize,
    /// How a step is solved.
    pub newton: Newton,
    /// Part of the load to within which a limit point is sought, if it is.
    pub limit_within: Option<f64>,
    /// What follows where no equilibrium is found.
    pub on_stall: OnStall,
}

/// The time axis of dynamics, with how loads and supports grow over it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ramp {
    /// End in seconds.
    pub duration: f64,
    /// Time in seconds over which loads and supports grow before they are constant; 0 is at once, and the file that gives none
    /// means the duration.
    pub over: Option<f64>,
    /// Equal intervals at whose ends results are reported.
    pub steps: usize,
    /// Mass-proportional damping in one per second, of the tools too where they have a mass (explicit).
    pub damping: f64,
}

impl Ramp {
    /// Time in seconds over which loads and supports grow.
    pub fn growth(&self) -> f64 {
        self.over.unwrap_or(self.duration)
    }
}

/// How implicit dynamics is stepped: generalised-alpha, in steps no longer than the time between two results.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Implicit {
    /// Time axis and growth of the loads.
    pub ramp: Ramp,
    /// How a step is solved.
    pub newton: Newton,
    /// Whether mass acts; without it, a quasi-static motion in which tissue relaxes.
    pub inertia: bool,
    /// Spectral radius at infinite frequency, 0 to 1.
    pub spectral_radius: f64,
    /// Local error of a displacement in metres that a step may make; steps that make more are cut.
    pub accuracy: Option<f64>,
}

/// Spectral radius where the file gives none. At 0.8 what a step cannot resolve loses a fifth per step. Above 0 a step balances a
/// mean of the forces at both its ends: a tool that has left the tissue pushes on for a step, and stiff contact gains energy that
/// way (a block between plates of 5 MPa/mm swung by 38 mm at 0.5 where it should move by 3 mm).
fn spectral_radius(tools: bool) -> f64 {
    if tools { 0.0 } else { 0.8 }
}

/// How explicit dynamics is stepped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Explicit {
    /// Time axis and growth of the loads.
    pub ramp: Ramp,
    /// Time step over the critical one.
    pub safety: f64,
    /// Time step in seconds; from the critical one if the file gives none.
    pub step: Option<f64>,
    /// Mass of a tool that a force drives, over the body's.
    pub tool_mass: f64,
}

/// Time step over the critical one where the file gives none.
const SAFETY: f64 = 0.9;

/// Mass of a driven tool over the body's where the file gives none: a tenth hardly slows its motion and is heavy enough for the
/// steps that a soft body takes.
const TOOL_MASS: f64 = 0.1;

/// More steps than this are a slip of the pen: each is solved, reported and kept.
const MOST_STEPS: u32 = 100_000;

/// What does not converge in so many iterations does not converge.
const MOST_ITERATIONS: usize = 10_000;

/// Modes that are reported where the file gives no number.
const MODES: usize = 24;

/// How a static step is solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Newton {
    /// Residual force relative to the larger of internal and external forces.
    pub tolerance: f64,
    /// Most iterations per step.
    pub iterations: usize,
    /// Uzawa iterations of the augmented Lagrangian per step; 0 is a plain penalty.
    pub augmentations: usize,
}

impl Newton {
    /// Where the file says nothing.
    pub const STANDARD: Newton = Newton { tolerance: 1e-8, iterations: 25, augmentations: 0 };
}

/// How the scene is solved; kind = "linear" unless given
#[derive(Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub(crate) enum ProcedureKeys {
    /// Shape functions and integration rows only: what a method costs before anything is solved
    Prepare {
        /// Ignored here; allowed so that you can switch `kind` without deleting it
        steps: Option<u32>,
    },
    /// One linear solve
    Linear {
        /// What solves the equations; "auto" unless given
        linear_solver: Option<LinearSolver>,
        /// Ignored here; allowed so that you can switch `kind` without deleting it
        steps: Option<u32>,
    },
    /// Small free vibrations: the lowest modes and every frequency
    Modes {
        /// Lowest modes of vibration that are reported and compared; 24 unless given
        modes: Option<u32>,
        /// Ignored here; allowed so that you can switch `kind` without deleting it
        steps: Option<u32>,
    },
    /// Quasi-static load steps, each by Newton's method; large-strain laws and tools
    Static(StaticKeys),
    /// Explicit dynamics: central differences
    Explicit(ExplicitKeys),
    /// Implicit dynamics: generalised-alpha
    ImplicitDynamic(ImplicitKeys),
}

#[derive(Deserialize, JsonSchema)]
pub(crate) struct StaticKeys {
    /// Load steps at whose ends results are reported; 1 unless given
    pub steps: Option<u32>,
    #[serde(flatten)]
    pub newton: NewtonKeys,
    /// Part of the load to within which a limit point is located, if the path loses its stability: steps are halved
    /// down to it. Unless given, a limit point is reported at the end of the load step that passes it
    pub limit_within: Option<f64>,
    /// What follows if no equilibrium is found
    pub on_stall: Option<OnStall>,
}

/// How a step is solved by Newton's method
#[derive(Deserialize, JsonSchema)]
pub(crate) struct NewtonKeys {
    /// Relative residual of a step by Newton's method; 1e-8 unless given
    pub tolerance: Option<f64>,
    /// Most iterations of Newton's method in a step; 25 unless given
    pub iterations: Option<u32>,
    /// Uzawa iterations of contact in a step; 0 (a plain penalty) unless given
    pub augmentations: Option<u32>,
}

/// The time axis of dynamics
#[derive(Deserialize, JsonSchema)]
pub(crate) struct RampKeys {
    /// Equal intervals of time at whose ends results are reported; 1 unless given
    pub steps: Option<u32>,
    /// End of the time axis
    pub duration: Q<Time>,
    /// Time over which loads and supports grow before they are constant; the duration unless given, "0 s" is at once
    pub over: Option<Q<Time>>,
    /// Mass-proportional damping, in explicit dynamics also of tools that have a mass; none unless given
    pub damping: Option<Q<Rate>>,
}

#[derive(Deserialize, JsonSchema)]
pub(crate) struct ExplicitKeys {
    #[serde(flatten)]
    pub ramp: RampKeys,
    /// Time step over the critical one; 0.9 unless given
    pub safety: Option<f64>,
    /// Time step; safety times the critical one unless given
    pub step: Option<Q<Time>>,
    /// Mass of a tool driven by a force over that of the body; 0.1 unless given
    pub tool_mass: Option<f64>,
}

#[derive(Deserialize, JsonSchema)]
pub(crate) struct ImplicitKeys {
    #[serde(flatten)]
    pub ramp: RampKeys,
    #[serde(flatten)]
    pub newton: NewtonKeys,
    /// Whether mass acts; true unless given, false for a quasi-static motion of tissue that relaxes
    pub inertia: Option<bool>,
    /// Spectral radius at infinite frequency, 0 to 1; 0.8 unless given, and 0 with tools
    pub spectral_radius: Option<f64>,
    /// Local error of a displacement that a time step may make; unlimited unless given
    pub accuracy: Option<Q<Length>>,
}

impl Procedure {
    /// Reads a procedure; without keys it is linear.
    pub(crate) fn read(keys: Option<ProcedureKeys>, tools: bool, report: &Report) -> Procedure {
        let Some(keys) = keys else { return Procedure::Linear { solver: LinearSolver::Auto } };
        match keys {
            ProcedureKeys::Linear { linear_solver, steps: unused } => {
                steps(unused, report);
                Procedure::Linear { solver: linear_solver.unwrap_or(LinearSolver::Auto) }
            }
            ProcedureKeys::Prepare { steps: unused } => {
                steps(unused, report);
                Procedure::Prepare
            }
            ProcedureKeys::Modes { modes: count, steps: unused } => {
                steps(unused, report);
                Procedure::Modes { count: modes(count, report) }
            }
            ProcedureKeys::Static(keys) => Procedure::Static(load_steps(&keys, report)),
            ProcedureKeys::Explicit(keys) => Procedure::Explicit(explicit(&keys, report)),
            ProcedureKeys::ImplicitDynamic(keys) => {
                Procedure::ImplicitDynamic(implicit(&keys, tools, report))
            }
        }
    }
}

fn modes(modes: Option<u32>, report: &Report) -> usize {
    let modes = modes.map_or(MODES, |n| n as usize);
    let sound = (1..=1000).contains(&modes);
    report.require(sound, "modes", "is no number of modes", "give 1 to 1000; 24 is usual");
    modes
}

fn load_steps(keys: &StaticKeys, report: &Report) -> Static {
    let limit_within = keys.limit_within;
    let sound = limit_within.is_none_or(|part| (1e-4..=1.0).contains(&part));
    let help = "give 1e-4 to 1; 0.02 is usual";
    report.require(sound, "limit_within", "is no part of the load", help);
    Static {
        steps: steps(keys.steps, report),
        newton: newton(&keys.newton, report),
        limit_within,
        on_stall: keys.on_stall.unwrap_or(OnStall::Stop),
    }
}

fn steps(steps: Option<u32>, report: &Report) -> usize {
    let steps = steps.unwrap_or(1);
    report.require(steps > 0, "steps", "is zero", "give 1 or more");
    let help = format!("give {MOST_STEPS} or less");
    report.require(steps <= MOST_STEPS, "steps", "are too many", &help);
    steps as usize
}

fn newton(keys: &NewtonKeys, report: &Report) -> Newton {
    let standard = Newton::STANDARD;
    let tolerance = keys.tolerance.unwrap_or(standard.tolerance);
    // Rounding leaves about 1e-13 of the forces of a nearly incompressible body.
    let sound = (1e-12..=1e-2).contains(&tolerance);
    report.require(sound, "tolerance", "is no tolerance", "give 1e-12 to 1e-2; 1e-8 is usual");
    let iterations = keys.iterations.map_or(standard.iterations, |n| n as usize);
    report.require(iterations > 0, "iterations", "is zero", "give 1 or more; 25 is usual");
    let augmentations = keys.augmentations.map_or(standard.augmentations, |n| n as usize);
    for (name, count) in [("iterations", iterations), ("augmentations", augmentations)] {
        let help = format!("give {MOST_ITERATIONS} or less");
        let sound = count <= MOST_ITERATIONS;
        report.require(sound, &format!("{name}"), "are too many", &help);
    }
    Newton { tolerance, iterations, augmentations }
}

fn ramp(keys: &RampKeys, report: &Report) -> Ramp {
    let steps = steps(keys.steps, report);
    let duration = report.positive("duration", keys.duration.0);
    let over = keys.over.as_ref().map(|q| q.0);
    let sound = over.is_none_or(|t| t >= 0.0);
    report.require(sound, "over", "is negative", "give \"0 s\" for at once, or leave it out");
    let damping = keys.damping.as_ref().map_or(0.0, |q| q.0);
    report.require(damping >= 0.0, "damping", "is negative", "give 0 /s or more, or leave it out");
    Ramp { duration, over, steps, damping }
}

fn explicit(keys: &ExplicitKeys, report: &Report) -> Explicit {
    let explicit = Explicit {
        ramp: ramp(&keys.ramp, report),
        safety: keys.safety.unwrap_or(SAFETY),
        step: keys.step.as_ref().map(|q| report.positive("step", q.0)),
        tool_mass: keys.tool_mass.map_or(TOOL_MASS, |m| report.positive("tool_mass", m)),
    };
    let sound = explicit.safety > 0.0 && explicit.safety <= 1.0;
    report.require(sound, "safety", "is not in (0, 1]", "0.9 is usual");
    let both = keys.safety.is_some() && explicit.step.is_some();
    report.require(!both, "safety", "has no step to shorten", "give step or safety, not both");
    explicit
}

fn implicit(keys: &ImplicitKeys, tools: bool, report: &Report) -> Implicit {
    let implicit = Implicit {
        ramp: ramp(&keys.ramp, report),
        newton: newton(&keys.newton, report),
        inertia: keys.inertia.unwrap_or(true),
        spectral_radius: keys.spectral_radius.unwrap_or(spectral_radius(tools)),
        accuracy: keys.accuracy.as_ref().map(|q| report.positive("accuracy", q.0)),
    };
    let sound = (0.0..=1.0).contains(&implicit.spectral_radius);
    let help = "1 dissipates nothing, 0 kills in one step what a step cannot resolve; 0.8 is usual";
    report.require(sound, "spectral_radius", "is not in [0, 1]", help);
    let moving = [
        ("damping", keys.ramp.damping.is_some()),
        ("spectral_radius", keys.spectral_radius.is_some()),
        ("accuracy", keys.accuracy.is_some()),
    ];
    for (name, _) in moving.into_iter().filter(|(_, given)| *given && !implicit.inertia) {
        let problem = Problem::new("is of a motion, and inertia = false has none").help("leave it out");
        report.add(&format!("{name}"), problem);
    }
    implicit
}
