//! Capsule: distance to the segment `|z| <= l` of the axis, less the radius. Next to the segment the Hessian
//! is that of a cylinder, `H = (I - z z^T - n n^T) / rho`; beyond the ends that of a ball. On the segment the
//! gradient is +x.

use catalogue::{Build, Entry};
use shape::{Matrix3, Vector3};

use super::signed_distance::{AXIS, LENGTH, MEDIAL, RADIUS, Shape, size};
use super::{cylinder, outline, sphere};
use crate::error::ContactError;

/// Capsule: the points within `radius` of a segment of the z axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule {
    /// Radius, m.
    pub radius: f64,
    /// Half length of the segment, m. The whole capsule extends to `half_length + radius`.
    pub half_length: f64,
}

pub(super) const ENTRY: Entry<Build<Capsule>> = Entry {
    name: "capsule",
    meaning: "a cylinder with hemispherical ends; the length is the distance between the centres of the \
              hemispheres",
    source: "",
    parameters: &[RADIUS, LENGTH, AXIS],
    build: |values| {
        let radius = values.number("radius")?;
        let half_length = 0.5 * values.number("length")?;
        Ok(Capsule { radius, half_length })
    },
};

impl Shape for Capsule {
    #[inline]
    fn foot(&self, p: &Vector3) -> (f64, Vector3) {
        foot(self.radius, self.half_length, p)
    }

    #[inline]
    fn hessian(&self, p: &Vector3) -> Matrix3 {
        hessian(self.radius, self.half_length, p)
    }

    fn half_extents(&self) -> Vector3 {
        Vector3::new(self.radius, self.radius, self.half_length + self.radius)
    }

    fn inradius(&self) -> f64 {
        self.radius
    }

    fn outline(&self, _body: f64) -> Vec<Vector3> {
        let end = |d: &Vector3| Vector3::z() * self.half_length + d * self.radius;
        outline::mirrored(outline::octant().iter().map(end).collect(), [true; 3])
    }

    fn axis(&self, _along: Vector3) -> Option<Vector3> {
        Some(Vector3::z())
    }

    fn check(&self) -> Result<(), ContactError> {
        size("the radius", self.radius)?;
        size("the half length", self.half_length)
    }
}

#[inline]
fn foot(radius: f64, half_length: f64, p: &Vector3) -> (f64, Vector3) {
    let beyond = p.z - p.z.clamp(-half_length, half_length);
    let to = Vector3::new(p.x, p.y, beyond);
    if to.norm() > MEDIAL * radius { sphere::foot(radius, &to) } else { (to.norm() - radius, Vector3::x()) }
}

#[inline]
fn hessian(radius: f64, half_length: f64, p: &Vector3) -> Matrix3 {
    let beyond = p.z - p.z.clamp(-half_length, half_length);
    if beyond == 0.0 {
        cylinder::side_hessian(radius, p)
    } else {
        sphere::hessian(radius, &Vector3::new(p.x, p.y, beyond))
    }
}
