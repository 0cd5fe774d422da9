#![allow(non_snake_case)] // G and K as in the formulas
//! The stiffness matrix: assembly by owner-computes, one node row at a time, and the product with a vector.
//!
//! Each row gathers from the points that see its node, in one fixed order, whichever thread does it: the bits do not
//! depend on the number of threads.

use rayon::prelude::*;

use crate::pattern::{BlockPattern, Connectivity, Incidence};
use crate::{Body, Matrix3, SolveError, Vector3};

/// Gradient rows ready for assembly: nodes ascending in each row, so that the partners `j <= i` of an entry are the
/// entries before it. Points carry a weight and the index of their moduli.
pub(crate) struct GradTable {
    offsets: Vec<usize>,
    nodes: Vec<u32>,
    /// Padded to four lanes: two or one vector instructions per axis instead of three scalar ones.
    grads: Vec<[f64; 4]>,
    weights: Vec<f64>,
    law: Vec<u16>,
    /// (lambda, mu) per law, Pa.
    moduli: Vec<(f64, f64)>,
}

impl GradTable {
    fn with_capacity(rows: usize, entries: usize, moduli: Vec<(f64, f64)>) -> GradTable {
        let mut offsets = Vec::with_capacity(rows + 1);
        offsets.push(0);
        GradTable {
            offsets,
            nodes: Vec::with_capacity(entries),
            grads: Vec::with_capacity(entries),
            weights: Vec::with_capacity(rows),
            law: Vec::with_capacity(rows),
            moduli,
        }
    }

    fn push(&mut self, row: &mut [(u32, Vector3)], weight: f64, law: u16) {
        row.sort_unstable_by_key(|e| e.0);
        let start = self.nodes.len();
        for &(node, g) in row.iter() {
            let pad = [g.x, g.y, g.z, 0.0];
            // A row may name a node twice; its gradients add up.
            if self.nodes.len() > start && self.nodes.last() == Some(&node) {
                let last = self.grads.last_mut().unwrap();
                (0..3).for_each(|c| last[c] += pad[c]);
            } else {
                self.nodes.push(node);
                self.grads.push(pad);
            }
        }
        self.offsets.push(self.nodes.len());
        self.weights.push(weight);
        self.law.push(law);
    }

    /// The body's own quadrature; with a projection only its deviatoric part, `lambda' = -2 mu / 3`.
    pub fn points(body: &Body) -> GradTable {
        let moduli = body.materials.iter().map(|m| match body.dilation {
            Some(_) => (-2.0 / 3.0 * m.mu(), m.mu()),
            None => (m.lambda(), m.mu()),
        });
        let rows = body.volume.rows();
        let mut table = GradTable::with_capacity(rows.len(), rows.nodes().len(), moduli.collect());
        let mut row = Vec::new();
        for q in 0..rows.len() {
            let (nodes, grads) = body.volume.row(q);
            row.clear();
            row.extend(nodes.iter().copied().zip(grads.iter().copied()));
            table.push(&mut row, body.volume.weights()[q], body.region.get(q).copied().unwrap_or(0));
        }
        table
    }

    /// The dilation groups: `kappa V_a b_a b_a^T` is the same integrand with moduli (1, 0) and weight `kappa V_a`.
    pub fn groups(body: &Body) -> Result<Option<GradTable>, SolveError> {
        let Some(groups) = body.dilation else { return Ok(None) };
        let mut table = GradTable::with_capacity(groups.len(), 0, vec![(1.0, 0.0)]);
        let scratch = || vec![Vector3::zeros(); body.nodes.len()];
        let averaged: Vec<_> = (0..groups.len())
            .into_par_iter()
            .map_init(scratch, |scratch, a| groups.averaged_gradient(a, body.volume, scratch))
            .collect();
        for (a, (volume, mut row)) in averaged.into_iter().enumerate() {
            // `!(V > 0)`: a NaN must not pass.
            if !(volume > 0.0) {
                return Err(SolveError::GroupVolume { group: a, volume });
            }
            table.push(&mut row, group_bulk(body, a) * volume, 0);
        }
        Ok(Some(table))
    }

