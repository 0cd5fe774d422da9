//! Whole rows of a symmetric matrix of which the lower triangle is stored; used to build a hierarchy and then
//! dropped.

use std::ops::Range;

use super::lower_triangle::LowerRows;

/// Columns of every row, ascending, with the positions of their blocks in the lower triangle.
pub(super) struct Graph {
    offsets: Vec<usize>,
    columns: Vec<u32>,
    /// Position of the block in a row of the lower triangle: in this row up to the diagonal, in the column's
    /// row beyond it.
    places: Vec<u32>,
}

impl Graph {
    pub fn new<const B: usize>(lower: &impl LowerRows<B>) -> Graph {
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
        let (mut columns, mut places) = (vec![0; offsets[nodes]], vec![0; offsets[nodes]]);
        // Rows come in order, so the part of a row beyond its diagonal fills in ascending order too.
        let mut next = offsets.clone();
        for i in 0..nodes {
            for (at, &j) in lower.columns(i).iter().enumerate() {
                let mut add = |row: usize, column: u32| {
                    columns[next[row]] = column;
                    places[next[row]] = at as u32;
                    next[row] += 1;
                };
                add(i, j);
                if (j as usize) < i {
                    add(j as usize, i as u32);
                }
            }
        }
        Graph { offsets, columns, places }
    }

    pub fn nodes(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Range of a row's entries.
    #[inline(always)]
    pub fn range(&self, row: usize) -> Range<usize> {
        self.offsets[row]..self.offsets[row + 1]
    }

    /// Columns of a row, ascending.
    #[inline]
    pub fn columns(&self, row: usize) -> &[u32] {
        &self.columns[self.range(row)]
    }

    /// Column of entry `k` ([`Graph::range`]), and the position of its block in the lower triangle.
    #[inline(always)]
    pub fn entry(&self, k: usize) -> (usize, usize) {
        (self.columns[k] as usize, self.places[k] as usize)
    }
}
