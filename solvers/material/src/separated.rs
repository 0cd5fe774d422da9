//! Laws that are separable into shape and volume: `psi(F, theta) = A(theta) psi(F, 1) + U(theta)`.
//!
//! Laws of isochoric invariants or stretches and of `ln J` are separable; St. Venant-Kirchhoff, foams and the
//! corotational law are not. A point of a cloud shares its volume change with
//! many groups. For a separable law it needs a single tangent instead of one per group: 83 nodes with 960
//! points have 26 000 pairs of point and group.

use crate::volumetric::Volumetric;

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
    /// Builds `A = 1` and `U` of a law whose shape part does not depend on the volume.
    pub fn of_volume(volume: Volumetric, theta_minus_1: f64) -> Separated {
        Separated { A: WHOLE, U: volume.derivatives(theta_minus_1) }
    }
}
