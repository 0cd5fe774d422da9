//! Rigid tools: their shapes, how they are driven and how they touch.

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
    /// Unit axis of a cylinder or capsule, or outward normal of a plate's face; `None` for other shapes.
    pub axis: Option<[f64; 3]>,
    /// How it is driven.
    pub drive: Drive,
    /// Time of the ramp in seconds (dynamics).
    pub over: Option<f64>,
    /// Normal pressure per penetration, in pascals per metre.
    pub penalty: f64,
    /// Friction; none if the file gives none, or a coefficient of 0.
    pub friction: Option<Friction>,
}

impl Tool {
    /// Area (m2) of the face that a mean pressure acts on: that of a rounded box which closes along one of its axes, roundings
    /// included. Other shapes have no face of their own.
    pub fn face_area(&self) -> Option<f64> {
        let ToolShape::RoundedBox { half, .. } = self.shape else { return None };
        let closes = (0..3).find(|&a| self.along[a].abs() > 1.0 - 1e-9)?;
        Some((0..3).filter(|&a| a != closes).map(|a| 2.0 * half[a]).product())
    }
}

/// Coulomb friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// Coefficient, positive.
    pub coefficient: f64,
    /// Tangential traction per elastic slip while the surfaces stick, in pascals per metre.
    pub stick: f64,
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
    /// A half space with a flat face.
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
    /// Total force along the way, in newtons.
    Force(f64),
    /// Mean pressure on the tool's face, in pascals.
    Pressure(f64),
}
