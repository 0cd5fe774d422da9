//! The regularised interpolating weight.

use catalogue::{Build, Dimension, Entry, Parameter, Range};

use super::weight::Weight;

/// Regularised interpolating weight `((q^2 + eps)^-2 - (1 + eps)^-2) / (eps^-2 - (1 + eps)^-2)`, with `q` the
/// distance from the node over the support radius. Shape functions almost interpolate for small `eps`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegularisedInterpolating {
    eps: f64,
}

const EPS: Parameter =
    Parameter::default("eps", Dimension::None, 1e-5, "regularisation parameter, which keeps the peak finite")
        .within(Range::Within(1e-8, 1.0));

pub(super) const ENTRY: Entry<Build<RegularisedInterpolating>> = Entry {
    name: "regularised-interpolating",
    meaning: "((q^2 + eps)^-2 - (1 + eps)^-2) / (eps^-2 - (1 + eps)^-2); nearly interpolating",
    source: "Most and Bucher (2005)",
    parameters: &[EPS],
    build: |values| Ok(RegularisedInterpolating { eps: values.number("eps")? }),
};

impl Weight for RegularisedInterpolating {
    #[inline(always)]
    fn weight(self) -> impl Fn(f64) -> (f64, f64) {
        let eps = self.eps;
        move |q| {
            let inverse_square = |t: f64| 1.0 / (t * t);
            let rim = inverse_square(1.0 + eps);
            let height = inverse_square(eps) - rim;
            let t = q * q + eps;
            ((inverse_square(t) - rim) / height, -4.0 * q / (t * t * t) / height)
        }
    }
}
