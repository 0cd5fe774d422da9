#![allow(non_snake_case)] // K, T, V as in the formulas
//! Displacements restricted to a few recorded deformations: `u = sum_k a_k V_k`.
//!
//! The modes `V_k` are those of a proper orthogonal decomposition: no other set of as many deformations is
//! nearer to the recorded ones in the sum of the squares of their gradients. Equilibrium is required of the
//! coefficients alone, `V^T f = 0`, with the tangent `V^T K V`. Source: Sirovich, Turbulence and the dynamics
//! of coherent structures, part I, Quarterly of Applied Mathematics 45 (1987), 561-571.

use algebra::Stiffness;
use nalgebra::{DMatrix, SymmetricEigen};
use rayon::prelude::*;
use shape::{Matrix3, Vector3, VolumeRows};

use super::error::StaticError;
use super::solid::Solid;

/// Part of the largest recorded deformation below which a further mode is rounding.
const ROUNDING: f64 = 1e-7;

/// Modes of deformation of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Basis {
    len: usize,
    /// Orthonormal modes; for each node and axis the component of every mode.
    values: Vec<f64>,
}

impl Basis {
    /// Takes at most `most` modes from recorded displacements (m), one for each node of `volume`. There are
    /// fewer if the displacements are combinations of fewer. The distance of two displacements is that of their
    /// gradients, the square integrated over the body: forces depend on gradients.
    pub fn of_states(volume: &VolumeRows, states: &[Vec<Vector3>], most: usize) -> Basis {
        let count = states.len();
        let weights = volume.weights();
        let gradients: Vec<Vec<Matrix3>> =
            states.par_iter().map(|u| volume.at().displacement_gradients(u)).collect();
        let product = |i: usize, j: usize| -> f64 {
            let both = gradients[i].iter().zip(&gradients[j]).zip(weights);
            both.map(|((a, b), w)| w * a.dot(b)).sum()
        };
        let rows: Vec<Vec<f64>> =
            (0..count).into_par_iter().map(|i| (0..=i).map(|j| product(i, j)).collect()).collect();
        let products = DMatrix::from_fn(count, count, |i, j| rows[i.max(j)][i.min(j)]);
        let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(products);
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|&i, &j| eigenvalues[j].total_cmp(&eigenvalues[i]));
        let least = order.first().map_or(0.0, |&first| ROUNDING.powi(2) * eigenvalues[first]);
        let nodes = states.first().map_or(0, Vec::len);
        let mut modes: Vec<Vec<Vector3>> = Vec::new();
        for &at in order.iter().take(most).filter(|&&at| eigenvalues[at] > least) {
            let mut mode = vec![Vector3::zeros(); nodes];
            for (state, part) in states.iter().zip(eigenvectors.column(at).iter()) {
                mode.iter_mut().zip(state).for_each(|(m, u)| *m += u * *part);
            }
            // Orthonormal as vectors, so that coefficients are as large as displacements.
            for other in &modes {
                let part: f64 = mode.iter().zip(other).map(|(a, b)| a.dot(b)).sum();
                mode.iter_mut().zip(other).for_each(|(m, o)| *m -= o * part);
            }
            let norm = mode.iter().map(Vector3::norm_squared).sum::<f64>().sqrt();
            mode.iter_mut().for_each(|m| *m /= norm);
            modes.push(mode);
        }
        let values = (0..3 * nodes).flat_map(|dof| modes.iter().map(move |mode| mode[dof / 3][dof % 3]));
        Basis { len: modes.len(), values: values.collect() }
    }

    /// Number of modes.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there is no mode, because nothing has moved.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Components of all modes at a node along an axis.
    fn at(&self, node: usize, axis: usize) -> &[f64] {
        let start = (3 * node + axis) * self.len;
        &self.values[start..start + self.len]
    }

    /// Returns `V^T x`: the coefficients of a displacement, or the forces on the coefficients.
    pub fn project(&self, nodal: &[Vector3]) -> Vec<f64> {
        let mut sums = vec![0.0; self.len];
        for (node, x) in nodal.iter().enumerate().filter(|(_, x)| **x != Vector3::zeros()) {
            for axis in 0..3 {
                sums.iter_mut().zip(self.at(node, axis)).for_each(|(sum, v)| *sum += v * x[axis]);
            }
        }
        sums
    }

    /// Adds `factor V a` to nodal vectors.
    pub fn add_to(&self, a: &[f64], factor: f64, nodal: &mut [Vector3]) {
        for (node, x) in nodal.iter_mut().enumerate() {
            for axis in 0..3 {
                let sum: f64 = self.at(node, axis).iter().zip(a).map(|(v, a)| v * a).sum();
                x[axis] += factor * sum;
            }
        }
    }

    /// Returns the symmetric tangent `V^T K V`, N/m.
    pub(crate) fn tangent(&self, K: &Stiffness) -> DMatrix<f64> {
        let nodes = self.values.len() / (3 * self.len).max(1);
        // T = K V, of the lower triangle: its other half is the transpose of the sum.
        let mut T = vec![0.0; 3 * self.len];
        let mut sum = DMatrix::zeros(self.len, self.len);
        for i in 0..nodes {
            let (columns, blocks) = K.row(i);
            T.fill(0.0);
            let mut some = false;
            for (&j, block) in columns.iter().zip(blocks).filter(|(_, block)| **block != Matrix3::zeros()) {
                some = true;
                let half = if j as usize == i { 0.5 } else { 1.0 };
                for a in 0..3 {
                    let row = &mut T[a * self.len..(a + 1) * self.len];
                    for b in 0..3 {
                        let entry = half * block[(a, b)];
                        row.iter_mut().zip(self.at(j as usize, b)).for_each(|(t, v)| *t += entry * v);
                    }
                }
            }
            if some {
                for a in 0..3 {
                    self.add_product(self.at(i, a), &T[a * self.len..(a + 1) * self.len], &mut sum);
                }
            }
        }
        let other = sum.transpose();
        sum + other
    }

    /// Adds `left right^T` to a matrix.
    fn add_product(&self, left: &[f64], right: &[f64], sum: &mut DMatrix<f64>) {
        for (mut column, r) in sum.column_iter_mut().zip(right) {
            column.iter_mut().zip(left).for_each(|(sum, l)| *sum += l * r);
        }
    }

    /// Adds the entries `V^T S V` of a sparse product `multiply`, which adds `S u` to its second argument.
    pub(crate) fn add_to_tangent(
        &self,
        tangent: &mut DMatrix<f64>,
        multiply: impl Fn(&[Vector3], &mut [Vector3]),
    ) {
        let nodes = self.values.len() / (3 * self.len).max(1);
        for k in 0..self.len {
            let mode: Vec<Vector3> =
                (0..nodes).map(|node| Vector3::from_fn(|axis, _| self.at(node, axis)[k])).collect();
            let mut product = vec![Vector3::zeros(); nodes];
            multiply(&mode, &mut product);
            let column = self.project(&product);
            tangent.column_mut(k).iter_mut().zip(column).for_each(|(t, c)| *t += c);
        }
    }

    /// Returns the work of the stress at each quadrature point along each mode, J, at the displacements `u`
    /// (m): the internal forces on the coefficients are the sums over all points.
    ///
    /// # Errors
    /// A point is inverted.
    pub fn works(&self, solid: &Solid, u: &[Vector3]) -> Result<Vec<Vec<f64>>, StaticError> {
        let internal = solid.internal(solid.pairs().as_ref(), u, &[])?;
        let of_point = |(q, stress): (usize, &Matrix3)| {
            let (nodes, grads) = solid.volume.row(q);
            let mut works = vec![0.0; self.len];
            for (&node, grad) in nodes.iter().zip(grads) {
                let force = stress * grad;
                for axis in 0..3 {
                    let along = self.at(node as usize, axis);
                    works.iter_mut().zip(along).for_each(|(work, v)| *work += v * force[axis]);
                }
            }
            works
        };
        Ok(internal.stress.iter().enumerate().map(of_point).collect())
    }
}