    pub fn connectivity(&self) -> Connectivity<'_> {
        Connectivity { offsets: &self.offsets, nodes: &self.nodes }
    }

    /// Takes the nodal forces `sum_q w sigma grad N`, `sigma = lambda tr H I + mu (H + H^T)`, from `force`.
    pub fn subtract_force(&self, incidence: &Incidence, u: &[Vector3], force: &mut [Vector3]) {
        let stress: Vec<Matrix3> = (0..self.weights.len())
            .into_par_iter()
            .with_min_len(256)
            .map(|q| {
                let (lambda, mu) = self.moduli[self.law[q] as usize];
                let range = self.offsets[q]..self.offsets[q + 1];
                let base = u[self.nodes[range.start] as usize];
                let mut H = Matrix3::zeros();
                for (&node, g) in self.nodes[range.clone()].iter().zip(&self.grads[range]) {
                    // Gradients of a partition of unity sum to zero: only differences of displacements count.
                    H += (u[node as usize] - base) * Vector3::new(g[0], g[1], g[2]).transpose();
                }
                ((H + H.transpose()) * mu + Matrix3::identity() * (lambda * H.trace())) * self.weights[q]
            })
            .collect();
        force.par_iter_mut().with_min_len(32).enumerate().for_each(|(i, force)| {
            for &(q, k) in incidence.of(i) {
                let g = self.grads[k as usize];
                *force -= stress[q as usize] * Vector3::new(g[0], g[1], g[2]);
            }
        });
    }

    /// Incidence in which each node meets its points sorted by law.
    pub fn incidence(&self, node_count: usize) -> Incidence {
        let mut order: Vec<usize> = (0..self.weights.len()).collect();
        order.sort_by_key(|&q| self.law[q]);
        Incidence::new(node_count, self.connectivity(), order.into_iter())
    }
}

/// Bulk modulus of one dilation group, Pa: the volume average over its points.
pub(crate) fn group_bulk(body: &Body, group: usize) -> f64 {
    let (points, shares) = body.dilation.expect("a body with groups").group(group);
    let (mut volume, mut bulk) = (0.0, 0.0);
    for (&q, share) in points.iter().zip(shares) {
        let dv = share * body.volume.weights()[q as usize];
        volume += dv;
        bulk += dv * body.material(q as usize).bulk();
    }
    bulk / volume
}

/// Symmetric matrix of 3x3 blocks, the lower triangle stored; N/m.
#[derive(Clone, Debug, PartialEq)]
pub struct Stiffness {
    pattern: BlockPattern,
    blocks: Vec<Matrix3>,
}

impl Stiffness {
    pub(crate) fn zeros(pattern: BlockPattern) -> Stiffness {
        let blocks = vec![Matrix3::zeros(); pattern.block_count()];
        Stiffness { pattern, blocks }
    }

    /// Sets all numbers to zero and keeps the pattern.
    pub(crate) fn clear(&mut self) {
        self.blocks.fill(Matrix3::zeros());
    }

    /// The symbolic pattern.
    pub fn pattern(&self) -> &BlockPattern {
        &self.pattern
    }

    /// Columns (ascending, the diagonal last) and blocks of one row of the lower triangle.
    pub fn row(&self, node: usize) -> (&[u32], &[Matrix3]) {
        (self.pattern.row(node), &self.blocks[self.pattern.range(node)])
    }

    /// `K u`, N.
    pub fn multiply(&self, u: &[Vector3]) -> Vec<Vector3> {
        let mut out = vec![Vector3::zeros(); u.len()];
        for i in 0..u.len() {
            let (columns, blocks) = self.row(i);
            let mut sum = Vector3::zeros();
            for (&j, block) in columns.iter().zip(blocks) {
                sum += block * u[j as usize];
                if j as usize != i {
                    out[j as usize] += block.tr_mul(&u[i]);
                }
            }
            out[i] += sum;
        }
        out
    }

