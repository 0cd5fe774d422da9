//! Ball: `sd = |p| - r`, Hessian `(I - n n^T) / |p|`. At the centre the gradient is +z and the Hessian zero.

use catalogue::{Build, Entry};
use shape::{Matrix3, Vector3};

use super::outline;
use super::signed_distance::{MEDIAL, RADIUS, Shape, size};
use crate::error::ContactError;

/// Ball about the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Radius, m.
    pub radius: f64,
}

pub(super) const ENTRY: Entry<Build<Sphere>> = Entry {
    name: "sphere",
    meaning: "a ball",
    source: "",
    parameters: &[RADIUS],
    build: |values| Ok(Sphere { radius: values.number("radius")? }),
};

impl Shape for Sphere {
    #[inline]
    fn foot(&self, p: &Vector3) -> (f64, Vector3) {
        foot(self.radius, p)
    }

    #[inline]
    fn hessian(&self, p: &Vector3) -> Matrix3 {
        hessian(self.radius, p)
    }

    fn half_extents(&self) -> Vector3 {
        Vector3::repeat(self.radius)
    }

    fn inradius(&self) -> f64 {
        self.radius
    }

    fn outline(&self, _body: f64) -> Vec<Vector3> {
        outline::mirrored(outline::octant().iter().map(|d| d * self.radius).collect(), [true; 3])
    }

    fn check(&self) -> Result<(), ContactError> {
        size("the radius", self.radius)
    }
}

#[inline]
pub(super) fn foot(radius: f64, p: &Vector3) -> (f64, Vector3) {
    let length = p.norm();
    (length - radius, if length > MEDIAL * radius { p / length } else { Vector3::z() })
}

#[inline]
pub(super) fn hessian(radius: f64, p: &Vector3) -> Matrix3 {
    let length = p.norm();
    if !(length > MEDIAL * radius) {
        return Matrix3::zeros();
    }
    let n = p / length;
    (Matrix3::identity() - n * n.transpose()) / length
}
