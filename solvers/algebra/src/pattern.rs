//! The symbolic block pattern: which pairs of nodes share an integration point. Built once per problem; the
//! numbers may then be assembled often.

use rayon::prelude::*;

/// Compressed rows (offsets, nodes) of a table, the symbolic part of it.
#[derive(Clone, Copy)]
pub struct Connectivity<'a> {
    /// Of each row among `nodes`, rows + 1 entries.
    pub offsets: &'a [usize],
    /// Nodes of all rows.
    pub nodes: &'a [u32],
    /// Where a row is of several points, which of them see a node, a bit each; empty where every row is of one.
    pub seen_by: &'a [u8],
}

impl Connectivity<'_> {
    /// Whether a point sees the nodes of both entries of a row.
    fn meet(&self, j: usize, k: usize) -> bool {
        self.seen_by.is_empty() || self.seen_by[j] & self.seen_by[k] != 0
    }
}

/// For each node the entries that name it: the transpose of a table.
#[derive(Clone, Debug)]
pub struct Incidence {
    offsets: Vec<usize>,
    /// (row, entry) pairs; entry is an index into the table's flat arrays.
    entries: Vec<(u32, u32)>,
}

impl Incidence {
    /// Transposes `table`, visiting its rows in `order`: that is the order in which a node meets them.
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

    /// The (row, entry) pairs of one node.
    #[inline]
    pub fn of(&self, node: usize) -> &[(u32, u32)] {
        &self.entries[self.offsets[node]..self.offsets[node + 1]]
    }
}

/// Lower triangle of the node graph in compressed rows: row `i` lists the neighbours `j <= i` in ascending order,
/// the diagonal last.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockPattern {
    offsets: Vec<usize>,
    columns: Vec<u32>,
}

impl BlockPattern {
    /// The union of the pairs of all tables, each with nodes ascending in every row. The diagonal is always there.
    pub fn new(node_count: usize, tables: &[(Connectivity, &Incidence)]) -> BlockPattern {
        /// Rows per task: few, as a cloud of 83 nodes is to keep two threads busy.
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
                                // All i + 1 columns are in: a dense cloud (83 nodes) leaves early.
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
        let columns = chunks.into_iter().flat_map(|c| c.0).collect();
        BlockPattern { offsets, columns }
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

    /// Columns of one block row, ascending, the diagonal last.
    #[inline]
    pub fn row(&self, node: usize) -> &[u32] {
        &self.columns[self.range(node)]
    }

    /// Where the blocks of one row lie in the flat array.
    #[inline]
    pub fn range(&self, node: usize) -> std::ops::Range<usize> {
        self.offsets[node]..self.offsets[node + 1]
    }
}
