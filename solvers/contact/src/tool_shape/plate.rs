//! The half space `z <= 0`: `sd = z`.

use shape::{Matrix3, Vector3};

pub(super) fn foot(p: &Vector3) -> (f64, Vector3) {
    (p.z, Vector3::z())
}

pub(super) fn hessian() -> Matrix3 {
    Matrix3::zeros()
}
