//! Hertz: a rigid sphere pressed into an elastic half space, no friction.
//!
//! ```text
//! Source      Hertz (1882); Johnson, Contact Mechanics (1985), ch. 3.2, 3.4 and 4.2.
//!
//!            .---.
//!           (  R  )  |           F = 4/3 E* sqrt(R) d^(3/2),   E* = E / (1 - nu^2)
//!    ________\   /___v_ d ___    a = sqrt(R d),   p(r) = p0 sqrt(1 - r^2 / a^2),   p0 = 2 E* a / (pi R)
//!             '-'   2 a
//!       half space z <= 0        far away: the field of a point force (Boussinesq), off by (a / |x|)^2
//!
//! Conditions  a << R (small slopes); the far field on the outer faces of a finite block stands in for the half space.
//! Must hold   force, contact radius and peak pressure converge; the error that is left is of the order of d / R and
//!             of (a / L)^2, L the size of the block.
//! ```

use std::f64::consts::PI;

use super::{Elastic, ExactError, Point3, Vector3};

/// A rigid sphere at depth `d` in the half space `z <= 0`, touching first at the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hertz {
    elastic: Elastic,
    radius: f64,
    depth: f64,
}

impl Hertz {
    /// Radius of the sphere (m) and how far it is pressed in (m), both above zero.
    pub fn new(elastic: Elastic, radius: f64, depth: f64) -> Result<Hertz, ExactError> {
        for (name, value) in [("radius", radius), ("depth", depth)] {
            if !(value > 0.0 && value.is_finite()) {
                let need = "above zero".into();
                return Err(ExactError::BadParameter { solution: "hertz", name, value, need });
            }
        }
        Ok(Hertz { elastic, radius, depth })
    }

    /// `E* = E / (1 - nu^2)`, Pa.
    pub fn modulus(&self) -> f64 {
        self.elastic.young() / (1.0 - self.elastic.poisson().powi(2))
    }

    /// Force on the sphere, N.
    pub fn force(&self) -> f64 {
        4.0 / 3.0 * self.modulus() * self.radius.sqrt() * self.depth.powf(1.5)
    }

    /// Radius of the contact, m.
    pub fn contact_radius(&self) -> f64 {
        (self.radius * self.depth).sqrt()
    }

    /// Pressure in the middle, Pa.
    pub fn peak_pressure(&self) -> f64 {
        2.0 * self.modulus() * self.contact_radius() / (PI * self.radius)
    }

    /// Displacement (m) far from the contact, `z <= 0`: that of the whole force in one point.
    ///
    /// ```text
    /// u_r = F / (4 pi mu |x|) (r s / |x|^2 - (1 - 2 nu) r / (|x| + s)),   s = -z
    /// u_z = -F / (4 pi mu |x|) (2 (1 - nu) + s^2 / |x|^2)
    /// ```
    pub fn far_displacement(&self, x: &Point3) -> Vector3 {
        let (nu, distance, s) = (self.elastic.poisson(), x.coords.norm(), -x.z);
        let scale = self.force() / (4.0 * PI * self.elastic.mu() * distance);
        let radial = s / distance.powi(2) - (1.0 - 2.0 * nu) / (distance + s);
        scale * Vector3::new(radial * x.x, radial * x.y, -2.0 * (1.0 - nu) - (s / distance).powi(2))
    }
}
