//! Elementary functions that vectorise: straight-line arithmetic on one number, which a loop over lanes turns
//! into vector instructions. `f64::ln` and `cbrt` are function calls and would cost 20 ns per number.

use lanes::{madd, madd_f32};

/// Returns `ln(1 + j)` for positive, normal `1 + j`, with errors of 2e-16 absolute and 4e-16 relative.
///
/// Exponent arithmetic gives `1 + j = 2^k (1 + f)` with `1 + f` in [sqrt(1/2), sqrt 2). Then follows the
/// atanh series of `s = f / (2 + f)` with the minimax coefficients of fdlibm's `e_log.c` (Sun Microsystems
/// 1993). The rounding error of `1 + j`, divided by `1 + j`, is added again, so no digits are lost at small
/// strain.
#[inline(always)]
pub fn ln_1p<const FMA: bool>(j: f64) -> f64 {
    const SQRT_HALF_HIGH: u64 = 0x3fe6_a09e;
    const LN2_HIGH: f64 = 6.931_471_803_691_238e-1;
    const LN2_LOW: f64 = 1.908_214_929_270_587_7e-10;
    let x = 1.0 + j;
    let high = (x.to_bits() >> 32) + (0x3ff0_0000 - SQRT_HALF_HIGH);
    // 2^52 + 2^51 plus an integer in the last bits: the conversion to f64 is one subtraction on every path.
    let k = f64::from_bits(0x4338_0000_0000_0000 + (high >> 20)) - 6_755_399_441_055_744.0 - 1023.0;
    let mantissa = ((high & 0xf_ffff) + SQRT_HALF_HIGH) << 32 | (x.to_bits() & 0xffff_ffff);
    let f = f64::from_bits(mantissa) - 1.0;
    let lost = j - (x - 1.0);
    let s = f / (2.0 + f);
    let z = s * s;
    let w = z * z;
    let m = madd::<FMA>;
    let odd =
        w * m(w, m(w, 1.531_383_769_920_937_3e-1, 2.222_219_843_214_978_4e-1), 3.999_999_999_940_942e-1);
    let even = z * m(
        w,
        m(w, m(w, 1.479_819_860_511_658_6e-1, 1.818_357_216_161_805e-1), 2.857_142_874_366_239e-1),
        6.666_666_666_666_735e-1,
    );
    let half = 0.5 * f * f;
    let low = m(lost, 1.0 / x, k * LN2_LOW);
    m(k, LN2_HIGH, f - (half - m(s, half + odd + even, low)))
}

/// Returns `(1 + j)^(-1/3) - 1` for positive, normal `1 + j`, with a relative error of 4e-16 even near
/// `j = 0`.
///
/// The first guess takes a third of the exponent bits (3.3 % off). Two steps of fourth order follow: with
/// `e = 1 - x y^3`, `y (1 - e)^(-1/3) = y (1 + e/3 + 2 e^2/9 + 14 e^3/81 + ...)`. The last step is a Newton
/// step for `d = y - 1` itself, with `e = -(j + t + j t)`, `t = (1 + d)^3 - 1`, so no digits are lost at
/// small strain.
#[inline(always)]
pub fn inverse_cbrt_less_1<const FMA: bool>(j: f64) -> f64 {
    let x = 1.0 + j;
    let high = x.to_bits() >> 32;
    // A product of two 32-bit numbers is one vector instruction; a division by 3 has none.
    let third = (high * 0xaaaa_aaab) >> 33;
    let mut y = f64::from_bits((0x553e_f0ff_u64.wrapping_sub(third)) << 32);
    let m = madd::<FMA>;
    for _ in 0..2 {
        let e = m(-x * y, y * y, 1.0);
        y = m(y * e, m(e, m(e, 14.0 / 81.0, 2.0 / 9.0), 1.0 / 3.0), y);
    }
    let d = y - 1.0;
    let t = d * m(d, d + 3.0, 3.0);
    let e = m(j, t, j + t);
    // Far from 0 the three terms of e cancel, and d is already accurate.
    if d.abs() < 0.5 { m(-y * e, 1.0 / 3.0, d) } else { d }
}

