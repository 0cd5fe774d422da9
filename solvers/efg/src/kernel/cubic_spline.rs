//! The cubic spline.

use catalogue::{Build, Entry};

use super::weight::Weight;

/// Cubic spline: 3/2 times `2/3 - 4q^2 + 4q^3` up to `q = 1/2` and `4/3 (1 - q)^3` beyond, with `q` the
/// distance from the node over the support radius. C2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CubicSpline;

pub(super) const ENTRY: Entry<Build<CubicSpline>> = Entry {
    name: "cubic-spline",
    meaning: "2/3 - 4q^2 + 4q^3 up to 1/2, then 4/3 (1 - q)^3, times 3/2; C2",
    source: "Dolbow and Belytschko (1998)",
    parameters: &[],
    build: |_| Ok(CubicSpline),
};

impl Weight for CubicSpline {
    #[inline(always)]
    fn weight(self) -> impl Fn(f64) -> (f64, f64) {
        |q| {
            // Both branches are computed and one is selected, so the loop over a list vectorises.
            let s = 1.0 - q;
            let inner = (1.0 - 6.0 * q * q * s, q * (18.0 * q - 12.0));
            let outer = (2.0 * s * s * s, -6.0 * s * s);
            if q <= 0.5 { inner } else { outer }
        }
    }
}
