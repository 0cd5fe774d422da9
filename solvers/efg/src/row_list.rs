//! Rows under construction, one after another.

use shape::Vector3;

/// Nodes, values and gradients of many rows; those of one chunk of points are appended to those of the chunks before.
pub(crate) struct RowList {
    /// Row starts, one more than rows.
    pub offsets: Vec<usize>,
    /// Nodes of each row, ascending.
    pub nodes: Vec<u32>,
    pub values: Vec<f64>,
    /// Gradients (1/m), one per value, or none at all.
    pub grads: Vec<Vector3>,
}

impl Default for RowList {
    fn default() -> RowList {
        RowList::with_capacity(0, 0, 0)
    }
}

impl RowList {
    pub fn with_capacity(rows: usize, entries: usize, grads: usize) -> RowList {
        let mut offsets = Vec::with_capacity(rows + 1);
        offsets.push(0);
        RowList {
            offsets,
            nodes: Vec::with_capacity(entries),
            values: Vec::with_capacity(entries),
            grads: Vec::with_capacity(grads),
        }
    }

    /// Entry range of one row.
    pub fn range(&self, row: usize) -> std::ops::Range<usize> {
        self.offsets[row]..self.offsets[row + 1]
    }

    /// Ends a row, whose nodes are already there.
    pub fn close(&mut self) {
        self.offsets.push(self.nodes.len());
    }

    pub fn append(&mut self, other: &RowList) {
        let first = self.nodes.len();
        self.offsets.extend(other.offsets[1..].iter().map(|offset| first + offset));
        self.nodes.extend_from_slice(&other.nodes);
        self.values.extend_from_slice(&other.values);
        self.grads.extend_from_slice(&other.grads);
    }
}
