//! Laws in principal stretches: `P` and `dP/dF` from the Kirchhoff stress as a function of logarithmic
//! stretch.

use shape::Matrix3;

use super::kinematics::{add_right, green_lagrange, volume_change};
use super::material::Tangent;
use super::spectral;

/// Principal axes and stretches of `C = F^T F = I + 2 E`.
pub(super) struct Principal {
    /// Axes `N_a`, as columns.
    axes: Matrix3,
    /// Principal Green-Lagrange strains, unordered.
    strain: [f64; 3],
    /// Squared stretches `c_a = 1 + 2 strain_a`.
    square: [f64; 3],
    /// Logarithmic principal stretches `e_a = ln(c_a) / 2`, with the eigenvalues `c_a` of `C`. They are NaN
    /// for `J <= 0`, which cannot be recognised from `C` alone.
    pub log: [f64; 3],
    /// `J - 1`.
    pub j: f64,
}

/// Derivatives of the principal Kirchhoff stresses with respect to the logarithmic stretches.
pub(super) struct Slopes {
    /// `d tau_a / d e_b`, Pa, symmetric.
    pub slope: [[f64; 3]; 3],
    /// `(tau_b - tau_c) / (e_b - e_c)`, Pa, for the pairs (1, 2), (2, 0), (0, 1), or its limit for equal
    /// stretches.
    pub quotient: [f64; 3],
}

impl Principal {
    pub(super) fn new(H: &Matrix3) -> Principal {
        let (strain, axes) = spectral::eigen(&green_lagrange(H));
        let j = volume_change(H);
        let log = if j > -1.0 { strain.map(|e| 0.5 * (2.0 * e).ln_1p()) } else { [f64::NAN; 3] };
        Principal { axes, strain, square: strain.map(|e| 1.0 + 2.0 * e), log, j }
    }

    /// Returns the second Piola-Kirchhoff stress `S = sum tau_a / c_a N_a N_a^T`.
    fn second_piola(&self, tau: &[f64; 3]) -> Matrix3 {
        let mut scaled = self.axes;
        for a in 0..3 {
            scaled.column_mut(a).scale_mut(tau[a] / self.square[a]);
        }
        scaled * self.axes.transpose()
    }

    /// Returns `P = F S` for the principal Kirchhoff stresses `tau`.
    pub(super) fn stress(&self, H: &Matrix3, tau: &[f64; 3]) -> Matrix3 {
        let S = self.second_piola(tau);
        S + H * S
    }

    /// Returns the tangent
    /// `dP/dF = delta_ik S_jl + sum_ab D_ab M_aa M_bb + sum_(a<b) theta_ab/2 (M_ab + M_ba)(M_ab + M_ba)`.
    ///
    /// Here `M_ab = (F N_a) N_b^T`, `D_ab = ds_a / dE_b` and `theta_ab = (s_a - s_b) / (E_a - E_b)`, with the
    /// principal stresses `s_a = tau_a / c_a` and strains `E_a`. `theta` is formed without division by
    /// `E_a - E_b`, so equal stretches need no special treatment. With `m = (tau_a - tau_b) / (e_a - e_b)`,
    ///
    /// ```text
    /// theta = m (e_a - e_b) / (E_a - E_b) (1/c_a + 1/c_b) / 2 - (tau_a + tau_b) / (c_a c_b)
    /// (e_a - e_b) / (E_a - E_b) = 2 / (c_a + c_b) atanh(x) / x,   x = (c_a - c_b) / (c_a + c_b)
    /// ```
    pub(super) fn tangent(&self, H: &Matrix3, tau: &[f64; 3], slopes: &Slopes) -> Tangent {
        let v = self.axes + H * self.axes;
        let c = &self.square;
        let dyad = |a: usize, b: usize| v.column(a) * self.axes.column(b).transpose();
        let mut tangent = Tangent::zeros();

        let normal = [dyad(0, 0), dyad(1, 1), dyad(2, 2)];
        for a in 0..3 {
            let mut row = Matrix3::zeros();
            for b in 0..3 {
                row += normal[b] * (slopes.slope[a][b] / (c[a] * c[b]));
            }
            row -= normal[a] * (2.0 * tau[a] / (c[a] * c[a]));
            add_dyad(&mut tangent, &row, &normal[a]);
        }
        for n in 0..3 {
            let (a, b) = ((n + 1) % 3, (n + 2) % 3);
            let x = (self.strain[a] - self.strain[b]) / (1.0 + self.strain[a] + self.strain[b]);
            let log_quotient = 2.0 / (c[a] + c[b]) * atanh_over(x);
            let product = c[a] * c[b];
            let theta = slopes.quotient[n] * log_quotient * 0.5 * (c[a] + c[b]) / product
                - (tau[a] + tau[b]) / product;
            let shear = dyad(a, b) + dyad(b, a);
            add_dyad(&mut tangent, &(shear * (0.5 * theta)), &shear);
        }
        add_right(&mut tangent, &self.second_piola(tau));
        tangent
    }
}

/// Adds `A_ij B_kl` to the tangent.
fn add_dyad(tangent: &mut Tangent, A: &Matrix3, B: &Matrix3) {
    for n in 0..9 {
        let b = B[n];
        for m in 0..9 {
            tangent[(m, n)] += A[m] * b;
        }
    }
}

/// Returns `sinh(x) / x`, 1 at 0.
pub(super) fn sinh_over(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { x.sinh() / x }
}

/// Returns `atanh(x) / x`, 1 at 0.
fn atanh_over(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { x.atanh() / x }
}
