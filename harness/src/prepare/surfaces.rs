//! Rows of shape functions over parts of the surface.

use geometry::{Point3, Vector3, quadrature};
use shape::{FluxRows, PointRows, RowSource, SurfaceRows};

use crate::discretise::place::{CutTriangle, Patch};
use crate::error::Failure;

/// Points per clipped triangle: a rule of degree 4, exact for a quadratic traction on the triangle.
const CUT_POINTS: usize = 6;

/// Builds rows with gradients over a patch of the surface.
pub(crate) fn flux(source: &dyn RowSource, patch: &Patch) -> Result<Vec<FluxRows>, Failure> {
    let mut surfaces = Vec::new();
    if !patch.whole.is_empty() {
        surfaces.push(source.flux(&patch.whole)?);
    }
    if !patch.cut.is_empty() {
        let (points, weights, normals) = cut_points(&patch.cut);
        surfaces.push(FluxRows::new(source.gradients_at(&points)?, weights, normals)?);
    }
    Ok(surfaces)
}

/// Builds surface rows over clipped triangles.
pub(super) fn cut_surface(source: &dyn RowSource, cut: &[CutTriangle]) -> Result<SurfaceRows, Failure> {
    let (points, weights, normals) = cut_points(cut);
    let (rows, _) = source.at_points(&points)?;
    Ok(SurfaceRows::new(rows, weights, normals)?)
}

/// Returns points (m), weights (m^2) and outward unit normals on clipped triangles.
fn cut_points(cut: &[CutTriangle]) -> (Vec<Point3>, Vec<f64>, Vec<Vector3>) {
    let rule = quadrature::tri(CUT_POINTS).expect("a tabulated rule");
    let (mut points, mut weights, mut normals) = (Vec::new(), Vec::new(), Vec::new());
    for triangle in cut {
        let area = triangle.area_vector();
        let [a, b, c] = triangle.corners;
        for (xi, w) in rule.points.iter().zip(&rule.weights) {
            points.push(a + (b - a) * xi[0] + (c - a) * xi[1]);
            weights.push(2.0 * w * area.norm());
            normals.push(area.normalize());
        }
    }
    (points, weights, normals)
}

/// Returns the rows of a surface without their gradients.
pub(super) fn values_of(flux: &FluxRows) -> Result<SurfaceRows, Failure> {
    let at = PointRows::new(flux.points().to_vec(), flux.at().rows().clone())?;
    Ok(SurfaceRows::new(at, flux.weights().to_vec(), flux.normals().to_vec())?)
}
