//! Galerkin product `P^T A P`, the matrix of the next level.
//!
//! The product is formed in double precision, because the softest motions of a slender body have 1e-10 of its
//! stiffness. With `S = P^T (L + D/2) P` the product is `S + S^T`, so that only the lower triangle of A is
//! read and half of the products are made.

use lanes::{LanePath, on_path};

use super::graph::Graph;
use super::lower_triangle::{Lower, LowerRows};
use super::row_sets::Sets;
use super::transfer::{Transfer, Weight};

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
    drop(seen_by);

    let sums = products(LanePath::best(), lower, transfer, &reached, &pattern);
    folded(&pattern, &sums, lower.unit())
}

on_path! {
    fn products<const B: usize, const C: usize; L: [LowerRows<B>], W: [Weight<B, C>]>(
        lower: &L, transfer: &Transfer<W>, reached: &Sets, pattern: &Sets,
    ) -> Vec<[[f64; C]; C]> = product_lanes
}

/// Returns the blocks of S at the positions of `pattern`.
#[inline(always)]
fn product_lanes<const FMA: bool, const B: usize, const C: usize, L: LowerRows<B>, W: Weight<B, C>>(
    lower: &L,
    transfer: &Transfer<W>,
    reached: &Sets,
    pattern: &Sets,
) -> Vec<[[f64; C]; C]> {
    let mut sums = vec![[[0.0; C]; C]; pattern.members.len()];
    // For each aggregate that row i of A P reaches: whether `(L + D/2) P` has an entry there, and its row.
    let mut rows: Vec<(bool, [[f64; C]; B])> = Vec::new();
    for i in 0..lower.nodes() {
        let (columns, weights) = transfer.row(i);
        if columns.is_empty() {
            continue;
        }
        let reached = reached.of(i);
        rows.clear();
        rows.resize(reached.len(), (false, [[0.0; C]; B]));
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
                rows[place].0 = true;
                weight.multiply::<FMA>(&block, &mut rows[place].1);
            }
        }
        for (&coarse, weight) in columns.iter().zip(weights) {
            let mut place = pattern.offsets[coarse as usize];
            for (column, (_, rows)) in reached.iter().zip(&rows).filter(|(_, (any, _))| *any) {
                while pattern.members[place] != *column {
                    place += 1;
                }
                weight.multiply_transposed::<FMA>(rows, &mut sums[place]);
            }
        }
    }
    sums
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
    // Next position in the upper part of each row: its columns ascend as the rows do.
    let mut next: Vec<usize> =
        (0..count).map(|i| pattern.offsets[i] + lower.offsets[i + 1] - lower.offsets[i] - 1).collect();
    for i in 0..count {
        for at in 0..lower.offsets[i + 1] - lower.offsets[i] {
            let j = lower.columns[lower.offsets[i] + at] as usize;
            let own = &sums[pattern.offsets[i] + at];
            let other = &sums[next[j]];
            next[j] += 1;
            let block = &mut lower.blocks[lower.offsets[i] + at];
            for b in 0..C {
                for a in 0..C {
                    block[b][a] = own[a][b] + other[b][a];
                }
            }
        }
    }
    lower.fill_empty();
    lower
}
