//! A law with an independent dilation: `psi(F, theta) = W(F_bar)`, `F_bar = (theta / J)^(1/3) F`,
//! `J = det F`.
//!
//! Every projection of the volume change needs this form:
//!
//! - With `theta = J` it is the law itself.
//! - With `theta = 1` it is the part of the law that does not change with the volume.
//! - With the average over an element or a nodal patch it is the mean-dilation method (Simo, Taylor & Pister
//!   1985). In this form the method derives from an energy for any law, so its tangent is symmetric.
//! - With a free `theta` and a pressure it is the mixed method.
//!
//! The small-strain law uses `J = 1 + tr H` and `H_bar = H + (theta - J) I / 3` instead. Dilations are passed
//! minus one (`theta - 1`), which is exact for small strain.

use shape::Matrix3;

use crate::kinematics::{cofactor as minors, volume_change};
use crate::material::{Material, Tangent};

/// Returns `J - 1`: `tr H + second invariant + det H` of `H = grad u`, exact for small H; `tr H` at small
/// strain.
pub fn dilation(small_strain: bool, H: &Matrix3) -> f64 {
    if small_strain {
        return H.trace();
    }
    volume_change(H)
}

/// Returns `dJ/dF = J F^-T`, the cofactor matrix; the identity at small strain.
pub fn cofactor(small_strain: bool, H: &Matrix3) -> Matrix3 {
    if small_strain {
        return Matrix3::identity();
    }
    minors(&(Matrix3::identity() + H))
}

/// Adds `factor` times the second derivative of J with respect to F (9, 9) to `D`: entry (ij, kl) is
/// `e_ikm e_jln F_mn`. The derivative is zero at small strain.
pub fn add_dilation_hessian(small_strain: bool, H: &Matrix3, factor: f64, D: &mut Tangent) {
    if small_strain || factor == 0.0 {
        return;
    }
    let F = Matrix3::identity() + H;
    for (i, k, m, sign) in PERMUTATIONS {
        for (j, l, n, other) in PERMUTATIONS {
            D[(i + 3 * j, k + 3 * l)] += factor * sign * other * F[(m, n)];
        }
    }
}

/// Permutations of (0, 1, 2) with their signs.
const PERMUTATIONS: [(usize, usize, usize, f64); 6] =
    [(0, 1, 2, 1.0), (1, 2, 0, 1.0), (2, 0, 1, 1.0), (0, 2, 1, -1.0), (2, 1, 0, -1.0), (1, 0, 2, -1.0)];

/// First derivatives of `psi(F, theta)`.
pub struct First {
    /// `d psi / dF` (3, 3), Pa, which contains no pressure.
    pub by_F: Matrix3,
    /// `d psi / d theta`, Pa: the mean stress.
    pub by_theta: f64,
}

/// Second derivatives of `psi(F, theta)`.
pub struct Second {
    /// `d2 psi / dF2` (9, 9), Pa.
    pub by_FF: Tangent,
    /// `d2 psi / dF d theta` (3, 3), Pa.
    pub by_F_theta: Matrix3,
    /// `d2 psi / d theta2`, Pa: the bulk modulus at small strain.
    pub by_theta_theta: f64,
}

/// The pair (F, theta) with the quantities common to all derivatives.
pub struct Split {
    /// Displacement gradient of `F_bar`.
    H_bar: Matrix3,
    /// `F_bar`; the identity at small strain, for which the derivatives then have the same form.
    F_bar: Matrix3,
    /// `F^-T`; the identity at small strain.
    T: Matrix3,
    /// `(theta / J)^(1/3)`.
    scale: f64,
    theta: f64,
    small_strain: bool,
}

impl Split {
    /// Builds the pair from `H`, its known `J - 1`, and `theta - 1`; both dilations must be positive.
    pub fn new(law: &impl Material, H: &Matrix3, j_minus_1: f64, theta_minus_1: f64) -> Split {
        if law.is_small_strain() {
            let I = Matrix3::identity();
            let H_bar = H + I * ((theta_minus_1 - j_minus_1) / 3.0);
            return Split { H_bar, F_bar: I, T: I, scale: 1.0, theta: 1.0, small_strain: true };
        }
        // ln(theta / J) / 3 by log1p keeps the digits of the difference of two nearly equal dilations.
        let log = (theta_minus_1.ln_1p() - j_minus_1.ln_1p()) / 3.0;
        let (scale, grown) = (log.exp(), log.exp_m1());
        let F = Matrix3::identity() + H;
        let H_bar = H + F * grown;
        Split {
            H_bar,
            F_bar: Matrix3::identity() + H_bar,
            T: cofactor(false, H) / (1.0 + j_minus_1),
            scale,
            theta: 1.0 + theta_minus_1,
            small_strain: false,
        }
    }

    /// Returns the energy density `psi` of `law`, J/m^3.
    pub fn energy(&self, law: &impl Material) -> f64 {
        law.energy(&self.H_bar)
    }

    /// Returns the first derivatives of `psi(F, theta)` for `law`.
    pub fn first(&self, law: &impl Material) -> First {
        self.first_of(&law.stress(&self.H_bar))
    }

    fn first_of(&self, P: &Matrix3) -> First {
        let s = P.dot(&self.F_bar);
        First { by_F: P * self.scale - self.T * (s / 3.0), by_theta: s / (3.0 * self.theta) }
    }

    /// Returns the first and second derivatives of `psi(F, theta)` for `law`.
    pub fn second(&self, law: &impl Material) -> (First, Second) {
        let (P, A) = law.stress_and_tangent(&self.H_bar);
        let Y = unflat(&(A * flat(&self.F_bar)));
        let s = P.dot(&self.F_bar);
        let FAF = Y.dot(&self.F_bar);
        // At small strain F_bar is constant, so the terms due to its change vanish.
        let (P_term, s_term) = if self.small_strain { (Matrix3::zeros(), 0.0) } else { (P, s) };
        let c = self.scale;
        let T = &self.T;
        let theta = self.theta;
        let Z = (Y + P_term) * (c / 3.0);
        let (t, z) = (flat(T), flat(&Z));
        let mut by_FF =
            A * (c * c) - z * t.transpose() - t * z.transpose() + t * t.transpose() * ((FAF + s_term) / 9.0);
        if s_term != 0.0 {
            // (s / 3) F^-T dF^T F^-T
            for i in 0..3 {
                for j in 0..3 {
                    for k in 0..3 {
                        for l in 0..3 {
                            by_FF[(i + 3 * j, k + 3 * l)] += s_term / 3.0 * T[(i, l)] * T[(k, j)];
                        }
                    }
                }
            }
        }
        let by_F_theta = (Z * 3.0 - T * ((FAF + s_term) / 3.0)) / (3.0 * theta);
        let by_theta_theta = (FAF - 2.0 * s_term) / (9.0 * theta * theta);
        (self.first_of(&P), Second { by_FF, by_F_theta, by_theta_theta })
    }
}

/// Returns the columns of a matrix as one vector.
pub fn flat(m: &Matrix3) -> nalgebra::SVector<f64, 9> {
    nalgebra::SVector::from_column_slice(m.as_slice())
}

/// Returns the matrix whose columns are listed in a vector.
pub fn unflat(v: &nalgebra::SVector<f64, 9>) -> Matrix3 {
    Matrix3::from_column_slice(v.as_slice())
}
