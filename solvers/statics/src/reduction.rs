//! Mapping between nodal parameters and unknowns, `u = T v + g`. Parameters are prescribed, expressed by
//! others through eliminated constraints, or unknowns themselves.

use algebra::{Stiffness, Symmetric};
use rayon::prelude::*;
use shape::Vector3;

use crate::constraint::Row;
use crate::eliminate::{Block, blocks};
use crate::error::SolveError;

/// `T` by rows, and `g`.
pub(crate) struct Reduction {
    /// Range of each degree of freedom `3 node + axis` in `terms`.
    offsets: Vec<usize>,
    /// Pairs (unknown, weight); none for a prescribed degree of freedom.
    terms: Vec<(usize, f64)>,
    /// `g`, m.
    value: Vec<f64>,
    /// Index of each degree of freedom among the unknowns; `usize::MAX` if it is not an unknown.
    pub place: Vec<usize>,
    /// Number of unknowns.
    pub free: usize,
    /// Eliminated constraints.
    pub blocks: Vec<Block>,
    /// Number of constraints left out because they follow from the others.
    pub dropped: usize,
}

impl Reduction {
    /// Builds `T` and `g` from the prescribed value of each degree of freedom (m) and the constraint `rows`
    /// to be eliminated.
    pub fn new(prescribed: &[Option<f64>], rows: &[Row]) -> Result<Reduction, SolveError> {
        let rows: Vec<Row> = rows.iter().map(|row| row.without(prescribed)).collect();
        let (blocks, dropped) = blocks(&rows, prescribed.len())?;
        let mut value: Vec<f64> = prescribed.iter().map(|v| v.unwrap_or(0.0)).collect();
        // For each eliminated parameter, its block and its position in the block.
        let mut given = vec![None; prescribed.len()];
        for (b, block) in blocks.iter().enumerate() {
            let weights = block.inverse.chunks_exact(block.rows.len());
            for ((k, &dof), inverse) in block.pivots.iter().enumerate().zip(weights) {
                given[dof] = Some((b, k));
                value[dof] = inverse.iter().zip(&block.rows).map(|(e, &r)| e * rows[r].value).sum();
            }
        }
        let mut place = vec![usize::MAX; prescribed.len()];
        let mut free = 0;
        for dof in 0..prescribed.len() {
            if prescribed[dof].is_none() && given[dof].is_none() {
                place[dof] = free;
                free += 1;
            }
        }
        let (mut offsets, mut terms) = (vec![0], Vec::new());
        for dof in 0..prescribed.len() {
            match given[dof] {
                Some((b, k)) => {
                    let Block { others, weights, .. } = &blocks[b];
                    let weights = &weights[k * others.len()..][..others.len()];
                    terms.extend(others.iter().zip(weights).map(|(&o, w)| (place[o], -w)));
                }
                None if place[dof] != usize::MAX => terms.push((place[dof], 1.0)),
                None => {}
            }
            offsets.push(terms.len());
        }
        Ok(Reduction { offsets, terms, value, place, free, blocks, dropped })
    }

    fn of(&self, dof: usize) -> &[(usize, f64)] {
        &self.terms[self.offsets[dof]..self.offsets[dof + 1]]
    }

    /// Number of eliminated constraints.
    pub fn eliminated(&self) -> usize {
        self.blocks.iter().map(|b| b.rows.len()).sum()
    }

    /// Returns `factor g`, m.
    pub fn constrained(&self, factor: f64) -> Vec<Vector3> {
        self.value.chunks_exact(3).map(|v| Vector3::new(v[0], v[1], v[2]) * factor).collect()
    }

    /// Adds `T v` to `u`.
    pub fn expand(&self, v: &[f64], u: &mut [Vector3]) {
        for dof in 0..self.value.len() {
            for &(at, weight) in self.of(dof) {
                u[dof / 3][dof % 3] += weight * v[at];
            }
        }
    }

