//! Axes of the material at the quadrature points.

use geometry::{Point3, Vector3};
use material::Material as _;
use shape::{Matrix3, RowSource, position_alone};

use super::wall::Walls;
use crate::discretise::{Discretisation, Volume};
use crate::error::{Failure, Key};
use crate::scenario::setup::{Direction, Directions, Setup};

/// Length of a direction, relative to the given vector, below which two directions are the same.
const PARALLEL: f64 = 1e-6;

/// Returns the axes of the material at every point of a volume; none if no law depends on them and nothing
/// contracts.
///
/// # Errors
/// Returns an error, with the position, if a direction is zero or not finite, or if a sheet lies along its
/// fibre; or if the depth of a wall cannot be determined.
pub(super) fn axes(
    method: &Discretisation,
    source: &dyn RowSource,
    volume: &Volume,
    setup: &Setup,
) -> Result<Vec<Matrix3>, Failure> {
    if setup.active.is_empty() && setup.laws.iter().all(|law| !law.has_axes()) {
        return Ok(Vec::new());
    }
    let mut walls = Walls::new(method, source, &volume.rows);
    let points = volume.rows.points();
    let mut axes = vec![Matrix3::identity(); points.len()];
    for (region, of) in setup.directions.iter().enumerate() {
        let Some(of) = of else { continue };
        let own: Vec<usize> = (0..points.len()).filter(|&q| volume.region(q) == region).collect();
        let fibers = units(of, "fibers", &of.fibers, points, &own, &mut walls)?;
        let sheets = of.sheets.as_ref().map(|sheets| units(of, "sheets", sheets, points, &own, &mut walls));
        let sheets = sheets.transpose()?;
        for (k, &q) in own.iter().enumerate() {
            let across = match &sheets {
                None => Vector3::ith(fibers[k].iamin(), 1.0),
                Some(sheets) => sheets[k],
            };
            axes[q] = frame(of, fibers[k], across, &points[q])?;
        }
    }
    Ok(axes)
}

/// Unit directions at some of the points, by their indices.
fn units(
    of: &Directions,
    key: &str,
    direction: &Direction,
    points: &[Point3],
    own: &[usize],
    walls: &mut Walls,
) -> Result<Vec<Vector3>, Failure> {
    let key = format!("{}.{key}", of.key);
    match direction {
        Direction::Field(field) => own.iter().map(|&q| unit(&key, field(&points[q]), &points[q])).collect(),
        Direction::File(vectors) => {
            let at: Vec<Point3> = own.iter().map(|&q| points[q]).collect();
            vectors.at(&at).map_err(|bad| {
                let help = "give a direction for every cell or node of the material";
                Failure::input(Key::Scene(format!("{key}.data")), bad, help)
            })
        }
        Direction::Wall(rule) => walls.directions(&key, rule, own),
    }
}

fn unit(key: &str, vector: Result<Vector3, String>, x: &Point3) -> Result<Vector3, Failure> {
    let refuse = |problem: String, help: &str| Failure::input(Key::Scene(key.into()), problem, help);
    let vector = vector.map_err(|bad| refuse(bad, "the direction has to be finite at every point"))?;
    vector.try_normalize(f64::MIN_POSITIVE).ok_or_else(|| {
        let problem = format!("is zero at {}", position_alone(x));
        refuse(problem, "give a direction at every point of the material")
    })
}

/// Axes of a unit fibre and a direction across it, of any length.
fn frame(of: &Directions, fibre: Vector3, across: Vector3, x: &Point3) -> Result<Matrix3, Failure> {
    let sheet = (across - fibre * fibre.dot(&across)).try_normalize(PARALLEL).ok_or_else(|| {
        let problem = format!("lies along the fibre at {}", position_alone(x));
        let key = Key::Scene(format!("{}.sheets", of.key));
        Failure::input(key, problem, "give a direction across the fibre")
    })?;
    Ok(Matrix3::from_columns(&[fibre, sheet, fibre.cross(&sheet)]))
}
