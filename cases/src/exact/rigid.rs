//! Rigid motion of small rotation: no strain, no stress, no energy.
//!
//! ```text
//! Source      the kernel of the linear strain; Gurtin, An Introduction to Continuum Mechanics, sec. 7.
//!
//!      +-------+        +-------+
//!      |       |   ->   |       |  turned      u = t + w x x
//!      +-------+        +-------+
//!
//! Conditions  the exact displacement on a part of the boundary that constrains the body; nothing else.
//! Must hold   the body follows to rounding; stress, energy and reactions vanish; the stiffness has exactly
//!             six such modes.
//! ```

use catalogue::{Dimension, Entry, Parameter};

use super::elastic::Elastic;
use super::solution::{Exact, SolutionEntry, numbers};
use super::vectors::{Matrix3, Point3, Vector3};

/// `u = t + w x x`: a shift and an infinitesimal rotation about the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rigid {
    elastic: Elastic,
    shift: Vector3,
    rotation: Vector3,
}

impl Rigid {
    /// A motion by the shift `t` (m) and the rotation vector `w` (rad, linearised).
    pub fn new(elastic: Elastic, shift: Vector3, rotation: Vector3) -> Rigid {
        Rigid { elastic, shift, rotation }
    }

    /// A motion whose six components are all nonzero and different.
    pub fn generic(elastic: Elastic) -> Rigid {
        Rigid {
            elastic,
            shift: Vector3::new(1.0e-5, -2.0e-5, 3.0e-5),
            rotation: Vector3::new(0.7e-3, -1.1e-3, 0.4e-3),
        }
    }
}

impl Exact for Rigid {
    fn displacement(&self, x: &Point3) -> Vector3 {
        self.shift + self.rotation.cross(&x.coords)
    }

    fn gradient(&self, _x: &Point3) -> Matrix3 {
        self.rotation.cross_matrix()
    }

    fn stress(&self, x: &Point3) -> Matrix3 {
        self.elastic.stress(&self.gradient(x))
    }
}

pub(super) const ENTRY: SolutionEntry = Entry {
    name: "rigid",
    meaning: "a shift and a small rotation, or a generic motion of this kind",
    source: "",
    parameters: &[
        Parameter::default(
            "tx",
            Dimension::Length,
            0.0,
            "shift along x; if no component is given, a generic motion is taken",
        ),
        Parameter::default("ty", Dimension::Length, 0.0, "shift along y"),
        Parameter::default("tz", Dimension::Length, 0.0, "shift along z"),
        Parameter::default("rx", Dimension::Angle, 0.0, "small rotation about x"),
        Parameter::default("ry", Dimension::Angle, 0.0, "small rotation about y"),
        Parameter::default("rz", Dimension::Angle, 0.0, "small rotation about z"),
    ],
    build: |medium, values| {
        if values.given().next().is_none() {
            return Ok(Box::new(Rigid::generic(medium.elastic)));
        }
        let [shift, rotation] = [["tx", "ty", "tz"], ["rx", "ry", "rz"]].map(|names| numbers(values, names));
        Ok(Box::new(Rigid::new(medium.elastic, shift?.into(), rotation?.into())))
    },
};
