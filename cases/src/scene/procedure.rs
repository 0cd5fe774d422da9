//! How a scene is solved: the procedures.

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

/// How the scene is solved: one procedure, with what it alone takes. In a static procedure loads, prescribed displacements and
/// drives of tools grow in proportion over its steps, in dynamics over its duration or a time of their own, and a tool over that
/// of its drive; loads are dead loads, per undeformed area and volume and of fixed direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Procedure {
    /// Tables only; nothing is solved.
    Prepare,
    /// One linear solve; what a file without `[procedure]` means.
    Linear,
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
            Procedure::Linear => ProcedureKind::Linear,
            Procedure::Modes { .. } => ProcedureKind::Modes,
            Procedure::Static(_) => ProcedureKind::Static,
            Procedure::Explicit(_) => ProcedureKind::Explicit,
            Procedure::ImplicitDynamic(_) => ProcedureKind::ImplicitDynamic,
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
pub(crate) fn spectral_radius(tools: bool) -> f64 {
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
pub(crate) const SAFETY: f64 = 0.9;

/// Mass of a driven tool over the body's where the file gives none: a tenth hardly slows its motion and is heavy enough for the
/// steps that a soft body takes.
pub(crate) const TOOL_MASS: f64 = 0.1;

/// Modes that are reported where the file gives no number.
pub(crate) const MODES: usize = 24;

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
