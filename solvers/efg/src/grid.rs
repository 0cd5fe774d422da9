//! Gauss points on a regular grid over the body; points outside are dropped.

use geometry::quadrature;
use shape::{Point3, VolumeRows};

use crate::approximation::Approximation;
use crate::error::EfgError;
use crate::info::MlsInfo;

/// Largest number of points of a grid. A larger grid usually indicates a wrong unit.
const MOST_POINTS: f64 = 2e7;

/// Result of clipping a grid by the body.
#[derive(Clone, Debug, PartialEq)]
pub struct GridInfo {
    /// Number of grid cells along each axis.
    pub cells: [usize; 3],
    /// Size of a cell along each axis, m.
    pub size: [f64; 3],
    /// Number of points kept, i.e. inside the body.
    pub kept: usize,
    /// Number of points dropped, i.e. outside the body.
    pub dropped: usize,
    /// Sum of the kept weights, m^3. The difference from the body's volume is the clipping error.
    pub volume: f64,
}

/// Computes shape values and gradients at `points_per_axis^3` Gauss points per grid cell, for the points that
/// lie `inside`.
///
/// The grid fills the box from `min` to `max` with cells of size `spacing` (m) or slightly less. Points
/// outside the body are dropped with their whole weight, so the volume is correct only on average. The error
/// is of the order of the surface area times the distance between points; it is reported in
/// [`GridInfo::volume`] and not corrected. The first element-free codes integrated over a body without a mesh
/// in this way (Belytschko, Lu and Gu 1994).
pub fn grid_rows(
    approximation: &Approximation,
    inside: impl Fn(&Point3) -> bool,
    (min, max): (Point3, Point3),
    spacing: f64,
    points_per_axis: usize,
) -> Result<(VolumeRows, GridInfo, MlsInfo), EfgError> {
    if !(spacing > 0.0 && spacing.is_finite()) {
        return Err(EfgError::BadParameter {
            what: "grid spacing",
            value: spacing,
            allowed: "a positive length",
        });
    }
    if !(1..=10).contains(&points_per_axis) {
        let value = points_per_axis as f64;
        return Err(EfgError::BadParameter { what: "grid points per axis", value, allowed: "1 to 10" });
    }
    let extent = max - min;
    if let Some(&value) = extent.iter().find(|&&e| !(e > 0.0 && e.is_finite())) {
        return Err(EfgError::BadParameter {
            what: "extent of the body",
            value,
            allowed: "a positive length",
        });
    }
    // An extent that is an integer multiple of the spacing, except for rounding, gives exactly this number of
    // cells.
    let exact: [f64; 3] = std::array::from_fn(|a| (extent[a] / spacing - 1e-9).ceil().max(1.0));
    let total = exact.iter().product::<f64>() * (points_per_axis as f64).powi(3);
    if total > MOST_POINTS {
        return Err(EfgError::HugeGrid { points: total, spacing, limit: MOST_POINTS });
    }
    let cells = exact.map(|n| n as usize);
    let size: [f64; 3] = std::array::from_fn(|a| extent[a] / exact[a]);
    let (abscissae, line_weights) = quadrature::gauss_legendre(points_per_axis);
    let along = |axis: usize| -> Vec<(f64, f64)> {
        let at = |cell: usize, k: usize| min[axis] + size[axis] * (cell as f64 + 0.5 * (1.0 + abscissae[k]));
        (0..cells[axis])
            .flat_map(|cell| (0..points_per_axis).map(move |k| (cell, k)))
            .map(|(cell, k)| (at(cell, k), 0.5 * size[axis] * line_weights[k]))
            .collect()
    };
    let (xs, ys, zs) = (along(0), along(1), along(2));
    let (mut points, mut weights) = (Vec::new(), Vec::new());
    for &(x, wx) in &xs {
        for &(y, wy) in &ys {
            for &(z, wz) in &zs {
                let point = Point3::new(x, y, z);
                if inside(&point) {
                    points.push(point);
                    weights.push(wx * wy * wz);
                }
            }
        }
    }
    let tried = xs.len() * ys.len() * zs.len();
    if points.is_empty() {
        return Err(EfgError::EmptyGrid { points: tried, spacing });
    }
    let kept = points.len();
    let grid = GridInfo { cells, size, kept, dropped: tried - kept, volume: weights.iter().sum() };
    let (at, info) = approximation.grad_rows(&points)?;
    Ok((VolumeRows::new(at, weights)?, grid, info))
}
