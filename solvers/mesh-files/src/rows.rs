//! Rows: the places of nodes and cells in the file that a mesh was read from.

use std::fmt;

use crate::error::Place;

/// Places of the nodes and cells of a mesh, in its order.
#[derive(Clone, Debug)]
pub struct Rows {
    /// Of each node.
    pub nodes: Vec<Row>,
    /// Of each cell.
    pub cells: Vec<Row>,
}

/// Place and number of a node or a cell in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Row {
    /// Line, byte or cell.
    pub place: Place,
    /// Number of the node or element in the file.
    pub tag: u64,
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.place {
            // Files with cell places have no other element number.
            Place::Cell(_) => write!(f, "{}", self.place),
            _ => write!(f, "{}, element {}", self.place, self.tag),
        }
    }
}
