//! Affine field: the linear patch test.
//!
//! ```text
//! Source      Irons & Razzaque (1972), the patch test; Zienkiewicz & Taylor, The Finite Element Method, ch. 10.
//!
//!      +-------+        +--------+
//!      |  . .  |   ->  /   . .  /     u = H x + t,  any body, any mesh or cloud inside
//!      | .   . |      /  .   . /
//!      +-------+     +--------+
//!
//! Conditions  the exact displacement on the boundary, or the exact traction with rigid motion removed; no body force.
//! Must hold   every consistent method returns the field to rounding, at any Poisson's ratio.
//! ```

use super::{Elastic, Exact, ExactError, Matrix3, Parameter, Point3, Values, Vector3};

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

    /// A field with all nine components and the shift different from zero and from each other, strains of some 1e-3:
    /// a patch test that no symmetry of the body can pass by luck.
    pub fn generic(elastic: Elastic) -> Affine {
        let gradient = Matrix3::new(1.1, -0.4, 0.7, 0.9, -1.3, 0.2, -0.6, 0.5, 0.8) * 1e-3;
        Affine { elastic, gradient, shift: Vector3::new(1.0e-5, -2.0e-5, 3.0e-5) }
    }
}

impl Exact for Affine {
    fn elastic(&self) -> Elastic {
        self.elastic
    }

    fn displacement(&self, x: &Point3) -> Vector3 {
        self.gradient * x.coords + self.shift
    }

    fn gradient(&self, _x: &Point3) -> Matrix3 {
        self.gradient
    }
}

pub(super) const PARAMETERS: &[Parameter] = &[
    Parameter::optional("hxx", "", "du_x/dx; with no component given, a generic field is taken", 0.0),
    Parameter::optional("hxy", "", "du_x/dy", 0.0),
    Parameter::optional("hxz", "", "du_x/dz", 0.0),
    Parameter::optional("hyx", "", "du_y/dx", 0.0),
    Parameter::optional("hyy", "", "du_y/dy", 0.0),
    Parameter::optional("hyz", "", "du_y/dz", 0.0),
    Parameter::optional("hzx", "", "du_z/dx", 0.0),
    Parameter::optional("hzy", "", "du_z/dy", 0.0),
    Parameter::optional("hzz", "", "du_z/dz", 0.0),
    Parameter::optional("tx", "m", "shift along x", 0.0),
    Parameter::optional("ty", "m", "shift along y", 0.0),
    Parameter::optional("tz", "m", "shift along z", 0.0),
];

pub(super) fn build(elastic: Elastic, values: &Values) -> Result<Box<dyn Exact>, ExactError> {
    if !values.any_given() {
        return Ok(Box::new(Affine::generic(elastic)));
    }
    let gradient = Matrix3::from_fn(|i, j| values.at(3 * i + j));
    Ok(Box::new(Affine::new(elastic, gradient, Vector3::new(values.at(9), values.at(10), values.at(11)))))
}
