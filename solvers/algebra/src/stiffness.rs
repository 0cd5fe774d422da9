#![allow(non_snake_case)] // G and K as in the formulas
//! Stiffness matrix: assembly by owner-computes, one node row at a time, and the product with a vector.
//!
//! Each row gathers from the points that see its node in one fixed order, whichever thread does it. The bits
//! therefore do not depend on the number of threads.

use std::ops::Range;

use lanes::{LanePath, madd, on_path};
use rayon::prelude::*;
use shape::{Matrix3, Vector3};

use crate::pattern::{BlockPattern, Incidence};
use crate::row_parts::RowPart;

/// Rows per task. The late rows of a lower triangle are long: with tasks of 32 rows, 83 nodes keep one of two
/// threads waiting.
const ROWS: usize = 8;
/// One block row of the lower triangle.
struct Row<'a> {
    node: usize,
    columns: &'a [u32],
    blocks: &'a mut [Matrix3],
}

impl Row<'_> {
    #[inline]
    fn set_slots(&self, slot: &mut [u32]) {
        for (at, &j) in self.columns.iter().enumerate() {
            slot[j as usize] = at as u32;
        }
    }
}

/// Symmetric matrix of 3x3 blocks, the lower triangle stored; N/m.
#[derive(Clone, Debug, PartialEq)]
pub struct Stiffness {
    pattern: BlockPattern,
    blocks: Vec<Matrix3>,
}

on_path! {
    fn multiply_rows(
        stiffness: &Stiffness, part: &RowPart, u: &[Vector3], out: &mut [Vector3], before: &mut [Vector3],
    ) = multiply_lanes
}

/// Computes the product of a part of the rows: `out` for these rows, `before` for the columns before them.
/// Each stored block is read once, for its row and, transposed, for its column.
#[inline(always)]
fn multiply_lanes<const FMA: bool>(
    stiffness: &Stiffness,
    part: &RowPart,
    u: &[Vector3],
    out: &mut [Vector3],
    before: &mut [Vector3],
) {
    out.fill(Vector3::zeros());
    let start = part.rows.start;
    let mut places = part.places.iter();
    for i in part.rows.clone() {
        let own = &u[i];
        let (columns, blocks) = stiffness.row(i);
        // Each column of a block is added to a sum of four lanes, of which three count. The last column is
        // read one entry early, so that its upper three lanes count.
        let mut sums = [[0.0; 4]; 3];
        for (&j, block) in columns.iter().zip(blocks) {
            let j = j as usize;
            let entries = block.data.0.as_flattened();
            let x = &u[j];
            for (c, (sum, start)) in sums.iter_mut().zip([0, 3, 5]).enumerate() {
                for (l, sum) in sum.iter_mut().enumerate() {
                    *sum = madd::<FMA>(entries[start + l], x[c], *sum);
                }
            }
            if j == i {
                continue;
            }
            let transposed = match j.checked_sub(start) {
                Some(j) => &mut out[j],
                None => &mut before[*places.next().expect("a place for every column before") as usize],
            };
            for (out, column) in transposed.iter_mut().zip(entries.chunks_exact(3)) {
                *out += madd::<FMA>(column[0], own[0], madd::<FMA>(column[1], own[1], column[2] * own[2]));
            }
        }
        for a in 0..3 {
            out[i - start][a] += sums[0][a] + sums[1][a] + sums[2][a + 1];
        }
    }
}

impl Stiffness {
    /// Returns a zero matrix on `pattern`.
    pub fn zeros(pattern: BlockPattern) -> Stiffness {
        let blocks = vec![Matrix3::zeros(); pattern.block_count()];
        Stiffness { pattern, blocks }
    }

    /// The symbolic pattern.
    #[inline]
    pub fn pattern(&self) -> &BlockPattern {
        &self.pattern
    }

    /// Columns (ascending, the diagonal last) and blocks of one row of the lower triangle.
    #[inline]
    pub fn row(&self, node: usize) -> (&[u32], &[Matrix3]) {
        (self.pattern.row(node), &self.blocks[self.pattern.range(node)])
    }

    /// Returns `K u`, N.
    pub fn multiply(&self, u: &[Vector3]) -> Vec<Vector3> {
        let mut out = vec![Vector3::zeros(); u.len()];
        self.multiply_into(u, &mut out);
        out
    }

    /// Computes `out = K u`, N. The contributions of later parts of the rows are added in their order.
    pub fn multiply_into(&self, u: &[Vector3], out: &mut [Vector3]) {
        let path = LanePath::best();
        let parts = self.pattern.parts();
        let multiplied = |(part, out): (&RowPart, &mut [Vector3])| {
            let mut before = vec![Vector3::zeros(); part.before.len()];
            multiply_rows(path, self, part, u, out, &mut before);
            before
        };
        let before: Vec<Vec<Vector3>> =
            parts.par_iter().zip(RowPart::split(parts, out)).map(multiplied).collect();
        let tasks = parts.par_iter().enumerate().zip(RowPart::split(parts, out));
        tasks.for_each(|((own, RowPart { rows, .. }), out)| {
            for (part, sums) in parts.iter().zip(&before).skip(own + 1) {
                let place = |row: usize| part.before.partition_point(|&j| (j as usize) < row);
                for k in place(rows.start)..place(rows.end) {
                    out[part.before[k] as usize - rows.start] += sums[k];
                }
            }
        });
    }

