//! A coarser mesh on the same body, for solvers with several levels.

use crate::rows::Rows;

/// Interpolation from the nodes of a coarser mesh, which are some of a method's nodes, to all nodes of the
/// method. An example is the interpolation from the corners of a quadratic mesh to all of its nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Coarser {
    /// One row per node of the method: the nodes of the coarser mesh in ascending order, and the values of
    /// their functions at the node.
    pub rows: Rows,
    /// Node of the method at the place of each node of the coarser mesh.
    pub places: Vec<u32>,
}
