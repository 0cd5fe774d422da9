//! The cylinder about the z axis, on the plane z = 0.

use std::f64::consts::PI;

use super::Shape;
use crate::{Point3, Vector3};

/// A cylinder around the z axis, from z = 0 to z = `height`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// Radius in metres.
    pub radius: f64,
    /// Height in metres.
    pub height: f64,
}

impl Cylinder {
    /// The point in the direction of `p` from the axis, at this radius and height.
    fn at(&self, p: &Point3, radius: f64, z: f64) -> Point3 {
        let v = super::along(Vector3::new(p.x, p.y, 0.0), radius);
        Point3::new(v.x, v.y, z)
    }

    /// A random point, uniform in the unit disc without the negligible disc of radius 1e-6 at its centre.
    fn disc(unit: &mut dyn FnMut() -> f64) -> Point3 {
        loop {
            let (x, y) = (2.0 * unit() - 1.0, 2.0 * unit() - 1.0);
            if (1e-12..1.0).contains(&(x * x + y * y)) {
                return Point3::new(x, y, 0.0);
            }
        }
    }
}

impl Shape for Cylinder {
    fn volume(&self) -> f64 {
        PI * self.radius * self.radius * self.height
    }

    fn level(&self, p: &Point3) -> f64 {
        let across = p.x.hypot(p.y) - self.radius;
        let along = (p.z - 0.5 * self.height).abs() - 0.5 * self.height;
        across.max(0.0).hypot(along.max(0.0)) + across.max(along).min(0.0)
    }

    fn bounds(&self) -> [Point3; 2] {
        let r = self.radius;
        [Point3::new(-r, -r, 0.0), Point3::new(r, r, self.height)]
    }

    fn project_to_surface(&self, p: &Point3) -> Point3 {
        let r = p.x.hypot(p.y);
        let z = p.z.clamp(0.0, self.height);
        if self.level(p) > 0.0 {
            return if r > self.radius { self.at(p, self.radius, z) } else { Point3::new(p.x, p.y, z) };
        }
        let side = self.radius - r;
        let bottom = p.z;
        let top = self.height - p.z;
        if side <= bottom.min(top) {
            self.at(p, self.radius, p.z)
        } else {
            Point3::new(p.x, p.y, if bottom <= top { 0.0 } else { self.height })
        }
    }

    fn volume_sample(&self, unit: &mut dyn FnMut() -> f64) -> Point3 {
        let v = Self::disc(unit);
        Point3::new(self.radius * v.x, self.radius * v.y, self.height * unit())
    }

    fn surface_sample(&self, unit: &mut dyn FnMut() -> f64) -> Point3 {
        // The side has the area 2 pi r h, each of the two ends pi r^2.
        let u = unit() * (self.height + self.radius);
        if u < self.height {
            let p = Self::disc(unit);
            return self.at(&p, self.radius, self.height * unit());
        }
        let mut p = self.volume_sample(unit);
        p.z = if unit() < 0.5 { 0.0 } else { self.height };
        p
    }

    fn edge_sample(&self, unit: &mut dyn FnMut() -> f64) -> Option<Point3> {
        let p = Self::disc(unit);
        let z = if unit() < 0.5 { 0.0 } else { self.height };
        Some(self.at(&p, self.radius, z))
    }
}
