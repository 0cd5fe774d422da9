//! Demiray's law, the isotropic form of Fung's exponential law.

use catalogue::{Build, Dimension, Entry, Parameter, Range};

use super::isochoric::{Isochoric, Slopes};
use super::moduli::{EITHER, either};
use crate::error::MaterialError;

/// Demiray's law `W = mu/(2 b) (exp(b (J^(-2/3) I1 - 3)) - 1) + kappa/2 (J - 1)^2`; moduli in Pa.
///
/// The stiffness of tissue grows exponentially with its strain. Source: Demiray, J. Biomech. 5 (1972)
/// 309-311.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FungDemiray {
    mu: f64,
    bulk: f64,
    b: f64,
}

pub(super) const ENTRY: Entry<Build<FungDemiray>> = Entry {
    name: "fung-demiray",
    meaning: "mu/(2 b) (exp(b (J^(-2/3) I1 - 3)) - 1) + kappa/2 (J - 1)^2, stiffening exponentially",
    source: "Demiray, J. Biomech. 5 (1972) 309-311",
    parameters: &[
        EITHER[0],
        EITHER[1],
        EITHER[2],
        EITHER[3],
        Parameter::required("b", Dimension::None, "exponent of the stiffening").within(Range::Positive),
    ],
    build: |values| {
        let (mu, bulk) = either(values)?;
        Ok(FungDemiray::new(mu, bulk, values.number("b")?)?)
    },
};

impl FungDemiray {
    /// Builds the law from shear and bulk modulus (Pa, positive) and the exponent `b` (positive).
    pub fn new(mu: f64, bulk: f64, b: f64) -> Result<FungDemiray, MaterialError> {
        MaterialError::check_moduli(mu, bulk)?;
        MaterialError::check_positive("b", b)?;
        Ok(FungDemiray { mu, bulk, b })
    }

    /// Exponent `b`.
    pub fn b(&self) -> f64 {
        self.b
    }
}

impl Isochoric for FungDemiray {
    fn kappa(&self) -> f64 {
        self.bulk
    }

    fn of_shape(&self) -> FungDemiray {
        FungDemiray { bulk: 0.0, ..*self }
    }

    fn shape_energy(&self, a: f64, _b: f64) -> f64 {
        0.5 * self.mu / self.b * (self.b * a).exp_m1()
    }

    fn slopes(&self, a: f64, _b: f64) -> Slopes {
        let first = 0.5 * self.mu * (self.b * a).exp();
        Slopes { first: [first, 0.0], second: [self.b * first, 0.0, 0.0] }
    }
}
