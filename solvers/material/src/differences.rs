//! Differences between a function and its leading terms, without cancellation.

/// Returns `x - ln(1 + x)` without cancellation near 0.
///
/// With `s = x / (2 + x)`: `ln(1 + x) = 2 atanh s = 2 (s + s^3/3 + ...)` and `x - 2 s = x s`.
#[inline]
pub fn less_ln_1p(x: f64) -> f64 {
    if x.abs() > 0.25 {
        return x - x.ln_1p();
    }
    let s = x / (2.0 + x);
    let q = s * s;
    // |s| <= 1/7: the first omitted term is q^9/21 < 1e-16 of the sum.
    let mut sum = 0.0;
    for n in (1..10).rev() {
        sum = sum * q + 1.0 / f64::from(2 * n + 1);
    }
    x * s - 2.0 * s * q * sum
}

/// Returns `exp(x) - 1 - x` without cancellation near 0.
pub(super) fn exp_m1_less(x: f64) -> f64 {
    if x.abs() > 0.5 {
        return x.exp_m1() - x;
    }
    // x^2/2 (1 + x/3 (1 + x/4 (...))): the first omitted term is 2 x^14/16! < 1e-17 of the sum.
    let mut sum = 1.0;
    for n in (3..16).rev() {
        sum = 1.0 + x / f64::from(n) * sum;
    }
    0.5 * x * x * sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_from_the_logarithm_keep_their_digits() {
        // Leading terms x^2/2 - x^3/3 + x^4/4 at small x; the direct difference if it is accurate enough.
        for x in [1e-12, -1e-9, 3e-6, -2e-5] {
            let series = x * x * (0.5 - x / 3.0 + x * x / 4.0);
            assert!((less_ln_1p(x) - series).abs() < 4e-15 * series, "{x}");
        }
        for x in [0.2499_f64, -0.2499, 0.1, -0.1] {
            let direct = x - x.ln_1p();
            assert!((less_ln_1p(x) - direct).abs() < 1e-13 * direct, "{x}");
        }
    }

    #[test]
    fn differences_from_the_exponential_keep_their_digits() {
        for x in [1e-12, -1e-9, 3e-6, -2e-5] {
            let series = x * x * (0.5 + x / 6.0 + x * x / 24.0);
            assert!((exp_m1_less(x) - series).abs() < 4e-15 * series, "{x}");
        }
        for x in [0.4999_f64, -0.4999, 0.1, -0.1] {
            let direct = x.exp_m1() - x;
            assert!((exp_m1_less(x) - direct).abs() < 1e-13 * direct, "{x}");
        }
    }
}
