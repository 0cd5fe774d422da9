//! Check of the gradients of a cloud.
//!
//! Shape values are checked in every table: they sum to one. Gradients come from the inverse of a moment
//! matrix, which loses as many digits as its condition number has. Maximum-entropy gradients on a face lose
//! twice as many. A displacement can be correct to rounding while the strain has no correct digit.

use cases::scene::ErrorKind;
use geometry::Point3;
use shape::{GradRows, position_alone};

use crate::error::{Failure, Key};

/// Largest relative error accepted in the gradient of a linear field. No later step of a run detects this
/// error, and relevant errors lie above the limit. Valid clouds have errors of 1e-14 to 1e-9, or up to 2e-7
/// for maximum entropy on faces.
const LIMIT: f64 = 1e-4;

/// Refuses gradients that do not reproduce linear fields. `nodes` (m) are the nodes of the method.
pub(crate) fn check(key: Key, nodes: &[Point3], rows: &GradRows) -> Result<(), Failure> {
    let Some((q, off)) = rows.worst_reproduction(nodes).filter(|(_, off)| *off > LIMIT) else {
        return Ok(());
    };
    let problem = format!(
        "has inaccurate gradients: at {}, with {} nodes, the gradient of a linear field has a \
         relative error of {off:.1e}; stresses are computed up to {LIMIT:e}",
        position_alone(&rows.points()[q]),
        rows.row(q).0.len()
    );
    let help = "take rule = \"cell-smoothed\", which forms gradients from values, or cells with edges of similar length";
    Err(Failure::at(ErrorKind::NotRun, key, problem, help))
}
