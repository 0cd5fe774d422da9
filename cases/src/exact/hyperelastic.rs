//! Isotropic hyperelastic laws in principal stretches, written out separately for the exact solutions.
//!
//! ```text
//! P_a = dW / dl_a             principal first Piola-Kirchhoff stresses for the stretches l_1, l_2, l_3
//! P   = sum_a P_a n_a N_a^T   with the spatial and material principal directions, F = sum_a l_a n_a N_a^T
//! J   = l_1 l_2 l_3
//! ```
//!
//! Source: Ogden, Non-linear Elastic Deformations (1984), ch. 4.3. Solvers work with tensors, and this file
//! works with three stretches only, so a solver's material is never judged by itself.

use super::elastic::Elastic;
use super::vectors::{Matrix3, Vector3};

/// A stored energy `W(l_1, l_2, l_3)`, Pa, with the usual constants of the law.
#[derive(Clone, Debug, PartialEq)]
pub enum Hyperelastic {
    /// `lambda/2 (tr E)^2 + mu E : E`, `E_a = (l_a^2 - 1) / 2`.
    SaintVenantKirchhoff(Elastic),
    /// `mu/2 (I1 - 3 - 2 ln J) + lambda/2 (ln J)^2`.
    NeoHookean(Elastic),
    /// `mu sum (ln l_a)^2 + lambda/2 (ln J)^2`.
    Hencky(Elastic),
    /// `C10 (J^(-2/3) I1 - 3) + C01 (J^(-4/3) I2 - 3) + kappa/2 (J - 1)^2`. With `C01 = 0` this is the
    /// isochoric neo-Hookean law.
    MooneyRivlin {
        /// `C10`, Pa.
        c10: f64,
        /// `C01`, Pa.
        c01: f64,
        /// Bulk modulus `kappa`, Pa.
        bulk: f64,
    },
    /// `sum_p mu_p / alpha_p (sum_a (J^(-1/3) l_a)^alpha_p - 3) + kappa/2 (J - 1)^2`.
    Ogden {
        /// `(mu_p, alpha_p)`, Pa and dimensionless.
        terms: Vec<(f64, f64)>,
        /// Bulk modulus `kappa`, Pa.
        bulk: f64,
    },
    /// `mu/(2 b) (exp(b (J^(-2/3) I1 - 3)) - 1) + kappa/2 (J - 1)^2`.
    FungDemiray {
        /// Shear modulus `mu`, Pa.
        mu: f64,
        /// Exponent.
        b: f64,
        /// Bulk modulus `kappa`, Pa.
        bulk: f64,
    },
    /// `-mu jm/2 ln(1 - (J^(-2/3) I1 - 3) / jm) + kappa/2 (J - 1)^2`.
    Gent {
        /// Shear modulus `mu`, Pa.
        mu: f64,
        /// Limit of `J^(-2/3) I1 - 3`.
        jm: f64,
        /// Bulk modulus `kappa`, Pa.
        bulk: f64,
    },
    /// `sum c_ij (J^(-2/3) I1 - 3)^i (J^(-4/3) I2 - 3)^j + kappa/2 (J - 1)^2`.
    Polynomial {
        /// `(i, j, c_ij)`, Pa.
        terms: Vec<(i32, i32, f64)>,
        /// Bulk modulus `kappa`, Pa.
        bulk: f64,
    },
    /// `mu/2 (sum l_a^-2 - 3 + (J^(2 beta) - 1) / beta)`, `beta = nu / (1 - 2 nu)`.
    BlatzKo(Elastic),
    /// `sum_p 2 mu_p / alpha_p^2 (sum_a l_a^alpha_p - 3 + (J^(-alpha_p beta_p) - 1) / beta_p)` and
    /// `kappa/2 (J - 1)^2`.
    Hyperfoam {
        /// `[mu_p, alpha_p, beta_p]`, Pa and dimensionless.
        terms: Vec<[f64; 3]>,
        /// Modulus `kappa` of the further volumetric term, Pa.
        kappa: f64,
    },
    /// `mu sum (l_a - 1)^2 + lambda/2 (sum l_a - 3)^2`.
    Corotational(Elastic),
    /// `mu/2 (I1 - 3) - mu (J - 1) + (lambda + mu)/2 (J - 1)^2`.
    StableNeoHookean(Elastic),
    /// A law of bulk modulus 0 and `kappa/2 (ln J)^2`.
    LogarithmicVolume {
        /// The law without its volumetric energy.
        rest: Box<Hyperelastic>,
        /// Bulk modulus `kappa`, Pa.
        bulk: f64,
    },
    /// A law of bulk modulus 0 and `kappa/4 (J^2 - 1 - 2 ln J)`.
    SimoTaylorVolume {
        /// The law without its volumetric energy.
        rest: Box<Hyperelastic>,
        /// Bulk modulus `kappa`, Pa.
        bulk: f64,
    },
}

/// Principal nominal stresses (Pa) of an energy of the isochoric invariants `a = J^(-2/3) I1 - 3` and
/// `b = J^(-4/3) I2 - 3` with the slopes that `slopes(a, b)` gives (Pa), and `kappa/2 (J - 1)^2`.
fn of_invariants(stretch: [f64; 3], bulk: f64, slopes: impl Fn(f64, f64) -> [f64; 2]) -> [f64; 3] {
    let jacobian = stretch[0] * stretch[1] * stretch[2];
    let square = stretch.map(|l| l * l);
    let first: f64 = square.iter().sum();
    let second = square[0] * square[1] + square[1] * square[2] + square[2] * square[0];
    let (of_first, of_second) = (jacobian.powf(-2.0 / 3.0), jacobian.powf(-4.0 / 3.0));
    let [by_a, by_b] = slopes(of_first * first - 3.0, of_second * second - 3.0);
    let (f, s) = (2.0 * by_a * of_first, 2.0 * by_b * of_second);
    let volume = bulk * (jacobian - 1.0) * jacobian;
    stretch.map(|l| {
        let l2 = l * l;
        (f * (l2 - first / 3.0) + s * (first * l2 - l2 * l2 - 2.0 * second / 3.0) + volume) / l
    })
}

