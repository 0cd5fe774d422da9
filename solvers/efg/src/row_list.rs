//! Compressed rows under construction, appended one after another.

use shape::Vector3;

/// Number of sampled rows for an estimate of a table's size, at most one in [`SPARING`]. Growth by doubling
/// would take up to three times the memory during copies, and touch new pages.
const SAMPLES: usize = 16_000;
/// Small tables are sampled by one row in this number.
const SPARING: usize = 25;

/// Returns the step between the rows that are sampled for [`RowList::expected_entries`].
pub(crate) fn sample_step(rows: usize) -> usize {
    (rows / SAMPLES).max(SPARING)
}

/// Nodes, values and gradients of many rows. The rows of one chunk of points are appended to those of the
/// previous chunks.
pub(crate) struct RowList {
    /// Row starts: one more than the number of rows.
    pub offsets: Vec<usize>,
    /// Nodes of each row, ascending.
    pub nodes: Vec<u32>,
    pub values: Vec<f64>,
    /// Gradients (1/m), one per value, or none.
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

    /// Reserves room for exactly these numbers of further entries. Spare room would be wasted, because a
    /// table outgrows its estimated size only near its end.
    pub fn reserve(&mut self, entries: usize, grads: usize) {
        self.nodes.reserve_exact(entries);
        self.values.reserve_exact(entries);
        self.grads.reserve_exact(grads);
    }

    /// Whether the list has no rows.
    pub fn is_empty(&self) -> bool {
        self.offsets.len() == 1
    }

    /// Returns the range of entries of a row.
    pub fn range(&self, row: usize) -> std::ops::Range<usize> {
        self.offsets[row]..self.offsets[row + 1]
    }

    /// Ends a row whose nodes are already appended.
    pub fn close(&mut self) {
        self.offsets.push(self.nodes.len());
    }

    /// Drops the nodes from entry `end` on, counted over all rows, and ends the last row there. The row must
    /// not have values yet.
    pub fn shorten_last(&mut self, end: usize) {
        self.nodes.truncate(end);
        self.offsets.pop();
        self.close();
    }

    /// Estimates the number of entries of a table with `rows` rows from the rows of this list, which are a
    /// sample of the table. The estimate includes a margin of two standard errors, for row lengths with a
    /// standard deviation of a third of their mean. For a large table the margin is 0.5 %.
    pub fn expected_entries(&self, rows: usize) -> usize {
        let sampled = (self.offsets.len() - 1).max(1) as f64;
        let margin = 1.0 + 2.0 / (3.0 * sampled.sqrt());
        (margin * self.nodes.len() as f64 * rows as f64 / sampled) as usize
    }

    pub fn append(&mut self, other: &RowList) {
        let first = self.nodes.len();
        self.offsets.extend(other.offsets[1..].iter().map(|offset| first + offset));
        self.nodes.extend_from_slice(&other.nodes);
        self.values.extend_from_slice(&other.values);
        self.grads.extend_from_slice(&other.grads);
    }
}
