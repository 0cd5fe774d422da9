//! Straight-sided background cells: positions and weights of the integration points.

use geometry::quadrature::Rule;
use geometry::{CellKind, Mesh};
use shape::{Matrix3, Point3, Vector3};

use crate::error::EfgError;

/// Appends the points and weights (m^3) of a tet4.
pub(crate) fn tet_points(
    mesh: &Mesh,
    cell: usize,
    rule: &Rule<3>,
    points: &mut Vec<Point3>,
    weights: &mut Vec<f64>,
) -> Result<(), EfgError> {
    let p = tet_corners(mesh, cell);
    let edges = [p[1] - p[0], p[2] - p[0], p[3] - p[0]];
    let det_j = positive_det(cell, &Matrix3::from_columns(&edges))?;
    for (xi, weight) in rule.points.iter().zip(&rule.weights) {
        points.push(p[0] + edges[0] * xi[0] + edges[1] * xi[1] + edges[2] * xi[2]);
        weights.push(weight * det_j);
    }
    Ok(())
}

/// Appends the points and weights (m^3) of a hex8.
pub(crate) fn hex_points(
    mesh: &Mesh,
    cell: usize,
    rule: &Rule<3>,
    points: &mut Vec<Point3>,
    weights: &mut Vec<f64>,
) -> Result<(), EfgError> {
    for (xi, weight) in rule.points.iter().zip(&rule.weights) {
        let mut x = Vector3::zeros();
        let mut jacobian = Matrix3::zeros();
        for (p, sign) in mesh.cell_points(cell).zip(&geometry::element::HEX_CORNERS) {
            let f: [f64; 3] = std::array::from_fn(|a| 0.5 * (1.0 + sign[a] * xi[a]));
            x += p.coords * (f[0] * f[1] * f[2]);
            let slope =
                Vector3::new(sign[0] * f[1] * f[2], sign[1] * f[2] * f[0], sign[2] * f[0] * f[1]) * 0.5;
            jacobian += p.coords * slope.transpose();
        }
        points.push(Point3::from(x));
        weights.push(weight * positive_det(cell, &jacobian)?);
    }
    Ok(())
}

/// Returns volume (m^3) and centroid of a tet4.
pub(crate) fn tet_measure(mesh: &Mesh, cell: usize) -> Result<(f64, Point3), EfgError> {
    if mesh.kind(cell) != CellKind::Tet4 {
        let kind = mesh.kind(cell);
        let what = "cell smoothing";
        return Err(EfgError::CellKind { cell, kind, what, allowed: "tet4" });
    }
    let p = tet_corners(mesh, cell);
    let det_j = positive_det(cell, &Matrix3::from_columns(&[p[1] - p[0], p[2] - p[0], p[3] - p[0]]))?;
    let centroid = p[0] + ((p[1] - p[0]) + (p[2] - p[0]) + (p[3] - p[0])) / 4.0;
    Ok((det_j / 6.0, centroid))
}

fn tet_corners(mesh: &Mesh, cell: usize) -> [Point3; 4] {
    let mut corners = [Point3::origin(); 4];
    corners.iter_mut().zip(mesh.cell_points(cell)).for_each(|(corner, p)| *corner = *p);
    corners
}

fn positive_det(cell: usize, jacobian: &Matrix3) -> Result<f64, EfgError> {
    let det_j = jacobian.determinant();
    if det_j > 0.0 { Ok(det_j) } else { Err(EfgError::InvertedCell { cell, det_j }) }
}
