//! Stiffness of hourglass control: springs between the nodes of a cell, which are constant in the reference
//! configuration.

use shape::{HOURGLASS_MODES, VolumeRows};

use crate::nonlinear::SurfaceTable;

/// Returns the rows of the hourglass control of a quadrature with the stiffness of each, N/m; `None` without
/// hourglass control. `moduli` gives the Lame moduli `lambda` and `mu` (Pa) of a point.
pub(crate) fn springs(volume: &VolumeRows, moduli: impl Fn(usize) -> [f64; 2]) -> Option<SurfaceTable> {
    let control = volume.hourglass()?;
    let stiffness = |cell: usize| [control.stiffness(cell, moduli(cell)); HOURGLASS_MODES];
    let weights = (0..control.len()).flat_map(stiffness).collect();
    Some(SurfaceTable::weighted(&volume.hourglass_rows()?, weights))
}
