//! How a scene is stepped.

use schemars::JsonSchema;
use serde::Deserialize;

/// Kinds of procedures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ProcedureKind {
    /// One linear solve.
    Linear,
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
            ProcedureKind::Linear => "linear",
            ProcedureKind::Static => "static",
            ProcedureKind::Explicit => "explicit",
            ProcedureKind::ImplicitDynamic => "implicit-dynamic",
        }
    }
}

/// How the scene is stepped. In a static procedure loads, prescribed displacements and drives of tools grow in proportion
/// over its steps; loads are dead loads, per undeformed area and volume and of fixed direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Procedure {
    /// Its kind; linear where the file has no `[procedure]`.
    pub kind: ProcedureKind,
    /// Equal load steps at whose ends results are told, 1 unless given. A step that fails is halved on the way.
    pub steps: usize,
    /// End of the time axis in seconds (dynamics).
    pub duration: Option<f64>,
    /// How a static step is solved.
    pub newton: Newton,
}

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
