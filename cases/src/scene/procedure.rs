//! Procedures of a scene: their keys, their values, and the conversion of keys into values.

use catalogue::Problem;
use schemars::JsonSchema;
use serde::Deserialize;

use super::frames::{ImplicitCg, ImplicitCgKeys, Swept, SweptKeys, implicit_cg, swept};
use super::ramp::{Ramp, RampKeys, sound_steps};
use super::report::Report;
use super::table::{Key, table};
use super::units::{Length, Q, Time};
use super::words::words;

words! {
    /// Kinds of procedures; their keys describe them.
    pub enum ProcedureKind {
        /// Tables only.
        Prepare = "prepare",
        /// One linear solve.
        Linear = "linear",
        /// Free vibrations.
        Modes = "modes",
        /// Quasi-static load steps.
        Static = "static",
        /// Explicit dynamics.
        Explicit = "explicit",
        /// Implicit dynamics.
        ImplicitDynamic = "implicit-dynamic",
        /// Vertex block descent.
        Vbd = "vbd",
        /// Extended position-based dynamics.
        Xpbd = "xpbd",
        /// Implicit Euler by conjugate gradients.
        ImplicitCg = "implicit-cg",
    }
}

impl ProcedureKind {
    /// Whether the procedure has neither load steps nor a time axis: it solves once or not at all.
    pub(crate) fn has_no_steps(self) -> bool {
        matches!(self, ProcedureKind::Prepare | ProcedureKind::Linear | ProcedureKind::Modes)
    }

    /// Problem and help for a request that needs displacements; `None` if the procedure solves for
    /// displacements.
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
}

words! {
    /// Precision of the internal forces of explicit dynamics.
    pub enum Precision {
        /// 16 digits; used unless given.
        Double = "double",
        /// 7 digits, in half the memory and with twice the lanes. Displacements, velocities and masses stay
        /// in double precision. For tet4, hex8, tet10 and hex20.
        Single = "single",
    }
}

words! {
    /// Behaviour of a static path that finds no equilibrium.
    pub enum OnStall {
        /// The path ends there; used unless given.
        Stop = "stop",
        /// Dynamic relaxation to the ends of the remaining load steps: from a limit point the tissue slips or
        /// snaps to its next equilibrium. For finite elements without a pressure field only; a cloud stops.
        Relax = "relax",
    }
}

words! {
    /// Solver of the equations of a linear procedure.
    pub enum LinearSolver {
        /// By size, Poisson's ratio and supports, as the plan says; used unless given.
        Auto = "auto",
        /// A factor, sparse or dense.
        Direct = "direct",
        /// Conjugate gradients with algebraic multigrid, to a relative residual of 1e-8. Not available with
        /// multipliers or elimination.
        Amg = "amg",
    }
}

/// Procedure that solves the scene; kind = "linear" unless given
#[derive(Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub(crate) enum ProcedureKeys {
    /// Shape functions and integration rows only: the cost of a method before anything is solved
    Prepare {
        /// Ignored here; allowed so that you can switch `kind` without deleting it
        steps: Option<u32>,
    },
    /// One linear solve
    Linear {
        /// Solver of the equations; "auto" unless given
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
    /// Vertex block descent: implicit Euler with a fixed number of sweeps in each frame
    Vbd(SweptKeys),
    /// Extended position-based dynamics: constraints relaxed by a fixed number of sweeps in each frame
    Xpbd(SweptKeys),
    /// Implicit Euler, linearised once in each frame, with a limited number of conjugate-gradient iterations
    ImplicitCg(ImplicitCgKeys),
}

