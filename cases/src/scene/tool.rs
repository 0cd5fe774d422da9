//! Rigid tools: shape, drive and contact parameters.

use contact::ToolShape;

/// A rigid tool.
#[derive(Clone, Debug, PartialEq)]
pub struct Tool {
    /// Name, unique within the scene.
    pub name: String,
    /// Shape of the tool.
    pub shape: ToolShape,
    /// Initial position of the centre, in metres.
    pub at: [f64; 3],
    /// Unit direction of motion.
    pub along: [f64; 3],
    /// Direction of the z axis of the shape's frame, as a unit vector: the axis of a cylinder or capsule, the
    /// outward normal of a plate's face. `None` for a shape aligned with the axes of the scene.
    pub axis: Option<[f64; 3]>,
    /// Drive of the tool.
    pub drive: Drive,
    /// Time of the ramp in seconds (dynamics).
    pub over: Option<f64>,
    /// Normal pressure per penetration, in pascals per metre.
    pub penalty: f64,
    /// Friction; `None` without a coefficient, or with a coefficient of 0.
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

/// Drive of a tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// Displacement along the direction of motion, in metres.
    Closure(f64),
    /// Total force along the direction of motion, in newtons.
    Force(f64),
    /// Mean pressure on the tool's face, in pascals.
    Pressure(f64),
}
