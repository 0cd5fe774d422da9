//! Blatz-Ko law of a foamed rubber.

use catalogue::{Build, Entry};
use shape::Matrix3;

use super::linear::LinearElastic;
use super::moduli::{MODULI, moduli};
use crate::error::MaterialError;
use crate::differences::exp_m1_less;
use crate::kinematics::{Kinematics, cofactor, green_lagrange, tangent_of};
use crate::material::{Material, Tangent};

/// Blatz-Ko law `W = mu/2 (tr C^-1 - 3 + (J^(2 beta) - 1) / beta)` with `beta = nu / (1 - 2 nu)`; moduli in Pa.
///
/// For `nu = 1/4` this is `mu/2 (I2/I3 + 2 sqrt(I3) - 5)`, the law of a polyurethane foam. It suits strongly
/// compressible tissue such as lung. Source: Blatz and Ko, Trans. Soc. Rheol. 6 (1962) 223-251, with f = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlatzKo {
    mu: f64,
    beta: f64,
}

pub(super) const ENTRY: Entry<Build<BlatzKo>> = Entry {
    name: "blatz-ko",
    meaning: "mu/2 (tr C^-1 - 3 + (J^(2 beta) - 1) / beta), beta = nu / (1 - 2 nu): foams and lung",
    source: "Blatz and Ko, Trans. Soc. Rheol. 6 (1962) 223-251",
    parameters: MODULI,
    build: |values| {
        let (young, poisson) = moduli(values)?;
        Ok(BlatzKo::new(young, poisson)?)
    },
};

impl BlatzKo {
    /// Builds the law from Young's modulus (Pa, positive) and Poisson's ratio (-1 < nu < 0.5).
    pub fn new(young: f64, poisson: f64) -> Result<BlatzKo, MaterialError> {
        let hooke = LinearElastic::new(young, poisson)?;
        Ok(BlatzKo { mu: hooke.mu(), beta: poisson / (1.0 - 2.0 * poisson) })
    }

    /// Returns `J^(2 beta) - 1`.
    fn grown(&self, k: &Kinematics) -> f64 {
        (2.0 * self.beta * k.ln_j()).exp_m1()
    }
}

impl Material for BlatzKo {
    /// With `y = ln(J^(-4/3) I2 / 3)` and `L = ln J`, `tr C^-1 = 3 exp(y - 2/3 L)`: the first-order terms of
    /// the two parts cancel and are left out.
    fn energy(&self, H: &Matrix3) -> f64 {
        let k = Kinematics::new(H);
        let (y, log) = (k.ln_i2_bar(), k.ln_j());
        let of_volume =
            if self.beta == 0.0 { 0.0 } else { exp_m1_less(2.0 * self.beta * log) / self.beta };
        0.5 * self.mu * (3.0 * y + 3.0 * exp_m1_less(y - 2.0 / 3.0 * log) + of_volume)
    }

    /// Returns `mu (J^(2 beta) G - G G^T G) = mu ((J^(2 beta) - 1) G + G D)` with `G = F^-T` and
    /// `D = I - C^-1`.
    fn stress(&self, H: &Matrix3) -> Matrix3 {
        let k = Kinematics::new(H);
        let I = Matrix3::identity();
        let E = green_lagrange(H);
        let cof = cofactor(&E);
        let (two, three) = (cof.trace(), E.column(0).dot(&cof.column(0)));
        let J = 1.0 + k.j;
        // As in the Mooney-Rivlin law.
        let D = (E * 2.0 - cof * 4.0 + I * (4.0 * two + 8.0 * three)) / (J * J);
        k.G * (D + I * self.grown(&k)) * self.mu
    }

    /// Returns, with `M = G G^T G`, `B = G G^T`, `C^-1 = G^T G` and `s = J^(2 beta)`,
    /// `mu (2 beta s G_ij G_kl - s G_il G_kj + G_il M_kj + M_il G_kj + B_ik C^-1_lj)`.
    fn tangent(&self, H: &Matrix3) -> Tangent {
        let k = Kinematics::new(H);
        let G = &k.G;
        let (B, inverse) = (G * G.transpose(), G.transpose() * G);
        let M = B * G;
        let s = 1.0 + self.grown(&k);
        let outer = 2.0 * self.beta * s;
        tangent_of(|i, j, k, l| {
            self.mu
                * (outer * G[(i, j)] * G[(k, l)] - s * G[(i, l)] * G[(k, j)]
                    + G[(i, l)] * M[(k, j)]
                    + M[(i, l)] * G[(k, j)]
                    + B[(i, k)] * inverse[(l, j)])
        })
    }

    fn mu(&self) -> f64 {
        self.mu
    }

    fn lambda(&self) -> f64 {
        2.0 * self.mu * self.beta
    }
}
