//! The ball: `sd = |p| - r`, Hessian `(I - n n^T) / |p|`. At the centre the gradient is +z and the Hessian zero.

use shape::{Matrix3, Vector3};

use super::MEDIAL;

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
