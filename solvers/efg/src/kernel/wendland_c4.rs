//! Wendland's function, C4.

use catalogue::{Build, Entry};

use super::weight::Weight;

/// Wendland's weight `(1 - q)^6 (35q^2 + 18q + 3) / 3`, with `q` the distance from the node over the support
/// radius. C4.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WendlandC4;

pub(super) const ENTRY: Entry<Build<WendlandC4>> = Entry {
    name: "wendland-c4",
    meaning: "(1 - q)^6 (35q^2 + 18q + 3) / 3; C4",
    source: "Wendland (1995)",
    parameters: &[],
    build: |_| Ok(WendlandC4),
};

impl Weight for WendlandC4 {
    #[inline(always)]
    fn weight(self) -> impl Fn(f64) -> (f64, f64) {
        |q| {
            let s = 1.0 - q;
            let s5 = s * s * s * s * s;
            (s5 * s * (35.0 * q * q + 18.0 * q + 3.0) / 3.0, -56.0 / 3.0 * q * (5.0 * q + 1.0) * s5)
        }
    }
}
