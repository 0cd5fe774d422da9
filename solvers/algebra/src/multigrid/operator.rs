//! The matrix of a level in single precision, whole rows of B x B blocks, and the chunks that it is swept in.
//!
//! Rows are swept in chunks that see each other as they were before the sweep, so that chunks can be swept at once: their
//! number depends on the size of the matrix alone and the bits not on the threads. Couplings between chunks are added to
//! the diagonal by rows, which keeps the sweep convergent for every positive definite matrix (the l1 Gauss-Seidel of
//! Baker, Falgout, Kolev and Yang 2011, SIAM J. Sci. Comput. 33, section 6.2).

use std::ops::Range;

use nalgebra::SMatrix;
use rayon::prelude::*;

use super::lower::LowerRows;
use super::sweep::times;

/// One vector entry of a node.
pub(super) type Entry<const B: usize> = [f32; B];

/// Columns and blocks of a part of a row.
pub(super) type Part<'a, const B: usize> = (&'a [u32], &'a [[[f32; B]; B]]);

/// Fewest rows of a chunk, and most chunks.
const CHUNK: usize = 8192;
const CHUNKS: usize = 8;

/// A level's matrix, divided by the largest diagonal entry of the finest.
pub(super) struct Operator<const B: usize> {
    offsets: Vec<usize>,
    columns: Vec<u32>,
    /// By columns.
    blocks: Vec<[[f32; B]; B]>,
    /// Of each row, the place of its diagonal block.
    diagonals: Vec<usize>,
    /// Of each row, the inverse of the diagonal block that is swept with.
    inverses: Vec<[[f32; B]; B]>,
    /// What was added to the diagonal for couplings between chunks; empty with one chunk.
    added: Vec<Entry<B>>,
    chunks: Vec<Range<usize>>,
}

impl<const B: usize> Operator<B> {
    /// The whole rows of a lower triangle, times `scale`.
    pub fn new(lower: &impl LowerRows<B>, scale: f64) -> Operator<B> {
        let nodes = lower.nodes();
        let mut offsets = vec![0; nodes + 1];
        for i in 0..nodes {
            let columns = lower.columns(i);
            offsets[i + 1] += columns.len();
            for &j in &columns[..columns.len() - 1] {
                offsets[j as usize + 1] += 1;
            }
        }
        for i in 0..nodes {
            offsets[i + 1] += offsets[i];
        }
        let count = offsets[nodes];
        let mut columns = vec![0; count];
        let mut blocks = vec![[[0.0; B]; B]; count];
        let diagonals: Vec<usize> = (0..nodes).map(|i| offsets[i] + lower.columns(i).len() - 1).collect();
        // Rows come in order, so the part of a row beyond its diagonal fills in ascending order too.
        let mut next: Vec<usize> = diagonals.iter().map(|d| d + 1).collect();
        for i in 0..nodes {
            for (at, &j) in lower.columns(i).iter().enumerate() {
                let block = lower.block(i, at);
                let here = offsets[i] + at;
                columns[here] = j;
                let j = j as usize;
                for b in 0..B {
                    for a in 0..B {
                        blocks[here][b][a] = (scale * block[b][a]) as f32;
                    }
                }
                if j < i {
                    let there = next[j];
                    next[j] += 1;
                    columns[there] = i as u32;
                    for b in 0..B {
                        for a in 0..B {
                            blocks[there][a][b] = blocks[here][b][a];
                        }
                    }
                }
            }
        }
        let count = (nodes / CHUNK).clamp(1, CHUNKS);
        let chunks = (0..count).map(|c| nodes * c / count..nodes * (c + 1) / count).collect();
        let mut operator =
            Operator { offsets, columns, blocks, diagonals, inverses: Vec::new(), added: Vec::new(), chunks };
        operator.invert_diagonals();
        operator
    }

    fn invert_diagonals(&mut self) {
        if self.chunks.len() > 1 {
            self.added = vec![[0.0; B]; self.nodes()];
            for chunk in &self.chunks {
                for i in chunk.clone() {
                    for k in self.row(i).filter(|&k| !chunk.contains(&(self.columns[k] as usize))) {
                        for column in &self.blocks[k] {
                            self.added[i].iter_mut().zip(column).for_each(|(sum, a)| *sum += 0.5 * a.abs());
                        }
                    }
                }
            }
        }
        self.inverses = (0..self.nodes())
            .into_par_iter()
            .map(|i| {
                let block = &self.blocks[self.diagonals[i]];
                let mut matrix = SMatrix::<f64, B, B>::from_fn(|a, b| f64::from(block[b][a]));
                if let Some(added) = self.added.get(i) {
                    (0..B).for_each(|a| matrix[(a, a)] += f64::from(added[a]));
                }
                inverse(&matrix)
            })
            .collect();
    }

