//! The quartic spline.

use catalogue::{Build, Entry};

use super::weight::Weight;

/// Quartic spline `1 - 6q^2 + 8q^3 - 3q^4`, with `q` the distance from the node over the support radius. C2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuarticSpline;

pub(super) const ENTRY: Entry<Build<QuarticSpline>> = Entry {
    name: "quartic-spline",
    meaning: "1 - 6q^2 + 8q^3 - 3q^4; C2",
    source: "Belytschko et al. (1996)",
    parameters: &[],
    build: |_| Ok(QuarticSpline),
};

impl Weight for QuarticSpline {
    #[inline(always)]
    fn weight(self) -> impl Fn(f64) -> (f64, f64) {
        |q| {
            let s = 1.0 - q;
            // 1 - 6q^2 + 8q^3 - 3q^4 in factored form, without cancellation near q = 1.
            (s * s * s * (1.0 + 3.0 * q), -12.0 * q * s * s)
        }
    }
}
