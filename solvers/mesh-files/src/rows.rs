//! Rows: the places of cells in the file that a mesh was read from.

use std::fmt;

use crate::error::Place;

/// Place and number of a cell in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Row {
    /// Line, byte or cell.
    pub place: Place,
    /// Element number in the file.
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
