//! Kinematic quantities common to the laws, computed from a displacement gradient without cancellation at
//! small strain.

use shape::Matrix3;

use super::differences::less_ln_1p;
use super::material::Tangent;

/// Returns the cofactor matrix `cof A = d(det A)/dA`, so `A^-T = cof A / det A`.
pub(super) fn cofactor(A: &Matrix3) -> Matrix3 {
    let (a, b, c) = (A.column(0), A.column(1), A.column(2));
    Matrix3::from_columns(&[b.cross(&c), c.cross(&a), a.cross(&b)])
}

/// Returns the Green-Lagrange strain `E = (H + H^T + H^T H) / 2`.
pub(super) fn green_lagrange(H: &Matrix3) -> Matrix3 {
    (H + H.transpose() + H.transpose() * H) * 0.5
}

/// Returns `J - 1 = tr H + II(H) + det H`, at small strain to as many digits as `H` has.
#[inline]
pub fn volume_change(H: &Matrix3) -> f64 {
    let cof = cofactor(H);
    H.trace() + cof.trace() + H.column(0).dot(&cof.column(0))
}

/// `F`, `F^-T` and `J`, with separate values of the differences that vanish at `H = 0`.
pub(super) struct Kinematics {
    /// `F = I + H`.
    pub F: Matrix3,
    /// `G = F^-T`.
    pub G: Matrix3,
    /// `F - F^-T`.
    pub F_less_G: Matrix3,
    /// `cof F - I = tr(H) I - H^T + cof H`.
    cof_less_I: Matrix3,
    /// `J - 1`.
    pub j: f64,
    /// `I1 - 3 = tr(F^T F) - 3 = 2 tr H + H : H`.
    pub i1: f64,
    /// `H : H`.
    pub square: f64,
    /// Second invariant of `H`.
    pub second: f64,
    /// `det H`.
    pub third: f64,
}

impl Kinematics {
    pub(super) fn new(H: &Matrix3) -> Kinematics {
        let cof = cofactor(H);
        let trace = H.trace();
        let square = H.norm_squared();
        let second = cof.trace();
        let third = H.column(0).dot(&cof.column(0));
        let j = trace + second + third;
        let per_j = 1.0 / (1.0 + j);
        let cof_less_I = Matrix3::identity() * trace - H.transpose() + cof;
        let G = (Matrix3::identity() + cof_less_I) * per_j;
        // I - F^-T = (J I - cof F) / J; in the numerator tr H cancels.
        let F_less_G = H + (H.transpose() + Matrix3::identity() * (second + third) - cof) * per_j;
        Kinematics {
            F: Matrix3::identity() + H,
            G,
            F_less_G,
            cof_less_I,
            j,
            i1: 2.0 * trace + square,
            square,
            second,
            third,
        }
    }

    /// Returns `ln J`; NaN for `J < 0`.
    pub(super) fn ln_j(&self) -> f64 {
        self.j.ln_1p()
    }

    /// Returns `I2 - 3`, with `I2 = ((tr C)^2 - tr C^2) / 2 = |cof F|^2`.
    pub(super) fn i2(&self) -> f64 {
        2.0 * self.cof_less_I.trace() + self.cof_less_I.norm_squared()
    }

    /// Returns `ln(I2 J^(-4/3) / 3)`; the first-order terms of the difference are removed analytically.
    pub(super) fn ln_i2_bar(&self) -> f64 {
        // With K = cof F - I: (I2 - 3) - 4 (J - 1) = K : K - 2 II - 4 III.
        let square = self.cof_less_I.norm_squared();
        (square - 2.0 * self.second - 4.0 * self.third) / 3.0 - less_ln_1p(self.i2() / 3.0)
            + 4.0 / 3.0 * less_ln_1p(self.j)
    }

    /// Returns `ln(I1 J^(-2/3) / 3)`; the first-order terms of the difference are removed analytically.
    pub(super) fn ln_i1_bar(&self) -> f64 {
        // (I1 - 3) - 2 (J - 1) = H : H - 2 II - 2 III.
        (self.square - 2.0 * (self.second + self.third)) / 3.0 - less_ln_1p(self.i1 / 3.0)
            + 2.0 / 3.0 * less_ln_1p(self.j)
    }
}

/// Returns the tangent with the entries `dP_ij/dF_kl = entry(i, j, k, l)`.
#[inline(always)]
pub(super) fn tangent_of(entry: impl Fn(usize, usize, usize, usize) -> f64) -> Tangent {
    let mut tangent = Tangent::zeros();
    for l in 0..3 {
        for k in 0..3 {
            let mut column = tangent.column_mut(k + 3 * l);
            for j in 0..3 {
                for i in 0..3 {
                    column[i + 3 * j] = entry(i, j, k, l);
                }
            }
        }
    }
    tangent
}

/// Adds `delta_ik M_jl`, the derivative of `F M` at constant symmetric `M`.
pub(super) fn add_right(tangent: &mut Tangent, M: &Matrix3) {
    for l in 0..3 {
        for j in 0..3 {
            for i in 0..3 {
                tangent[(i + 3 * j, i + 3 * l)] += M[(j, l)];
            }
        }
    }
}

/// Adds `M_ik delta_jl`, the derivative of `M F` at constant `M`.
pub(super) fn add_left(tangent: &mut Tangent, M: &Matrix3) {
    for j in 0..3 {
        for k in 0..3 {
            for i in 0..3 {
                tangent[(i + 3 * j, k + 3 * j)] += M[(i, k)];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn volume_change_of_a_tiny_gradient_is_its_trace() {
        let H = Matrix3::new(1e-13, 2e-13, 0.0, -3e-13, 2e-13, 1e-13, 0.0, 0.0, 4e-13);
        assert!((volume_change(&H) - 7e-13).abs() < 1e-24);
        let H = Matrix3::new(0.1, 0.2, -0.3, 0.0, -0.4, 0.1, 0.2, 0.3, 0.5);
        assert!((volume_change(&H) + 1.0 - (Matrix3::identity() + H).determinant()).abs() < 1e-15);
    }
}
