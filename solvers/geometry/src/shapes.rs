//! Simple bodies in closed form: volume, inside test, level function, points drawn from them.

mod ball;
mod cuboid;
mod cylinder;
mod kidney;

pub use ball::{Ball, SphereShell};
pub use cuboid::Cuboid;
pub use cylinder::Cylinder;
pub use kidney::{HalfKidney, Kidney};

use crate::Point3;

/// A solid body in closed form: what a node cloud, a clipped grid or a probe needs to know of it.
pub trait Shape {
    /// Volume in m^3.
    fn volume(&self) -> f64;

    /// Negative inside, 0 on the surface, positive outside, in the units of the shape's own formula (metres for all
    /// but the kidney, whose level function is dimensionless).
    fn level(&self, p: &Point3) -> f64;

    /// Lowest and highest corner of the bounding box (m).
    fn bounds(&self) -> [Point3; 2];

    /// A surface point near `p`: the closest one, or for the kidney the one on the same ray of the ball it is the
    /// image of. A point without a direction (a centre) goes to a fixed surface point.
    fn project_to_surface(&self, p: &Point3) -> Point3;

    /// A point drawn uniformly from the volume; `unit` gives uniform numbers in [0, 1).
    fn volume_sample(&self, unit: &mut dyn FnMut() -> f64) -> Point3;

    /// A point drawn uniformly from the surface.
    fn surface_sample(&self, unit: &mut dyn FnMut() -> f64) -> Point3;

    /// Points every discretisation should have: corners.
    fn corners(&self) -> Vec<Point3> {
        Vec::new()
    }

    /// A point drawn uniformly from the sharp edges, if there are any.
    fn edge_sample(&self, _unit: &mut dyn FnMut() -> f64) -> Option<Point3> {
        None
    }

    /// Whether the body holds `p`, its surface included.
    fn inside(&self, p: &Point3) -> bool {
        self.level(p) <= 0.0
    }
}

/// Uniform in the unit ball, by rejection: no libm function whose last bit differs between platforms.
fn unit_ball(unit: &mut dyn FnMut() -> f64) -> crate::Vector3 {
    loop {
        let v = crate::Vector3::new(2.0 * unit() - 1.0, 2.0 * unit() - 1.0, 2.0 * unit() - 1.0);
        if v.norm_squared() < 1.0 {
            return v;
        }
    }
}

/// Uniform on the unit sphere.
fn unit_sphere(unit: &mut dyn FnMut() -> f64) -> crate::Vector3 {
    loop {
        let v = unit_ball(unit);
        if v.norm_squared() > 1e-4 {
            return v.normalize();
        }
    }
}

/// `v` scaled to `length`, or along x where `v` vanishes.
fn along(v: crate::Vector3, length: f64) -> crate::Vector3 {
    v.try_normalize(0.0).unwrap_or_else(crate::Vector3::x) * length
}
