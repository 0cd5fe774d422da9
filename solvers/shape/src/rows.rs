//! Compressed rows of (node, value): the sparse matrix on which all tables are based.

use rayon::prelude::*;

use crate::Vector3;

/// Smallest number of rows checked by a task: a few microseconds. A table of at most this size is checked by
/// the calling thread, because passing it on would take as long.
const CHECKED_TOGETHER: usize = 2048;

/// Promised sum of each row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Unity {
    /// Rows sum to one within this absolute tolerance, which is checked.
    Within(f64),
    /// No promise, for example for radial bases without a polynomial.
    NotPromised,
}

/// Reason why a table is invalid.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ShapeError {
    /// Offsets that do not start at 0, decrease, or do not end at the number of entries.
    #[error("row offsets are inconsistent at row {row}: {offset} (entries: {entries})")]
    BrokenOffsets {
        /// Row index.
        row: usize,
        /// Offset found there.
        offset: usize,
        /// Total number of entries.
        entries: usize,
    },
    /// Two arrays that should have the same length.
    #[error("{what} has {found} entries instead of {expected}")]
    Length {
        /// Name of the array.
        what: &'static str,
        /// Its length.
        found: usize,
        /// Required length.
        expected: usize,
    },
    /// A node index beyond the number of nodes.
    #[error("row {row} names node {node}, but there are only {nodes} nodes")]
    NodeOutOfRange {
        /// Row index.
        row: usize,
        /// Invalid node.
        node: usize,
        /// Number of nodes.
        nodes: usize,
    },
    /// A NaN or an infinity.
    #[error("{what} of row {row} is not finite")]
    NotFinite {
        /// Name of the array.
        what: &'static str,
        /// Row index.
        row: usize,
    },
    /// A row whose sum violates the promise of one.
    #[error("row {row} sums to {sum}; the sum must be 1 within {tolerance:e}")]
    NotUnity {
        /// Row index.
        row: usize,
        /// Its sum.
        sum: f64,
        /// The promised tolerance.
        tolerance: f64,
    },
    /// A quadrature weight that is not positive.
    #[error("point {row} has weight {weight:e}; a positive one is needed")]
    BadWeight {
        /// Row index.
        row: usize,
        /// Its weight.
        weight: f64,
    },
}

/// Values of the nonzero shape functions at each of a list of points.
#[derive(Clone, Debug, PartialEq)]
pub struct Rows {
    node_count: usize,
    offsets: Vec<usize>,
    nodes: Vec<u32>,
    values: Vec<f64>,
    uniform_len: Option<usize>,
}

impl Rows {
    /// Checks the arrays and builds rows over `node_count` nodes: `offsets` (rows + 1), `nodes` and `values`
    /// (one per entry).
    ///
    /// # Errors
    /// Arrays of unequal length, broken offsets, a node out of range, a value that is not finite, or a row
    /// whose sum violates `unity`.
    pub fn new(
        node_count: usize,
        offsets: Vec<usize>,
        nodes: Vec<u32>,
        values: Vec<f64>,
        unity: Unity,
    ) -> Result<Rows, ShapeError> {
        let entries = nodes.len();
        if values.len() != entries {
            return Err(ShapeError::Length { what: "values", found: values.len(), expected: entries });
        }
        if offsets.first() != Some(&0) {
            return Err(ShapeError::BrokenOffsets {
                row: 0,
                offset: offsets.first().copied().unwrap_or(usize::MAX),
                entries,
            });
        }
        for (row, pair) in offsets.windows(2).enumerate() {
            if pair[1] < pair[0] || pair[1] > entries {
                return Err(ShapeError::BrokenOffsets { row, offset: pair[1], entries });
            }
        }
        let row = offsets.len() - 1;
        let end = *offsets.last().unwrap();
        if end != entries {
            return Err(ShapeError::BrokenOffsets { row, offset: end, entries });
        }
        let lengths = || offsets.windows(2).map(|p| p[1] - p[0]);
        let uniform_len = lengths().next().filter(|&first| lengths().all(|n| n == first));
        let rows = Rows { node_count, offsets, nodes, values, uniform_len };
        match rows.first_fault(|row| rows.fault(row, unity)) {
            Some(fault) => Err(fault),
            None => Ok(rows),
        }
    }