    /// Runs `gather(i, slot, row)` for every block row: `slot[j]` is the place of column `j` in `row`.
    pub(crate) fn for_each_row(
        &mut self,
        gather: impl Fn(usize, &[u32], &mut [Matrix3], &mut Vec<[f64; 12]>) + Sync,
    ) {
        /// Rows per task. Late rows of a lower triangle are the long ones: 83 nodes in tasks of 32 keep one of two
        /// threads waiting.
        const CHUNK: usize = 8;
        let pattern = &self.pattern;
        let mut rest = &mut self.blocks[..];
        let mut tasks = Vec::with_capacity(pattern.node_count() / CHUNK + 1);
        for first in (0..pattern.node_count()).step_by(CHUNK) {
            let last = (first + CHUNK).min(pattern.node_count());
            let (head, tail) = rest.split_at_mut(pattern.range(last - 1).end - pattern.range(first).start);
            tasks.push((first..last, head));
            rest = tail;
        }
        tasks.into_par_iter().for_each_init(
            || (vec![0u32; pattern.node_count()], Vec::new()),
            |(slot, sums), (rows, mut blocks)| {
                for i in rows {
                    let columns = pattern.row(i);
                    let (row, tail) = std::mem::take(&mut blocks).split_at_mut(columns.len());
                    blocks = tail;
                    for (at, &j) in columns.iter().enumerate() {
                        slot[j as usize] = at as u32;
                    }
                    gather(i, slot, row, sums);
                }
            },
        );
    }

    /// Adds `integral of lambda div v div u + 2 mu eps(v) : eps(u)`.
    ///
    /// With `g = grad N` the block of nodes i, j is
    /// `K_ij = sum_q w (lambda g_i g_j^T + mu g_j g_i^T + mu (g_i . g_j) I)`. The moduli are constant over many
    /// points, so only `G_ij = sum_q w g_i g_j^T` is summed in the inner loop and
    /// `K_ij += lambda G + mu G^T + mu tr(G) I` is formed once per law: a third of the arithmetic.
    pub(crate) fn add_volume(&mut self, table: &GradTable, incidence: &Incidence) {
        self.for_each_row(|i, slot, row, sums| {
            sums.clear();
            sums.resize(row.len(), [0.0; 12]);
            let mut seen = incidence.of(i);
            while let Some(&(first, _)) = seen.first() {
                let law = table.law[first as usize];
                let (alike, rest) =
                    seen.split_at(seen.partition_point(|&(q, _)| table.law[q as usize] == law));
                gather(table, alike, slot, sums);
                flush(sums, row, table.moduli[law as usize]);
                seen = rest;
            }
        });
    }
}

/// `G_ij += w g_i g_j^T` over the points `seen` that node i sees and their nodes j <= i: the inner loop.
///
/// It waits for memory rather than arithmetic: the same loop compiled for AVX2 took 8.6 ms beside 8.8 ms (83 nodes,
/// 4000 points of 30 neighbours), and rows of one fixed length have nothing to gain either, as the trip count is
/// that of the triangle, 1 to n.
fn gather(table: &GradTable, seen: &[(u32, u32)], slot: &[u32], sums: &mut [[f64; 12]]) {
    for &(q, k) in seen {
        let (q, k) = (q as usize, k as usize);
        let start = table.offsets[q];
        let [x, y, z, _] = table.grads[k].map(|g| table.weights[q] * g);
        for (&j, gj) in table.nodes[start..=k].iter().zip(&table.grads[start..=k]) {
            let G = &mut sums[slot[j as usize] as usize];
            for c in 0..4 {
                G[c] += x * gj[c];
                G[4 + c] += y * gj[c];
                G[8 + c] += z * gj[c];
            }
        }
    }
}

/// `K += lambda G + mu G^T + mu tr(G) I` for a whole row; the sums start again from zero.
fn flush(sums: &mut [[f64; 12]], row: &mut [Matrix3], (lambda, mu): (f64, f64)) {
    for (K, s) in row.iter_mut().zip(sums) {
        #[rustfmt::skip]
        let G = Matrix3::new(s[0], s[1], s[2],
                             s[4], s[5], s[6],
                             s[8], s[9], s[10]);
        *K += G * lambda + G.transpose() * mu + Matrix3::identity() * (mu * G.trace());
        *s = [0.0; 12];
    }
}
