//! The lower triangle of a symmetric matrix of B x B blocks: what every level of the hierarchy starts from.

use crate::Stiffness;

/// A block by columns.
pub(super) type Block<const B: usize> = [[f64; B]; B];

/// Rows of a lower triangle: columns ascend, the diagonal is the last.
pub(super) trait LowerRows<const B: usize>: Sync {
    fn nodes(&self) -> usize;
    fn columns(&self, row: usize) -> &[u32];
    /// The block at a place of a row. A degree of freedom without a stiffness has one of its own, [`LowerRows::unit`].
    fn block(&self, row: usize, at: usize) -> Block<B>;
    /// The largest diagonal entry.
    fn unit(&self) -> f64;
}

/// A stiffness with some degrees of freedom held.
pub(super) struct Held<'a> {
    stiffness: &'a Stiffness,
    held: &'a [bool],
    /// Of each node, whether any axis is held: hardly any is, and every block asks for two.
    any: Vec<bool>,
    unit: f64,
}

impl<'a> Held<'a> {
    /// `held` has an entry for each degree of freedom `3 node + axis`.
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

    #[inline]
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

/// A lower triangle of its own, of a coarse level.
pub(super) struct Lower<const B: usize> {
    pub offsets: Vec<usize>,
    pub columns: Vec<u32>,
    pub blocks: Vec<Block<B>>,
    pub unit: f64,
}

impl<const B: usize> Lower<B> {
    /// Zeros at these places.
    pub fn zeros(offsets: Vec<usize>, columns: Vec<u32>, unit: f64) -> Lower<B> {
        let blocks = vec![[[0.0; B]; B]; columns.len()];
        Lower { offsets, columns, blocks, unit }
    }

    /// Gives degrees of freedom that no function of the finer level sees a stiffness of their own.
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

    #[inline]
    fn block(&self, row: usize, at: usize) -> Block<B> {
        self.blocks[self.offsets[row] + at]
    }

    fn unit(&self) -> f64 {
        self.unit
    }
}
