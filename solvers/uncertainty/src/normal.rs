//! The standard normal distribution.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// Density at `x`.
pub(crate) fn density(x: f64) -> f64 {
    (-0.5 * x * x).exp() / (2.0 * PI).sqrt()
}

/// Probability of a value below `x`.
pub(crate) fn below(x: f64) -> f64 {
    0.5 * libm::erfc(-x * FRAC_1_SQRT_2)
}

/// Value below which a value lies with the probability `u`, `0 < u < 1`.
///
/// Newton's method from the centre, on the smaller tail: the tail is convex, so no step passes the root.
pub(crate) fn quantile(u: f64) -> f64 {
    let tail = u.min(1.0 - u);
    let mut x = 0.0;
    for _ in 0..200 {
        let step = (below(-x) - tail) / density(x);
        x += step;
        if step.abs() <= 1e-15 * (1.0 + x) {
            break;
        }
    }
    if u < 0.5 { -x } else { x }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_tables() {
        for (u, x) in [
            (0.5, 0.0),
            (0.95, 1.644_853_626_951_472_2),
            (0.975, 1.959_963_984_540_054),
            (0.001, -3.090_232_306_167_813),
            (1e-12, -7.034_483_825_301_131),
        ] {
            assert!((quantile(u) - x).abs() < 1e-12 * (1.0 + x.abs()), "{u}: {}", quantile(u));
        }
        for u in [1e-8, 1e-3, 0.2, 0.7, 1.0 - 1e-9] {
            assert!((below(quantile(u)) / u - 1.0).abs() < 1e-13);
        }
    }
}
