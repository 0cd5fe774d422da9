//! Pure bending of a prism, exact in three dimensions at any Poisson's ratio.
//!
//! ```text
//! Source      Timoshenko & Goodier, Theory of Elasticity, pure bending of prismatical bars.
//!
//!   y
//!   |   .-----------------------.
//!   |  M(                       )M       curvature k = M / (E I), any section centred on the x axis
//!   +---'-----------------------'---x    whose principal axes are y and z
//!
//! Field       u = (k x y, -k/2 (x^2 + nu (y^2 - z^2)), -k nu y z),   sigma_xx = E k y, all else zero.
//! Conditions  exact displacement on x = 0, exact traction E k y on the far end; sides free; no body force.
//! Must hold   quadratic elements return it to rounding; linear ones show locking as nu -> 0.5. The mean
//!             stress is E k y / 3 for any nu, so the pressure error is well defined.
//! ```

use catalogue::{Dimension, Entry, Parameter};

use super::elastic::Elastic;
use super::solution::{Exact, SolutionEntry};
use super::vectors::{Matrix3, Point3, Vector3};

/// Bending about the z axis with constant curvature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PureBending {
    elastic: Elastic,
    curvature: f64,
}

impl PureBending {
    /// The field with curvature `k` in 1/m; a positive value stretches the side of positive y.
    pub fn new(elastic: Elastic, curvature: f64) -> PureBending {
        PureBending { elastic, curvature }
    }
}

impl Exact for PureBending {
    fn displacement(&self, p: &Point3) -> Vector3 {
        let (x, y, z, nu) = (p.x, p.y, p.z, self.elastic.poisson());
        self.curvature * Vector3::new(x * y, -0.5 * (x * x + nu * (y * y - z * z)), -nu * y * z)
    }

    fn gradient(&self, p: &Point3) -> Matrix3 {
        let (x, y, z, nu) = (p.x, p.y, p.z, self.elastic.poisson());
        #[rustfmt::skip]
        let h = Matrix3::new(
             y,       x,      0.0,
            -x, -nu * y,   nu * z,
            0.0, -nu * z, -nu * y,
        );
        self.curvature * h
    }

    /// Cauchy stress `sigma_xx = E k y`, Pa, in closed form: Hooke's law loses digits as nu nears 0.5.
    fn stress(&self, p: &Point3) -> Matrix3 {
        Matrix3::from_diagonal(&Vector3::new(self.elastic.young() * self.curvature * p.y, 0.0, 0.0))
    }
}

pub(super) const ENTRY: SolutionEntry = Entry {
    name: "pure-bending",
    meaning: "pure bending of a prism about z",
    source: "Timoshenko and Goodier, Theory of Elasticity, pure bending of prismatical bars",
    parameters: &[Parameter::required(
        "curvature",
        Dimension::Curvature,
        "curvature of the axis, bending about z",
    )],
    build: |medium, values| Ok(Box::new(PureBending::new(medium.elastic, values.number("curvature")?))),
};
