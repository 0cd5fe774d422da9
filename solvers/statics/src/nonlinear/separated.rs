#![allow(non_snake_case)] // A, U as in the formulas
//! Laws in which shape and volume part: `psi(F, theta) = A(theta) psi(F, 1) + U(theta)`.
//!
//! All but St. Venant-Kirchhoff's do. A point that shares its volume change with many groups, as every point of a cloud
//! does, then needs one tangent in place of one per group: 83 nodes with 960 points have 26 000 pairs of the two.

use material::{Law, Material, less_ln_1p};

/// `A` and `U` (J/m^3) at a dilation, each with its first and second derivative.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Volumetric {
    pub A: [f64; 3],
    pub U: [f64; 3],
}

impl Volumetric {
    /// At `theta - 1`; `None` for a law that does not part.
    pub fn new(law: &Law, theta1: f64) -> Option<Volumetric> {
        let (mu, lambda) = (law.mu(), law.lambda());
        let bulk = lambda + 2.0 / 3.0 * mu;
        let theta = 1.0 + theta1;
        let whole = [1.0, 0.0, 0.0];
        Some(match law {
            Law::SaintVenantKirchhoff(_) => return None,
            // kappa/2 (theta - 1)^2
            Law::Linear(_) | Law::NeoHookeanIsochoric(_) | Law::MooneyRivlin(_) | Law::Ogden(_) => {
                Volumetric { A: whole, U: [0.5 * bulk * theta1 * theta1, bulk * theta1, bulk] }
            }
            // kappa/2 (ln theta)^2
            Law::Hencky(_) => {
                let log = theta1.ln_1p();
                let U = [0.5 * log * log, log / theta, (1.0 - log) / (theta * theta)].map(|u| bulk * u);
                Volumetric { A: whole, U }
            }
            // mu/2 theta^(2/3) I1_bar, and 3 mu/2 (theta^(2/3) - 1) - mu ln theta + lambda/2 (ln theta)^2 beyond psi(F, 1)
            Law::NeoHookean(_) => {
                let log = theta1.ln_1p();
                let grown = (2.0 / 3.0 * log).exp_m1();
                let A = 1.0 + grown;
                let slope = mu * grown + lambda * log;
                Volumetric {
                    A: [A, 2.0 / 3.0 * A / theta, -2.0 / 9.0 * A / (theta * theta)],
                    U: [
                        1.5 * mu * less_ln_1p(grown) + 0.5 * lambda * log * log,
                        slope / theta,
                        (2.0 / 3.0 * mu * A + lambda - slope) / (theta * theta),
                    ],
                }
            }
        })
    }
}
