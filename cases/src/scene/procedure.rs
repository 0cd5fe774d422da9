//! How a scene is stepped.

use schemars::JsonSchema;
use serde::Deserialize;

/// Kinds of procedures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ProcedureKind {
    /// Shape functions and integration rows only: what a method costs before anything is solved.
    Prepare,
    /// One linear solve.
    Linear,
    /// Small free vibrations: the lowest modes and every frequency.
    Modes,
    /// Quasi-static load steps, each by Newton's method; tools touch and large-strain laws act.
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

/// What follows where a static path finds no equilibrium.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum OnStall {
    /// The path ends there.
    #[default]
    Stop,
    /// Dynamic relaxation to the ends of the load steps that are left: from a limit point tissue slips or snaps to where it
    /// rests again.
    Relax,
}

/// How the scene is stepped. In a static procedure loads, prescribed displacements and drives of tools grow in proportion
/// over its steps, in dynamics over its duration or a time of their own, and a tool over that of its drive; loads are dead loads, per undeformed
/// area and volume and of fixed direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Procedure {
    /// Its kind; linear where the file has no `[procedure]`.
    pub kind: ProcedureKind,
    /// Equal load steps at whose ends results are told, 1 unless given: a step of a static procedure or of implicit dynamics
    /// that fails is halved on the way, and explicit dynamics takes as many time steps as it needs.
    pub steps: usize,
    /// End of the time axis in seconds (dynamics).
    pub duration: Option<f64>,
    /// Time in seconds over which loads and supports grow before they are held (dynamics); 0 is at once, and the file that says
    /// nothing means the duration.
    pub over: Option<f64>,
    /// How a step is solved (static procedure, implicit dynamics).
    pub newton: Newton,
    /// Part of the load to within which a limit point of a static path is sought, if it is.
    pub limit_within: Option<f64>,
    /// Lowest modes that are told and compared (kind = "modes").
    pub modes: usize,
    /// What follows where a static path finds no equilibrium.
    pub on_stall: OnStall,
    /// Mass-proportional damping in one per second (dynamics); of the tools too where they have a mass (explicit).
    pub damping: f64,
    /// How explicit dynamics is stepped.
    pub explicit: Explicit,
    /// How implicit dynamics is stepped.
    pub implicit: Implicit,
}

/// How implicit dynamics is stepped: generalised-alpha, in steps no longer than the time between two results.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Implicit {
    /// Whether mass acts; without it, a quasi-static motion in which tissue relaxes.
    pub inertia: bool,
    /// Spectral radius at infinite frequency, 0 to 1.
    pub spectral_radius: f64,
    /// Local error of a displacement in metres that a step may make; steps that make more are cut.
    pub accuracy: Option<f64>,
}

impl Implicit {
    /// Where the file says nothing. At 0.8 what a step cannot resolve loses a fifth per step. Above 0 a step balances a mean of
    /// the forces at both its ends: a tool that has left the tissue pushes on for a step, and stiff contact gains energy that
    /// way (a block between plates of 5 MPa/mm swung by 38 mm at 0.5 where it should move by 3 mm).
    pub fn standard(tools: bool) -> Implicit {
        Implicit { inertia: true, spectral_radius: if tools { 0.0 } else { 0.8 }, accuracy: None }
    }
}

/// How explicit dynamics is stepped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Explicit {
    /// Time step over the critical one.
    pub safety: f64,
    /// Time step in seconds; from the critical one if the file gives none.
    pub step: Option<f64>,
    /// Mass of a tool that a force drives, over the body's.
    pub tool_mass: f64,
}

impl Explicit {
    /// Where the file says nothing. A tool of a tenth of the body's mass hardly slows its motion and is heavy enough for the
    /// steps that a soft body takes.
    pub const STANDARD: Explicit = Explicit { safety: 0.9, step: None, tool_mass: 0.1 };
}

/// Modes that are told where the file says nothing.
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
