//! Linear interpolation in a mesh of tetrahedra.

use catalogue::Entry;
use geometry::{Mesh, Point3, locate};
use nalgebra::Matrix3;
use shape::{GradRows, PointRows, Rows, Unity};

use crate::neighbours::check_finite;
use crate::scheme::{SchemeEntry, Source, Transfer};
use crate::{InterpError, TransferInfo};

/// [`barycentric`] as a scheme.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Barycentric;

pub(crate) const ENTRY: SchemeEntry = Entry {
    name: "barycentric",
    meaning: "linear interpolation in the tetrahedra of the mesh",
    source: "",
    parameters: &[],
    build: |_| Ok(Barycentric.into()),
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

/// `u(x) = sum_a lambda_a(x) u_a` over the four corners of the tetrahedron that holds the target, `lambda`
/// its barycentric coordinates. Exact for linear fields, everywhere; interpolates; continuous within the
/// mesh.
///
/// A target outside the mesh takes the linear field of the closest tetrahedron, extrapolated (a curved body
/// always has such targets, a small part of a cell away), and is counted in [`TransferInfo::outside`]. Of
/// quadratic tetrahedra only the corners count; a mesh with other cells is refused.
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

/// [`barycentric`] with gradients (1/m), constant in each tetrahedron.
pub fn barycentric_gradients(
    mesh: &Mesh,
    targets: &[Point3],
) -> Result<(GradRows, TransferInfo), InterpError> {
    let (rows, info) = barycentric(mesh, targets)?;
    let mut grads = Vec::with_capacity(4 * targets.len());
    for corners in rows.rows().nodes().chunks_exact(4) {
        let [o, a, b, c] = [0, 1, 2, 3].map(|k| mesh.points()[corners[k] as usize]);
        let edges = Matrix3::from_columns(&[a - o, b - o, c - o]);
        // Flat cells are refused where targets are located.
        let inverse = edges.try_inverse().unwrap_or_else(Matrix3::zeros);
        let [ga, gb, gc] = [0, 1, 2].map(|k| inverse.row(k).transpose());
        grads.extend([-ga - gb - gc, ga, gb, gc]);
    }
    Ok((GradRows::new(targets.to_vec(), rows.rows().clone(), grads)?, info))
}

/// Barycentric coordinates of any point; some are negative outside the tetrahedron.
fn extrapolated(mesh: &Mesh, cell: usize, x: &Point3) -> Result<[f64; 4], InterpError> {
    let corner = |a: usize| mesh.points()[mesh.cell(cell)[a] as usize];
    let origin = corner(0);
    let edges = Matrix3::from_columns(&[corner(1) - origin, corner(2) - origin, corner(3) - origin]);
    let flat = || geometry::LocateError::Flat { cell, det_j: edges.determinant() };
    let l = edges.try_inverse().ok_or_else(flat)? * (x - origin);
    Ok([1.0 - l.x - l.y - l.z, l.x, l.y, l.z])
}
