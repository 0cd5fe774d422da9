//! Free-slip compression: a prism or cylinder shortened between frictionless plates.
//!
//! ```text
//! Source      Hooke's law; the homogeneous state of any textbook.
//!
//!   z   ======= plate =======
//!   |     |           |  ^
//!   |     |           |  |  h -> h (1 - e)     sides free, plates slip
//!   +--   |           |  |
//!       ======= plate =======                  z = 0 stays
//!
//! Field       u = (nu e x, nu e y, -e z),   sigma_zz = -E e, all else zero.
//! Conditions  u_z = 0 on z = 0 and u_z = -e h on z = h (or the pressure E e); the axis cannot drift or turn.
//! Must hold   every consistent method returns it to rounding at every nu; the plate force is E e times the
//!             area.
//! ```

use catalogue::{Dimension, Entry, Parameter};

use super::elastic::Elastic;
use super::solution::{Exact, SolutionEntry};
use super::vectors::{Matrix3, Point3, Vector3};

/// Homogeneous uniaxial stress along z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UniaxialCompression {
    elastic: Elastic,
    strain: f64,
}

impl UniaxialCompression {
    /// The state with a shortening `e` per unit height; a negative value stretches.
    pub fn new(elastic: Elastic, strain: f64) -> UniaxialCompression {
        UniaxialCompression { elastic, strain }
    }

    fn stretches(&self) -> Vector3 {
        let lateral = self.elastic.poisson() * self.strain;
        Vector3::new(lateral, lateral, -self.strain)
    }
}

impl Exact for UniaxialCompression {
    fn displacement(&self, x: &Point3) -> Vector3 {
        self.stretches().component_mul(&x.coords)
    }

    fn gradient(&self, _x: &Point3) -> Matrix3 {
        Matrix3::from_diagonal(&self.stretches())
    }

    /// Cauchy stress `sigma_zz = -E e`, Pa, in closed form: Hooke's law loses digits as nu nears 0.5.
    fn stress(&self, _x: &Point3) -> Matrix3 {
        Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, -self.elastic.young() * self.strain))
    }
}

pub(super) const ENTRY: SolutionEntry = Entry {
    name: "uniaxial-compression",
    meaning: "a prism shortened along z between frictionless plates",
    source: "textbook solution",
    parameters: &[Parameter::required(
        "strain",
        Dimension::None,
        "shortening per unit height along z, positive in compression",
    )],
    build: |medium, values| Ok(Box::new(UniaxialCompression::new(medium.elastic, values.number("strain")?))),
};
