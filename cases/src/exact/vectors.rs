//! Vectors and matrices.

/// A position in the reference configuration, in metres.
pub type Point3 = nalgebra::Point3<f64>;
/// A displacement (m), a normal (-), a traction (Pa) or a body force (N/m^3).
pub type Vector3 = nalgebra::Vector3<f64>;
/// A displacement gradient (-) or a stress (Pa).
pub type Matrix3 = nalgebra::Matrix3<f64>;
