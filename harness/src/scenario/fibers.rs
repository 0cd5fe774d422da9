//! Directions of fibres by rules.

use geometry::generate::Ventricle;
use geometry::{Point3, Vector3};

/// Returns the direction of the fibre at a point (m) of a ventricle: in the ellipsoid through the point, at an
/// angle (radians) from the circumference towards the base, linear in the depth of the wall between the angles
/// inside and outside.
///
/// With the polar angle u of the ellipsoid and the angle v about the z axis this is `sin(a) d_u + cos(a) d_v` with
/// unit tangents. Source: Land et al., Proc. R. Soc. A 471 (2015) 20150641, problem 3.
pub(super) fn helix(wall: &Ventricle, [inside, outside]: [f64; 2], p: &Point3) -> Vector3 {
    let depth = wall.depth(p);
    let [across, along] = wall.radii(depth);
    let angle = inside + depth * (outside - inside);
    let r = p.x.hypot(p.y);
    // On the axis the circumference has no direction; one is as good as any other.
    let out = if r > 0.0 { Vector3::new(p.x / r, p.y / r, 0.0) } else { Vector3::x() };
    let around = Vector3::new(-out.y, out.x, 0.0);
    let (sin, cos) = (r / across, p.z / along);
    let up = (Vector3::z() * (along * sin) - out * (across * cos)).normalize();
    up * angle.sin() + around * angle.cos()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    #[test]
    fn fibres_turn_from_base_to_base_through_the_circumference() {
        let wall = Ventricle { inner: [7e-3, 17e-3], outer: [10e-3, 20e-3], base: 5e-3 };
        for (depth, z) in [(0.0, 0.0), (0.5, -6e-3), (1.0, 3e-3), (0.25, -15e-3)] {
            let [across, along] = wall.radii(depth);
            let r = across * (1.0 - (z / along).powi(2)).sqrt();
            let p = Point3::new(0.6 * r, 0.8 * r, z);
            assert!((wall.depth(&p) - depth).abs() < 1e-12);
            let f = helix(&wall, [FRAC_PI_2, -FRAC_PI_2], &p);
            assert!((f.norm() - 1.0).abs() < 1e-14);
            // Tangential to the ellipsoid, at the angle 90 - 180 t degrees.
            let normal = Vector3::new(p.x / across.powi(2), p.y / across.powi(2), p.z / along.powi(2));
            assert!(f.dot(&normal.normalize()).abs() < 1e-12);
            let around = Vector3::new(-0.8, 0.6, 0.0);
            assert!((f.dot(&around) - (FRAC_PI_2 * (1.0 - 2.0 * depth)).cos()).abs() < 1e-10);
            assert_eq!(f.z > 0.0, depth < 0.5 || f.z > 0.0);
        }
    }
}
