//! The Gaussian.

use super::{
    Dimension, Entry, KernelEntry, Parameter, Problem, Range, Values, Weight, exponential::exponential,
};

/// Gaussian weight `(e^{-(q/alpha)^2} - e^{-(1/alpha)^2}) / (1 - e^{-(1/alpha)^2})`, with `q` the distance
/// from the node over the support radius and `alpha` the width over the support radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gaussian {
    alpha: f64,
}

/// Parameter `alpha`, the relative width. Below 0.05 the kernel is zero to rounding at the nearest neighbour;
/// above 10 it has no shape.
pub(super) const fn width(default: f64) -> Parameter {
    Parameter::default("alpha", Dimension::None, default, "width relative to the support radius")
        .within(Range::Within(0.05, 10.0))
}

pub(super) const ENTRY: KernelEntry = Entry {
    name: "gaussian",
    meaning: "(e^-(q/alpha)^2 - e^-(1/alpha)^2) / (1 - e^-(1/alpha)^2)",
    source: "Belytschko, Lu and Gu (1994)",
    parameters: &[width(0.4)],
    build: |values: &Values| -> Result<_, Problem> { Ok(Gaussian { alpha: values.number("alpha")? }.into()) },
};

impl Weight for Gaussian {
    #[inline(always)]
    fn weight(self) -> impl Fn(f64) -> (f64, f64) {
        exponential(self.alpha, 1)
    }
}
