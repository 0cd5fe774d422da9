//! Thick sphere under internal and external pressure (Lame).
//!
//! ```text
//! Source      Lame (1852); Timoshenko & Goodier, Theory of Elasticity, spherical container under pressure.
//!
//!        .-"""-.
//!      .'  .-.  '.        radii a < r < b, centred on the origin
//!     |   ( p )   | q     p inside, q outside, both pushing on the wall
//!      '.  '-'  .'
//!        '-...-'
//!
//! Field       u = (A + B / r^3) x,
//!             A = (p a^3 - q b^3) / (3 kappa (b^3 - a^3)),  B = (p - q) a^3 b^3 / (4 mu (b^3 - a^3)).
//! Conditions  the two pressures; symmetry planes of an octant (u_n = 0), or rigid motion removed otherwise.
//! Must hold   sigma_rr = -p at a and -q at b; the mean stress (p a^3 - q b^3) / (b^3 - a^3) is constant for
//!             any nu, so locking shows at once in the pressure. Defined for r > 0.
//! ```

use catalogue::{Dimension, Entry, Parameter};

use super::elastic::Elastic;
use super::error::ExactError;
use super::solution::{Exact, SolutionEntry, numbers};
use super::vectors::{Matrix3, Point3, Vector3};

/// Lame's sphere centred on the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThickSphere {
    elastic: Elastic,
    mean_stress: f64,
    /// `4 mu B`, N m: the deviatoric part falls as `1 / r^3`.
    source: f64,
}

impl ThickSphere {
    /// A sphere with the radii `0 < inner < outer` (m), under pressures on the inner and the outer wall (Pa,
    /// positive if they push on the wall).
    pub fn new(
        elastic: Elastic,
        [inner, outer]: [f64; 2],
        [inner_pressure, outer_pressure]: [f64; 2],
    ) -> Result<ThickSphere, ExactError> {
        if !(inner > 0.0 && inner.is_finite()) {
            let need = "above zero".into();
            return Err(ExactError::BadParameter { solution: ENTRY.name, name: "inner", value: inner, need });
        }
        if !(outer > inner && outer.is_finite()) {
            let need = format!("above the inner radius of {inner} m");
            return Err(ExactError::BadParameter { solution: ENTRY.name, name: "outer", value: outer, need });
        }
        let (a, b) = (inner.powi(3), outer.powi(3));
        let mean_stress = (inner_pressure * a - outer_pressure * b) / (b - a);
        let source = (inner_pressure - outer_pressure) * a * b / (b - a);
        Ok(ThickSphere { elastic, mean_stress, source })
    }

    /// `A` (dimensionless) and `B / r^3` at a radius.
    fn terms(&self, r: f64) -> (f64, f64) {
        (self.mean_stress / (3.0 * self.elastic.bulk()), self.source / (4.0 * self.elastic.mu() * r.powi(3)))
    }
}

/// `I - 3 n n^T` with `n = x / r`: the shape of the gradient of `x / r^3`.
fn quadrupole(x: &Point3, r: f64) -> Matrix3 {
    let n = x.coords / r;
    Matrix3::identity() - 3.0 * (n * n.transpose())
}

impl Exact for ThickSphere {
    fn displacement(&self, x: &Point3) -> Vector3 {
        let (a, b) = self.terms(x.coords.norm());
        (a + b) * x.coords
    }

    fn gradient(&self, x: &Point3) -> Matrix3 {
        let r = x.coords.norm();
        let (a, b) = self.terms(r);
        a * Matrix3::identity() + b * quadrupole(x, r)
    }

    /// Cauchy stress, Pa: the mean stress plus `2 mu B / r^3 (I - 3 n n^T)`. Hooke's law would lose digits as
    /// nu nears 0.5.
    fn stress(&self, x: &Point3) -> Matrix3 {
        let r = x.coords.norm();
        self.mean_stress * Matrix3::identity() + 0.5 * self.source / r.powi(3) * quadrupole(x, r)
    }
}

pub(super) const ENTRY: SolutionEntry = Entry {
    name: "thick-sphere",
    meaning: "a hollow sphere about the origin under internal and external pressure",
    source: "Lame (1852)",
    parameters: &[
        Parameter::required("inner", Dimension::Length, "inner radius"),
        Parameter::required("outer", Dimension::Length, "outer radius"),
        Parameter::default("inner_pressure", Dimension::Pressure, 0.0, "pressure on the inner wall"),
        Parameter::default("outer_pressure", Dimension::Pressure, 0.0, "pressure on the outer wall"),
    ],
    build: |medium, values| {
        let radii = numbers(values, ["inner", "outer"])?;
        let pressures = numbers(values, ["inner_pressure", "outer_pressure"])?;
        Ok(Box::new(ThickSphere::new(medium.elastic, radii, pressures)?))
    },
};
