//! A coarser mesh on the same body, for solvers with several levels.

use crate::Rows;

/// Functions of some of a method's nodes, interpolated at all of them: the linear mesh under a quadratic one.
#[derive(Clone, Debug, PartialEq)]
pub struct Coarser {
    /// For each node of the method the coarser nodes, ascending, and the values of their functions.
    pub rows: Rows,
    /// The method's node at the place of each coarser node.
    pub places: Vec<u32>,
}
