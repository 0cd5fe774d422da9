//! Rows with ascending, unique nodes. The partners `j <= i` of an entry are the entries before it, as the
//! assembly of a lower triangle requires.

use std::ops::AddAssign;

use algebra::{Connectivity, Incidence};

/// Compressed rows with one datum per (row, node).
#[derive(Clone, Debug)]
pub(crate) struct Sorted<T> {
    pub offsets: Vec<usize>,
    pub nodes: Vec<u32>,
    pub data: Vec<T>,
}

impl<T: Copy + AddAssign> Sorted<T> {
    /// Sorts each row; the data of repeated nodes add up.
    pub fn new<R: Iterator<Item = (u32, T)>>(rows: impl Iterator<Item = R>) -> Sorted<T> {
        let mut sorted = Sorted { offsets: vec![0], nodes: Vec::new(), data: Vec::new() };
        let mut row: Vec<(u32, T)> = Vec::new();
        for entries in rows {
            row.clear();
            row.extend(entries);
            row.sort_by_key(|e| e.0);
            let start = sorted.nodes.len();
            for &(node, value) in &row {
                if sorted.nodes.len() > start && sorted.nodes.last() == Some(&node) {
                    *sorted.data.last_mut().expect("just pushed") += value;
                } else {
                    sorted.nodes.push(node);
                    sorted.data.push(value);
                }
            }
            sorted.offsets.push(sorted.nodes.len());
        }
        sorted
    }

    pub fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    pub fn connectivity(&self) -> Connectivity<'_> {
        Connectivity { offsets: &self.offsets, nodes: &self.nodes, seen_by: &[] }
    }

    pub fn incidence(&self, node_count: usize) -> Incidence {
        Incidence::new(node_count, self.connectivity(), 0..self.len())
    }

    /// Returns nodes and data of a row.
    pub fn row(&self, row: usize) -> (&[u32], &[T]) {
        let range = self.offsets[row]..self.offsets[row + 1];
        (&self.nodes[range.clone()], &self.data[range])
    }
}
