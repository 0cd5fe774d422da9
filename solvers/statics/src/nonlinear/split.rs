#![allow(non_snake_case)] // H as in the formulas
//! The dilation of a law at a given pressure.

use material::Material;
use material::split::Split;
use shape::Matrix3;

/// Solves `d psi / d theta = p` for `theta - 1` by Newton's method from a guess. The result is `None` if the
/// iteration leaves the positive dilations or does not converge.
pub(crate) fn dilation_at_pressure(
    law: &impl Material,
    H: &Matrix3,
    j_minus_1: f64,
    p: f64,
    guess: f64,
) -> Option<f64> {
    let mut theta_minus_1 = guess;
    for _ in 0..40 {
        let (first, second) = Split::new(law, H, j_minus_1, theta_minus_1).second(law);
        let step = (p - first.by_theta) / second.by_theta_theta;
        if !step.is_finite() {
            return None;
        }
        // A step may remove at most half of the volume. At small strain every dilation has a pressure.
        theta_minus_1 += if law.is_small_strain() { step } else { step.max(-0.5 * (1.0 + theta_minus_1)) };
        if step.abs() <= 1e-14 * (1.0 + theta_minus_1.abs()) {
            return Some(theta_minus_1);
        }
    }
    None
}