/// Returns `ln(1 + j)` in single precision, with errors of 1.2e-7 absolute and 2.5e-7 relative. The steps are
/// those of [`ln_1p`], with the coefficients of fdlibm's `e_logf.c`.
#[inline(always)]
pub fn ln_1p_f32<const FMA: bool>(j: f32) -> f32 {
    const SQRT_HALF: u32 = 0x3f35_04f3;
    const LN2_HIGH: f32 = 6.931_381e-1;
    const LN2_LOW: f32 = 9.058_001e-6;
    let x = 1.0 + j;
    let bits = x.to_bits() + (0x3f80_0000 - SQRT_HALF);
    let k = ((bits >> 23) as i32 - 127) as f32;
    let f = f32::from_bits((bits & 0x7f_ffff) + SQRT_HALF) - 1.0;
    let lost = j - (x - 1.0);
    let s = f / (2.0 + f);
    let z = s * s;
    let w = z * z;
    let m = madd_f32::<FMA>;
    let odd = w * m(w, 0.242_790_79, 0.400_009_72);
    let even = z * m(w, 0.284_987_87, 0.666_666_6);
    let half = 0.5 * f * f;
    let low = m(lost, 1.0 / x, k * LN2_LOW);
    m(k, LN2_HIGH, f - (half - m(s, half + odd + even, low)))
}

/// Returns `(1 + j)^(-1/3) - 1` in single precision, with a relative error of 3.3e-7 even near `j = 0`, by
/// the steps of [`inverse_cbrt_less_1`].
#[inline(always)]
pub fn inverse_cbrt_less_1_f32<const FMA: bool>(j: f32) -> f32 {
    let x = 1.0 + j;
    let mut y = f32::from_bits(0x54a2_fa8c_u32.wrapping_sub(x.to_bits() / 3));
    let m = madd_f32::<FMA>;
    for _ in 0..2 {
        let e = m(-x * y, y * y, 1.0);
        y = m(y * e, m(e, m(e, 14.0 / 81.0, 2.0 / 9.0), 1.0 / 3.0), y);
    }
    let d = y - 1.0;
    let t = d * m(d, d + 3.0, 3.0);
    let e = m(j, t, j + t);
    // Far from 0 the three terms of e cancel, and d is already accurate.
    if d.abs() < 0.5 { m(-y * e, 1.0 / 3.0, d) } else { d }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns positive numbers over 40 binades, and numbers close to 1 on both sides, minus 1.
    fn samples() -> impl Iterator<Item = f64> {
        let wide = (0..4000).map(|i| 2f64.powf(-20.0 + i as f64 * 0.01 + 1e-3) - 1.0);
        let near = (0..300).flat_map(|i| [1.0, -1.0].map(|sign| sign * 10f64.powf(-16.0 + i as f64 * 0.053)));
        wide.chain(near).filter(|j| *j > -1.0).chain([0.0, 0.4142, 0.41422, -0.29289, -0.2929])
    }

    #[test]
    fn logarithm_agrees_with_the_library() {
        for j in samples() {
            let exact = j.ln_1p();
            for found in [ln_1p::<false>(j), ln_1p::<true>(j)] {
                assert!((found - exact).abs() <= 1e-15 * exact.abs().max(1e-30), "{j}: {found} {exact}");
            }
            let plain = (1.0 + j).ln();
            assert!((ln_1p::<false>(j) - plain).abs() <= 1e-14 * plain.abs().max(1.0), "{j}");
        }
    }

    #[test]
    fn cube_root_agrees_with_the_library() {
        for j in samples() {
            let exact = (-j.ln_1p() / 3.0).exp_m1();
            for found in [inverse_cbrt_less_1::<false>(j), inverse_cbrt_less_1::<true>(j)] {
                assert!((found - exact).abs() <= 2e-15 * exact.abs(), "{j}: {found} {exact}");
            }
        }
    }

    #[test]
    fn single_precision_agrees_with_double() {
        for j in samples().map(|j| j as f32).filter(|j| *j > -1.0) {
            let exact = f64::from(j).ln_1p();
            for found in [ln_1p_f32::<false>(j), ln_1p_f32::<true>(j)] {
                let error = (f64::from(found) - exact).abs();
                assert!(error <= 2.5e-7 * exact.abs().max(1e-30), "{j}: {found} {exact}");
            }
            let exact = (-f64::from(j).ln_1p() / 3.0).exp_m1();
            for found in [inverse_cbrt_less_1_f32::<false>(j), inverse_cbrt_less_1_f32::<true>(j)] {
                let error = (f64::from(found) - exact).abs();
                assert!(error <= 4e-7 * exact.abs(), "{j}: {found} {exact}");
            }
        }
    }
}
