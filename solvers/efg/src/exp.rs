//! Exponential function that the compiler vectorises eightfold.

/// Returns `e^x` for `x <= 0`, with a relative error of 3e-16, and zero below -708. The library's function
/// would be a call for each number.
#[inline(always)]
pub(crate) fn exp(x: f64) -> f64 {
    /// `1.5 * 2^52`: a sum with this number has the nearest integer in its last bits.
    const ROUND: f64 = 6755399441055744.0;
    const LN2: [f64; 2] = [0.693_147_180_369_123_8, 1.908_214_929_270_587_7e-10];
    let inside = if x > -708.0 { x } else { -708.0 };
    let shifted = inside * std::f64::consts::LOG2_E + ROUND;
    let k = shifted - ROUND;
    // |r| <= ln(2)/2, for which the first omitted term of the series is 2e-16.
    let r = (inside - k * LN2[0]) - k * LN2[1];
    let mut sum = 1.0 / 479001600.0;
    for factorial in
        [39916800.0, 3628800.0, 362880.0, 40320.0, 5040.0, 720.0, 120.0, 24.0, 6.0, 2.0, 1.0, 1.0]
    {
        sum = sum * r + 1.0 / factorial;
    }
    let power = f64::from_bits(shifted.to_bits().wrapping_add(1023) << 52);
    if x > -708.0 { sum * power } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_librarys() {
        let worst = (0..200_000)
            .map(|k| -7e2 * k as f64 / 199_999.0)
            .map(|x| (exp(x) / x.exp() - 1.0).abs())
            .fold(0.0, f64::max);
        assert!(worst < 5e-16, "{worst:e}");
        assert_eq!([exp(0.0), exp(-710.0), exp(f64::NEG_INFINITY)], [1.0, 0.0, 0.0]);
    }
}
