//! Box with rounded edges: with `q = |p| - (half - r)`, `sd = |max(q, 0)| + min(max(q_x, q_y, q_z), 0) - r`.
//!
//! Deeper than `r` (in the core `q <= 0`) the nearest face pushes. Of equally near faces the first of x, y, z
//! is taken, and the positive face of a pair.

use catalogue::{Build, Dimension, Entry, Kind, Parameter, Problem, Range};
use shape::{Matrix3, Vector3};

use super::outline;
use super::signed_distance::{MEDIAL, RADIUS, Shape, size};
use crate::error::ContactError;

/// Box about the origin with all edges and corners rounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundedBox {
    /// Half extents, rounding included, m.
    pub half: [f64; 3],
    /// Rounding radius, from 0 to the smallest half extent, m.
    pub radius: f64,
}

const HALF: Parameter =
    Parameter::required("half", Dimension::Length, "half extents, including the rounding")
        .of(Kind::Vector)
        .within(Range::Positive);

pub(super) const ENTRY: Entry<Build<RoundedBox>> = Entry {
    name: "rounded-box",
    meaning: "an axis-parallel box with rounded edges and corners",
    source: "",
    parameters: &[HALF, RADIUS],
    build: |values| {
        let &[x, y, z] = values.list("half").unwrap_or_default() else {
            return Err(Problem::new("does not have three half extents").of("half"));
        };
        let shape = RoundedBox { half: [x, y, z], radius: values.number("radius")? };
        shape.check().map_err(|bad| Problem::new(bad.to_string()).of("radius"))?;
        Ok(shape)
    },
};

impl Shape for RoundedBox {
    #[inline]
    fn foot(&self, p: &Vector3) -> (f64, Vector3) {
        foot(self.half, self.radius, p)
    }

    #[inline]
    fn hessian(&self, p: &Vector3) -> Matrix3 {
        hessian(self.half, self.radius, p)
    }

    fn half_extents(&self) -> Vector3 {
        Vector3::from(self.half)
    }

    fn inradius(&self) -> f64 {
        self.half[0].min(self.half[1]).min(self.half[2])
    }

    fn outline(&self, _body: f64) -> Vec<Vector3> {
        let core = Vector3::from(self.half).add_scalar(-self.radius);
        outline::mirrored(outline::octant().iter().map(|d| core + d * self.radius).collect(), [true; 3])
    }

    /// Returns the area of the face, roundings included, of a box that moves along one of its axes.
    fn face_area(&self, along: &Vector3) -> Option<f64> {
        let closes = (0..3).find(|&a| along[a].abs() > 1.0 - 1e-9)?;
        Some((0..3).filter(|&a| a != closes).map(|a| 2.0 * self.half[a]).product())
    }

    fn check(&self) -> Result<(), ContactError> {
        self.half.iter().try_for_each(|&h| size("a half extent", h))?;
        let radius = self.radius;
        let half = self.inradius();
        // Written so that a NaN fails.
        if radius >= 0.0 && radius <= half { Ok(()) } else { Err(ContactError::Rounding { radius, half }) }
    }
}

/// Returns `q` and the length of `max(q, 0)`; no length in the core.
#[inline]
fn beyond_core(half: [f64; 3], radius: f64, p: &Vector3) -> (Vector3, Option<f64>) {
    let q = p.abs() - Vector3::from(half).add_scalar(-radius);
    let length = q.sup(&Vector3::zeros()).norm();
    (q, (length > MEDIAL * half[0].min(half[1]).min(half[2])).then_some(length))
}

#[inline]
fn sign(x: f64) -> f64 {
    if x >= 0.0 { 1.0 } else { -1.0 }
}

#[inline]
fn foot(half: [f64; 3], radius: f64, p: &Vector3) -> (f64, Vector3) {
    let (q, length) = beyond_core(half, radius, p);
    if let Some(length) = length {
        (length - radius, q.zip_map(p, |q, p| q.max(0.0) * sign(p) / length))
    } else {
        let face = if q.x >= q.y && q.x >= q.z {
            0
        } else if q.y >= q.z {
            1
        } else {
            2
        };
        let mut n = Vector3::zeros();
        n[face] = sign(p[face]);
        (q[face] - radius, n)
    }
}

/// Returns `(D - n n^T) / |max(q, 0)|` with `D` the axes along which `q > 0`; zero in the core.
#[inline]
fn hessian(half: [f64; 3], radius: f64, p: &Vector3) -> Matrix3 {
    let (q, length) = beyond_core(half, radius, p);
    let Some(length) = length else { return Matrix3::zeros() };
    let n = q.zip_map(p, |q, p| q.max(0.0) * sign(p) / length);
    let beyond = q.map(|q| f64::from(u8::from(q > 0.0)));
    (Matrix3::from_diagonal(&beyond) - n * n.transpose()) / length
}
