//! Simple bodies in closed form: volume, inside test, level function and random sample points.

mod ball;
mod cuboid;
mod cylinder;
mod kidney;

pub use ball::{Ball, SphereShell};
pub use cuboid::Cuboid;
pub use cylinder::Cylinder;
pub use kidney::{HalfKidney, Kidney};

use crate::Point3;

/// A solid body in closed form, as needed by node clouds, clipped grids and probes.
pub trait Shape {
    /// Volume in m^3.
    fn volume(&self) -> f64;

    /// Level function: negative inside, 0 on the surface, positive outside. The unit is metres, except for
    /// the kidney, whose level function is dimensionless.
    fn level(&self, p: &Point3) -> f64;

    /// Lowest and highest corner of the bounding box (m).
    fn bounds(&self) -> [Point3; 2];

    /// A surface point near `p`. For most shapes it is the closest point; for the kidney it lies on the ray
    /// through the preimage of `p` in the ball. A point without a direction (a centre) maps to a fixed
    /// surface point.
    fn project_to_surface(&self, p: &Point3) -> Point3;

    /// A random point, uniform in the volume; `unit` returns uniform numbers in [0, 1).
    fn volume_sample(&self, unit: &mut dyn FnMut() -> f64) -> Point3;

    /// A random point, uniform on the surface.
    fn surface_sample(&self, unit: &mut dyn FnMut() -> f64) -> Point3;

    /// Corners, which every discretisation should contain.
    fn corners(&self) -> Vec<Point3> {
        Vec::new()
    }

    /// A random point, uniform on the sharp edges, or `None` without such edges.
    fn edge_sample(&self, _unit: &mut dyn FnMut() -> f64) -> Option<Point3> {
        None
    }

    /// Whether the body or its surface contains `p`.
    fn inside(&self, p: &Point3) -> bool {
        self.level(p) <= 0.0
    }
}

/// A random point, uniform in the unit ball, by rejection. It uses no libm function whose last bit is
/// platform-dependent.
fn unit_ball(unit: &mut dyn FnMut() -> f64) -> crate::Vector3 {
    loop {
        let v = crate::Vector3::new(2.0 * unit() - 1.0, 2.0 * unit() - 1.0, 2.0 * unit() - 1.0);
        if v.norm_squared() < 1.0 {
            return v;
        }
    }
}

/// A random point, uniform on the unit sphere.
fn unit_sphere(unit: &mut dyn FnMut() -> f64) -> crate::Vector3 {
    loop {
        let v = unit_ball(unit);
        if v.norm_squared() > 1e-4 {
            return v.normalize();
        }
    }
}

/// `v` scaled to `length`, or along x if `v` vanishes.
fn along(v: crate::Vector3, length: f64) -> crate::Vector3 {
    v.try_normalize(0.0).unwrap_or_else(crate::Vector3::x) * length
}