/// Procedure of a scene with its settings. In a static procedure, loads, prescribed displacements and tool
/// drives grow in proportion over the steps. In dynamics, loads and displacements grow over the duration or
/// over the time `over`, and a tool moves over the time of its drive. Tractions and body forces are dead
/// loads: per undeformed area or volume, with a fixed direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Procedure {
    /// Tables only; nothing is solved.
    Prepare,
    /// One linear solve, also for a file without `[procedure]`.
    Linear {
        /// Solver of the equations.
        solver: LinearSolver,
    },
    /// Free vibrations.
    Modes {
        /// Number of lowest modes that are reported and compared.
        count: usize,
    },
    /// Quasi-static load steps.
    Static(Static),
    /// Explicit dynamics.
    Explicit(Explicit),
    /// Implicit dynamics.
    ImplicitDynamic(Implicit),
    /// Vertex block descent.
    Vbd(Swept),
    /// Extended position-based dynamics.
    Xpbd(Swept),
    /// Implicit Euler by conjugate gradients.
    ImplicitCg(ImplicitCg),
}

impl Procedure {
    /// Kind of the procedure.
    pub fn kind(&self) -> ProcedureKind {
        match self {
            Procedure::Prepare => ProcedureKind::Prepare,
            Procedure::Linear { .. } => ProcedureKind::Linear,
            Procedure::Modes { .. } => ProcedureKind::Modes,
            Procedure::Static(_) => ProcedureKind::Static,
            Procedure::Explicit(_) => ProcedureKind::Explicit,
            Procedure::ImplicitDynamic(_) => ProcedureKind::ImplicitDynamic,
            Procedure::Vbd(_) => ProcedureKind::Vbd,
            Procedure::Xpbd(_) => ProcedureKind::Xpbd,
            Procedure::ImplicitCg(_) => ProcedureKind::ImplicitCg,
        }
    }

    /// Whether the procedure advances frames with a fixed budget of work.
    pub fn has_frames(&self) -> bool {
        matches!(self, Procedure::Vbd(_) | Procedure::Xpbd(_) | Procedure::ImplicitCg(_))
    }

    /// Whether masses are accelerated: in vibrations, and in dynamics except with `inertia = false`.
    pub(crate) fn has_inertia(&self) -> bool {
        match self {
            Procedure::Modes { .. } | Procedure::Explicit(_) | Procedure::ImplicitCg(_) => true,
            Procedure::ImplicitDynamic(implicit) => implicit.inertia,
            Procedure::Vbd(swept) | Procedure::Xpbd(swept) => swept.inertia,
            Procedure::Prepare | Procedure::Linear { .. } | Procedure::Static(_) => false,
        }
    }

    /// The time axis; `None` for procedures without time.
    pub fn ramp(&self) -> Option<Ramp> {
        match self {
            Procedure::Explicit(explicit) => Some(explicit.ramp),
            Procedure::ImplicitDynamic(implicit) => Some(implicit.ramp),
            Procedure::Vbd(swept) | Procedure::Xpbd(swept) => Some(swept.ramp),
            Procedure::ImplicitCg(asked) => Some(asked.ramp),
            _ => None,
        }
    }

    /// End of the time axis in seconds.
    pub fn duration(&self) -> Option<f64> {
        self.ramp().map(|ramp| ramp.duration)
    }
}

table! {
    /// Load steps of a quasi-static path
    pub struct Static from StaticKeys {
        /// Load steps at whose ends results are reported; 1 unless given
        steps: usize as u32 = 1,
        /// Newton's method in each step
        #[serde(flatten)]
        newton: Newton as NewtonKeys,
        /// Fraction of the load to within which a limit point is located, if the path loses its stability, by
        /// halving load steps. Unless given, a limit point is reported at the end of the load step that
        /// passes it
        limit_within: Option<f64>,
        /// Behaviour if no equilibrium is found; "stop" unless given
        on_stall: OnStall = OnStall::Stop,
    }
}

table! {
    /// Settings of Newton's method in a step
    pub struct Newton from NewtonKeys {
        /// Relative residual of a step by Newton's method; 1e-8 unless given
        tolerance: f64 = Newton::STANDARD.tolerance,
        /// Most iterations of Newton's method in a step; 25 unless given
        iterations: usize as u32 = Newton::STANDARD.iterations,
        /// Uzawa iterations of contact in a step; 0 (a plain penalty) unless given
        augmentations: usize as u32 = Newton::STANDARD.augmentations,
    }
}

