//! Comparison of displacements with the exact solution or a reference.

use catalogue::metric;
use geometry::{Point3, Vector3};

use super::norms::{difference, exact_at};
use super::request::Request;
use super::solved::Solved;
use crate::outcome::{Metric, push};

/// Points where displacements are compared, m: the scene's targets, or the method's own nodes.
pub(super) fn compared<'a>(run: &Solved<'a>, request: &Request<'a>) -> &'a [Point3] {
    if request.targets.is_empty() { run.method.nodes() } else { request.targets }
}

/// Displacement (m) of the exact solution or the reference at these points; `None` if there is neither.
pub(super) fn against(run: &Solved, request: &Request) -> Option<Vec<Vector3>> {
    match (&run.setup.exact, request.reference) {
        (Some(exact), _) => Some(exact_at(exact.as_ref(), compared(run, request))),
        (None, reference) => reference.map(|reference| reference.targets.clone()),
    }
}

/// Adds the RMS of a difference along each axis and of its magnitude.
pub(super) fn push_difference(
    metrics: &mut Vec<Metric>,
    of: &'static metric::Metric,
    field: &[Vector3],
    against: &[Vector3],
) {
    let d = difference(field, against);
    for (part, value) in of.parts().into_iter().zip(d.rms.into_iter().chain([d.rms_magnitude])) {
        push(metrics, part, value);
    }
}
