//! Yeoh's law, a polynomial of the first invariant.

use catalogue::{Build, Dimension, Entry, Kind, Parameter, Problem};

use super::isochoric::{Isochoric, Slopes};
use super::moduli::{VOLUME, volume};
use crate::error::MaterialError;

/// Yeoh's law `W = sum_i c_i (J^(-2/3) I1 - 3)^i + kappa/2 (J - 1)^2`; constants in Pa.
///
/// The shear modulus at small strain is `2 c_1`. Source: Yeoh, Rubber Chem. Technol. 66 (1993) 754-771.
#[derive(Clone, Debug, PartialEq)]
pub struct Yeoh {
    constants: Vec<f64>,
    bulk: f64,
}

pub(super) const ENTRY: Entry<Build<Yeoh>> = Entry {
    name: "yeoh",
    meaning: "sum c_i (J^(-2/3) I1 - 3)^i + kappa/2 (J - 1)^2: takes c = [c_1, c_2, ...]",
    source: "Yeoh, Rubber Chem. Technol. 66 (1993) 754-771",
    parameters: &[
        Parameter::required("c", Dimension::Pressure, "constant of each power, from 1 on").of(Kind::List),
        VOLUME[0],
        VOLUME[1],
    ],
    build: |values| {
        let constants = values.list("c").unwrap_or_default();
        let mu = 2.0 * constants.first().copied().unwrap_or(0.0);
        if !(mu > 0.0) {
            return Err(Problem::new("does not give a positive shear modulus")
                .help("the first constant, which is half the shear modulus, must be positive")
                .of("c"));
        }
        Ok(Yeoh::new(constants, volume(values, mu)?)?)
    },
};

impl Yeoh {
    /// Builds the law from the constants of the powers 1, 2, ... (Pa; the first positive) and the bulk modulus
    /// (Pa, positive).
    pub fn new(constants: &[f64], bulk: f64) -> Result<Yeoh, MaterialError> {
        MaterialError::check_moduli(2.0 * constants.first().copied().unwrap_or(0.0), bulk)?;
        Ok(Yeoh { constants: constants.to_vec(), bulk })
    }

    /// Constants of the powers 1, 2, ..., Pa.
    pub fn constants(&self) -> &[f64] {
        &self.constants
    }
}

impl Isochoric for Yeoh {
    fn kappa(&self) -> f64 {
        self.bulk
    }

    fn of_shape(&self) -> Yeoh {
        Yeoh { bulk: 0.0, ..self.clone() }
    }

    fn shape_energy(&self, a: f64, _b: f64) -> f64 {
        self.constants.iter().rev().fold(0.0, |sum, c| (sum + c) * a)
    }

    fn slopes(&self, a: f64, _b: f64) -> Slopes {
        // Horner's scheme for the slope `sum_i i c_i a^(i - 1)` and its derivative.
        let (mut first, mut second) = (0.0, 0.0);
        for (k, c) in self.constants.iter().enumerate().rev() {
            second = second * a + first;
            first = first * a + (k + 1) as f64 * c;
        }
        Slopes { first: [first, 0.0], second: [second, 0.0, 0.0] }
    }
}