    pub fn nodes(&self) -> usize {
        self.diagonals.len()
    }

    /// Number of blocks stored.
    pub fn block_count(&self) -> usize {
        self.columns.len()
    }

    /// Places of a row.
    #[inline]
    pub fn row(&self, i: usize) -> Range<usize> {
        self.offsets[i]..self.offsets[i + 1]
    }

    /// Column and block at a place.
    #[inline]
    pub fn at(&self, k: usize) -> (usize, &[[f32; B]; B]) {
        (self.columns[k] as usize, &self.blocks[k])
    }

    /// Columns of a row, ascending.
    #[inline]
    pub fn columns(&self, i: usize) -> &[u32] {
        &self.columns[self.row(i)]
    }

    /// The part of a row before its diagonal.
    #[inline(always)]
    pub fn before(&self, i: usize) -> Part<'_, B> {
        let range = self.offsets[i]..self.diagonals[i];
        (&self.columns[range.clone()], &self.blocks[range])
    }

    /// The part of a row after its diagonal.
    #[inline(always)]
    pub fn after(&self, i: usize) -> Part<'_, B> {
        let range = self.diagonals[i] + 1..self.offsets[i + 1];
        (&self.columns[range.clone()], &self.blocks[range])
    }

    /// A whole row.
    #[inline(always)]
    pub fn whole(&self, i: usize) -> Part<'_, B> {
        (&self.columns[self.row(i)], &self.blocks[self.row(i)])
    }

    /// Inverse of the diagonal block that a row is swept with.
    #[inline(always)]
    pub fn inverse(&self, i: usize) -> &[[f32; B]; B] {
        &self.inverses[i]
    }

    /// The largest eigenvalue of `D^-1 A` by six steps of the power method, from below by some per cent.
    pub fn largest_eigenvalue(&self) -> f32 {
        // A fixed sequence without pattern (the golden ratio's multiples).
        let mut x: Vec<Entry<B>> = (0..self.nodes())
            .map(|i| {
                std::array::from_fn(|a| ((i * B + a) as f64 * 0.618_033_988_749_895).fract() as f32 - 0.5)
            })
            .collect();
        let zero = vec![[0.0; B]; self.nodes()];
        let mut product = zero.clone();
        let mut value = 1.0;
        for _ in 0..6 {
            // The sign does not matter.
            self.residual(&zero, &x, &mut product);
            let mut squares = [0.0f64; 2];
            for (i, (x, p)) in x.iter_mut().zip(&product).enumerate() {
                let y = times(self.inverse(i), p);
                for (x, y) in x.iter().zip(&y) {
                    squares[0] += f64::from(x * x);
                    squares[1] += f64::from(y * y);
                }
                *x = y;
            }
            if !(squares[0] > 0.0 && squares[1] > 0.0) {
                return 1.0;
            }
            value = (squares[1] / squares[0]).sqrt() as f32;
            let shrink = 1.0 / squares[1].sqrt() as f32;
            x.iter_mut().flatten().for_each(|x| *x *= shrink);
        }
        value
    }

    /// What was added to the diagonal, times `x`.
    #[inline(always)]
    pub fn added_part(&self, i: usize, x: &Entry<B>) -> Entry<B> {
        self.added.get(i).map_or([0.0; B], |added| std::array::from_fn(|a| added[a] * x[a]))
    }

    /// Whether there are several chunks.
    pub fn is_chunked(&self) -> bool {
        self.chunks.len() > 1
    }

    /// Every chunk with its part of `out`, at once.
    pub fn each_chunk(&self, out: &mut [Entry<B>], run: impl Fn(&Range<usize>, &mut [Entry<B>]) + Sync) {
        if let [chunk] = &self.chunks[..] {
            return run(chunk, out);
        }
        let mut rest = out;
        let mut parts = Vec::with_capacity(self.chunks.len());
        for chunk in &self.chunks {
            let (part, after) = std::mem::take(&mut rest).split_at_mut(chunk.len());
            rest = after;
            parts.push((chunk, part));
        }
        parts.into_par_iter().for_each(|(chunk, part)| run(chunk, part));
    }
}

/// Inverse of a diagonal block; of one that is not definite only that of its diagonal.
fn inverse<const B: usize>(matrix: &SMatrix<f64, B, B>) -> [[f32; B]; B] {
    // `Cholesky` needs dimensions that are known to it; Gauss-Jordan on a definite matrix needs no pivots.
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
