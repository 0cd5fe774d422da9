//! The box with rounded edges: with `q = |p| - (half - r)`, `sd = |max(q, 0)| + min(max(q_x, q_y, q_z), 0) - r`.
//!
//! Deeper than `r` (in the core `q <= 0`) the nearest face pushes; of equally near faces the first of x, y, z, and
//! the positive one of a pair.

use shape::{Matrix3, Vector3};

use super::MEDIAL;

/// `q`, and the length of `max(q, 0)`: none in the core.
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
pub(super) fn foot(half: [f64; 3], radius: f64, p: &Vector3) -> (f64, Vector3) {
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

/// `(D - n n^T) / |max(q, 0)|` with `D` the axes along which `q > 0`; zero in the core.
#[inline]
pub(super) fn hessian(half: [f64; 3], radius: f64, p: &Vector3) -> Matrix3 {
    let (q, length) = beyond_core(half, radius, p);
    let Some(length) = length else { return Matrix3::zeros() };
    let n = q.zip_map(p, |q, p| q.max(0.0) * sign(p) / length);
    let beyond = q.map(|q| f64::from(u8::from(q > 0.0)));
    (Matrix3::from_diagonal(&beyond) - n * n.transpose()) / length
}
