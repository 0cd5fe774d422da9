//! Rigid motions and their names.

use shape::Vector3;

/// A rigid motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RigidMode {
    /// Translation along this unit vector.
    Translation(Vector3),
    /// Rotation about an axis along this unit vector (through some point).
    Rotation(Vector3),
}

impl std::fmt::Display for RigidMode {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let (word, v) = match self {
            RigidMode::Translation(v) => ("translation along", v),
            RigidMode::Rotation(v) => ("rotation about", v),
        };
        match v.iter().position(|c| c.abs() > 1.0 - 1e-6) {
            Some(axis) => write!(f, "{word} {}", ["x", "y", "z"][axis]),
            None => {
                // Avoids "-0.000".
                let v = v.map(|c| if c.abs() < 5e-4 { 0.0 } else { c });
                write!(f, "{word} ({:.3}, {:.3}, {:.3})", v.x, v.y, v.z)
            }
        }
    }
}
