//! Transfer between a level and the next coarser level: the prolongation, with one row per node.

use std::ops::Range;

use lanes::{LanePath, madd, madd_f32, on_path};
use rayon::prelude::*;
use shape::Coarser;

use super::aggregate::{Aggregates, MODES, Modes, NONE};
use super::graph::Graph;
use super::operator::{Entry, Operator};
use super::row_sets::{Sets, by_rows};
use crate::vectors::repeated;

/// Weight of a coarse node with C degrees of freedom at a fine node with B.
pub(super) trait Weight<const B: usize, const C: usize>: Copy + Send + Sync {
    /// Computes `x += P coarse`.
    fn add<const FMA: bool>(&self, coarse: &Entry<C>, x: &mut Entry<B>);
    /// Computes `sum += P^T rest`.
    fn add_transposed<const FMA: bool>(&self, rest: &Entry<B>, sum: &mut Entry<C>);
    /// Computes `rows += A P`; the block is stored by columns, `rows` by degree of freedom.
    fn multiply<const FMA: bool>(&self, block: &[[f64; B]; B], rows: &mut [[f64; C]; B]);
    /// Computes `sum += P^T rows`, by rows.
    fn multiply_transposed<const FMA: bool>(&self, rows: &[[f64; C]; B], sum: &mut [[f64; C]; C]);
}

/// Dense weight, by rows: any linear map, as for a smoothed aggregate.
#[derive(Clone, Copy)]
pub(super) struct Dense<const B: usize>(pub [[f32; MODES]; B]);

impl<const B: usize> Weight<B, MODES> for Dense<B> {
    #[inline(always)]
    fn add<const FMA: bool>(&self, coarse: &Entry<MODES>, x: &mut Entry<B>) {
        // Each weight has its own sum, so that the next does not have to wait for it.
        for (x, row) in x.iter_mut().zip(&self.0) {
            *x += row.iter().zip(coarse).fold(0.0, |sum, (weight, c)| madd_f32::<FMA>(*weight, *c, sum));
        }
    }

    #[inline(always)]
    fn add_transposed<const FMA: bool>(&self, rest: &Entry<B>, sum: &mut Entry<MODES>) {
        for a in 0..B {
            for m in 0..MODES {
                sum[m] = madd_f32::<FMA>(self.0[a][m], rest[a], sum[m]);
            }
        }
    }

    #[inline(always)]
    fn multiply<const FMA: bool>(&self, block: &[[f64; B]; B], rows: &mut [[f64; MODES]; B]) {
        for b in 0..B {
            let weights = self.0[b].map(f64::from);
            for a in 0..B {
                for m in 0..MODES {
                    rows[a][m] = madd::<FMA>(block[b][a], weights[m], rows[a][m]);
                }
            }
        }
    }

    #[inline(always)]
    fn multiply_transposed<const FMA: bool>(
        &self,
        rows: &[[f64; MODES]; B],
        sum: &mut [[f64; MODES]; MODES],
    ) {
        for a in 0..B {
            for m in 0..MODES {
                let weight = f64::from(self.0[a][m]);
                for n in 0..MODES {
                    sum[m][n] = madd::<FMA>(weight, rows[a][n], sum[m][n]);
                }
            }
        }
    }
}

/// Diagonal weight, equal in all directions that are free on both sides, as for a nested mesh.
#[derive(Clone, Copy)]
pub(super) struct Diagonal(pub [f32; 3]);

impl Weight<3, 3> for Diagonal {
    #[inline(always)]
    fn add<const FMA: bool>(&self, coarse: &Entry<3>, x: &mut Entry<3>) {
        (0..3).for_each(|a| x[a] = madd_f32::<FMA>(self.0[a], coarse[a], x[a]));
    }

    #[inline(always)]
    fn add_transposed<const FMA: bool>(&self, rest: &Entry<3>, sum: &mut Entry<3>) {
        self.add::<FMA>(rest, sum);
    }

    #[inline(always)]
    fn multiply<const FMA: bool>(&self, block: &[[f64; 3]; 3], rows: &mut [[f64; 3]; 3]) {
        for b in 0..3 {
            for a in 0..3 {
                rows[a][b] = madd::<FMA>(block[b][a], f64::from(self.0[b]), rows[a][b]);
            }
        }
    }

    #[inline(always)]
    fn multiply_transposed<const FMA: bool>(&self, rows: &[[f64; 3]; 3], sum: &mut [[f64; 3]; 3]) {
        for a in 0..3 {
            for b in 0..3 {
                sum[a][b] = madd::<FMA>(f64::from(self.0[a]), rows[a][b], sum[a][b]);
            }
        }
    }
}

