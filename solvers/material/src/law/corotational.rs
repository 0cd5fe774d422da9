//! Corotational law: Hooke's law in the stretches.

use catalogue::{Build, Entry};
use shape::Matrix3;

use super::linear::LinearElastic;
use super::moduli::{MODULI, moduli};
use crate::error::MaterialError;
use crate::material::{Material, Tangent};
use crate::principal::{Principal, Slopes, sinh_over};

/// Corotational law `W = mu sum_a (s_a - 1)^2 + lambda/2 (s_1 + s_2 + s_3 - 3)^2` with the principal stretches
/// `s_a`; moduli in Pa.
///
/// Simulators solve this law: linear elasticity in the frame that rotates with the tissue. SOFA calls it
/// "polar". Nothing prevents `J` from reaching 0. Source: Chao, Pinkall, Sanan and Schroder, ACM Trans. Graph.
/// 29 (2010) 38.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corotational {
    mu: f64,
    lambda: f64,
}

pub(super) const ENTRY: Entry<Build<Corotational>> = Entry {
    name: "corotational",
    meaning: "mu sum (s_a - 1)^2 + lambda/2 (s_1 + s_2 + s_3 - 3)^2, s_a principal stretches: as in simulators",
    source: "Chao, Pinkall, Sanan and Schroder, ACM Trans. Graph. 29 (2010) 38",
    parameters: MODULI,
    build: |values| {
        let (young, poisson) = moduli(values)?;
        Ok(Corotational::new(young, poisson)?)
    },
};

impl Corotational {
    /// Builds the law from Young's modulus (Pa, positive) and Poisson's ratio (-1 < nu < 0.5).
    pub fn new(young: f64, poisson: f64) -> Result<Corotational, MaterialError> {
        let hooke = LinearElastic::new(young, poisson)?;
        Ok(Corotational { mu: hooke.mu(), lambda: hooke.lambda() })
    }

    /// Returns `tau_a = s_a (2 mu (s_a - 1) + lambda (s_1 + s_2 + s_3 - 3))`.
    fn kirchhoff(&self, principal: &Principal) -> [f64; 3] {
        let grown = principal.log.map(f64::exp_m1);
        let sum: f64 = grown.iter().sum();
        grown.map(|g| (1.0 + g) * (2.0 * self.mu * g + self.lambda * sum))
    }

    fn slopes(&self, principal: &Principal) -> Slopes {
        let e = principal.log;
        let grown = e.map(f64::exp_m1);
        let sum: f64 = grown.iter().sum();
        let (mut slope, mut quotient) = ([[0.0; 3]; 3], [0.0; 3]);
        for a in 0..3 {
            let s = 1.0 + grown[a];
            for b in 0..3 {
                slope[a][b] = self.lambda * s * (1.0 + grown[b]);
            }
            slope[a][a] += s * (2.0 * self.mu * (grown[a] + s) + self.lambda * sum);
            let (b, c) = ((a + 1) % 3, (a + 2) % 3);
            let stretches = (0.5 * (e[b] + e[c])).exp() * sinh_over(0.5 * (e[b] - e[c]));
            quotient[a] = stretches * (2.0 * self.mu * (1.0 + grown[b] + grown[c]) + self.lambda * sum);
        }
        Slopes { slope, quotient }
    }
}

impl Material for Corotational {
    fn energy(&self, H: &Matrix3) -> f64 {
        let grown = Principal::new(H).log.map(f64::exp_m1);
        let sum: f64 = grown.iter().sum();
        self.mu * grown.iter().map(|g| g * g).sum::<f64>() + 0.5 * self.lambda * sum * sum
    }

    fn stress(&self, H: &Matrix3) -> Matrix3 {
        let principal = Principal::new(H);
        principal.stress(H, &self.kirchhoff(&principal))
    }

    fn tangent(&self, H: &Matrix3) -> Tangent {
        let principal = Principal::new(H);
        principal.tangent(H, &self.kirchhoff(&principal), &self.slopes(&principal))
    }

    fn mu(&self) -> f64 {
        self.mu
    }

    fn lambda(&self) -> f64 {
        self.lambda
    }
}
