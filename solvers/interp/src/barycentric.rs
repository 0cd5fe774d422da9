//! Linear interpolation in a mesh of tetrahedra.

use catalogue::{Build, Entry};
use geometry::{Mesh, Point3, locate};
use nalgebra::Matrix3;
use shape::{GradRows, PointRows, Rows, Unity};

use crate::error::InterpError;
use crate::neighbours::check_finite;
use crate::transfer::{Source, Transfer, TransferInfo};

/// The scheme of [`barycentric`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Barycentric;

pub(crate) const ENTRY: Entry<Build<Barycentric>> = Entry {
    name: "barycentric",
    meaning: "linear interpolation in the tetrahedra of the mesh",
    source: "",
    parameters: &[],
    build: |_| Ok(Barycentric),
};

impl Transfer for Barycentric {
    fn name(&self) -> &'static str {
        ENTRY.name
    }

    fn exact_degree(&self) -> Option<usize> {
        Some(1)
    }

    fn interpolates(&self) -> bool {
        true
    }

    fn rows(&self, source: Source, targets: &[Point3]) -> Result<(PointRows, TransferInfo), InterpError> {
        barycentric(source.mesh("barycentric")?, targets)
    }

    fn grad_rows(&self, source: Source, targets: &[Point3]) -> Result<(GradRows, TransferInfo), InterpError> {
        barycentric_gradients(source.mesh("barycentric")?, targets)
    }
}

/// Builds the table of linear interpolation in tetrahedra, `u(x) = sum_a lambda_a(x) u_a`, with the
/// barycentric coordinates `lambda` of the tetrahedron that contains the target.
///
/// The scheme is exact for linear fields everywhere, interpolates, and is continuous within the mesh. A
/// target outside the mesh takes the extrapolated linear field of the closest tetrahedron and is counted in
/// [`TransferInfo::outside`]. A curved body always has such targets, at a small fraction of a cell. For
/// quadratic tetrahedra only the corners are used.
///
/// # Errors
/// Coordinates that are not finite, and a mesh with other cells than tetrahedra or with flat cells.
pub fn barycentric(mesh: &Mesh, targets: &[Point3]) -> Result<(PointRows, TransferInfo), InterpError> {
    check_finite(mesh.points(), targets)?;
    let mut info = TransferInfo::default();
    let mut nodes = Vec::with_capacity(4 * targets.len());
    let mut values = Vec::with_capacity(4 * targets.len());
    for (x, place) in targets.iter().zip(locate(mesh, targets)?) {
        let cell = place.cell as usize;
        nodes.extend_from_slice(&mesh.cell(cell)[..4]);
        if place.outside > 0.0 {
            info.outside += 1;
            values.extend(extrapolated(mesh, cell, x)?);
        } else {
            values.extend(place.barycentric);
        }
    }
    let offsets = (0..=targets.len()).map(|row| 4 * row).collect();
    let rows = Rows::new(mesh.points().len(), offsets, nodes, values, Unity::Within(1e-9))?;
    Ok((PointRows::new(targets.to_vec(), rows)?, info))
}

/// Builds the table of [`barycentric`] with gradients (1/m), which are constant in each tetrahedron.
pub fn barycentric_gradients(
    mesh: &Mesh,
    targets: &[Point3],
) -> Result<(GradRows, TransferInfo), InterpError> {
    let (rows, info) = barycentric(mesh, targets)?;
    let mut grads = Vec::with_capacity(4 * targets.len());
    for corners in rows.rows().nodes().chunks_exact(4) {
        let [o, a, b, c] = [0, 1, 2, 3].map(|k| mesh.points()[corners[k] as usize]);
        let edges = Matrix3::from_columns(&[a - o, b - o, c - o]);
        // Flat cells are already refused by the location of targets.
        let inverse = edges.try_inverse().unwrap_or_else(Matrix3::zeros);
        let [ga, gb, gc] = [0, 1, 2].map(|k| inverse.row(k).transpose());
        grads.extend([-ga - gb - gc, ga, gb, gc]);
    }
    Ok((GradRows::new(targets.to_vec(), rows.rows().clone(), grads)?, info))
}

/// Returns the barycentric coordinates of any point; outside the tetrahedron some are negative.
fn extrapolated(mesh: &Mesh, cell: usize, x: &Point3) -> Result<[f64; 4], InterpError> {
    let corner = |a: usize| mesh.points()[mesh.cell(cell)[a] as usize];
    let origin = corner(0);
    let edges = Matrix3::from_columns(&[corner(1) - origin, corner(2) - origin, corner(3) - origin]);
    let flat = || geometry::LocateError::Flat { cell, det_j: edges.determinant() };
    let l = edges.try_inverse().ok_or_else(flat)? * (x - origin);
    Ok([1.0 - l.x - l.y - l.z, l.x, l.y, l.z])
}
