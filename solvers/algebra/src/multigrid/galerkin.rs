//! Galerkin product `P^T A P`, the matrix of the next level.
//!
//! The product is formed in double precision, because the softest motions of a slender body have 1e-10 of its
//! stiffness. With `S = P^T (L + D/2) P` the product is `S + S^T`, so that only the lower triangle of A is
//! read and half of the products are made.

use std::ops::Range;

use lanes::{LanePath, on_path};
use rayon::prelude::*;

use super::graph::Graph;
use super::lower_triangle::{Lower, LowerRows};
use super::row_sets::{Sets, by_rows, each_row, first};
use super::transfer::{Transfer, Weight};
use crate::vectors::repeated;

/// Rows of A P that are computed before they are added: few, so that they stay in the cache.
const WINDOW: usize = 4096;

/// Returns `P^T A P` for the matrix `lower` with its `graph`.
pub(super) fn galerkin<const B: usize, const C: usize, W: Weight<B, C>>(
    lower: &impl LowerRows<B>,
    graph: &Graph,
    transfer: &Transfer<W>,
) -> Lower<C> {
    let nodes = graph.nodes();
    // Aggregates reached by each row of A P, then by each row of P^T A P.
    let reached = Sets::unions(nodes, transfer.count, |i, add| {
        if !transfer.row(i).0.is_empty() {
            graph.columns(i).iter().for_each(|&j| add(transfer.row(j as usize).0));
        }
    });
    let seen_by = Sets::transposed(nodes, transfer.count, |i| transfer.row(i).0);
    let pattern = Sets::unions(transfer.count, transfer.count, |coarse, add| {
        seen_by.of(coarse).iter().for_each(|&i| add(reached.of(i as usize)));
    });
    let sums = products(lower, transfer, &reached, &seen_by, &pattern);
    folded(&pattern, &sums, lower.unit())
}

/// Block of a row of `(L + D/2) P`, and whether the row has an entry there.
type Reached<const B: usize, const C: usize> = (bool, [[f64; C]; B]);

/// Consecutive rows of `(L + D/2) P`.
struct Window<'a, const B: usize, const C: usize> {
    start: usize,
    reached: &'a Sets,
    blocks: &'a [Reached<B, C>],
}

impl<const B: usize, const C: usize> Window<'_, B, C> {
    /// Columns and blocks of a row.
    #[inline(always)]
    fn row(&self, i: usize) -> impl Iterator<Item = (&u32, &Reached<B, C>)> {
        let first = self.reached.offsets[i] - self.reached.offsets[self.start];
        self.reached.of(i).iter().zip(&self.blocks[first..])
    }
}

/// Row of S with the next of the rows of A P to be added to it.
struct Gathered<'a, const C: usize> {
    sums: &'a mut [[[f64; C]; C]],
    next: usize,
}

/// Returns the blocks of S at the positions of `pattern`. Every row of S is summed by one task in the order
/// of the rows of A P.
fn products<const B: usize, const C: usize, L: LowerRows<B>, W: Weight<B, C>>(
    lower: &L,
    transfer: &Transfer<W>,
    reached: &Sets,
    seen_by: &Sets,
    pattern: &Sets,
) -> Vec<[[f64; C]; C]> {
    let path = LanePath::best();
    let mut sums = repeated([[0.0; C]; C], pattern.members.len());
    let mut rest = &mut sums[..];
    let gathered = |coarse: usize| Gathered { sums: first(&mut rest, pattern.of(coarse).len()), next: 0 };
    let mut gathered: Vec<Gathered<C>> = (0..transfer.count).map(gathered).collect();
    let starts = (0..lower.nodes()).step_by(WINDOW);
    let end = |start: usize| lower.nodes().min(start + WINDOW);
    let sizes = starts.clone().map(|start| reached.offsets[end(start)] - reached.offsets[start]);
    let mut window: Vec<Reached<B, C>> = vec![(false, [[0.0; C]; B]); sizes.max().unwrap_or(0)];
    for start in starts {
        let end = end(start);
        let offsets = &reached.offsets[start..=end];
        let window = &mut window[..offsets[end - start] - offsets[0]];
        by_rows(offsets, window).into_par_iter().for_each(|(rows, window)| {
            multiply_rows(path, lower, transfer, reached, start + rows.start..start + rows.end, window);
        });
        gathered.par_iter_mut().enumerate().with_min_len(16).for_each(|(coarse, of)| {
            let rows = &seen_by.of(coarse)[of.next..];
            let rows = &rows[..rows.partition_point(|&i| (i as usize) < end)];
            of.next += rows.len();
            let window = Window { start, reached, blocks: &*window };
            gather(path, transfer, &window, rows, coarse, pattern.of(coarse), of.sums);
        });
    }
    sums
}

