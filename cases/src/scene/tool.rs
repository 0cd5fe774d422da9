//! Rigid tools: their shapes, how they are driven and how they touch.

use contact::ToolShape;

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
    /// Where the z axis of the shape's frame points, as a unit vector: the axis of a cylinder or capsule, the outward normal of
    /// a plate's face; `None` for a shape that stands along the axes of the scene.
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

/// Coulomb friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// Coefficient, positive.
    pub coefficient: f64,
    /// Tangential traction per elastic slip while the surfaces stick, in pascals per metre.
    pub stick: f64,
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
