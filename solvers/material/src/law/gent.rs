//! Gent's law of limited extension.

use catalogue::{Build, Dimension, Entry, Parameter, Range};

use super::isochoric::{Isochoric, Slopes};
use super::moduli::{EITHER, either};
use crate::error::MaterialError;

/// Gent's law `W = -mu jm/2 ln(1 - (J^(-2/3) I1 - 3) / jm) + kappa/2 (J - 1)^2`; moduli in Pa.
///
/// No state with `J^(-2/3) I1 - 3 >= jm` has a finite energy; the values there are not numbers. For large `jm`
/// this is the isochoric neo-Hookean law. Source: Gent, Rubber Chem. Technol. 69 (1996) 59-61.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gent {
    mu: f64,
    bulk: f64,
    jm: f64,
}

pub(super) const ENTRY: Entry<Build<Gent>> = Entry {
    name: "gent",
    meaning: "-mu jm/2 ln(1 - (J^(-2/3) I1 - 3) / jm) + kappa/2 (J - 1)^2, of limited extension",
    source: "Gent, Rubber Chem. Technol. 69 (1996) 59-61",
    parameters: &[
        EITHER[0],
        EITHER[1],
        EITHER[2],
        EITHER[3],
        Parameter::required("jm", Dimension::None, "limit of J^(-2/3) I1 - 3").within(Range::Positive),
    ],
    build: |values| {
        let (mu, bulk) = either(values)?;
        Ok(Gent::new(mu, bulk, values.number("jm")?)?)
    },
};

impl Gent {
    /// Builds the law from shear and bulk modulus (Pa, positive) and the limit `jm` (positive).
    pub fn new(mu: f64, bulk: f64, jm: f64) -> Result<Gent, MaterialError> {
        MaterialError::check_moduli(mu, bulk)?;
        MaterialError::check_positive("jm", jm)?;
        Ok(Gent { mu, bulk, jm })
    }

    /// Limit `jm`.
    pub fn jm(&self) -> f64 {
        self.jm
    }
}

impl Isochoric for Gent {
    fn kappa(&self) -> f64 {
        self.bulk
    }

    fn of_shape(&self) -> Gent {
        Gent { bulk: 0.0, ..*self }
    }

    fn shape_energy(&self, a: f64, _b: f64) -> f64 {
        -0.5 * self.mu * self.jm * (-a / self.jm).ln_1p()
    }

    fn slopes(&self, a: f64, _b: f64) -> Slopes {
        let left = 1.0 - a / self.jm;
        // Beyond the limit the slopes are finite, but there is no state.
        let first = if left > 0.0 { 0.5 * self.mu / left } else { f64::NAN };
        Slopes { first: [first, 0.0], second: [first / (self.jm * left), 0.0, 0.0] }
    }
}
