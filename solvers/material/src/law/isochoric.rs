//! Laws of the isochoric invariants: `W = f(a, b) + kappa/2 (J - 1)^2` with `a = J^(-2/3) I1 - 3` and
//! `b = J^(-4/3) I2 - 3`.
//!
//! The stress is that of a Mooney-Rivlin law whose constants are the slopes of `f`; the tangent has the second
//! derivatives of `f` in addition. A law gives only `f`.

use shape::Matrix3;

use super::mooney_rivlin::MooneyRivlin;
use crate::kinematics::Kinematics;
use crate::material::{Material, Tangent};
use crate::separated::Separated;
use crate::volumetric::Volumetric;

/// Derivatives of `f(a, b)`, Pa.
pub(super) struct Slopes {
    /// `df/da` and `df/db`.
    pub first: [f64; 2],
    /// `d2f/da2`, `d2f/da db` and `d2f/db2`.
    pub second: [f64; 3],
}

/// A law of the isochoric invariants.
pub(super) trait Isochoric: Clone {
    /// Bulk modulus `kappa`, Pa.
    fn kappa(&self) -> f64;

    /// Returns the law without its volumetric energy.
    fn of_shape(&self) -> Self;

    /// Returns `f(a, b)`, J/m^3.
    fn shape_energy(&self, a: f64, b: f64) -> f64;

    /// Returns the derivatives of `f` at `(a, b)`.
    fn slopes(&self, a: f64, b: f64) -> Slopes;
}

/// Returns `a` and `b`, to as many digits as `H` has at small strain.
fn invariants(H: &Matrix3) -> [f64; 2] {
    let k = Kinematics::new(H);
    [3.0 * k.ln_i1_bar().exp_m1(), 3.0 * k.ln_i2_bar().exp_m1()]
}

impl<T: Isochoric> Material for T {
    fn energy(&self, H: &Matrix3) -> f64 {
        let [a, b] = invariants(H);
        let j = Kinematics::new(H).j;
        self.shape_energy(a, b) + 0.5 * self.kappa() * j * j
    }

    fn stress(&self, H: &Matrix3) -> Matrix3 {
        let [a, b] = invariants(H);
        MooneyRivlin::with_slopes(self.slopes(a, b).first, self.kappa()).stress(H)
    }

    fn tangent(&self, H: &Matrix3) -> Tangent {
        self.stress_and_tangent(H).1
    }

    fn stress_and_tangent(&self, H: &Matrix3) -> (Matrix3, Tangent) {
        let [a, b] = invariants(H);
        let Slopes { first, second: [aa, ab, bb] } = self.slopes(a, b);
        let (stress, mut tangent) = MooneyRivlin::with_slopes(first, self.kappa()).stress_and_tangent(H);
        // da/dF and db/dF.
        let [A, B] = [[1.0, 0.0], [0.0, 1.0]].map(|unit| MooneyRivlin::with_slopes(unit, 0.0).stress(H));
        for n in 0..9 {
            for m in 0..9 {
                tangent[(m, n)] += aa * A[m] * A[n] + ab * (A[m] * B[n] + B[m] * A[n]) + bb * B[m] * B[n];
            }
        }
        (stress, tangent)
    }

    fn split(&self) -> Option<(T, Volumetric)> {
        Some((self.of_shape(), Volumetric::quadratic(self.kappa())))
    }

    fn separated(&self, theta_minus_1: f64) -> Option<Separated> {
        Some(Separated::of_volume(Volumetric::quadratic(self.kappa()), theta_minus_1))
    }

    fn mu(&self) -> f64 {
        let [a, b] = self.slopes(0.0, 0.0).first;
        2.0 * (a + b)
    }

    fn lambda(&self) -> f64 {
        self.kappa() - 2.0 / 3.0 * Material::mu(self)
    }
}
