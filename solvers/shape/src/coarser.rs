//! A coarser mesh on the same body, for solvers with several levels.

use crate::Rows;

/// Interpolation from some of a method's nodes to all of its nodes, such as from the linear mesh under a
/// quadratic mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Coarser {
    /// For each node of the method, the coarser nodes in ascending order and the values of their functions at
    /// the node.
    pub rows: Rows,
    /// Node of the method that coincides with each coarser node.
    pub places: Vec<u32>,
}
