//! Rigid tools and procedures: read and checked in full, though only linear statics without tools runs today.

use schemars::JsonSchema;
use serde::Deserialize;

use super::method::MeshFile;

/// A rigid tool.
#[derive(Clone, Debug, PartialEq)]
pub struct Tool {
    /// Unique within the scene.
    pub name: String,
    /// Its shape.
    pub shape: ToolShape,
    /// Centre at the start, in metres.
    pub at: [f64; 3],
    /// Unit direction of motion.
    pub along: [f64; 3],
    /// How it is driven.
    pub drive: Drive,
    /// Time of the ramp in seconds (dynamics).
    pub over: Option<f64>,
    /// Coulomb coefficient.
    pub friction: f64,
}

/// Shape names of tools.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum ToolShapeName {
    Plate,
    RoundedBox,
    Sphere,
    Cylinder,
    Capsule,
    File,
}

/// Shapes of tools; lengths in metres.
#[derive(Clone, Debug, PartialEq)]
pub enum ToolShape {
    /// A half space.
    Plate,
    /// A box whose edges are rounded.
    RoundedBox {
        /// Half extents.
        half: [f64; 3],
        /// Edge radius.
        radius: f64,
    },
    /// A sphere.
    Sphere {
        /// Radius.
        radius: f64,
    },
    /// A cylinder.
    Cylinder {
        /// Radius.
        radius: f64,
        /// Length.
        length: f64,
    },
    /// A cylinder with half spheres at its ends.
    Capsule {
        /// Radius.
        radius: f64,
        /// Length between the centres of the half spheres.
        length: f64,
    },
    /// The distance to a meshed surface.
    File(MeshFile),
}

/// What drives a tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// Distance moved, in metres.
    Closure(f64),
    /// Total force, in newtons.
    Force(f64),
    /// Mean pressure, in pascals.
    Pressure(f64),
}

/// Kinds of procedures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ProcedureKind {
    /// One linear solve.
    Linear,
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
            ProcedureKind::Linear => "linear",
            ProcedureKind::Static => "static",
            ProcedureKind::Explicit => "explicit",
            ProcedureKind::ImplicitDynamic => "implicit-dynamic",
        }
    }
}

/// How the scene is stepped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Procedure {
    /// Its kind; linear where the file has no `[procedure]`.
    pub kind: ProcedureKind,
    /// Load steps, 1 unless given.
    pub steps: usize,
    /// End of the time axis in seconds (dynamics).
    pub duration: Option<f64>,
}