impl Newton {
    /// Settings of a file without these keys.
    pub const STANDARD: Newton = Newton { tolerance: 1e-8, iterations: 25, augmentations: 0 };
}

table! {
    /// Central differences of explicit dynamics
    pub struct Explicit from ExplicitKeys {
        /// Time axis and growth of the loads
        #[serde(flatten)]
        ramp: Ramp as RampKeys,
        /// Time step over the critical time step; 0.9 unless given
        safety: f64 = 0.9,
        /// Time step; safety times the critical time step unless given
        step: Option<f64> as Option<Q<Time>>,
        /// Mass of a tool driven by a force over that of the body; 0.1 unless given
        tool_mass: f64 = TOOL_MASS,
        /// Precision of the internal forces; "double" unless given
        precision: Precision = Precision::Double,
    }
}

table! {
    /// Generalised-alpha steps of implicit dynamics, no longer than the time between two results
    pub struct Implicit from ImplicitKeys {
        /// Time axis and growth of the loads
        #[serde(flatten)]
        ramp: Ramp as RampKeys,
        /// Newton's method in each step
        #[serde(flatten)]
        newton: Newton as NewtonKeys,
        /// Whether mass acts; true unless given, false for a quasi-static motion of tissue that relaxes
        inertia: bool = true,
        /// Spectral radius at infinite frequency, 0 to 1; 0.8 unless given, and 0 with tools
        spectral_radius: f64 = SPECTRAL_RADIUS,
        /// Alpha of the method of Hilber, Hughes and Taylor in place of the spectral radius, -1/3 to 0; 0 is
        /// Newmark's trapezoidal rule
        alpha: Option<f64>,
        /// Largest local error of a displacement in a time step; unlimited unless given
        accuracy: Option<f64> as Option<Q<Length>>,
    }
}

/// Default spectral radius without tools: a motion that a step cannot resolve loses a fifth per step. With
/// tools the default is 0. Above 0, a step balances a mean of the forces at both of its ends. A tool that has
/// left the tissue then pushes for one more step, and stiff contact gains energy: at 0.5, a block between
/// plates of 5 MPa/mm swung by 38 mm instead of 3 mm.
const SPECTRAL_RADIUS: f64 = 0.8;

/// Default mass of a tool driven by a force, as a fraction of the body's mass. A tenth hardly slows the tool,
/// and is heavy enough for the time steps of a soft body.
const TOOL_MASS: f64 = 0.1;

/// Largest number of iterations: a step that has not converged by then will not converge.
const MOST_ITERATIONS: usize = 10_000;

/// Default number of reported modes.
const MODES: usize = 24;

impl Procedure {
    /// Reads a procedure; without keys it is linear.
    pub(crate) fn read(keys: Option<ProcedureKeys>, tools: bool, report: &Report) -> Procedure {
        let Some(keys) = keys else { return Procedure::Linear { solver: LinearSolver::Auto } };
        match keys {
            ProcedureKeys::Linear { linear_solver, steps } => {
                check_steps(steps, report);
                Procedure::Linear { solver: linear_solver.unwrap_or(LinearSolver::Auto) }
            }
            ProcedureKeys::Prepare { steps } => {
                check_steps(steps, report);
                Procedure::Prepare
            }
            ProcedureKeys::Modes { modes, steps } => {
                check_steps(steps, report);
                let count = modes.map_or(MODES, |n| n as usize);
                let sound = (1..=1000).contains(&count);
                report.require(sound, "modes", "is no number of modes", "give 1 to 1000; 24 is usual");
                Procedure::Modes { count }
            }
            ProcedureKeys::Static(keys) => Procedure::Static(load_steps(keys, report)),
            ProcedureKeys::Explicit(keys) => Procedure::Explicit(explicit(keys, report)),
            ProcedureKeys::ImplicitDynamic(keys) => Procedure::ImplicitDynamic(implicit(keys, tools, report)),
            ProcedureKeys::Vbd(keys) => Procedure::Vbd(swept(keys, false, report)),
            ProcedureKeys::Xpbd(keys) => Procedure::Xpbd(swept(keys, true, report)),
            ProcedureKeys::ImplicitCg(keys) => Procedure::ImplicitCg(implicit_cg(keys, report)),
        }
    }
}

