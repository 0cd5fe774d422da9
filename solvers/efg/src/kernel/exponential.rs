//! The exponential weight with a free power.

use catalogue::{Build, Dimension, Entry, Kind, Parameter, Range};

use super::weight::Weight;

/// Exponential weight `(e^{-(q/alpha)^{2k}} - e^{-(1/alpha)^{2k}}) / (1 - e^{-(1/alpha)^{2k}})`, with `q` the
/// distance from the node over the support radius and `alpha` the width over the support radius. The weight
/// is flat-topped for `k > 1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponential {
    alpha: f64,
    power: u32,
}

/// Parameter `alpha`, the relative width. Below 0.05 the kernel is zero to rounding at the nearest neighbour;
/// above 10 it has no shape.
pub(super) const fn width(default: f64) -> Parameter {
    Parameter::default("alpha", Dimension::None, default, "width relative to the support radius")
        .within(Range::Within(0.05, 10.0))
}

const POWER: Parameter = Parameter::default("power", Dimension::None, 2.0, "exponent k; flat-topped above 1")
    .of(Kind::Count)
    .within(Range::Within(1.0, 8.0));

pub(super) const ENTRY: Entry<Build<Exponential>> = Entry {
    name: "exponential",
    meaning: "(e^-(q/alpha)^2k - e^-(1/alpha)^2k) / (1 - e^-(1/alpha)^2k)",
    source: "Belytschko, Lu and Gu (1994), with a free power k",
    parameters: &[width(0.5), POWER],
    build: |values| {
        let (alpha, power) = (values.number("alpha")?, values.number("power")?);
        Ok(Exponential { alpha, power: power as u32 })
    },
};

impl Weight for Exponential {
    #[inline(always)]
    fn weight(self) -> impl Fn(f64) -> (f64, f64) {
        exponential(self.alpha, self.power)
    }
}

/// Returns the weight function; the part that does not depend on `q` is computed once per list.
#[inline(always)]
pub(super) fn exponential(alpha: f64, power: u32) -> impl Fn(f64) -> (f64, f64) {
    let k = power as i32;
    let inverse = 1.0 / alpha;
    let rim = (-inverse.powi(2 * k)).exp();
    let height = 1.0 / (1.0 - rim);
    let slope = -2.0 * k as f64 * inverse * height;
    move |q| {
        let t = q * inverse;
        let odd = t.powi(2 * k - 1);
        let e = (-(odd * t)).exp();
        ((e - rim) * height, slope * odd * e)
    }
}
