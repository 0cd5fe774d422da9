//! Wendland's function, C2.

use catalogue::{Build, Entry};

use super::weight::Weight;

/// Wendland's weight `(1 - q)^4 (4q + 1)`, with `q` the distance from the node over the support radius. C2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WendlandC2;

pub(super) const ENTRY: Entry<Build<WendlandC2>> = Entry {
    name: "wendland-c2",
    meaning: "(1 - q)^4 (4q + 1); C2",
    source: "Wendland (1995)",
    parameters: &[],
    build: |_| Ok(WendlandC2),
};

impl Weight for WendlandC2 {
    #[inline(always)]
    fn weight(self) -> impl Fn(f64) -> (f64, f64) {
        |q| {
            let s = 1.0 - q;
            (s * s * s * s * (4.0 * q + 1.0), -20.0 * q * s * s * s)
        }
    }
}
