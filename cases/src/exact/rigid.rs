//! Rigid motion of small rotation: no strain, no stress, no energy.
//!
//! ```text
//! Source      the kernel of the linear strain; Gurtin, An Introduction to Continuum Mechanics, sec. 7.
//!
//!      +-------+        +-------+
//!      |       |   ->   |       |  turned      u = t + w x x
//!      +-------+        +-------+
//!
//! Conditions  the exact displacement on a part of the boundary that holds the body; nothing else.
//! Must hold   the body follows to rounding; stress, energy and reactions vanish; the stiffness has exactly six such modes.
//! ```

use super::{Elastic, Exact, ExactError, Matrix3, Parameter, Point3, Values, Vector3};

/// `u = t + w x x`: a shift and an infinitesimal rotation about the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rigid {
    elastic: Elastic,
    shift: Vector3,
    rotation: Vector3,
}

impl Rigid {
    /// A shift `t` (m) and a rotation vector `w` (rad, linearised).
    pub fn new(elastic: Elastic, shift: Vector3, rotation: Vector3) -> Rigid {
        Rigid { elastic, shift, rotation }
    }

    /// A motion with all six components different from zero and from each other.
    pub fn generic(elastic: Elastic) -> Rigid {
        Rigid {
            elastic,
            shift: Vector3::new(1.0e-5, -2.0e-5, 3.0e-5),
            rotation: Vector3::new(0.7e-3, -1.1e-3, 0.4e-3),
        }
    }
}

impl Exact for Rigid {
    fn elastic(&self) -> Elastic {
        self.elastic
    }

    fn displacement(&self, x: &Point3) -> Vector3 {
        self.shift + self.rotation.cross(&x.coords)
    }

    fn gradient(&self, _x: &Point3) -> Matrix3 {
        self.rotation.cross_matrix()
    }
}

pub(super) const PARAMETERS: &[Parameter] = &[
    Parameter::optional("tx", "m", "shift along x; with no component given, a generic motion is taken", 0.0),
    Parameter::optional("ty", "m", "shift along y", 0.0),
    Parameter::optional("tz", "m", "shift along z", 0.0),
    Parameter::optional("rx", "rad", "small rotation about x", 0.0),
    Parameter::optional("ry", "rad", "small rotation about y", 0.0),
    Parameter::optional("rz", "rad", "small rotation about z", 0.0),
];

pub(super) fn build(elastic: Elastic, values: &Values) -> Result<Box<dyn Exact>, ExactError> {
    if !values.any_given() {
        return Ok(Box::new(Rigid::generic(elastic)));
    }
    let triple = |first| Vector3::new(values.at(first), values.at(first + 1), values.at(first + 2));
    Ok(Box::new(Rigid::new(elastic, triple(0), triple(3))))
}