    /// Returns the fault of the first faulty row.
    pub(crate) fn first_fault(
        &self,
        of: impl Fn(usize) -> Option<ShapeError> + Sync + Send,
    ) -> Option<ShapeError> {
        if self.len() <= CHECKED_TOGETHER {
            return (0..self.len()).find_map(of);
        }
        (0..self.len()).into_par_iter().with_min_len(CHECKED_TOGETHER).find_map_first(of)
    }

    fn fault(&self, row: usize, unity: Unity) -> Option<ShapeError> {
        let (nodes, values) = self.row(row);
        // The sum is tested first, because a search would test every entry. Any value that is not finite
        // makes the sum not finite.
        let sum = sum_of(values);
        let highest = nodes.iter().fold(0, |highest, &node| highest.max(node)) as usize;
        if !nodes.is_empty() && highest >= self.node_count {
            let first = nodes.iter().map(|&n| n as usize).find(|&n| n >= self.node_count);
            return Some(ShapeError::NodeOutOfRange {
                row,
                node: first.unwrap_or(highest),
                nodes: self.node_count,
            });
        }
        if !sum.is_finite() && !values.iter().all(|v| v.is_finite()) {
            return Some(ShapeError::NotFinite { what: "value", row });
        }
        match unity {
            // A NaN sum also fails this test.
            Unity::Within(tolerance) if !((sum - 1.0).abs() <= tolerance) => {
                Some(ShapeError::NotUnity { row, sum, tolerance })
            }
            _ => None,
        }
    }

    /// Number of rows (points).
    pub fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of nodes of the table (columns).
    pub fn node_count(&self) -> usize {
        self.node_count
    }

    /// Row starts, rows + 1 entries.
    pub fn offsets(&self) -> &[usize] {
        &self.offsets
    }

    /// Node indices of all rows, one row after another.
    pub fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    /// Values of all rows, one row after another.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Common length of all rows; `None` if lengths differ. Hot loops use it as a fixed trip count.
    pub fn uniform_len(&self) -> Option<usize> {
        self.uniform_len
    }

    /// Returns the nodes and values of a row.
    pub fn row(&self, row: usize) -> (&[u32], &[f64]) {
        let range = self.range(row);
        (&self.nodes[range.clone()], &self.values[range])
    }

    /// Returns the range of entries of a row.
    pub fn range(&self, row: usize) -> std::ops::Range<usize> {
        self.offsets[row]..self.offsets[row + 1]
    }

    /// Evaluates the field with nodal parameters `u` at every row's point: `u(x_q) = sum_I N_I(x_q) u_I`.
    /// [`crate::RowBlocks`] is faster for repeated products.
    pub fn apply(&self, u: &[Vector3]) -> Vec<Vector3> {
        assert_eq!(u.len(), self.node_count, "one vector per node");
        let at = |row: usize| {
            let (nodes, values) = self.row(row);
            nodes.iter().zip(values).map(|(&node, &value)| value * u[node as usize]).sum()
        };
        (0..self.len()).map(at).collect()
    }

    /// Returns the nodal forces that do the same work as forces at the rows' points:
    /// `f_I = sum_q N_I(x_q) f_q`, so `sum_I f_I . u_I = sum_q f_q . u(x_q)` for every nodal `u`. The total
    /// force is preserved if rows sum to one, the total moment if they reproduce linear fields.
    pub fn apply_transposed(&self, forces: &[Vector3]) -> Vec<Vector3> {
        assert_eq!(forces.len(), self.len(), "one vector per row");
        let mut nodal = vec![Vector3::zeros(); self.node_count];
        for (row, force) in forces.iter().enumerate() {
            let (nodes, values) = self.row(row);
            for (&node, &value) in nodes.iter().zip(values) {
                nodal[node as usize] += value * force;
            }
        }
        nodal
    }
}

/// Sums by four partial sums: a single sum would wait four processor cycles for every addition.
fn sum_of(values: &[f64]) -> f64 {
    let (groups, rest) = values.as_chunks::<4>();
    let mut sums = [0.0; 4];
    for group in groups {
        for (sum, value) in sums.iter_mut().zip(group) {
            *sum += value;
        }
    }
    let rest: f64 = rest.iter().sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}
