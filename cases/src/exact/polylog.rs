//! Closed sums of the series `L_p(s, t) = sum_n (-1)^n n^-p e^(-n s) e^(i n t)`, an alternating Fourier
//! series, for p = 2 and 3.
//!
//! The sums are the polylogarithms `Li_p(-e^(-s + i t))`. On the edge s = 0 the series converges like `n^-p`
//! only, and its derivatives not at all. The closed sums are accurate to 1e-15 everywhere, corners included,
//! at a fixed cost.
//!
//! Source: Lewin, Polylogarithms and Associated Functions (1981), ch. 7. With `mu = -s + i (t -+ pi)` and
//! `|mu| < 2 pi`, `Li_p(e^mu) = mu^(p-1)/(p-1)! (H_(p-1) - ln(-mu)) + sum_(k != p-1) zeta(p - k) mu^k / k!`.

use std::f64::consts::PI;
use std::sync::LazyLock;

/// A complex number.
pub type Complex = nalgebra::Complex<f64>;

/// Decay `s` above which the power series is summed, and below which the logarithmic series. In the latter
/// `|mu| < 3.44`, so each term is smaller by at least `(3.44 / 2 pi)^2 = 0.30`, and 30 terms are enough.
const SWITCH: f64 = 1.4;
const LOG_TERMS: usize = 30;

const ZETA_2: f64 = PI * PI / 6.0;
const ZETA_3: f64 = 1.202_056_903_159_594_3;

/// `zeta(1 - 2j) / (2j + 1)!` for j = 1, 2, ..., that is `(-1)^j 2 zeta(2j) / ((2 pi)^(2j) 2j (2j + 1))`.
static TAIL: LazyLock<[f64; LOG_TERMS]> = LazyLock::new(|| {
    std::array::from_fn(|index| {
        let j = index as i32 + 1;
        let even_zeta = match j {
            1 => ZETA_2,
            2 => power(PI, 4) / 90.0,
            3 => power(PI, 6) / 945.0,
            _ => (1..=200).rev().map(|n: i32| 1.0 / power(f64::from(n), 2 * j)).sum(),
        };
        let sign = if j % 2 == 0 { 1.0 } else { -1.0 };
        sign * 2.0 * even_zeta / (power(2.0 * PI, 2 * j) * f64::from(2 * j) * f64::from(2 * j + 1))
    })
});

/// `x^n` by products from the left. `powi` rounds differently if the compiler knows the exponent, so that its
/// bits depend on the division of the build into units (1e-16 to 3e-14 in the results).
fn power(x: f64, n: i32) -> f64 {
    (0..n).fold(1.0, |product, _| product * x)
}

/// `mu` and `ln(-mu)` of the logarithmic series; `None` at the singular corner, at which every term with them
/// vanishes.
fn logarithm(s: f64, t: f64) -> Option<(Complex, Complex)> {
    let mu = Complex::new(-s, if t > 0.0 { t - PI } else { t + PI });
    (mu.norm_sqr() > 0.0).then(|| (mu, (-mu).ln()))
}

/// `sum_n (-1)^n n^-p e^(n (-s + i t))`, summed by terms, for a decay above [`SWITCH`].
fn power_series(s: f64, t: f64, weight: impl Fn(f64) -> f64) -> Complex {
    let w = Complex::from_polar((-s).exp(), t) * -1.0;
    let terms = (38.0 / s).ceil() as i32;
    (1..=terms).rev().fold(Complex::ZERO, |sum, n| (sum + weight(f64::from(n))) * w)
}

/// `L_2(s, t)` for `s >= 0`, `|t| <= pi`.
pub fn alternating_2(s: f64, t: f64) -> Complex {
    if s > SWITCH {
        return power_series(s, t, |n| 1.0 / (n * n));
    }
    let Some((mu, log)) = logarithm(s, t) else { return Complex::from(ZETA_2) };
    let square = mu * mu;
    let tail = TAIL.iter().rev().fold(Complex::ZERO, |sum, c| (sum + c) * square);
    ZETA_2 + mu * (1.0 - log - 0.25 * mu + tail)
}

/// `L_3(s, t)` for `s >= 0`, `|t| <= pi`.
pub fn alternating_3(s: f64, t: f64) -> Complex {
    if s > SWITCH {
        return power_series(s, t, |n| 1.0 / (n * n * n));
    }
    let Some((mu, log)) = logarithm(s, t) else { return Complex::from(ZETA_3) };
    let square = mu * mu;
    let tail = TAIL
        .iter()
        .enumerate()
        .rev()
        .fold(Complex::ZERO, |sum, (index, c)| (sum + c / (2.0 * index as f64 + 4.0)) * square);
    ZETA_3 + mu * ZETA_2 + square * (0.75 - 0.5 * log - mu / 12.0 + tail)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Plain sum of the series; accurate to 1e-15 if `e^(-n s)` has decayed.
    fn brute(p: i32, s: f64, t: f64) -> Complex {
        (1..20_000).rev().fold(Complex::ZERO, |sum, n| {
            let n_f = f64::from(n);
            let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
            sum + Complex::from_polar(sign * n_f.powi(-p) * (-n_f * s).exp(), n_f * t)
        })
    }

    #[test]
    fn closed_sums_equal_the_series_on_both_sides_of_the_switch() {
        for s in [0.01, 0.3, 1.39, 1.41, 3.0, 9.0] {
            for t in [-3.1, -2.0, -0.5, 0.0, 1e-9, 0.7, 3.0, PI] {
                let two = alternating_2(s, t);
                let three = alternating_3(s, t);
                assert!((two - brute(2, s, t)).norm() < 3e-15, "L2 at {s} {t}: {two}");
                assert!((three - brute(3, s, t)).norm() < 3e-15, "L3 at {s} {t}: {three}");
            }
        }
    }

    #[test]
    fn edge_and_corner_have_their_known_values() {
        assert!((alternating_2(0.0, 0.0).re + PI * PI / 12.0).abs() < 1e-15);
        assert!((alternating_3(0.0, 0.0).re + 0.75 * ZETA_3).abs() < 1e-15);
        assert!((alternating_2(0.0, PI).re - ZETA_2).abs() < 1e-15);
        assert!((alternating_3(0.0, PI).re - ZETA_3).abs() < 1e-15);
        // sum (-1)^n cos(n t) / n^2 = t^2/4 - pi^2/12, the parabola that the flexure series represents
        for t in [0.4, 1.5, 3.0] {
            assert!((alternating_2(0.0, t).re - (t * t / 4.0 - PI * PI / 12.0)).abs() < 1e-15);
        }
    }
}
