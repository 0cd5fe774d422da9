//! Matrix of a level in single precision, in rows of B x B blocks, and the chunks of its sweeps.
//!
//! Each chunk of rows sees the other chunks as they were before the sweep, so that all chunks can be swept at
//! once. The number of chunks depends on the size of the matrix alone, so the bits do not depend on the
//! threads. Couplings between chunks are added to the diagonal by rows, which keeps the sweep convergent for
//! every positive definite matrix (the l1 Gauss-Seidel of Baker, Falgout, Kolev and Yang 2011, SIAM J. Sci.
//! Comput. 33, section 6.2).

use std::ops::Range;

use nalgebra::SMatrix;
use rayon::prelude::*;

use super::graph::Graph;
use super::lower_triangle::LowerRows;
use super::row_sets::{by_rows, first};
use crate::row_parts::{ROWS, parts};
use crate::vectors::{CHUNK, GRAIN, repeated, sums};

/// Vector entry of a node.
pub(super) type Entry<const B: usize> = [f32; B];

/// Columns and blocks of part of a row.
pub(super) type Part<'a, const B: usize> = (&'a [u32], &'a [[[f32; B]; B]]);

/// Smallest number of rows in a chunk of a sweep: chunks of coarse levels, whose rows are longer, have a
/// quarter of the rows. On a cube of 311,469 unknowns (tet4) the number of iterations stays at 20; with an
/// eighth it is 21, with a sixteenth 24.
fn smallest<const B: usize>() -> usize {
    if B == 3 { ROWS } else { ROWS / 4 }
}

/// Mean number of couplings of a row up to its diagonal above which there is one chunk. In the wide rows of a
/// cloud, the couplings between chunks add more to the diagonal than it has: a cloud of 97,336 nodes (support
/// scale 1.6) takes 86 iterations with two or more chunks, and 55 with one.
const WIDE: usize = 50;

/// Matrix of a level, divided by the largest diagonal entry of the finest level.
///
/// Only the lower triangle is stored; a product passes through it once for both triangles. On a cube of
/// 107,811 unknowns the iterations take 0.4 (hex8) and 0.5 (tet4) of their time with whole rows, half of
/// which a sweep reads in vain.
pub(super) struct Operator<const B: usize> {
    /// Couplings before the diagonal within the chunk of a row.
    inside: Rows<B>,
    /// Couplings to other chunks, before and after.
    outside: Rows<B>,
    diagonals: Vec<[[f32; B]; B]>,
    /// Inverse of the diagonal block of each row, as used in a sweep.
    inverses: Vec<[[f32; B]; B]>,
    /// Additions to the diagonal for couplings between chunks; empty if there is one chunk.
    added: Vec<Entry<B>>,
    chunks: Vec<Range<usize>>,
}

/// Compressed rows of blocks, each stored by columns.
struct Rows<const B: usize> {
    offsets: Vec<usize>,
    columns: Vec<u32>,
    blocks: Vec<[[f32; B]; B]>,
}

impl<const B: usize> Rows<B> {
    /// Returns zeros with the given number of blocks in each row.
    fn zeros(lengths: impl Iterator<Item = usize>) -> Rows<B> {
        let mut offsets = vec![0];
        offsets.extend(lengths.scan(0, |end, length| {
            *end += length;
            Some(*end)
        }));
        let count = offsets[offsets.len() - 1];
        Rows { offsets, columns: vec![0; count], blocks: repeated([[0.0; B]; B], count) }
    }

    /// Calls `fill` for the columns and the blocks of every row, concurrently.
    fn fill(&mut self, fill: impl Fn(usize, &mut [u32], &mut [[[f32; B]; B]]) + Sync) {
        let Rows { offsets, columns, blocks } = self;
        let tasks = by_rows(offsets, columns).into_par_iter().zip(by_rows(offsets, blocks));
        tasks.for_each(|((rows, mut columns), (_, mut blocks))| {
            for row in rows {
                let length = offsets[row + 1] - offsets[row];
                fill(row, first(&mut columns, length), first(&mut blocks, length));
            }
        });
    }

    #[inline(always)]
    fn row(&self, i: usize) -> Part<'_, B> {
        let range = self.offsets[i]..self.offsets[i + 1];
        (&self.columns[range.clone()], &self.blocks[range])
    }
}

