//! Values of loads and supports at points.

use geometry::{Point3, Vector3};

use crate::error::{Failure, Key};
use crate::scenario::setup::Support;

/// Values of one load at its points: traction or pressure, Pa.
pub(super) enum Values {
    Traction(Vec<Vector3>),
    Pressure(Vec<f64>),
}

/// Values of a support at points, m.
pub(super) fn at(support: &Support, points: &[Point3]) -> Result<Vec<Vector3>, Failure> {
    points.iter().map(&support.value).collect::<Result<_, _>>().map_err(not_finite(&support.key, "move"))
}

/// Returns the error for a value of `below` at `key` that is not finite somewhere.
pub(super) fn not_finite(key: &str, below: &'static str) -> impl Fn(String) -> Failure {
    let key = Key::Scene(format!("{key}.{below}"));
    move |problem| {
        Failure::input(key.clone(), problem, "the value has to be finite at every point of the region")
    }
}
