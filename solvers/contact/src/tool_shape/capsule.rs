//! The capsule: distance to the segment `|z| <= l` of the axis, less the radius. Beside the segment it is a cylinder,
//! `H = (I - z z^T - n n^T) / rho`, beyond its ends a ball. On the segment the gradient is +x.

use shape::{Matrix3, Vector3};

use super::{MEDIAL, cylinder, sphere};

#[inline]
pub(super) fn foot(radius: f64, half_length: f64, p: &Vector3) -> (f64, Vector3) {
    let beyond = p.z - p.z.clamp(-half_length, half_length);
    let to = Vector3::new(p.x, p.y, beyond);
    if to.norm() > MEDIAL * radius { sphere::foot(radius, &to) } else { (to.norm() - radius, Vector3::x()) }
}

#[inline]
pub(super) fn hessian(radius: f64, half_length: f64, p: &Vector3) -> Matrix3 {
    let beyond = p.z - p.z.clamp(-half_length, half_length);
    if beyond == 0.0 {
        cylinder::side_hessian(radius, p)
    } else {
        sphere::hessian(radius, &Vector3::new(p.x, p.y, beyond))
    }
}
