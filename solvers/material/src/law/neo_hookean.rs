//! Compressible neo-Hookean law in `I1` and `ln J`.

use catalogue::{Build, Entry};
use lanes::LANES;
use shape::Matrix3;

use super::linear::LinearElastic;
use super::moduli::{MODULI, moduli};
use crate::error::MaterialError;
use crate::differences::less_ln_1p;
use crate::kinematics::{Kinematics, tangent_of};
use crate::lane::invariants::piola;
use crate::lane::{LaneStrain, Lanes};
use crate::material::{Material, Tangent};
use crate::separated::Separated;

/// Compressible neo-Hookean law `W = mu/2 (I1 - 3 - 2 ln J) + lambda/2 (ln J)^2` with `I1 = tr(F^T F)`;
/// moduli in Pa.
///
/// `P = mu (F - F^-T) + lambda ln(J) F^-T`. Shape and volume are not split: `mu` acts on `I1` itself, and the
/// volumetric part `(ln J)^2` flattens beyond `J = e`. In Abaqus and CalculiX, "neo-Hookean" means the split
/// form, [`NeoHookeanIsochoric`](super::NeoHookeanIsochoric). The two laws agree only to first order in the
/// strain. Source: Bonet and Wood, Nonlinear Continuum Mechanics for Finite Element Analysis, 2nd ed.,
/// section 6.4.3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeoHookean {
    mu: f64,
    lambda: f64,
}

pub(super) const ENTRY: Entry<Build<NeoHookean>> = Entry {
    name: "neo-hookean",
    meaning: "mu/2 (I1 - 3 - 2 ln J) + lambda/2 (ln J)^2",
    source: "Bonet and Wood, Nonlinear Continuum Mechanics for Finite Element Analysis, 2nd ed., section 6.4.3",
    parameters: MODULI,
    build: |values| {
        let (young, poisson) = moduli(values)?;
        Ok(NeoHookean::new(young, poisson)?)
    },
};

impl NeoHookean {
    /// Builds the law from Young's modulus (Pa, positive) and Poisson's ratio (-1 < nu < 0.5).
    pub fn new(young: f64, poisson: f64) -> Result<NeoHookean, MaterialError> {
        let hooke = LinearElastic::new(young, poisson)?;
        Ok(NeoHookean { mu: hooke.mu(), lambda: hooke.lambda() })
    }

    fn stress_at(&self, k: &Kinematics, ln_j: f64) -> Matrix3 {
        k.F_less_G * self.mu + k.G * (self.lambda * ln_j)
    }

    /// Returns `mu delta_ik delta_jl + (mu - lambda ln J) G_il G_kj + lambda G_ij G_kl` with `G = F^-T`.
    fn tangent_at(&self, k: &Kinematics, ln_j: f64) -> Tangent {
        let G = &k.G;
        let swap = self.mu - self.lambda * ln_j;
        let mut tangent =
            tangent_of(|i, j, k, l| swap * G[(i, l)] * G[(k, j)] + self.lambda * G[(i, j)] * G[(k, l)]);
        for n in 0..9 {
            tangent[(n, n)] += self.mu;
        }
        tangent
    }
}

impl Material for NeoHookean {
    fn energy(&self, H: &Matrix3) -> f64 {
        let k = Kinematics::new(H);
        // I1 - 3 - 2 (J - 1) has no first-order term: H : H - 2 II(H) - 2 det H.
        let shape = k.square - 2.0 * (k.second + k.third) + 2.0 * less_ln_1p(k.j);
        0.5 * (self.mu * shape + self.lambda * k.ln_j().powi(2))
    }

    fn stress(&self, H: &Matrix3) -> Matrix3 {
        let k = Kinematics::new(H);
        self.stress_at(&k, k.ln_j())
    }

    fn tangent(&self, H: &Matrix3) -> Tangent {
        let k = Kinematics::new(H);
        self.tangent_at(&k, k.ln_j())
    }

    fn stress_and_tangent(&self, H: &Matrix3) -> (Matrix3, Tangent) {
        let k = Kinematics::new(H);
        let ln_j = k.ln_j();
        (self.stress_at(&k, ln_j), self.tangent_at(&k, ln_j))
    }

    #[inline(always)]
    fn stress_lanes<const FMA: bool>(&self, strain: &LaneStrain, p: &mut [Lanes; 9]) {
        for l in 0..LANES {
            let (x, minors) = strain.invariants(l);
            let stress = piola::<FMA, _>(&strain.lane(l), minors, x.stress::<FMA>(1.0, self.mu, self.lambda));
            for k in 0..9 {
                p[k][l] = stress[k];
            }
        }
    }

    /// Returns `mu/2 theta^(2/3) I1_bar`, and the part of the energy in addition to `psi(F, 1)`:
    /// `3 mu/2 (theta^(2/3) - 1) - mu ln theta + lambda/2 (ln theta)^2`.
    fn separated(&self, theta_minus_1: f64) -> Option<Separated> {
        let mu = self.mu;
        let lambda = self.lambda;
        let theta = 1.0 + theta_minus_1;
        let log = theta_minus_1.ln_1p();
        let grown = (2.0 / 3.0 * log).exp_m1();
        let A = 1.0 + grown;
        let slope = mu * grown + lambda * log;
        Some(Separated {
            A: [A, 2.0 / 3.0 * A / theta, -2.0 / 9.0 * A / (theta * theta)],
            U: [
                1.5 * mu * less_ln_1p(grown) + 0.5 * lambda * log * log,
                slope / theta,
                (2.0 / 3.0 * mu * A + lambda - slope) / (theta * theta),
            ],
        })
    }

    fn mu(&self) -> f64 {
        self.mu
    }

    fn lambda(&self) -> f64 {
        self.lambda
    }
}
