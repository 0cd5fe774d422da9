//! Stable neo-Hookean law of simulators, in `I1` and `J`.

use catalogue::{Build, Entry};
use lanes::LANES;
use shape::Matrix3;

use super::linear::LinearElastic;
use super::moduli::{MODULI, moduli};
use crate::differences::less_ln_1p;
use crate::error::MaterialError;
use crate::kinematics::{cofactor, tangent_of, volume_change};
use crate::lane::invariants::piola;
use crate::lane::{LaneStrain, Lanes};
use crate::material::{Material, Tangent};
use crate::separated::Separated;

/// Stable neo-Hookean law `W = mu/2 (I1 - 3) + (lambda + mu)/2 (J - 1 - mu/(lambda + mu))^2`, less its value
/// at `F = I`; `lambda` and `mu` are the moduli at small strain, Pa.
///
/// Vertex block descent and position-based solvers use this law, because its energy is finite for every `F`,
/// inverted ones included, and quadratic in the position of one vertex of a tetrahedron.
/// `P = mu F + ((lambda + mu) (J - 1) - mu) cof F`. Source: Smith, De Goes and Kim, ACM Trans. Graph. 37
/// (2018) 12, without the barrier against `F = 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StableNeoHookean {
    mu: f64,
    lambda: f64,
}

pub(super) const ENTRY: Entry<Build<StableNeoHookean>> = Entry {
    name: "stable-neo-hookean",
    meaning: "mu/2 (I1 - 3) + (lambda + mu)/2 (J - 1 - mu/(lambda + mu))^2: as in simulators",
    source: "Smith, De Goes and Kim, ACM Trans. Graph. 37 (2018) 12",
    parameters: MODULI,
    build: |values| {
        let (young, poisson) = moduli(values)?;
        Ok(StableNeoHookean::new(young, poisson)?)
    },
};

impl StableNeoHookean {
    /// Builds the law from Young's modulus (Pa, positive) and Poisson's ratio (-1 < nu < 0.5).
    pub fn new(young: f64, poisson: f64) -> Result<StableNeoHookean, MaterialError> {
        let hooke = LinearElastic::new(young, poisson)?;
        Ok(StableNeoHookean { mu: hooke.mu(), lambda: hooke.lambda() })
    }

    /// Modulus `lambda + mu` of the volume change, Pa.
    pub fn volumetric(&self) -> f64 {
        self.lambda + self.mu
    }
}

impl Material for StableNeoHookean {
    fn energy(&self, H: &Matrix3) -> f64 {
        // I1 - 3 - 2 (J - 1) has no first-order term: H : H - 2 II(H) - 2 det H.
        let cof = cofactor(H);
        let rest = cof.trace() + H.column(0).dot(&cof.column(0));
        let j = H.trace() + rest;
        0.5 * (self.mu * (H.norm_squared() - 2.0 * rest) + self.volumetric() * j * j)
    }

    fn stress(&self, H: &Matrix3) -> Matrix3 {
        let cof = cofactor(H);
        let (identity, trace) = (Matrix3::identity(), H.trace());
        let cof_F = identity * (1.0 + trace) - H.transpose() + cof;
        let F_less_cof = H + H.transpose() - identity * trace - cof;
        F_less_cof * self.mu + cof_F * (self.volumetric() * volume_change(H))
    }

    /// Returns `mu delta_ik delta_jl + (lambda + mu) C_ij C_kl + ((lambda + mu) (J - 1) - mu) dC_ij/dF_kl`
    /// with `C = cof F`.
    fn tangent(&self, H: &Matrix3) -> Tangent {
        let F = Matrix3::identity() + H;
        let cof = cofactor(&F);
        let swap = self.volumetric() * volume_change(H) - self.mu;
        let mut tangent = tangent_of(|i, j, k, l| {
            self.volumetric() * cof[(i, j)] * cof[(k, l)] + swap * of_cofactor(&F, [i, j], [k, l])
        });
        for n in 0..9 {
            tangent[(n, n)] += self.mu;
        }
        tangent
    }

    #[inline(always)]
    fn stress_lanes<const FMA: bool>(&self, strain: &LaneStrain, p: &mut [Lanes; 9]) {
        for l in 0..LANES {
            let (x, minors) = strain.invariants(l);
            let pressure = self.volumetric() * x.j;
            let coefficients =
                [self.mu, pressure - self.mu, pressure + (pressure - self.mu) * x.trace];
            let stress = piola::<FMA, _>(&strain.lane(l), minors, coefficients);
            for k in 0..9 {
                p[k][l] = stress[k];
            }
        }
    }

    /// Returns `mu/2 theta^(2/3) I1_bar`, and the part of the energy in addition to `psi(F, 1)`:
    /// `3 mu/2 (theta^(2/3) - 1) - mu (theta - 1) + (lambda + mu)/2 (theta - 1)^2`.
    fn separated(&self, theta_minus_1: f64) -> Option<Separated> {
        let (mu, bulk) = (self.mu, self.volumetric());
        let theta = 1.0 + theta_minus_1;
        let log = theta_minus_1.ln_1p();
        let grown = (2.0 / 3.0 * log).exp_m1();
        let A = 1.0 + grown;
        let shape = 1.5 * less_ln_1p(grown) - less_ln_1p(theta_minus_1);
        Some(Separated {
            A: [A, 2.0 / 3.0 * A / theta, -2.0 / 9.0 * A / (theta * theta)],
            U: [
                mu * shape + 0.5 * bulk * theta_minus_1 * theta_minus_1,
                mu * (-log / 3.0).exp_m1() + bulk * theta_minus_1,
                bulk - mu / 3.0 * A / (theta * theta),
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

/// Derivative of the entry `at` of `cof F` with respect to an entry of `F`: an entry of `F`, its negative, or
/// 0.
fn of_cofactor(F: &Matrix3, at: [usize; 2], by: [usize; 2]) -> f64 {
    let [i, j] = at;
    let [k, l] = by;
    if i == k || j == l {
        return 0.0;
    }
    let is_even = (k + 3 - i) % 3 == (l + 3 - j) % 3;
    let other = F[(3 - i - k, 3 - j - l)];
    if is_even { other } else { -other }
}
