//! Numbers and positions in messages.

use crate::Point3;

pub(super) fn point(p: &Point3) -> String {
    format!("({}, {}, {})", short(p.x), short(p.y), short(p.z))
}

/// Rounds to seven digits, the precision of single precision.
fn short(x: f64) -> f64 {
    format!("{x:.6e}").parse().unwrap_or(x)
}

/// Rounds to three digits.
pub(super) fn rounded(x: f64) -> f64 {
    format!("{x:.2e}").parse().unwrap_or(x)
}
