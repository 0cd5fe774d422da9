//! Reduced models: modes of deformation, and cells whose weighted forces stand for those of all cells.

use algebra::nonnegative_weights;
use geometry::Vector3;
use shape::{DilationGroups, GradRows, Layout, Rows, ShapeError, Unity, VolumeRows};
use statics::Basis;

use crate::discretise::Volume;
use crate::error::Failure;

/// Error of the forces in the training states, relative to those of all cells, at which no further cell is
/// taken.
const ENOUGH: f64 = 1e-3;

/// A reduced model.
pub struct Reduced {
    /// Modes of deformation.
    pub basis: Basis,
    /// Quadrature in the chosen cells; `None` for that of the method.
    pub volume: Option<Volume>,
    /// Coefficients of the modes in each state of the training, m.
    pub states: Vec<Vec<f64>>,
    /// Part of the cells in which forces are evaluated.
    pub cells: f64,
    /// Error of the chosen cells' forces on the modes in the training states, relative to those of all cells.
    pub error: f64,
}

impl Reduced {
    /// Returns the largest distance of displacements (m, by node) from the nearest state of the training,
    /// relative to the largest of them, both as coefficients of the modes.
    pub fn distance(&self, fields: &[Vec<Vector3>]) -> f64 {
        let (mut farthest, mut largest) = (0.0f64, 0.0f64);
        for field in fields {
            let at = self.basis.project(field);
            let from = |state: &Vec<f64>| at.iter().zip(state).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
            farthest = farthest.max(self.states.iter().map(from).fold(f64::INFINITY, f64::min).sqrt());
            largest = largest.max(at.iter().map(|a| a * a).sum::<f64>().sqrt());
        }
        if largest > 0.0 { farthest / largest } else { 0.0 }
    }
}

/// Chooses at most a part of the cells, with weights for which the works of the stresses along the modes (J,
/// for each state by point and mode) add up to those of all points. Returns the quadrature, the number of
/// cells taken and of all, and the relative error.
///
/// Source: energy-conserving sampling and weighting, Farhat et al., Int. J. Numer. Meth. Engng 98 (2014),
/// 625-662.
pub fn chosen(
    volume: &Volume,
    works: &[Vec<Vec<f64>>],
    part: f64,
) -> Result<(Volume, [usize; 2], f64), Failure> {
    let cells = cells(volume);
    let modes = works.first().and_then(|points| points.first()).map_or(0, Vec::len);
    let column = |cell: &[usize]| -> Vec<f64> {
        let mut column = vec![0.0; works.len() * modes];
        for (entries, works) in column.chunks_exact_mut(modes.max(1)).zip(works) {
            for &q in cell {
                entries.iter_mut().zip(&works[q]).for_each(|(sum, work)| *sum += work);
            }
        }
        column
    };
    let columns: Vec<Vec<f64>> = cells.iter().map(|cell| column(cell)).collect();
    let all = column(&(0..volume.rows.weights().len()).collect::<Vec<_>>());
    let most = ((part * cells.len() as f64).round() as usize).max(1);
    let (weights, error) = nonnegative_weights(&columns, &all, ENOUGH, most);
    let taken: Vec<(&[usize], f64)> =
        weights.iter().map(|&(cell, weight)| (&cells[cell][..], weight)).collect();
    Ok((restricted(volume, &taken)?, [taken.len(), cells.len()], error))
}

/// Points of each cell: those that share a dilation or belong to one cell of a mesh.
fn cells(volume: &Volume) -> Vec<Vec<usize>> {
    let count = volume.rows.weights().len();
    if let Some(groups) = &volume.groups {
        return (0..groups.len()).map(|a| groups.group(a).0.iter().map(|&q| q as usize).collect()).collect();
    }
    let points = match volume.rows.layout() {
        Layout::Cells { points, .. } => points,
        Layout::General | Layout::LinearTetrahedra => 1,
    };
    (0..count / points).map(|cell| (cell * points..(cell + 1) * points).collect()).collect()
}

/// Quadrature of some cells, whose weights are multiplied.
fn restricted(volume: &Volume, taken: &[(&[usize], f64)]) -> Result<Volume, ShapeError> {
    let points: Vec<(usize, f64)> =
        taken.iter().flat_map(|(cell, weight)| cell.iter().map(move |&q| (q, *weight))).collect();
    let rows = volume.rows.rows();
    let (mut offsets, mut nodes, mut values, mut grads) = (vec![0], Vec::new(), Vec::new(), Vec::new());
    for &(q, _) in &points {
        let (near, at) = rows.row(q);
        nodes.extend_from_slice(near);
        values.extend_from_slice(at);
        grads.extend_from_slice(volume.rows.row(q).1);
        offsets.push(nodes.len());
    }
    let table = Rows::new(rows.node_count(), offsets, nodes, values, Unity::NotPromised)?;
    let at = points.iter().map(|&(q, _)| volume.rows.points()[q]).collect();
    let weights = points.iter().map(|&(q, weight)| weight * volume.rows.weights()[q]).collect();
    let rows = VolumeRows::new(GradRows::new(at, table, grads)?, weights)?.laid_out(volume.rows.layout())?;
    let groups = match &volume.groups {
        Some(_) => Some(DilationGroups::of_cells(taken.iter().map(|(cell, _)| cell.len()))?),
        None => None,
    };
    fn of<T: Copy>(all: &[T], points: &[(usize, f64)]) -> Vec<T> {
        if all.is_empty() { Vec::new() } else { points.iter().map(|&(q, _)| all[q]).collect() }
    }
    Ok(Volume {
        rows,
        region: of(&volume.region, &points),
        axes: of(&volume.axes, &points),
        groups,
        pressure: None,
        diagnostics: Vec::new(),
    })
}
