//! Lower triangle of a symmetric matrix of B x B blocks, from which every level of the hierarchy is built.

use crate::stiffness::Stiffness;

/// Block, stored by columns.
pub(super) type Block<const B: usize> = [[f64; B]; B];

/// Rows of a lower triangle: columns ascend, the diagonal is last.
pub(super) trait LowerRows<const B: usize>: Sync {
    fn nodes(&self) -> usize;
    fn columns(&self, row: usize) -> &[u32];
    /// Returns the block at position `at` of a row. A degree of freedom without stiffness has
    /// [`LowerRows::unit`] on its diagonal.
    fn block(&self, row: usize, at: usize) -> Block<B>;
    /// Returns the largest diagonal entry.
    fn unit(&self) -> f64;
}

/// Stiffness with some constrained degrees of freedom.
pub(super) struct Held<'a> {
    stiffness: &'a Stiffness,
    held: &'a [bool],
    /// Whether any axis of each node is constrained. Few are, and every block asks this of two nodes.
    any: Vec<bool>,
    unit: f64,
}

impl<'a> Held<'a> {
    /// Builds the lower triangle of a stiffness in which the degrees of freedom `3 node + axis` marked in
    /// `held` are constrained.
    pub fn new(stiffness: &'a Stiffness, held: &'a [bool]) -> Held<'a> {
        let diagonal = |i: usize| *stiffness.row(i).1.last().expect("every row has its diagonal");
        let nodes = stiffness.pattern().node_count();
        let unit = (0..nodes)
            .flat_map(|i| (0..3).filter(move |a| !held[3 * i + a]).map(move |a| diagonal(i)[(a, a)]))
            .fold(0.0, f64::max);
        let any = held.chunks_exact(3).map(|held| held.contains(&true)).collect();
        Held { stiffness, held, any, unit }
    }
}

impl LowerRows<3> for Held<'_> {
    fn nodes(&self) -> usize {
        self.stiffness.pattern().node_count()
    }

    #[inline]
    fn columns(&self, row: usize) -> &[u32] {
        self.stiffness.pattern().row(row)
    }

    #[inline(always)]
    fn block(&self, row: usize, at: usize) -> Block<3> {
        let (columns, blocks) = self.stiffness.row(row);
        let column = columns[at] as usize;
        let mut block = blocks[at].data.0;
        if self.any[row] || self.any[column] {
            let (of_row, of_column) = (&self.held[3 * row..][..3], &self.held[3 * column..][..3]);
            for (b, entries) in block.iter_mut().enumerate() {
                for (a, entry) in entries.iter_mut().enumerate() {
                    if of_row[a] || of_column[b] {
                        *entry = if column == row && a == b { self.unit } else { 0.0 };
                    }
                }
            }
        }
        block
    }

    fn unit(&self) -> f64 {
        self.unit
    }
}

/// Lower triangle of a coarse level, which owns its blocks.
pub(super) struct Lower<const B: usize> {
    pub offsets: Vec<usize>,
    pub columns: Vec<u32>,
    pub blocks: Vec<Block<B>>,
    pub unit: f64,
}

impl<const B: usize> Lower<B> {
    /// Returns a zero matrix on the pattern `offsets`, `columns` (lower triangle, the diagonal last in each
    /// row). `unit` is the stiffness that [`Lower::fill_empty`] gives to empty diagonal entries.
    pub fn zeros(offsets: Vec<usize>, columns: Vec<u32>, unit: f64) -> Lower<B> {
        let blocks = vec![[[0.0; B]; B]; columns.len()];
        Lower { offsets, columns, blocks, unit }
    }

    /// Gives the stiffness `unit` to degrees of freedom of the coarse level to which no degree of freedom of
    /// the finer level contributes.
    pub fn fill_empty(&mut self) {
        for end in &self.offsets[1..] {
            let diagonal = &mut self.blocks[end - 1];
            for (a, column) in diagonal.iter_mut().enumerate() {
                if column[a] == 0.0 {
                    column[a] = self.unit;
                }
            }
        }
    }
}

impl<const B: usize> LowerRows<B> for Lower<B> {
    fn nodes(&self) -> usize {
        self.offsets.len() - 1
    }

    #[inline]
    fn columns(&self, row: usize) -> &[u32] {
        &self.columns[self.offsets[row]..self.offsets[row + 1]]
    }

    #[inline(always)]
    fn block(&self, row: usize, at: usize) -> Block<B> {
        self.blocks[self.offsets[row] + at]
    }

    fn unit(&self) -> f64 {
        self.unit
    }
}
