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
//! Conditions  a << R (small slopes); the far field on the outer faces of a finite block replaces the half
//!             space.
//! Must hold   force, contact radius and peak pressure converge; the remaining error is of the order of d / R
//!             and of (a / L)^2, with L the size of the block.
//! ```

use std::f64::consts::PI;

use catalogue::{Dimension, Entry, Parameter, Range};

use super::elastic::Elastic;
use super::error::ExactError;
use super::solution::{Contact, Exact, SolutionEntry, numbers};
use super::vectors::{Matrix3, Point3, Vector3};

/// A rigid sphere at depth `d` in the half space `z <= 0`, touching first at the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hertz {
    elastic: Elastic,
    radius: f64,
    depth: f64,
    share: f64,
}

impl Hertz {
    /// A sphere of the given radius (m), pressed into the half space to the given depth (m).
    ///
    /// # Errors
    ///
    /// A radius or depth that is not positive.
    pub fn new(elastic: Elastic, radius: f64, depth: f64) -> Result<Hertz, ExactError> {
        for (name, value) in [("radius", radius), ("depth", depth)] {
            if !(value > 0.0 && value.is_finite()) {
                let need = "above zero".into();
                return Err(ExactError::BadParameter { solution: ENTRY.name, name, value, need });
            }
        }
        Ok(Hertz { elastic, radius, depth, share: 1.0 })
    }

    /// The solution for a part of the half space, reduced by symmetry; `share` is 0.25 for a quarter.
    pub fn of_share(self, share: f64) -> Hertz {
        Hertz { share, ..self }
    }

    /// Contact modulus `E* = E / (1 - nu^2)`, Pa.
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

    /// Pressure at the centre of the contact, Pa.
    pub fn peak_pressure(&self) -> f64 {
        2.0 * self.modulus() * self.contact_radius() / (PI * self.radius)
    }

    /// `F / (4 pi mu)`, m^2.
    fn scale(&self) -> f64 {
        self.force() / (4.0 * PI * self.elastic.mu())
    }
}

/// Far field of the contact, `z <= 0`: the field of the whole force acting at one point.
///
/// ```text
/// u_r = F / (4 pi mu |x|) (r s / |x|^2 - (1 - 2 nu) r / (|x| + s)),   s = -z
/// u_z = -F / (4 pi mu |x|) (2 (1 - nu) + s^2 / |x|^2)
/// ```
impl Exact for Hertz {
    fn displacement(&self, x: &Point3) -> Vector3 {
        let nu = self.elastic.poisson();
        let distance = x.coords.norm();
        let s = -x.z;
        let scale = self.scale() / distance;
        let radial = s / distance.powi(2) - (1.0 - 2.0 * nu) / (distance + s);
        scale * Vector3::new(radial * x.x, radial * x.y, -2.0 * (1.0 - nu) - (s / distance).powi(2))
    }

    fn gradient(&self, x: &Point3) -> Matrix3 {
        let (nu, d, s) = (self.elastic.poisson(), x.coords.norm(), -x.z);
        let part = (1.0 - 2.0 * nu) / (d * (d + s)).powi(2);
        // u_r = c r A, u_z = -c B; derivatives by r (divided by r) and by z.
        let a = s / d.powi(3) - (1.0 - 2.0 * nu) / (d * (d + s));
        let a_r = -3.0 * s / d.powi(5) + part * (2.0 * d + s) / d;
        let a_z = -(1.0 / d.powi(3) - 3.0 * s * s / d.powi(5) + part * (s * (2.0 * d + s) / d + d));
        let b_r = -2.0 * (1.0 - nu) / d.powi(3) - 3.0 * s * s / d.powi(5);
        let b_z = -(2.0 * nu * s / d.powi(3) - 3.0 * s.powi(3) / d.powi(5));
        let (x, y) = (x.x, x.y);
        #[rustfmt::skip]
        let h = Matrix3::new(
            a + x * x * a_r, x * y * a_r,     x * a_z,
            x * y * a_r,     a + y * y * a_r, y * a_z,
            -x * b_r,        -y * b_r,        -b_z,
        );
        h * self.scale()
    }

    fn stress(&self, x: &Point3) -> Matrix3 {
        self.elastic.stress(&self.gradient(x))
    }

    fn contact(&self) -> Option<Contact> {
        let area = PI * self.contact_radius().powi(2);
        Some(Contact { force: self.share * self.force(), area: self.share * area })
    }
}

pub(super) const ENTRY: SolutionEntry = Entry {
    name: "hertz",
    meaning: "a rigid sphere pressed without friction into the half space z <= 0, with first contact at the \
              origin",
    source: "Hertz (1882); Johnson, Contact Mechanics (1985), ch. 3 and 4",
    parameters: &[
        Parameter::required("radius", Dimension::Length, "radius of the sphere"),
        Parameter::required("depth", Dimension::Length, "indentation depth of the sphere"),
        Parameter::default(
            "share",
            Dimension::None,
            1.0,
            "fraction of the half space that the body represents; less than 1 with planes of symmetry",
        )
        .within(Range::Within(0.25, 1.0)),
    ],
    build: |medium, values| {
        let [radius, depth, share] = numbers(values, ["radius", "depth", "share"])?;
        Ok(Box::new(Hertz::new(medium.elastic, radius, depth)?.of_share(share)))
    },
};