/// Prolongation from the next coarser level.
pub(super) struct Transfer<W> {
    offsets: Vec<usize>,
    /// Nodes of the coarser level, ascending in each row.
    columns: Vec<u32>,
    weights: Vec<W>,
    /// Number of nodes of the coarser level.
    pub count: usize,
}

impl<W> Transfer<W> {
    /// Nodes of the coarser level with their weights at node `i`.
    #[inline]
    pub fn row(&self, i: usize) -> (&[u32], &[W]) {
        let range = self.offsets[i]..self.offsets[i + 1];
        (&self.columns[range.clone()], &self.weights[range])
    }

    /// Computes `out = P^T rest`.
    pub fn restrict<const B: usize, const C: usize>(&self, rest: &[Entry<B>], out: &mut [Entry<C>])
    where
        W: Weight<B, C>,
    {
        let path = LanePath::best();
        in_parts(rest.len(), out, |rows, out| restrict_rows(path, self, rows, rest, out));
    }

    /// Computes `x += P coarse`.
    pub fn prolong<const B: usize, const C: usize>(&self, coarse: &[Entry<C>], x: &mut [Entry<B>])
    where
        W: Weight<B, C>,
    {
        const ROWS: usize = 2048;
        let path = LanePath::best();
        let part = |(part, x): (usize, &mut [Entry<B>])| prolong_rows(path, self, part * ROWS, coarse, x);
        x.par_chunks_mut(ROWS).enumerate().for_each(part);
    }
}

on_path! {
    fn restrict_rows<const B: usize, const C: usize; W: [Weight<B, C>]>(
        transfer: &Transfer<W>, rows: Range<usize>, rest: &[Entry<B>], out: &mut [Entry<C>],
    ) = restrict_lanes
}
on_path! {
    fn prolong_rows<const B: usize, const C: usize; W: [Weight<B, C>]>(
        transfer: &Transfer<W>, start: usize, coarse: &[Entry<C>], x: &mut [Entry<B>],
    ) = prolong_lanes
}

#[inline(always)]
fn restrict_lanes<const FMA: bool, const B: usize, const C: usize, W: Weight<B, C>>(
    transfer: &Transfer<W>,
    rows: Range<usize>,
    rest: &[Entry<B>],
    out: &mut [Entry<C>],
) {
    for i in rows {
        let (columns, weights) = transfer.row(i);
        for (&column, weight) in columns.iter().zip(weights) {
            weight.add_transposed::<FMA>(&rest[i], &mut out[column as usize]);
        }
    }
}

/// Prolongs to the rows from `start` on.
#[inline(always)]
fn prolong_lanes<const FMA: bool, const B: usize, const C: usize, W: Weight<B, C>>(
    transfer: &Transfer<W>,
    start: usize,
    coarse: &[Entry<C>],
    x: &mut [Entry<B>],
) {
    for (i, x) in x.iter_mut().enumerate() {
        let (columns, weights) = transfer.row(start + i);
        for (&column, weight) in columns.iter().zip(weights) {
            weight.add::<FMA>(&coarse[column as usize], x);
        }
    }
}

impl<const B: usize> Transfer<Dense<B>> {
    /// Builds the smoothed prolongation `P = (I - w D^-1 A) T` from the prolongation `T` of the aggregates,
    /// with `w = 4/3` over the largest eigenvalue of `D^-1 A` (Vanek, Mandel and Brezina 1996).
    pub fn smoothed(
        matrix: &Operator<B>,
        graph: &Graph,
        aggregates: &Aggregates,
        functions: &[Modes<B>],
    ) -> Transfer<Dense<B>> {
        // The power method is a few per cent low, which is harmless: from 0.9 to 1.2 times this weight the
        // number of iterations is the same.
        let weight = 4.0 / (3.0 * matrix.largest_eigenvalue());
        let functions: Vec<[[f32; MODES]; B]> =
            functions.par_iter().map(|rows| rows.map(|row| row.map(|v| v as f32))).collect();
        let of = &aggregates.of[..];
        let Sets { offsets, members: columns } = Sets::unions(matrix.nodes(), aggregates.count, |i, add| {
            graph
                .columns(i)
                .iter()
                .filter(|&&j| of[j as usize] != NONE)
                .for_each(|&j| add(&of[j as usize..][..1]));
        });
        let mut weights = repeated(Dense([[0.0; MODES]; B]), columns.len());
        let smoothing = Smoothing { matrix, graph, of, functions: &functions, weight };
        let path = LanePath::best();
        by_rows(&offsets, &mut weights).into_par_iter().for_each(|(rows, weights)| {
            smooth_rows(path, &smoothing, rows, &offsets, &columns, weights);
        });
        Transfer { offsets, columns, weights, count: aggregates.count }
    }
}

