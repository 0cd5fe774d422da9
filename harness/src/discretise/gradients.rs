//! Whether the gradients of a cloud are good.
//!
//! Values have a test of their own, that of every table: they sum to one. Gradients are the inverse of a moment matrix, which loses
//! as many digits as its condition number has, and of maximum entropy on a face twice as many. A displacement can be right
//! to rounding where the strain has no right digit.

use cases::scene::ErrorKind;
use geometry::Point3;
use shape::GradRows;

use crate::Failure;
use crate::error::Key;

/// The gradient of a linear field is off by this part of itself at most. Nothing later in a run sees it, and errors worth having
/// begin above. Those of sound clouds are off by 1e-14 to 1e-9; on faces, of maximum entropy, by up to 2e-7.
const LIMIT: f64 = 1e-4;

/// Refuses gradients that do not reproduce linear fields; `nodes` (m) are those of the method.
pub(crate) fn check(key: Key, nodes: &[Point3], rows: &GradRows) -> Result<(), Failure> {
    let Some((q, off)) = rows.worst_reproduction(nodes).filter(|(_, off)| *off > LIMIT) else {
        return Ok(());
    };
    let x = rows.points()[q];
    let problem = format!(
        "has bad gradients: at ({:e}, {:e}, {:e}) m those of {} nodes make the gradient of a linear field {off:.1e} of itself \
         wrong; {LIMIT:e} is the most that a stress is taken from",
        x.x,
        x.y,
        x.z,
        rows.row(q).0.len()
    );
    let help =
        "take rule = \"cell-smoothed\", whose gradients are made of values, or cells of more equal edges";
    Err(Failure::at(ErrorKind::NotRun, key, problem, help))
}
