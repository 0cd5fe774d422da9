//! The energy that bounds of a scene with an exact solution have to enclose.

use geometry::Point3;

use super::body::tetrahedra;
use crate::discretise::Discretisation;
use crate::error::Failure;
use crate::scenario::setup::Setup;

/// Strain energy of the scene's exact solution, J, by a finer quadrature than that of the bounds; `None`
/// without such a solution.
///
/// # Errors
/// A mesh with curved faces.
pub(crate) fn exact_energy(method: &Discretisation, setup: &Setup) -> Result<Option<f64>, Failure> {
    let Some(exact) = &setup.exact else { return Ok(None) };
    let finer = tetrahedra(method)?;
    let rows = fem::volume_rows(finer.mesh(), &fem::VolumeRule::FINE)?;
    let each = rows.weights().len() / finer.mesh().cell_count();
    let density = |(q, x): (usize, &Point3)| {
        let material = &setup.materials[usize::from(finer.mesh().region(q / each))];
        rows.weights()[q] * material.energy_density(&exact.gradient(x))
    };
    Ok(Some(rows.points().iter().enumerate().map(density).sum()))
}
