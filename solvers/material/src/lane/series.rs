//! Power series of a traceless symmetric tensor `X` without its eigenvalues.
//!
//! By Cayley and Hamilton `X^3 = a X + b I`, `a = X : X / 2`, `b = det X`. A polynomial of any degree is
//! therefore `x0 I + x1 X + x2 X^2`, and one step of Horner's scheme on the three numbers takes two products.
//! Equal eigenvalues need no special treatment, and no digits are lost near `X = 0`.

use std::sync::LazyLock;

use lanes::{LANES, madd};

use super::Lanes;

/// Bounds of the eigenvalues of `X` for which there is a series, each with a separate length.
pub(crate) const BOUNDS: [f64; 4] = [0.05, 0.15, 0.35, 0.6];

/// Numbers of coefficients for which Horner's scheme is straight-line code, including those of the logarithm.
const LENGTHS: [usize; 6] = [10, 12, 14, 21, 32, 64];

/// Coefficients `g_0, g_1, ...`, padded with zeros to one of [`LENGTHS`]; the zeros change no bit.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Power(Vec<f64>);

impl Power {
    /// Pads the coefficients `g_k` of a power series `sum_k g_k X^k` with zeros to the next of the lengths
    /// 10, 12, 14, 21, 32 and 64; `None` if there are more than 64.
    pub fn new(mut g: Vec<f64>) -> Option<Power> {
        let length = LENGTHS.into_iter().find(|&length| g.len() <= length)?;
        g.resize(length, 0.0);
        Some(Power(g))
    }

    /// Returns the coefficients as an array if there are exactly `N`.
    pub fn exactly<const N: usize>(&self) -> Option<&[f64; N]> {
        self.0.as_slice().try_into().ok()
    }
}

/// Calls `$function(g, ...)` with the coefficients of a [`Power`] as an array.
macro_rules! unrolled {
    ($power:expr, $function:ident::<$fma:ident>($($arg:expr),* $(,)?)) => {
        unrolled!(@ $power, $function, $fma, ($($arg),*); 10 12 14 21 32 64)
    };
    (@ $power:expr, $function:ident, $fma:ident, $args:tt; $($length:literal)*) => {
        $(if let Some(g) = $power.exactly::<$length>() {
            unrolled!(@call $function, $fma, $length, g, $args)
        })else*
    };
    (@call $function:ident, $fma:ident, $length:literal, $g:ident, ($($arg:expr),*)) => {
        $function::<$fma, $length>($g, $($arg),*)
    };
}
pub(crate) use unrolled;

/// Coefficients `g` of `ln(1 + x) = x g(x) + constant`, for each of [`BOUNDS`].
static LOGARITHM: LazyLock<[Option<Power>; 4]> =
    LazyLock::new(|| BOUNDS.map(|bound| Power::new(logarithm(bound))));

/// Returns the index in [`BOUNDS`] that is valid for all lanes, `None` beyond the last. No eigenvalue exceeds
/// `2 sqrt(a / 3)`.
#[inline(always)]
pub(crate) fn rung(a: &Lanes) -> Option<usize> {
    BOUNDS.iter().position(|bound| {
        let limit = 0.75 * bound * bound;
        let mut within = true;
        for l in 0..LANES {
            within &= a[l] <= limit;
        }
        within
    })
}

/// Returns `g` of the logarithm for an index in [`BOUNDS`].
#[inline(always)]
pub(crate) fn of_logarithm(rung: usize) -> Option<&'static Power> {
    LOGARITHM[rung].as_ref()
}

/// Returns `g_0, g_1, ...` from the Chebyshev series of the logarithm on `[-bound, bound]`.
///
/// `ln(1 + x) = constant - 2 sum_k (-beta)^k / k T_k(x / bound)` with
/// `beta = bound / (1 + sqrt(1 - bound^2))` is half as long as Taylor's series. The coefficients of `T_k`
/// grow as `(1 + sqrt 2)^k`, more slowly than `beta^k` decreases.
fn logarithm(bound: f64) -> Vec<f64> {
    let beta = bound / (1.0 + (1.0 - bound * bound).sqrt());
    let size = |k: i32| 2.0 * beta.powi(k) / f64::from(k);
    let degree = (1..).find(|&k| size(k + 1) < 2f64.powi(-54) * bound).unwrap_or(1);
    let length = degree as usize + 1;
    let mut sum = vec![0.0; length];
    let (mut before, mut now) = (vec![0.0; length], vec![0.0; length]);
    (before[0], now[1]) = (1.0, 1.0);
    for k in 1..=degree {
        let sign = if k % 2 == 0 { -1.0 } else { 1.0 };
        for (sum, t) in sum.iter_mut().zip(&now) {
            *sum += sign * size(k) * t;
        }
        let shifted = std::iter::once(0.0).chain(now.iter().copied());
        let next = shifted.zip(&before).map(|(shifted, before)| 2.0 * shifted - before).collect();
        before = std::mem::replace(&mut now, next);
    }
    sum.iter().enumerate().skip(1).map(|(k, c)| c / bound.powi(k as i32)).collect()
}

/// Returns the three numbers of `sum_k g_k X^k`, given the `a` and `b` of `X`.
#[inline(always)]
pub(crate) fn horner<const FMA: bool, const N: usize>(g: &[f64; N], a: f64, b: f64) -> [f64; 3] {
    // Explicit zeros of the first three steps are omitted.
    let [mut g0, mut g1, mut g2] = [g[N - 3], g[N - 2], g[N - 1]];
    for k in (0..N - 3).rev() {
        (g0, g1, g2) = (madd::<FMA>(b, g2, g[k]), madd::<FMA>(a, g2, g0), g1);
    }
    [g0, g1, g2]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn length<const FMA: bool, const N: usize>(_: &[f64; N], out: &mut usize) {
        *out = N;
    }

    #[test]
    fn every_length_has_code_of_its_own() {
        const FMA: bool = false;
        for expected in LENGTHS {
            let power = Power::new(vec![1.0; expected - 1]).unwrap();
            let mut found = 0;
            unrolled!(power, length::<FMA>(&mut found));
            assert_eq!(found, expected);
        }
        assert_eq!(Power::new(vec![1.0; 65]), None);
    }

    #[test]
    fn differences_of_logarithms_agree_with_the_library() {
        for (rung, bound) in BOUNDS.into_iter().enumerate() {
            for i in -100..=100 {
                let x = bound * f64::from(i) / 100.0;
                let sum = of_logarithm(rung).unwrap().0.iter().rev().fold(0.0, |sum, c| sum * x + c) * x;
                // The constant cancels in the deviator; it is also below the last digit.
                let error = (sum - x.ln_1p()).abs();
                assert!(error < 1e-15 * x.abs().max(0.2 * bound), "{bound}: {x}: {error:e}");
            }
        }
    }

    #[test]
    fn horner_on_three_numbers_is_the_polynomial_of_the_eigenvalues() {
        let (x, y) = (0.3, -0.1);
        let z = -x - y;
        let (a, b) = (0.5 * (x * x + y * y + z * z), x * y * z);
        let g = [1.5, -0.4, 0.7, 2.0, -1.1, 0.3];
        let out = horner::<false, 6>(&g, a, b);
        for t in [x, y, z] {
            let expected = g.iter().rev().fold(0.0, |sum, c| sum * t + c);
            let found = out[0] + t * (out[1] + t * out[2]);
            assert!((found - expected).abs() < 1e-15, "{t}: {found} {expected}");
        }
    }
}
