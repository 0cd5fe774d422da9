//! Hourglassing: strain that a method's own integration points do not see.
//!
//! Means over nodes and reduced quadrature ignore strain that alternates from cell to cell. A finer
//! quadrature of the same displacement finds its energy `D`. If dead loads do the work `2 E` on a linear
//! body, the same functions integrated finely have at least the energy `E^2 / (E + D)` (minimum of the
//! potential energy over the multiples of the displacement), so `D / E` bounds how much too soft the body is.
//!
//! Only the energy of shear counts. A volumetric projection ignores alternating dilation on purpose.

use catalogue::warning;
use geometry::{Matrix3, Point3, Vector3, quality};
use material::{Law, Material as _};
use shape::GradRows;

use super::solved::Solved;
use crate::discretise::region_at;
use crate::error::Failure;
use crate::outcome::Warning;
use crate::scenario::setup::Setup;

/// Ratio of hourglass energy to strain energy above which the warning is given.
const SOFT: f64 = 0.25;
/// Energy at rounding level, relative to that of the largest displacement taken as a strain across the body.
const ROUNDING: f64 = 1e-20;
/// Cells whose shape functions are stored together.
const CHUNK: usize = 8192;

/// Warns if a node-smoothed cloud ignores much of the strain energy. With an exact solution, the errors are
/// known and there is no warning.
pub(super) fn warning(run: &Solved, energy: Option<f64>, largest: f64) -> Result<Option<Warning>, Failure> {
    let Solved { method, setup, prepared, solution } = *run;
    if method.interpolates || !method.inner.vertices || setup.exact.is_some() {
        return Ok(None);
    }
    let own = &prepared.volume;
    let small = setup.is_linear() || setup.laws.iter().all(Law::is_small_strain);
    let averaged = shear(setup, own.rows.at(), own.rows.weights(), &own.region, &solution.u, small);
    let volume: f64 = own.rows.weights().iter().sum();
    let modulus = setup.materials.iter().map(|m| m.mu()).fold(0.0, f64::max);
    if averaged <= ROUNDING * modulus * largest * largest * volume.cbrt() {
        return Ok(None);
    }
    let mesh = method.mesh();
    let mut all = 0.0;
    let volumes = quality::volumes(mesh);
    for (chunk, volumes) in volumes.chunks(CHUNK).enumerate() {
        let cells = || chunk * CHUNK..chunk * CHUNK + volumes.len();
        let centre = |cell: usize| {
            let corners = mesh.cell_points(cell);
            Point3::from(corners.map(|p| p.coords / 4.0).sum::<Vector3>())
        };
        let centres = prepared.source.gradients_at(&cells().map(centre).collect::<Vec<_>>())?;
        let region: Vec<u16> = cells().map(|cell| mesh.region(cell)).collect();
        all += shear(setup, &centres, volumes, &region, &solution.u, small);
    }
    let relative = (all - averaged) / energy.map_or(averaged, |energy| energy.max(averaged));
    Ok((relative > SOFT).then(|| {
        let message = format!(
            "the means over nodes ignore strain that alternates from cell to cell, whose energy is {:.0} % of the strain energy: \
             displacements under given loads may be too large by up to that, and forces under given displacements too small. Use a \
             larger stabilisation, rule = \"cell-smoothed\" or smaller cells",
            100.0 * relative
        );
        Warning::new(&warning::HOURGLASSING, relative, "method.integration", message)
    }))
}

/// Energy of shear (J) of a displacement with nodal parameters `u` (m) at points with these weights (m^3).
/// `small` selects the linear strain.
pub(super) fn shear(
    setup: &Setup,
    rows: &GradRows,
    weights: &[f64],
    region: &[u16],
    u: &[Vector3],
    small: bool,
) -> f64 {
    let each = rows.displacement_gradients(u).into_iter().zip(weights).enumerate().map(|(q, (h, w))| {
        let law = &setup.materials[region_at(region, q)];
        let turned = if small { Matrix3::zeros() } else { h.transpose() * h };
        let strain = (h + h.transpose() + turned) * 0.5;
        w * law.mu() * (strain.norm_squared() - strain.trace().powi(2) / 3.0)
    });
    each.sum()
}
