//! Axes of the material at the quadrature points.

use geometry::Vector3;
use material::Material as _;
use shape::{Matrix3, position_alone};

use crate::discretise::Volume;
use crate::error::{Failure, Key};
use crate::scenario::setup::{Directions, Setup};

/// Length of a direction, relative to the given vector, below which two directions are the same.
const PARALLEL: f64 = 1e-6;

/// Returns the axes of the material at every point of a volume; none if no law depends on them.
///
/// # Errors
/// Returns an error, with the position, if a direction is zero or not finite, or if a sheet lies along its
/// fibre.
pub(super) fn axes(volume: &Volume, setup: &Setup) -> Result<Vec<Matrix3>, Failure> {
    if setup.laws.iter().all(|law| !law.has_axes()) {
        return Ok(Vec::new());
    }
    let at = |(q, x)| match &setup.directions[volume.region(q)] {
        Some(directions) => at_point(directions, x),
        None => Ok(Matrix3::identity()),
    };
    volume.rows.points().iter().enumerate().map(at).collect()
}

fn at_point(of: &Directions, x: &geometry::Point3) -> Result<Matrix3, Failure> {
    let refuse = |key: &str, problem: String, help: &str| {
        let key = Key::Scene(format!("{}.{key}", of.key));
        Failure::input(key, problem, help)
    };
    let unit = |key: &str, vector: Result<Vector3, String>| {
        let vector =
            vector.map_err(|bad| refuse(key, bad, "the direction has to be finite at every point"))?;
        vector.try_normalize(f64::MIN_POSITIVE).ok_or_else(|| {
            let problem = format!("is zero at {}", position_alone(x));
            refuse(key, problem, "give a direction at every point of the material")
        })
    };
    let fibre = unit("fibers", (of.fibers)(x))?;
    let across = match &of.sheets {
        None => Vector3::ith(fibre.iamin(), 1.0),
        Some(sheets) => unit("sheets", sheets(x))?,
    };
    let sheet = (across - fibre * fibre.dot(&across)).try_normalize(PARALLEL).ok_or_else(|| {
        let problem = format!("lies along the fibre at {}", position_alone(x));
        refuse("sheets", problem, "give a direction across the fibre")
    })?;
    Ok(Matrix3::from_columns(&[fibre, sheet, fibre.cross(&sheet)]))
}