impl<const B: usize> Operator<B> {
    /// Builds `scale` times the matrix of a lower triangle with this graph.
    pub fn new(lower: &impl LowerRows<B>, graph: &Graph, scale: f64) -> Operator<B> {
        let nodes = lower.nodes();
        let couplings: usize = (0..nodes).map(|i| lower.columns(i).len()).sum();
        let smallest = if couplings > WIDE * nodes { nodes } else { smallest::<B>() };
        let chunks = parts(nodes, smallest);
        let block = |i: usize, at: usize| lower.block(i, at).map(|column| column.map(|a| (scale * a) as f32));
        // Columns of each row before its chunk, within it before the diagonal, and after it.
        let lengths = |i: usize| {
            let chunk = &chunks[chunks.partition_point(|chunk| chunk.end <= i)];
            let columns = graph.columns(i);
            let ends =
                [chunk.start, i, chunk.end].map(|end| columns.partition_point(|&j| (j as usize) < end));
            [ends[0], ends[1] - ends[0], columns.len() - ends[2]].map(|length| length as u32)
        };
        let lengths: Vec<[u32; 3]> = (0..nodes).into_par_iter().with_min_len(512).map(lengths).collect();
        let mut inside = Rows::zeros(lengths.iter().map(|[_, within, _]| *within as usize));
        let mut outside = Rows::zeros(lengths.iter().map(|[before, _, after]| (before + after) as usize));
        inside.fill(|i, columns, blocks| {
            let first = lengths[i][0] as usize;
            columns.copy_from_slice(&lower.columns(i)[first..][..columns.len()]);
            blocks.iter_mut().zip(first..).for_each(|(out, at)| *out = block(i, at));
        });
        outside.fill(|i, columns, blocks| {
            let range = graph.range(i);
            let after = range.end - lengths[i][2] as usize..range.end;
            let entries = (range.start..range.start + lengths[i][0] as usize).chain(after);
            for ((out, column), k) in blocks.iter_mut().zip(columns).zip(entries) {
                let (j, place) = graph.entry(k);
                *column = j as u32;
                *out = if j < i { block(i, place) } else { transposed(&block(j, place)) };
            }
        });
        let diagonal = |i: usize| block(i, lower.columns(i).len() - 1);
        let diagonals = (0..nodes).into_par_iter().with_min_len(512).map(diagonal).collect();
        let (added, inverses) = (Vec::new(), Vec::new());
        let mut operator = Operator { inside, outside, diagonals, inverses, added, chunks };
        operator.invert_diagonals();
        operator
    }

    fn invert_diagonals(&mut self) {
        if self.is_chunked() {
            let half = |i| {
                let mut sums = [0.0; B];
                for column in self.outside(i).1.iter().flatten() {
                    sums.iter_mut().zip(column).for_each(|(sum, a)| *sum += 0.5 * a.abs());
                }
                sums
            };
            self.added = (0..self.nodes()).into_par_iter().with_min_len(512).map(half).collect();
        }
        let inverted = |(i, block): (usize, &[[f32; B]; B])| {
            let mut matrix = SMatrix::<f64, B, B>::from_fn(|a, b| f64::from(block[b][a]));
            if let Some(added) = self.added.get(i) {
                (0..B).for_each(|a| matrix[(a, a)] += f64::from(added[a]));
            }
            inverse(&matrix)
        };
        self.inverses = self.diagonals.par_iter().enumerate().with_min_len(512).map(inverted).collect();
    }

    pub fn nodes(&self) -> usize {
        self.diagonals.len()
    }

    /// Number of blocks of both triangles.
    pub fn block_count(&self) -> usize {
        self.nodes() + 2 * self.inside.columns.len() + self.outside.columns.len()
    }

    /// Column and block of entry `k` ([`Graph::range`]) of a row, in this matrix's graph.
    #[inline(always)]
    pub fn at(&self, graph: &Graph, row: usize, k: usize) -> (usize, [[f32; B]; B]) {
        let (column, place) = graph.entry(k);
        if column <= row {
            (column, *self.of_lower(row, place))
        } else {
            (column, transposed(self.of_lower(column, place)))
        }
    }

    /// Returns the block at index `place` of row `row` of the lower triangle (ascending columns, the diagonal
    /// last).
    #[inline(always)]
    fn of_lower(&self, row: usize, place: usize) -> &[[f32; B]; B] {
        let (columns, blocks) = self.outside(row);
        let before = columns.partition_point(|&j| (j as usize) < row);
        if place < before {
            &blocks[place]
        } else {
            self.inside(row).1.get(place - before).unwrap_or(&self.diagonals[row])
        }
    }

