//! Circumcentre of a tetrahedron, also for flat tetrahedra.

use nalgebra::Vector3 as V;
use shape::{Point3, Vector3};

use crate::twofold::Twofold;

/// Volume relative to the product of three sides below which double precision leaves fewer than ten digits of
/// the centre. In a rotated lattice, four nodes of a square form tetrahedra of volume 1e-16.
const FLAT: f64 = 1e-6;

/// Returns the circumcentre relative to the first corner:
/// `(|a|^2 b x c + |b|^2 c x a + |c|^2 a x b) / (2 a . (b x c))`.
pub(crate) fn circumcentre(&[o, a, b, c]: &[Point3; 4]) -> Vector3 {
    let (u, v, w) = (a - o, b - o, c - o);
    let (uu, vv, ww) = (u.norm_squared(), v.norm_squared(), w.norm_squared());
    let volume = u.dot(&v.cross(&w));
    if volume * volume > FLAT * FLAT * uu * vv * ww {
        (uu * v.cross(&w) + vv * w.cross(&u) + ww * u.cross(&v)) / (2.0 * volume)
    } else {
        of_flat(&o, &a, &b, &c)
    }
}

/// Computes the circumcentre in twofold precision, in which the differences of the corners are exact.
fn of_flat(o: &Point3, a: &Point3, b: &Point3, c: &Point3) -> Vector3 {
    let from = |p: &Point3| [0, 1, 2].map(|i| Twofold::difference(p[i], o[i]));
    let dot = |p: &[Twofold; 3], q: &[Twofold; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    let cross = |p: &[Twofold; 3], q: &[Twofold; 3]| {
        [0, 1, 2].map(|i| p[(i + 1) % 3] * q[(i + 2) % 3] - p[(i + 2) % 3] * q[(i + 1) % 3])
    };
    let (u, v, w) = (from(a), from(b), from(c));
    let (vw, wu, uv) = (cross(&v, &w), cross(&w, &u), cross(&u, &v));
    let volume = dot(&u, &vw);
    let volume = volume + volume;
    let (uu, vv, ww) = (dot(&u, &u), dot(&v, &v), dot(&w, &w));
    V::from_fn(|i, _| (uu * vw[i] + vv * wu[i] + ww * uv[i]).ratio(volume))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn centres_are_as_far_from_every_corner() {
        for thickness in [1.0, 1e-3, 1e-9, 1e-15] {
            // Four points of a circle around (0.1, 0.2), one of them moved off its plane.
            let turn = nalgebra::Rotation3::from_euler_angles(0.3, 0.7, -0.4);
            let on = |t: f64, z: f64| turn * Point3::new(0.1 + 0.7 * f64::cos(t), 0.2 + 0.7 * f64::sin(t), z);
            let corners = [on(0.0, 0.0), on(1.3, 0.0), on(2.9, thickness), on(4.6, 0.0)];
            let centre = corners[0] + circumcentre(&corners);
            let radii = corners.map(|p| (p - centre).norm());
            let (least, most) = radii.iter().fold((f64::INFINITY, 0.0f64), |(l, m), &r| (l.min(r), m.max(r)));
            assert!(most - least < 1e-13 * most, "{thickness:e}: {radii:?}");
        }
    }
}