/// Checks the number of steps, which is ignored by procedures without steps.
fn check_steps(steps: Option<u32>, report: &Report) {
    sound_steps(steps.map_or(1, |n| n as usize), report);
}

fn load_steps(keys: StaticKeys, report: &Report) -> Static {
    let path = keys.value();
    sound_steps(path.steps, report);
    path.newton.check(report);
    let sound = path.limit_within.is_none_or(|part| (1e-4..=1.0).contains(&part));
    let help = "give 1e-4 to 1; 0.02 is usual";
    report.require(sound, "limit_within", "is no part of the load", help);
    path
}

impl Newton {
    fn check(&self, report: &Report) {
        // Rounding leaves about 1e-13 of the forces of a nearly incompressible body.
        let sound = (1e-12..=1e-2).contains(&self.tolerance);
        report.require(sound, "tolerance", "is no tolerance", "give 1e-12 to 1e-2; 1e-8 is usual");
        report.require(self.iterations > 0, "iterations", "is zero", "give 1 or more; 25 is usual");
        for (key, count) in [("iterations", self.iterations), ("augmentations", self.augmentations)] {
            let help = format!("give {MOST_ITERATIONS} or less");
            report.require(count <= MOST_ITERATIONS, key, "are too many", &help);
        }
    }
}

fn explicit(keys: ExplicitKeys, report: &Report) -> Explicit {
    let explicit = keys.value();
    explicit.ramp.check(report);
    explicit.step.map(|step| report.positive("step", step));
    report.positive("tool_mass", explicit.tool_mass);
    let sound = explicit.safety > 0.0 && explicit.safety <= 1.0;
    report.require(sound, "safety", "is not in (0, 1]", "0.9 is usual");
    let both = report.is_given("safety") && explicit.step.is_some();
    report.require(!both, "safety", "has no step to shorten", "give step or safety, not both");
    explicit
}

fn implicit(keys: ImplicitKeys, tools: bool, report: &Report) -> Implicit {
    let mut implicit = keys.value();
    if tools && !report.is_given("spectral_radius") {
        implicit.spectral_radius = 0.0;
    }
    implicit.ramp.check(report);
    implicit.newton.check(report);
    implicit.accuracy.map(|accuracy| report.positive("accuracy", accuracy));
    let sound = (0.0..=1.0).contains(&implicit.spectral_radius);
    let help = "1 dissipates nothing, 0 kills in one step what a step cannot resolve; 0.8 is usual";
    report.require(sound, "spectral_radius", "is not in [0, 1]", help);
    let sound = implicit.alpha.is_none_or(|alpha| (-1.0 / 3.0..=0.0).contains(&alpha));
    report.require(sound, "alpha", "is not in [-1/3, 0]", "0 dissipates nothing; -0.05 is usual");
    let both = report.is_given("spectral_radius") && implicit.alpha.is_some();
    report.require(
        !both,
        "alpha",
        "has a spectral radius of its own",
        "give alpha or spectral_radius, not both",
    );
    for key in ["damping", "stiffness_damping", "spectral_radius", "alpha", "accuracy"] {
        if !implicit.inertia && report.is_given(key) {
            let problem = Problem::new("is of a motion, and inertia = false has none").help("leave it out");
            report.add(key, problem);
        }
    }
    implicit
}