    /// Computes `out = |K| |u|` with the magnitudes of all entries, N.
    pub fn multiply_magnitudes(&self, u: &[Vector3], out: &mut [Vector3]) {
        out.fill(Vector3::zeros());
        for i in 0..u.len() {
            let (columns, blocks) = self.row(i);
            for (&j, block) in columns.iter().zip(blocks) {
                let j = j as usize;
                let block = block.abs();
                out[i] += block * u[j].abs();
                if j != i {
                    out[j] += block.tr_mul(&u[i].abs());
                }
            }
        }
    }

    /// Returns the block rows in `order`, in tasks of `ROWS`.
    fn tasks(&mut self, order: impl Iterator<Item = usize>) -> Vec<Vec<Row<'_>>> {
        let pattern = &self.pattern;
        let mut rest = &mut self.blocks[..];
        let mut rows: Vec<Option<Row>> = (0..pattern.node_count())
            .map(|node| {
                let (blocks, after) = std::mem::take(&mut rest).split_at_mut(pattern.range(node).len());
                rest = after;
                Some(Row { node, columns: pattern.row(node), blocks })
            })
            .collect();
        let mut ordered = order.map(|node| rows[node].take().expect("an order names every row once"));
        let mut tasks = Vec::new();
        loop {
            let task: Vec<Row> = ordered.by_ref().take(ROWS).collect();
            if task.is_empty() {
                return tasks;
            }
            tasks.push(task);
        }
    }

    /// Fills every block row by `gather(i, slot, row)`, where `row` are the blocks of node `i`. `slot[j]` is
    /// the position of column `j` in `row`. The rows run in parallel.
    pub fn for_each_row(&mut self, gather: impl Fn(usize, &[u32], &mut [Matrix3]) + Sync) {
        let nodes = self.pattern.node_count();
        self.tasks(0..nodes).into_par_iter().for_each_init(
            || vec![0; nodes],
            |slot, rows| {
                for row in rows {
                    row.set_slots(slot);
                    gather(row.node, slot, row.blocks);
                }
            },
        );
    }

    /// Assembles all block rows from a table whose transpose is `incidence`. Several block rows traverse the
    /// rows of the table together, in tiles of `tile` rows, so that a tile stays in the cache.
    ///
    /// `gather(entries, slot, sums)` adds the (row, entry) pairs of a node in one tile to `sums`, one sum per
    /// column of the block row, which start as `zero`. `slot[j]` is the position of column `j` in `sums`.
    /// After each of the `parts` of the table, `finish(part, node, slot, sums, blocks)` moves the sums to the
    /// blocks and leaves zeros.
    pub fn by_tiles<S: Copy + Send + Sync>(
        &mut self,
        incidence: &Incidence,
        parts: &[Range<usize>],
        tile: usize,
        zero: S,
        gather: impl Fn(&[(u32, u32)], &[u32], &mut [S]) + Sync,
        finish: impl Fn(usize, usize, &[u32], &mut [S], &mut [Matrix3]) + Sync,
    ) {
        let nodes = self.pattern.node_count();
        let mut order: Vec<usize> = (0..nodes).collect();
        order.sort_by_key(|&i| incidence.of(i).first());
        self.tasks(order.into_iter()).into_par_iter().for_each_init(
            || vec![(vec![0; nodes], Vec::new()); ROWS],
            |scratch, mut rows| {
                let mut seen: Vec<&[(u32, u32)]> = rows.iter().map(|row| incidence.of(row.node)).collect();
                for (row, (slot, sums)) in rows.iter().zip(&mut *scratch) {
                    row.set_slots(slot);
                    // The sums of earlier rows are zero again.
                    sums.resize(row.columns.len(), zero);
                }
                for (part, range) in parts.iter().enumerate() {
                    let next = |seen: &[&[(u32, u32)]]| {
                        let first =
                            seen.iter().filter_map(|seen| seen.first()).map(|of| of.0 as usize).min()?;
                        (first < range.end).then_some(first)
                    };
                    while let Some(first) = next(&seen) {
                        let end = (first + tile).min(range.end);
                        for (seen, (slot, sums)) in seen.iter_mut().zip(&mut *scratch) {
                            let (here, later) =
                                seen.split_at(seen.partition_point(|&(row, _)| (row as usize) < end));
                            gather(here, slot, sums);
                            *seen = later;
                        }
                    }
                    for (row, (slot, sums)) in rows.iter_mut().zip(&mut *scratch) {
                        finish(part, row.node, slot, sums, row.blocks);
                    }
                }
            },
        );
    }
}