/// Input for smoothing a prolongation.
struct Smoothing<'a, const B: usize> {
    matrix: &'a Operator<B>,
    graph: &'a Graph,
    /// Aggregate of each node.
    of: &'a [u32],
    functions: &'a [[[f32; MODES]; B]],
    weight: f32,
}

on_path! {
    /// Computes rows of `(I - w D^-1 A) T`; their weights start as zeros.
    fn smooth_rows<const B: usize>(
        by: &Smoothing<'_, B>, rows: Range<usize>, offsets: &[usize], columns: &[u32], weights: &mut [Dense<B>],
    ) = smooth_rows_lanes
}

#[inline(always)]
fn smooth_rows_lanes<const FMA: bool, const B: usize>(
    by: &Smoothing<'_, B>,
    rows: Range<usize>,
    offsets: &[usize],
    columns: &[u32],
    weights: &mut [Dense<B>],
) {
    let mut rest = weights;
    for i in rows {
        let range = offsets[i]..offsets[i + 1];
        let (row, after) = std::mem::take(&mut rest).split_at_mut(range.len());
        rest = after;
        let columns = &columns[range];
        for k in by.graph.range(i) {
            let (j, block) = by.matrix.at(by.graph, i, k);
            let Some(at) = columns.iter().position(|column| *column == by.of[j]) else { continue };
            let mut sum = row[at].0;
            for (column, function) in block.iter().zip(&by.functions[j]) {
                for (sum, a) in sum.iter_mut().zip(column) {
                    *sum = std::array::from_fn(|m| madd_f32::<FMA>(*a, function[m], sum[m]));
                }
            }
            row[at].0 = sum;
        }
        for (column, Dense(sum)) in columns.iter().zip(row) {
            let mut out = if *column == by.of[i] { by.functions[i] } else { [[0.0; MODES]; B] };
            for (column, sum) in by.matrix.inverse(i).iter().zip(&*sum) {
                for (out, a) in out.iter_mut().zip(column) {
                    *out = std::array::from_fn(|m| madd_f32::<FMA>(-by.weight * a, sum[m], out[m]));
                }
            }
            *sum = out;
        }
    }
}

impl Transfer<Diagonal> {
    /// Builds the prolongation between nested meshes. It couples the degrees of freedom `3 node + axis` that
    /// are free at the fine node and at the coarse node; `held` marks the constrained degrees of freedom of
    /// the fine mesh.
    pub fn nested(coarser: &Coarser, held: &[bool]) -> Transfer<Diagonal> {
        let (mut offsets, mut columns, mut weights) = (vec![0], Vec::new(), Vec::new());
        for i in 0..coarser.rows.len() {
            let (nodes, values) = coarser.rows.row(i);
            for (&node, &value) in nodes.iter().zip(values) {
                let place = coarser.places[node as usize] as usize;
                let free = |a: usize| !held[3 * i + a] && !held[3 * place + a];
                let weight = |a| if free(a) { value as f32 } else { 0.0 };
                columns.push(node);
                weights.push(Diagonal(std::array::from_fn(weight)));
            }
            offsets.push(columns.len());
        }
        Transfer { offsets, columns, weights, count: coarser.places.len() }
    }
}

/// Sums contributions of `rows` rows in parts with sums of their own, which are then added in order. The
/// parts depend on the number of rows alone.
fn in_parts<const C: usize>(
    rows: usize,
    out: &mut [Entry<C>],
    add: impl Fn(Range<usize>, &mut [Entry<C>]) + Sync,
) {
    const PART: usize = 16384;
    let count = rows.div_ceil(PART).clamp(1, 16);
    out.fill([0.0; C]);
    if count == 1 {
        return add(0..rows, out);
    }
    let parts: Vec<Vec<Entry<C>>> = (0..count)
        .into_par_iter()
        .map(|part| {
            let mut sums = vec![[0.0; C]; out.len()];
            add(rows * part / count..rows * (part + 1) / count, &mut sums);
            sums
        })
        .collect();
    const ENTRIES: usize = 1024;
    out.par_chunks_mut(ENTRIES).enumerate().for_each(|(chunk, out)| {
        for part in &parts {
            for (out, sum) in out.iter_mut().zip(&part[chunk * ENTRIES..]) {
                out.iter_mut().zip(sum).for_each(|(o, s)| *o += s);
            }
        }
    });
}
