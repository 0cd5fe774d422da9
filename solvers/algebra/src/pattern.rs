//! Symbolic block pattern: the pairs of nodes that share an integration point.
//!
//! A pattern is built once per problem. Values may be assembled into it any number of times.

use rayon::prelude::*;

use crate::row_parts::RowPart;

/// Symbolic part of a table in compressed rows: the nodes of each row.
#[derive(Clone, Copy)]
pub struct Connectivity<'a> {
    /// Start of each row in `nodes`; rows + 1 entries.
    pub offsets: &'a [usize],
    /// Nodes of all rows, row after row.
    pub nodes: &'a [u32],
    /// Bit mask per entry of `nodes`, if a row covers several points: bit `p` is set if point `p` of the row
    /// sees the node. Empty if every row covers one point.
    pub seen_by: &'a [u8],
}

impl Connectivity<'_> {
    /// Whether one point sees the nodes of both entries of a row.
    fn meet(&self, j: usize, k: usize) -> bool {
        self.seen_by.is_empty() || self.seen_by[j] & self.seen_by[k] != 0
    }
}

/// Transpose of a table: for each node, the entries that name it.
#[derive(Clone, Debug)]
pub struct Incidence {
    offsets: Vec<usize>,
    /// Pairs (row, entry); `entry` is an index into the table's flat arrays.
    entries: Vec<(u32, u32)>,
}

impl Incidence {
    /// Transposes `table`. The rows are visited in `order`, which is the order of the entries of each node.
    pub fn new(node_count: usize, table: Connectivity, order: impl Iterator<Item = usize>) -> Incidence {
        let mut offsets = vec![0usize; node_count + 1];
        for &node in table.nodes {
            offsets[node as usize + 1] += 1;
        }
        for i in 0..node_count {
            offsets[i + 1] += offsets[i];
        }
        let mut next = offsets.clone();
        let mut entries = vec![(0, 0); table.nodes.len()];
        for q in order {
            for k in table.offsets[q]..table.offsets[q + 1] {
                let slot = &mut next[table.nodes[k] as usize];
                entries[*slot] = (q as u32, k as u32);
                *slot += 1;
            }
        }
        Incidence { offsets, entries }
    }

    /// Pairs (row, entry) that name `node`; `entry` is an index into the flat arrays of the whole table.
    #[inline]
    pub fn of(&self, node: usize) -> &[(u32, u32)] {
        &self.entries[self.offsets[node]..self.offsets[node + 1]]
    }
}

/// Lower triangle of the node graph in compressed rows: row `i` lists the neighbours `j <= i` in ascending
/// order, the diagonal last.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockPattern {
    offsets: Vec<usize>,
    columns: Vec<u32>,
    /// Parts of the rows, for products.
    parts: Vec<RowPart>,
}

impl BlockPattern {
    /// Builds the union of the node pairs of all tables. The nodes of every row must ascend. The diagonal is
    /// always included.
    pub fn new(node_count: usize, tables: &[(Connectivity, &Incidence)]) -> BlockPattern {
        /// Rows per task: few, so that a cloud of 83 nodes keeps two threads busy.
        const CHUNK: usize = 16;
        let nodes: Vec<usize> = (0..node_count).collect();
        let chunks: Vec<(Vec<u32>, Vec<usize>)> = nodes
            .par_chunks(CHUNK)
            .map_init(
                || vec![u32::MAX; node_count],
                |mark, rows| {
                    let (mut columns, mut lengths) = (Vec::new(), Vec::with_capacity(rows.len()));
                    for &i in rows {
                        let start = columns.len();
                        columns.push(i as u32);
                        mark[i] = i as u32;
                        'row: for (table, incidence) in tables {
                            for &(q, k) in incidence.of(i) {
                                // All i + 1 columns are found: a dense cloud (83 nodes) leaves early.
                                if columns.len() - start == i + 1 {
                                    break 'row;
                                }
                                for at in table.offsets[q as usize]..k as usize {
                                    let j = table.nodes[at];
                                    if mark[j as usize] != i as u32 && table.meet(at, k as usize) {
                                        mark[j as usize] = i as u32;
                                        columns.push(j);
                                    }
                                }
                            }
                        }
                        columns[start..].sort_unstable();
                        lengths.push(columns.len() - start);
                    }
                    (columns, lengths)
                },
            )
            .collect();
        let mut offsets = Vec::with_capacity(node_count + 1);
        offsets.push(0);
        for &length in chunks.iter().flat_map(|c| &c.1) {
            offsets.push(offsets[offsets.len() - 1] + length);
        }
        let columns: Vec<u32> = chunks.into_iter().flat_map(|c| c.0).collect();
        let parts = RowPart::of(node_count, |row| &columns[offsets[row]..offsets[row + 1]]);
        BlockPattern { offsets, columns, parts }
    }

    /// Number of nodes (block rows).
    #[inline]
    pub fn node_count(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Number of 3x3 blocks stored.
    #[inline]
    pub fn block_count(&self) -> usize {
        self.columns.len()
    }

    /// Parts of the rows, for products.
    #[inline]
    pub(crate) fn parts(&self) -> &[RowPart] {
        &self.parts
    }

    /// Columns of one block row, ascending, the diagonal last.
    #[inline]
    pub fn row(&self, node: usize) -> &[u32] {
        &self.columns[self.range(node)]
    }

    /// Range of the blocks of one row in the flat array.
    #[inline]
    pub fn range(&self, node: usize) -> std::ops::Range<usize> {
        self.offsets[node]..self.offsets[node + 1]
    }
}