impl Hyperelastic {
    /// Principal nominal stresses `P_a = dW / dl_a` (Pa) of three positive stretches.
    pub fn principal_stress(&self, stretch: [f64; 3]) -> [f64; 3] {
        let jacobian = stretch[0] * stretch[1] * stretch[2];
        // From the Kirchhoff stresses, tau_a = l_a P_a.
        let nominal = |tau: &dyn Fn(f64) -> f64| stretch.map(|l| tau(l) / l);
        match self {
            Hyperelastic::SaintVenantKirchhoff(e) => {
                let green = stretch.map(|l| 0.5 * (l * l - 1.0));
                let trace: f64 = green.iter().sum();
                std::array::from_fn(|a| stretch[a] * (e.lambda() * trace + 2.0 * e.mu() * green[a]))
            }
            Hyperelastic::NeoHookean(e) => nominal(&|l| e.mu() * (l * l - 1.0) + e.lambda() * jacobian.ln()),
            Hyperelastic::Hencky(e) => nominal(&|l| 2.0 * e.mu() * l.ln() + e.lambda() * jacobian.ln()),
            Hyperelastic::MooneyRivlin { c10, c01, bulk } => {
                of_invariants(stretch, *bulk, |_, _| [*c10, *c01])
            }
            Hyperelastic::FungDemiray { mu, b, bulk } => {
                of_invariants(stretch, *bulk, |first, _| [0.5 * mu * (b * first).exp(), 0.0])
            }
            Hyperelastic::Gent { mu, jm, bulk } => {
                of_invariants(stretch, *bulk, |first, _| [0.5 * mu * jm / (jm - first), 0.0])
            }
            Hyperelastic::Polynomial { terms, bulk } => of_invariants(stretch, *bulk, |first, second| {
                let power = |x: f64, n: i32| if n < 0 { 0.0 } else { x.powi(n) };
                let slope = |&(i, j, c): &(i32, i32, f64)| {
                    let by_first = f64::from(i) * c * power(first, i - 1) * power(second, j);
                    [by_first, f64::from(j) * c * power(first, i) * power(second, j - 1)]
                };
                terms.iter().map(slope).fold([0.0; 2], |sum, slope| [sum[0] + slope[0], sum[1] + slope[1]])
            }),
            Hyperelastic::BlatzKo(e) => {
                let beta = e.poisson() / (1.0 - 2.0 * e.poisson());
                nominal(&|l| e.mu() * (jacobian.powf(2.0 * beta) - 1.0 / (l * l)))
            }
            Hyperelastic::Hyperfoam { terms, kappa } => nominal(&|l| {
                let of_term = |&[mu, alpha, beta]: &[f64; 3]| {
                    2.0 * mu / alpha * (l.powf(alpha) - jacobian.powf(-alpha * beta))
                };
                terms.iter().map(of_term).sum::<f64>() + kappa * (jacobian - 1.0) * jacobian
            }),
            Hyperelastic::Corotational(e) => {
                let sum: f64 = stretch.iter().sum();
                stretch.map(|l| 2.0 * e.mu() * (l - 1.0) + e.lambda() * (sum - 3.0))
            }
            Hyperelastic::StableNeoHookean(e) => {
                let slope = (e.lambda() + e.mu()) * (jacobian - 1.0) - e.mu();
                nominal(&|l| e.mu() * l * l + slope * jacobian)
            }
            Hyperelastic::LogarithmicVolume { rest, bulk } => {
                let tau = bulk * jacobian.ln();
                let of_rest = rest.principal_stress(stretch);
                std::array::from_fn(|a| of_rest[a] + tau / stretch[a])
            }
            Hyperelastic::SimoTaylorVolume { rest, bulk } => {
                let tau = 0.5 * bulk * (jacobian * jacobian - 1.0);
                let of_rest = rest.principal_stress(stretch);
                std::array::from_fn(|a| of_rest[a] + tau / stretch[a])
            }
            Hyperelastic::Ogden { terms, bulk } => {
                let volume = bulk * (jacobian - 1.0) * jacobian;
                let cube = jacobian.cbrt();
                nominal(&|l| {
                    let shape: f64 = (terms.iter())
                        .map(|&(mu, alpha)| {
                            let mean = stretch.iter().map(|m| (m / cube).powf(alpha)).sum::<f64>() / 3.0;
                            mu * ((l / cube).powf(alpha) - mean)
                        })
                        .sum();
                    shape + volume
                })
            }
        }
    }

    /// First Piola-Kirchhoff stress `P` (3, 3), Pa, of a deformation gradient with `det F > 0`, by the
    /// eigenvectors of `F^T F`. Accurate to about 1e-14. If two stretches are equal, any pair of directions
    /// is valid.
    pub fn stress(&self, gradient: &Matrix3) -> Matrix3 {
        let right = (gradient.transpose() * gradient).symmetric_eigen();
        let stretch: [f64; 3] = std::array::from_fn(|a| right.eigenvalues[a].sqrt());
        let principal = self.principal_stress(stretch);
        (0..3).fold(Matrix3::zeros(), |sum, a| {
            let material: Vector3 = right.eigenvectors.column(a).into();
            sum + (gradient * material / stretch[a]) * material.transpose() * principal[a]
        })
    }
}
