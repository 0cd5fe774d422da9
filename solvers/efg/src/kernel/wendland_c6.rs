//! Wendland's function, C6.

use catalogue::{Build, Entry};

use super::weight::Weight;

/// Wendland's weight `(1 - q)^8 (32q^3 + 25q^2 + 8q + 1)`, with `q` the distance from the node over the
/// support radius. C6.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WendlandC6;

pub(super) const ENTRY: Entry<Build<WendlandC6>> = Entry {
    name: "wendland-c6",
    meaning: "(1 - q)^8 (32q^3 + 25q^2 + 8q + 1); C6",
    source: "Wendland (1995)",
    parameters: &[],
    build: |_| Ok(WendlandC6),
};

impl Weight for WendlandC6 {
    #[inline(always)]
    fn weight(self) -> impl Fn(f64) -> (f64, f64) {
        |q| {
            let s = 1.0 - q;
            let s2 = s * s;
            let s7 = s2 * s2 * s2 * s;
            (
                s7 * s * (((32.0 * q + 25.0) * q + 8.0) * q + 1.0),
                -22.0 * q * ((16.0 * q + 7.0) * q + 1.0) * s7,
            )
        }
    }
}
