//! Cylinder with flat ends. In the half plane of `rho = |(x, y)|` and `z` it is a rectangle, so that with
//! `q = (rho - r, |z| - l)`, `sd = |max(q, 0)| + min(max(q_r, q_z), 0)`.
//!
//! If side and end are equally near inside, the side is taken. On the axis the side's normal is +x. Halfway
//! between the ends the upper end is taken.

use catalogue::{Build, Entry};
use shape::{Matrix3, Vector3};

use super::outline;
use super::signed_distance::{AXIS, LENGTH, MEDIAL, RADIUS, Shape, size};
use crate::error::ContactError;

/// Cylinder about the z axis with flat ends and sharp rims. If `half_length` is far larger than the body, it
/// is a roller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// Radius, m.
    pub radius: f64,
    /// Half length, m.
    pub half_length: f64,
}

pub(super) const ENTRY: Entry<Build<Cylinder>> = Entry {
    name: "cylinder",
    meaning: "a cylinder with flat ends and sharp rims; a roller if it is longer than the body",
    source: "",
    parameters: &[RADIUS, LENGTH, AXIS],
    build: |values| {
        let radius = values.number("radius")?;
        let half_length = 0.5 * values.number("length")?;
        Ok(Cylinder { radius, half_length })
    },
};

impl Shape for Cylinder {
    #[inline]
    fn foot(&self, p: &Vector3) -> (f64, Vector3) {
        foot(self.radius, self.half_length, p)
    }

    #[inline]
    fn hessian(&self, p: &Vector3) -> Matrix3 {
        hessian(self.radius, self.half_length, p)
    }

    fn half_extents(&self) -> Vector3 {
        Vector3::new(self.radius, self.radius, self.half_length)
    }

    fn inradius(&self) -> f64 {
        self.radius.min(self.half_length)
    }

    fn outline(&self, _body: f64) -> Vec<Vector3> {
        let rim = outline::octant().into_iter().filter(|d| d.z == 0.0);
        let rim = rim.map(|d| d * self.radius + Vector3::z() * self.half_length);
        outline::mirrored(rim.collect(), [true; 3])
    }

    fn axis(&self, _along: Vector3) -> Option<Vector3> {
        Some(Vector3::z())
    }

    fn check(&self) -> Result<(), ContactError> {
        size("the radius", self.radius)?;
        size("the half length", self.half_length)
    }
}

/// Returns `rho` and the unit vector away from the axis; +x on the axis.
#[inline]
fn radial(radius: f64, p: &Vector3) -> (f64, Vector3) {
    let rho = p.x.hypot(p.y);
    (rho, if rho > MEDIAL * radius { Vector3::new(p.x, p.y, 0.0) / rho } else { Vector3::x() })
}

fn end(p: &Vector3) -> Vector3 {
    Vector3::new(0.0, 0.0, if p.z >= 0.0 { 1.0 } else { -1.0 })
}

#[inline]
fn foot(radius: f64, half_length: f64, p: &Vector3) -> (f64, Vector3) {
    let (rho, outward) = radial(radius, p);
    let side = rho - radius;
    let flat = p.z.abs() - half_length;
    if side > 0.0 && flat > 0.0 {
        let value = side.hypot(flat);
        (value, (outward * side + end(p) * flat) / value)
    } else if side >= flat {
        (side, outward)
    } else {
        (flat, end(p))
    }
}

/// Returns `(I - z z^T - n n^T) / rho = s s^T / rho`, `s` along the circumference; zero on the axis.
#[inline]
pub(super) fn side_hessian(radius: f64, p: &Vector3) -> Matrix3 {
    let (rho, n) = radial(radius, p);
    if !(rho > MEDIAL * radius) {
        return Matrix3::zeros();
    }
    let s = Vector3::new(-n.y, n.x, 0.0);
    s * s.transpose() / rho
}

#[inline]
fn hessian(radius: f64, half_length: f64, p: &Vector3) -> Matrix3 {
    let (rho, outward) = radial(radius, p);
    let side = rho - radius;
    let flat = p.z.abs() - half_length;
    if side > 0.0 && flat > 0.0 {
        // Distance to the rim: a circle in the half plane, with `1 / value` across the rim and `n_r / rho`
        // along it.
        let (value, normal) = foot(radius, half_length, p);
        let across = (outward * flat - end(p) * side) / value;
        across * across.transpose() / value + side_hessian(radius, p) * normal.dot(&outward)
    } else if side >= flat {
        side_hessian(radius, p)
    } else {
        Matrix3::zeros()
    }
}
