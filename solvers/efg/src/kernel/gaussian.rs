//! The Gaussian.

use catalogue::{Build, Entry};

use super::exponential::{exponential, width};
use super::weight::Weight;

/// Gaussian weight `(e^{-(q/alpha)^2} - e^{-(1/alpha)^2}) / (1 - e^{-(1/alpha)^2})`, with `q` the distance
/// from the node over the support radius and `alpha` the width over the support radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gaussian {
    alpha: f64,
}

pub(super) const ENTRY: Entry<Build<Gaussian>> = Entry {
    name: "gaussian",
    meaning: "(e^-(q/alpha)^2 - e^-(1/alpha)^2) / (1 - e^-(1/alpha)^2)",
    source: "Belytschko, Lu and Gu (1994)",
    parameters: &[width(0.4)],
    build: |values| Ok(Gaussian { alpha: values.number("alpha")? }),
};

impl Weight for Gaussian {
    #[inline(always)]
    fn weight(self) -> impl Fn(f64) -> (f64, f64) {
        exponential(self.alpha, 1)
    }
}
