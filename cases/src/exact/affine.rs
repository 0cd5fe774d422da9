//! Affine field: the linear patch test.
//!
//! ```text
//! Source      Irons & Razzaque (1972), the patch test; Zienkiewicz & Taylor, The Finite Element Method,
//!             ch. 10.
//!
//!      +-------+        +--------+
//!      |  . .  |   ->  /   . .  /     u = H x + t,  any body, any mesh or cloud inside
//!      | .   . |      /  .   . /
//!      +-------+     +--------+
//!
//! Conditions  the exact displacement on the boundary, or the exact traction with rigid motion removed; no
//!             body force.
//! Must hold   every consistent method returns the field to rounding, at any Poisson's ratio.
//! ```

use catalogue::{Dimension, Entry, Parameter};

use super::elastic::Elastic;
use super::solution::{Exact, SolutionEntry, numbers};
use super::vectors::{Matrix3, Point3, Vector3};

/// `u = H x + t` with constant stress.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine {
    elastic: Elastic,
    gradient: Matrix3,
    shift: Vector3,
}

impl Affine {
    /// The field of a displacement gradient `H` (dimensionless) and a shift `t` (m).
    pub fn new(elastic: Elastic, gradient: Matrix3, shift: Vector3) -> Affine {
        Affine { elastic, gradient, shift }
    }

    /// A field whose nine components and shift are all nonzero and different, with strains of about 1e-3. No
    /// symmetry of the body can let a wrong method pass this patch test by chance.
    pub fn generic(elastic: Elastic) -> Affine {
        let gradient = Matrix3::new(1.1, -0.4, 0.7, 0.9, -1.3, 0.2, -0.6, 0.5, 0.8) * 1e-3;
        Affine { elastic, gradient, shift: Vector3::new(1.0e-5, -2.0e-5, 3.0e-5) }
    }
}

impl Exact for Affine {
    fn displacement(&self, x: &Point3) -> Vector3 {
        self.gradient * x.coords + self.shift
    }

    fn gradient(&self, _x: &Point3) -> Matrix3 {
        self.gradient
    }

    fn stress(&self, x: &Point3) -> Matrix3 {
        self.elastic.stress(&self.gradient(x))
    }
}

pub(super) const ENTRY: SolutionEntry = Entry {
    name: "affine",
    meaning: "u = H x + t, or a generic field of this form",
    source: "",
    parameters: &[
        Parameter::default(
            "hxx",
            Dimension::None,
            0.0,
            "du_x/dx; if no component is given, a generic field is taken",
        ),
        Parameter::default("hxy", Dimension::None, 0.0, "du_x/dy"),
        Parameter::default("hxz", Dimension::None, 0.0, "du_x/dz"),
        Parameter::default("hyx", Dimension::None, 0.0, "du_y/dx"),
        Parameter::default("hyy", Dimension::None, 0.0, "du_y/dy"),
        Parameter::default("hyz", Dimension::None, 0.0, "du_y/dz"),
        Parameter::default("hzx", Dimension::None, 0.0, "du_z/dx"),
        Parameter::default("hzy", Dimension::None, 0.0, "du_z/dy"),
        Parameter::default("hzz", Dimension::None, 0.0, "du_z/dz"),
        Parameter::default("tx", Dimension::Length, 0.0, "shift along x"),
        Parameter::default("ty", Dimension::Length, 0.0, "shift along y"),
        Parameter::default("tz", Dimension::Length, 0.0, "shift along z"),
    ],
    build: |medium, values| {
        if values.given().next().is_none() {
            return Ok(Box::new(Affine::generic(medium.elastic)));
        }
        let gradient = numbers(values, ["hxx", "hxy", "hxz", "hyx", "hyy", "hyz", "hzx", "hzy", "hzz"])?;
        let shift = Vector3::from(numbers(values, ["tx", "ty", "tz"])?);
        Ok(Box::new(Affine::new(medium.elastic, Matrix3::from_row_slice(&gradient), shift)))
    },
};