    /// Entries of row `i` before its diagonal and within its chunk.
    #[inline(always)]
    pub fn inside(&self, i: usize) -> Part<'_, B> {
        self.inside.row(i)
    }

    /// Entries of row `i` in other chunks, before and after the diagonal.
    #[inline(always)]
    pub fn outside(&self, i: usize) -> Part<'_, B> {
        self.outside.row(i)
    }

    #[inline(always)]
    pub fn diagonal(&self, i: usize) -> &[[f32; B]; B] {
        &self.diagonals[i]
    }

    /// Inverse of the diagonal block of a row, as used in a sweep.
    #[inline(always)]
    pub fn inverse(&self, i: usize) -> &[[f32; B]; B] {
        &self.inverses[i]
    }

    /// Estimates the largest eigenvalue of `D^-1 A` by six steps of the power method, too low by a few per
    /// cent.
    pub fn largest_eigenvalue(&self) -> f32 {
        // A fixed sequence without pattern: multiples of the golden ratio.
        let mut x: Vec<Entry<B>> = (0..self.nodes())
            .map(|i| {
                std::array::from_fn(|a| ((i * B + a) as f64 * 0.618_033_988_749_895).fract() as f32 - 0.5)
            })
            .collect();
        let zero = vec![[0.0; B]; self.nodes()];
        let mut product = zero.clone();
        let mut value = 1.0;
        for _ in 0..6 {
            // The product is `-A x`; its sign does not matter.
            self.residual(&zero, &x, &mut product);
            let chunks = x.par_chunks_mut(CHUNK).zip(product.par_chunks(CHUNK)).enumerate();
            let squares = sums(chunks.map(|(chunk, (x, product))| {
                let mut squares = [0.0f64; 2];
                for (i, (x, p)) in x.iter_mut().zip(product).enumerate() {
                    let y = times(self.inverse(chunk * CHUNK + i), p);
                    for (x, y) in x.iter().zip(&y) {
                        squares[0] += f64::from(x * x);
                        squares[1] += f64::from(y * y);
                    }
                    *x = y;
                }
                squares
            }));
            if !(squares[0] > 0.0 && squares[1] > 0.0) {
                return 1.0;
            }
            value = (squares[1] / squares[0]).sqrt() as f32;
            let shrink = 1.0 / squares[1].sqrt() as f32;
            x.par_iter_mut().with_min_len(GRAIN).flatten_iter().for_each(|x| *x *= shrink);
        }
        value
    }

    /// Returns the additions to the diagonal of row `i`, which account for couplings between chunks, times
    /// `x`; zero if there is one chunk.
    #[inline(always)]
    pub fn added_part(&self, i: usize, x: &Entry<B>) -> Entry<B> {
        self.added.get(i).map_or([0.0; B], |added| std::array::from_fn(|a| added[a] * x[a]))
    }

    /// Whether there are several chunks.
    pub fn is_chunked(&self) -> bool {
        self.chunks.len() > 1
    }

    /// Calls `run` for every chunk and its part of a vector, concurrently.
    pub fn each_chunk(&self, out: &mut [Entry<B>], run: impl Fn(&Range<usize>, &mut [Entry<B>]) + Sync) {
        let parts: Vec<_> = self.chunks.iter().zip(self.split(out)).collect();
        parts.into_par_iter().for_each(|(chunk, part)| run(chunk, part));
    }

    /// Calls `run` for every chunk and its parts of two vectors, concurrently.
    pub fn each_chunk_of_two(
        &self,
        first: &mut [Entry<B>],
        second: &mut [Entry<B>],
        run: impl Fn(&Range<usize>, &mut [Entry<B>], &mut [Entry<B>]) + Sync,
    ) {
        let parts: Vec<_> = self.chunks.iter().zip(self.split(first)).zip(self.split(second)).collect();
        parts.into_par_iter().for_each(|((chunk, first), second)| run(chunk, first, second));
    }

    /// Splits a vector into the parts of the chunks.
    fn split<'a>(&self, vector: &'a mut [Entry<B>]) -> impl Iterator<Item = &'a mut [Entry<B>]> {
        self.chunks.iter().scan(vector, |rest, chunk| {
            let (part, after) = std::mem::take(rest).split_at_mut(chunk.len());
            *rest = after;
            Some(part)
        })
    }
}

/// Returns the transpose of a block.
pub(super) fn transposed<const B: usize>(block: &[[f32; B]; B]) -> [[f32; B]; B] {
    std::array::from_fn(|b| std::array::from_fn(|a| block[a][b]))
}

/// Inverts a diagonal block. If the block is not definite, only its diagonal is inverted.
fn inverse<const B: usize>(matrix: &SMatrix<f64, B, B>) -> [[f32; B]; B] {
    // `Cholesky` needs dimensions known at compile time; Gauss-Jordan on a definite matrix needs no pivoting.
    let mut left = *matrix;
    let mut right = SMatrix::<f64, B, B>::identity();
    for p in 0..B {
        let pivot = left[(p, p)];
        if !(pivot > 1e-12 * matrix[(p, p)]) {
            return std::array::from_fn(|b| {
                std::array::from_fn(|a| if a == b { (1.0 / matrix[(a, a)]) as f32 } else { 0.0 })
            });
        }
        for c in 0..B {
            left[(p, c)] /= pivot;
            right[(p, c)] /= pivot;
        }
        for r in (0..B).filter(|&r| r != p) {
            let factor = left[(r, p)];
            for c in 0..B {
                left[(r, c)] -= factor * left[(p, c)];
                right[(r, c)] -= factor * right[(p, c)];
            }
        }
    }
    std::array::from_fn(|b| std::array::from_fn(|a| right[(a, b)] as f32))
}

/// Returns `block x`.
#[inline(always)]
pub(super) fn times<const B: usize>(block: &[[f32; B]; B], x: &Entry<B>) -> Entry<B> {
    let mut sum = [0.0; B];
    for (column, x) in block.iter().zip(x) {
        for (s, a) in sum.iter_mut().zip(column) {
            *s += a * x;
        }
    }
    sum
}
