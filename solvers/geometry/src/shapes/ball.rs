//! The ball and the thick sphere, around the origin.

use std::f64::consts::PI;

use super::{Shape, along, unit_ball, unit_sphere};
use crate::Point3;

/// A ball of `radius` (m) around the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// Radius in metres.
    pub radius: f64,
}

impl Shape for Ball {
    fn volume(&self) -> f64 {
        4.0 / 3.0 * PI * self.radius.powi(3)
    }

    fn level(&self, p: &Point3) -> f64 {
        p.coords.norm() - self.radius
    }

    fn bounds(&self) -> [Point3; 2] {
        [-self.radius, self.radius].map(|r| Point3::new(r, r, r))
    }

    fn project_to_surface(&self, p: &Point3) -> Point3 {
        along(p.coords, self.radius).into()
    }

    fn volume_sample(&self, unit: &mut dyn FnMut() -> f64) -> Point3 {
        (unit_ball(unit) * self.radius).into()
    }

    fn surface_sample(&self, unit: &mut dyn FnMut() -> f64) -> Point3 {
        (unit_sphere(unit) * self.radius).into()
    }
}

/// The shell between two spheres around the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereShell {
    /// Inner radius in metres.
    pub inner: f64,
    /// Outer radius in metres.
    pub outer: f64,
}

impl Shape for SphereShell {
    fn volume(&self) -> f64 {
        4.0 / 3.0 * PI * (self.outer.powi(3) - self.inner.powi(3))
    }

    fn level(&self, p: &Point3) -> f64 {
        let r = p.coords.norm();
        (r - self.outer).max(self.inner - r)
    }

    fn bounds(&self) -> [Point3; 2] {
        Ball { radius: self.outer }.bounds()
    }

    fn project_to_surface(&self, p: &Point3) -> Point3 {
        let middle = 0.5 * (self.inner + self.outer);
        along(p.coords, if p.coords.norm() < middle { self.inner } else { self.outer }).into()
    }

    fn volume_sample(&self, unit: &mut dyn FnMut() -> f64) -> Point3 {
        // r^3 is uniform between the cubes of the radii.
        let (a, b) = (self.inner.powi(3), self.outer.powi(3));
        let radius = (a + (b - a) * unit()).cbrt().clamp(self.inner, self.outer);
        (unit_sphere(unit) * radius).into()
    }

    fn surface_sample(&self, unit: &mut dyn FnMut() -> f64) -> Point3 {
        let (a, b) = (self.inner.powi(2), self.outer.powi(2));
        let radius = if unit() * (a + b) < a { self.inner } else { self.outer };
        (unit_sphere(unit) * radius).into()
    }
}
