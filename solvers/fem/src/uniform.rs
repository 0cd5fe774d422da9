//! Hexahedra with uniform strain: one point, the mean gradients of the cell, and hourglass control.

use geometry::{CellKind, Mesh, Point3, Vector3};
use shape::{GradRows, HOURGLASS, Hourglass, HourglassModulus, Rows, VolumeRows};

use crate::error::FemError;
use crate::rule::VolumeRule;
use crate::volume::{UNITY, volume_rows};

/// Number of nodes of a hexahedron.
const NODES: usize = 8;

/// Returns one row per trilinear hexahedron with the exact mean gradients `b_a` of its shape functions
/// (Flanagan & Belytschko, Int. J. Numer. Meth. Engng 17 (1981) 679-706), and hourglass control of stiffness
/// `coefficient V sum_a |b_a|^2 / 8` per `modulus`.
///
/// With the P-wave modulus, the stiffness against a pattern of length 1 is `coefficient` times an
/// upper bound of the largest eigenvalue of the cell's uniform strain. The volume and the mean gradients are
/// those of 2 x 2 x 2 Gauss points, whose degree of 3 is exact: `det J` and the cofactors of `J` are of degree
/// two along each axis. The gradients at the centre would fail the patch test in distorted cells, whose
/// volume they do not have.
///
/// # Errors
///
/// [`FemError::NoRule`] if a cell is no trilinear hexahedron, [`FemError::InvertedElement`] with the first cell
/// that has `det J <= 0` at a Gauss point, and [`FemError::Shape`] if the coefficient is negative or not finite.
pub fn uniform_rows(
    mesh: &Mesh,
    coefficient: f64,
    modulus: HourglassModulus,
) -> Result<VolumeRows, FemError> {
    let other = (0..mesh.cell_count()).map(|cell| mesh.kind(cell)).find(|kind| *kind != CellKind::Hex8);
    if let Some(kind) = other {
        let (kind, known) = (kind.name(), CellKind::Hex8.name().into());
        return Err(FemError::NoRule { kind, points: 1, counted: "point with hourglass control", known });
    }
    let full = volume_rows(mesh, &VolumeRule::STANDARD)?;
    let per_cell = VolumeRule::STANDARD.points(CellKind::Hex8);
    let cells = mesh.cell_count();
    let (mut points, mut weights) = (Vec::with_capacity(cells), Vec::with_capacity(cells));
    let (mut nodes, mut grads) = (Vec::with_capacity(NODES * cells), Vec::with_capacity(NODES * cells));
    let (mut moments, mut lengths) = (Vec::with_capacity(cells), Vec::with_capacity(cells));
    for cell in 0..cells {
        let own = cell * per_cell..(cell + 1) * per_cell;
        let volume: f64 = full.weights()[own.clone()].iter().sum();
        let mut mean = [Vector3::zeros(); NODES];
        for q in own {
            let weight = full.weights()[q] / volume;
            mean.iter_mut().zip(full.row(q).1).for_each(|(mean, grad)| *mean += grad * weight);
        }
        let list = mesh.cell(cell);
        let first = mesh.points()[list[0] as usize];
        let offset = |a: usize| mesh.points()[list[a] as usize] - first;
        let middle: Vector3 = (0..NODES).map(|a| offset(a) / NODES as f64).sum();
        points.push(Point3::from(first.coords + middle));
        moments.push(HOURGLASS.map(|base| (0..NODES).map(|a| offset(a) * base[a]).sum::<Vector3>()));
        lengths.push(coefficient * volume * mean.iter().map(Vector3::norm_squared).sum::<f64>() / 8.0);
        weights.push(volume);
        nodes.extend_from_slice(list);
        grads.extend_from_slice(&mean);
    }
    let offsets = (0..=cells).map(|cell| NODES * cell).collect();
    let values = vec![1.0 / NODES as f64; NODES * cells];
    let rows = Rows::new(mesh.points().len(), offsets, nodes, values, UNITY)?;
    let rows = VolumeRows::new(GradRows::new(points, rows, grads)?, weights)?;
    Ok(rows.controlled(Hourglass::new(modulus, moments, lengths)?)?)
}
