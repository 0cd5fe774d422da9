//! Twofold precision: an unevaluated sum of two numbers, for the few computations in which double precision
//! cancels.

use std::ops::{Add, Mul, Sub};

/// `high + low`, with `|low|` at most half a unit in the last place of `high` (Dekker 1971).
#[derive(Clone, Copy)]
pub(crate) struct Twofold {
    high: f64,
    low: f64,
}

impl Twofold {
    /// Returns `a - b` exactly.
    pub(crate) fn difference(a: f64, b: f64) -> Twofold {
        sum(a, -b)
    }

    /// Returns the ratio of two numbers in double precision, with an error of a few roundings.
    pub(crate) fn ratio(self, by: Twofold) -> f64 {
        self.high / by.high
    }
}

/// Returns the exact sum of two numbers (Knuth 1969).
fn sum(a: f64, b: f64) -> Twofold {
    let high = a + b;
    let part = high - a;
    Twofold { high, low: (a - (high - part)) + (b - part) }
}

/// Returns the exact sum of two numbers with `|a| >= |b|`.
fn quick_sum(a: f64, b: f64) -> Twofold {
    let high = a + b;
    Twofold { high, low: b - (high - a) }
}

impl Add for Twofold {
    type Output = Twofold;

    fn add(self, other: Twofold) -> Twofold {
        let high = sum(self.high, other.high);
        let low = sum(self.low, other.low);
        let first = quick_sum(high.high, high.low + low.high);
        quick_sum(first.high, first.low + low.low)
    }
}

impl Sub for Twofold {
    type Output = Twofold;

    fn sub(self, other: Twofold) -> Twofold {
        self + Twofold { high: -other.high, low: -other.low }
    }
}

impl Mul for Twofold {
    type Output = Twofold;

    fn mul(self, other: Twofold) -> Twofold {
        let high = self.high * other.high;
        let low = self.high.mul_add(other.high, -high);
        quick_sum(high, low + (self.high * other.low + self.low * other.high))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cancellation_leaves_the_digits_that_double_precision_loses() {
        let exact = |a: f64| Twofold::difference(a, 0.0);
        // (1 + e)^2 - (1 + 2 e) = e^2.
        let e = f64::EPSILON;
        let square = exact(1.0 + e) * exact(1.0 + e) - exact(1.0 + 2.0 * e);
        assert_eq!((1.0 + e) * (1.0 + e) - (1.0 + 2.0 * e), 0.0);
        assert_eq!(square.high, e * e);
        // A difference that no double can represent: 1 - 1e-30.
        let rest = exact(1.0) - Twofold::difference(1.0, 1e-30);
        assert!((rest.high / 1e-30 - 1.0).abs() < 1e-15);
        assert!(((rest * exact(3.0)).ratio(rest) / 3.0 - 1.0).abs() < 1e-15);
    }
}
