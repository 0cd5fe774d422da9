//! A coarser mesh on the same body, for solvers with several levels.

use crate::Rows;

/// Functions of some of a method's nodes, interpolated at all of its nodes: the linear mesh under a quadratic
/// mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Coarser {
    /// For each node of the method, the coarser nodes in ascending order and the values of their functions.
    pub rows: Rows,
    /// Node of the method that coincides with each coarser node.
    pub places: Vec<u32>,
}
