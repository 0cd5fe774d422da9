//! Recovery of a cloud's gradients, as an error indicator.
//!
//! At every node the displacement gradients at the points in its support are fitted by a linear field, by
//! least squares with weights `w_q phi_I(x_q)`. Between nodes the fits are blended by the shape functions.
//! The difference of the gradients from this field is an error indicator: Zienkiewicz & Zhu (1992), with
//! patches of a cloud instead of patches of elements.

use nalgebra::{Matrix4, SMatrix};
use rayon::prelude::*;
use shape::{Matrix3, Point3, Vector3, VolumeRows};

/// Coefficients of a linear field of displacement gradients: 1, x, y, z by the nine components.
type Fit = SMatrix<f64, 4, 9>;

/// Returns the estimated error (dimensionless) of the displacement gradient at each node, for nodal
/// parameters `u` (m) and node positions `nodes` (m). The error is the difference between the gradients and a
/// smoother field fitted to them, as the root mean square over the quadrature points in the node's support.
pub fn gradient_error(volume: &VolumeRows, u: &[Vector3], nodes: &[Point3]) -> Vec<f64> {
    let gradients: Vec<Matrix3> = volume.at().displacement_gradients(u);
    let points = volume.points();
    let of_nodes = covered(volume, nodes.len());
    let fits: Vec<Option<Fit>> =
        nodes.par_iter().zip(&of_nodes).map(|(at, rows)| fit(at, rows, points, &gradients)).collect();
    let squares: Vec<f64> = (0..points.len())
        .into_par_iter()
        .map(|q| {
            let (row, values) = volume.rows().row(q);
            let (mut recovered, mut total) = (Matrix3::zeros(), 0.0);
            for (&node, &phi) in row.iter().zip(values) {
                if let Some(fit) = &fits[node as usize] {
                    recovered += phi * at_offset(fit, &(points[q] - nodes[node as usize]));
                    total += phi;
                }
            }
            if total > 0.5 { (recovered / total - gradients[q]).norm_squared() } else { 0.0 }
        })
        .collect();
    let mean = |rows: &Vec<(u32, f64)>| {
        let (sum, weight) =
            rows.iter().fold((0.0, 0.0), |(s, t), &(q, w)| (s + w * squares[q as usize], t + w));
        if weight > 0.0 { (sum / weight).sqrt() } else { 0.0 }
    };
    of_nodes.iter().map(mean).collect()
}

/// Returns the points in each node's support with their weights `w_q phi_I(x_q)`. Negative values of a
/// quadratic basis are left out.
fn covered(volume: &VolumeRows, nodes: usize) -> Vec<Vec<(u32, f64)>> {
    let mut of_nodes = vec![Vec::new(); nodes];
    for (q, w) in volume.weights().iter().enumerate() {
        let (row, values) = volume.rows().row(q);
        for (&node, &phi) in row.iter().zip(values).filter(|(_, phi)| **phi > 0.0) {
            of_nodes[node as usize].push((q as u32, w * phi));
        }
    }
    of_nodes
}

/// Fits a linear field; `None` if the points do not determine it.
fn fit(at: &Point3, rows: &[(u32, f64)], points: &[Point3], gradients: &[Matrix3]) -> Option<Fit> {
    let reach = rows.iter().map(|&(q, _)| (points[q as usize] - at).norm()).fold(0.0, f64::max);
    let (mut moment, mut right) = (Matrix4::zeros(), Fit::zeros());
    for &(q, w) in rows {
        let s = (points[q as usize] - at) / reach;
        let p = nalgebra::Vector4::new(1.0, s.x, s.y, s.z);
        let gradient = SMatrix::<f64, 1, 9>::from_iterator(gradients[q as usize].iter().copied());
        moment += w * p * p.transpose();
        right += w * p * gradient;
    }
    let scale = moment[(0, 0)];
    let factors = (moment / scale).cholesky().filter(|l| l.l_dirty().diagonal().min() > 1e-4)?;
    let mut fit = factors.solve(&(right / scale));
    for axis in 1..4 {
        fit.row_mut(axis).unscale_mut(reach);
    }
    Some(fit)
}

fn at_offset(fit: &Fit, e: &Vector3) -> Matrix3 {
    let row = fit.row(0) + e.x * fit.row(1) + e.y * fit.row(2) + e.z * fit.row(3);
    Matrix3::from_iterator(row.iter().copied())
}
