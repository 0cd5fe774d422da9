//! Laws that are separable into shape and volume: `psi(F, theta) = A(theta) psi(F, 1) + U(theta)`.
//!
//! Laws of isochoric invariants or stretches and of `ln J` are separable; St. Venant-Kirchhoff, foams and the
//! corotational law are not. A point of a cloud shares its volume change with
//! many groups. For a separable law it needs a single tangent instead of one per group: 83 nodes with 960
//! points have 26 000 pairs of point and group.

/// Functions `A` (dimensionless) and `U` (J/m^3) of a separable law,
/// `psi(F, theta) = A(theta) psi(F, 1) + U(theta)`, at one dilation `theta`. Each array has the value and the
/// first and second derivative with respect to `theta`.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs)]
pub struct Separated {
    pub A: [f64; 3],
    pub U: [f64; 3],
}

/// Constant `A` of a law whose shape part does not depend on the volume.
const WHOLE: [f64; 3] = [1.0, 0.0, 0.0];

impl Separated {
    /// Builds `A = 1`, `U = kappa/2 (theta - 1)^2`.
    pub fn quadratic(bulk: f64, theta_minus_1: f64) -> Separated {
        let U = [0.5 * bulk * theta_minus_1 * theta_minus_1, bulk * theta_minus_1, bulk];
        Separated { A: WHOLE, U }
    }

    /// Builds `A = 1`, `U = kappa/2 (ln theta)^2`.
    pub fn logarithmic(bulk: f64, theta_minus_1: f64) -> Separated {
        let log = theta_minus_1.ln_1p();
        let theta = 1.0 + theta_minus_1;
        let U = [0.5 * log * log, log / theta, (1.0 - log) / (theta * theta)].map(|u| bulk * u);
        Separated { A: WHOLE, U }
    }
}