    /// Writes `T^T f` to the first unknowns of `out` and zero to the others.
    pub fn fold(&self, f: &[Vector3], out: &mut [f64]) {
        out.fill(0.0);
        for dof in 0..self.value.len() {
            for &(at, weight) in self.of(dof) {
                out[at] += weight * f[dof / 3][dof % 3];
            }
        }
    }

    /// Returns `T^T K T`, which is symmetric positive definite if `K` is so on the subspace of the
    /// constraints.
    pub fn matrix(&self, stiffness: &Stiffness) -> Symmetric {
        if self.blocks.is_empty() {
            return Symmetric::displacements(stiffness, &self.place, self.free);
        }
        let nodes = self.value.len() / 3;
        // Rows of K below the diagonal by node: a block is stored with the later of its two nodes.
        let mut below: Vec<Vec<(usize, usize)>> = vec![Vec::new(); nodes];
        for i in 0..nodes {
            for (k, &j) in stiffness.row(i).0.iter().enumerate().filter(|(_, j)| **j as usize != i) {
                below[j as usize].push((i, k));
            }
        }
        // K T by rows, one row for each degree of freedom.
        let work = || (vec![0.0; self.free], vec![false; self.free], Vec::new());
        let products: Vec<Vec<(usize, f64)>> = (0..3 * nodes)
            .into_par_iter()
            .map_init(work, |(sum, seen, touched), dof| {
                let (i, a) = (dof / 3, dof % 3);
                let mut add = |j: usize, k: [f64; 3]| {
                    for (b, k) in k.into_iter().enumerate() {
                        for &(at, weight) in self.of(3 * j + b) {
                            if !std::mem::replace(&mut seen[at], true) {
                                touched.push(at);
                            }
                            sum[at] += k * weight;
                        }
                    }
                };
                let (columns, blocks) = stiffness.row(i);
                for (&j, block) in columns.iter().zip(blocks) {
                    add(j as usize, [0, 1, 2].map(|b| block[(a, b)]));
                }
                for &(j, k) in &below[i] {
                    let block = stiffness.row(j).1[k];
                    add(j, [0, 1, 2].map(|b| block[(b, a)]));
                }
                gathered(sum, seen, touched)
            })
            .collect();
        let mut transposed: Vec<Vec<(usize, f64)>> = vec![Vec::new(); self.free];
        for dof in 0..3 * nodes {
            self.of(dof).iter().for_each(|&(at, weight)| transposed[at].push((dof, weight)));
        }
        let columns: Vec<Vec<(usize, f64)>> = transposed
            .par_iter()
            .enumerate()
            .map_init(work, |(sum, seen, touched), (column, dofs)| {
                for &(dof, weight) in dofs {
                    let product = &products[dof];
                    let upper = product.partition_point(|p| p.0 <= column);
                    for &(at, value) in &product[..upper] {
                        if !std::mem::replace(&mut seen[at], true) {
                            touched.push(at);
                        }
                        sum[at] += weight * value;
                    }
                }
                gathered(sum, seen, touched)
            })
            .collect();
        let mut offsets = vec![0];
        offsets.extend(columns.iter().scan(0, |sum, column| {
            *sum += column.len();
            Some(*sum)
        }));
        let (rows, values) = columns.into_iter().flatten().unzip();
        // The unknowns of a node differ in their neighbours if one of its axes is in a block.
        let vertices = (0..=self.free).collect();
        Symmetric { offsets, rows, values, multipliers: self.free, vertices }
    }
}

/// Returns the touched entries by ascending index and clears the workspace.
fn gathered(sum: &mut [f64], seen: &mut [bool], touched: &mut Vec<usize>) -> Vec<(usize, f64)> {
    touched.sort_unstable();
    let entries = touched.iter().map(|&at| (at, std::mem::take(&mut sum[at]))).collect();
    touched.drain(..).for_each(|at| seen[at] = false);
    entries
}
