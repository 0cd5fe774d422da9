//! Polynomials of the isochoric invariants.

use catalogue::{Build, Dimension, Entry, Parameter, Problem};

use super::isochoric::{Isochoric, Slopes};
use super::moduli::{VOLUME, volume};
use crate::error::MaterialError;

/// Polynomial law `W = sum_ij c_ij (J^(-2/3) I1 - 3)^i (J^(-4/3) I2 - 3)^j + kappa/2 (J - 1)^2` up to the third
/// degree; constants in Pa.
///
/// The shear modulus at small strain is `2 (c10 + c01)`. Source: Rivlin and Saunders, Phil. Trans. R. Soc. A
/// 243 (1951) 251-288; form as in the Abaqus Theory Guide.
#[derive(Clone, Debug, PartialEq)]
pub struct Polynomial {
    /// Powers `i` and `j`, and constant (Pa) of each term.
    terms: Vec<(i32, i32, f64)>,
    bulk: f64,
}

/// Powers of the terms, with their constants.
const TERMS: [(i32, i32, Parameter); 9] = [
    (1, 0, constant("c10")),
    (0, 1, constant("c01")),
    (2, 0, constant("c20")),
    (1, 1, constant("c11")),
    (0, 2, constant("c02")),
    (3, 0, constant("c30")),
    (2, 1, constant("c21")),
    (1, 2, constant("c12")),
    (0, 3, constant("c03")),
];

const fn constant(name: &'static str) -> Parameter {
    Parameter::default(name, Dimension::Pressure, 0.0, "constant of the powers in its name; 0 unless given")
}

pub(super) const ENTRY: Entry<Build<Polynomial>> = Entry {
    name: "polynomial",
    meaning: "sum c_ij (J^(-2/3) I1 - 3)^i (J^(-4/3) I2 - 3)^j + kappa/2 (J - 1)^2, up to degree 3",
    source: "Rivlin and Saunders (1951); Abaqus Theory Guide, Hyperelastic material behavior",
    parameters: &[
        TERMS[0].2, TERMS[1].2, TERMS[2].2, TERMS[3].2, TERMS[4].2, TERMS[5].2, TERMS[6].2, TERMS[7].2,
        TERMS[8].2, VOLUME[0], VOLUME[1],
    ],
    build: |values| {
        let mut terms = Vec::new();
        for (i, j, parameter) in &TERMS {
            terms.push((*i, *j, values.number(parameter.name)?));
        }
        let mu = shear(&terms);
        if !(mu > 0.0) {
            return Err(Problem::new("does not give a positive shear modulus")
                .help("c10 + c01, which is half the shear modulus, must be positive")
                .of("c10"));
        }
        Ok(Polynomial::new(terms, volume(values, mu)?)?)
    },
};

fn shear(terms: &[(i32, i32, f64)]) -> f64 {
    2.0 * terms.iter().filter(|(i, j, _)| i + j == 1).map(|term| term.2).sum::<f64>()
}

impl Polynomial {
    /// Builds the law from its terms `(i, j, c_ij)` with `i + j >= 1`, constants in Pa and `c10 + c01`
    /// positive, and the bulk modulus (Pa, positive).
    pub fn new(terms: Vec<(i32, i32, f64)>, bulk: f64) -> Result<Polynomial, MaterialError> {
        MaterialError::check_moduli(shear(&terms), bulk)?;
        Ok(Polynomial { terms: terms.into_iter().filter(|term| term.2 != 0.0).collect(), bulk })
    }

    /// Terms `(i, j, c_ij)` other than zero, Pa.
    pub fn terms(&self) -> &[(i32, i32, f64)] {
        &self.terms
    }
}

impl Isochoric for Polynomial {
    fn kappa(&self) -> f64 {
        self.bulk
    }

    fn of_shape(&self) -> Polynomial {
        Polynomial { bulk: 0.0, ..self.clone() }
    }

    fn shape_energy(&self, a: f64, b: f64) -> f64 {
        self.terms.iter().map(|&(i, j, c)| c * a.powi(i) * b.powi(j)).sum()
    }

    fn slopes(&self, a: f64, b: f64) -> Slopes {
        let mut slopes = Slopes { first: [0.0; 2], second: [0.0; 3] };
        // Value, first and second derivative of a power.
        let powers = |x: f64, n: i32| {
            let part = |k: i32, factor: i32| if n < k { 0.0 } else { f64::from(factor) * x.powi(n - k) };
            [part(0, 1), part(1, n), part(2, n * (n - 1))]
        };
        for &(i, j, c) in &self.terms {
            let (of_a, of_b) = (powers(a, i), powers(b, j));
            slopes.first[0] += c * of_a[1] * of_b[0];
            slopes.first[1] += c * of_a[0] * of_b[1];
            slopes.second[0] += c * of_a[2] * of_b[0];
            slopes.second[1] += c * of_a[1] * of_b[1];
            slopes.second[2] += c * of_a[0] * of_b[2];
        }
        slopes
    }
}