on_path! {
    fn multiply_rows<const B: usize, const C: usize; L: [LowerRows<B>], W: [Weight<B, C>]>(
        lower: &L, transfer: &Transfer<W>, reached: &Sets, rows: Range<usize>, out: &mut [Reached<B, C>],
    ) = multiply_lanes
}

/// Computes rows of `(L + D/2) P`.
#[inline(always)]
fn multiply_lanes<const FMA: bool, const B: usize, const C: usize, L: LowerRows<B>, W: Weight<B, C>>(
    lower: &L,
    transfer: &Transfer<W>,
    reached: &Sets,
    rows: Range<usize>,
    out: &mut [Reached<B, C>],
) {
    let mut rest = out;
    for i in rows {
        let reached = reached.of(i);
        let row = first(&mut rest, reached.len());
        if row.is_empty() {
            continue;
        }
        row.fill((false, [[0.0; C]; B]));
        for (at, &j) in lower.columns(i).iter().enumerate() {
            let mut block = lower.block(i, at);
            if j as usize == i {
                block.iter_mut().flatten().for_each(|a| *a *= 0.5);
            }
            let (columns, weights) = transfer.row(j as usize);
            let mut place = 0;
            for (column, weight) in columns.iter().zip(weights) {
                while reached[place] != *column {
                    place += 1;
                }
                row[place].0 = true;
                weight.multiply::<FMA>(&block, &mut row[place].1);
            }
        }
    }
}

on_path! {
    fn gather<const B: usize, const C: usize; W: [Weight<B, C>]>(
        transfer: &Transfer<W>, window: &Window<'_, B, C>, rows: &[u32], coarse: usize, columns: &[u32],
        sums: &mut [[[f64; C]; C]],
    ) = gather_lanes
}

/// Adds `P^T` times some rows of the window to the row of S that belongs to the aggregate `coarse` and has
/// these `columns`.
#[inline(always)]
fn gather_lanes<const FMA: bool, const B: usize, const C: usize, W: Weight<B, C>>(
    transfer: &Transfer<W>,
    window: &Window<'_, B, C>,
    rows: &[u32],
    coarse: usize,
    columns: &[u32],
    sums: &mut [[[f64; C]; C]],
) {
    for i in rows.iter().map(|&i| i as usize) {
        let (own, weights) = transfer.row(i);
        let at = own.partition_point(|&column| (column as usize) < coarse);
        let mut place = 0;
        for (column, (_, rows)) in window.row(i).filter(|(_, (any, _))| *any) {
            while columns[place] != *column {
                place += 1;
            }
            weights[at].multiply_transposed::<FMA>(rows, &mut sums[place]);
        }
    }
}

/// Returns the lower triangle of `S + S^T`.
fn folded<const C: usize>(pattern: &Sets, sums: &[[[f64; C]; C]], unit: f64) -> Lower<C> {
    let count = pattern.offsets.len() - 1;
    let (mut offsets, mut columns) = (vec![0], Vec::new());
    for i in 0..count {
        columns.extend(pattern.of(i).iter().copied().take_while(|&j| j as usize <= i));
        offsets.push(columns.len());
    }
    let mut lower = Lower::zeros(offsets, columns, unit);
    each_row(&lower.offsets, &mut lower.blocks, |i, blocks| {
        for (at, block) in blocks.iter_mut().enumerate() {
            let j = pattern.of(i)[at] as usize;
            let own = &sums[pattern.offsets[i] + at];
            let other = &sums[pattern.offsets[j] + pattern.of(j).partition_point(|&k| (k as usize) < i)];
            for b in 0..C {
                for a in 0..C {
                    block[b][a] = own[a][b] + other[b][a];
                }
            }
        }
    });
    lower.fill_empty();
    lower
}
