//! Rows: the places of cells in the file that a mesh was read from.

use std::fmt;
use std::path::Path;

use super::error::Place;
use super::{bytes, read_bytes};
use crate::quality::InvertedElement;

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

/// Row of a cell in a file that [`read`](super::read) accepts; `None` if the file has no such cell.
pub fn row_of_cell(file: &Path, cell: usize) -> Option<Row> {
    let (_, rows) = read_bytes(&bytes(file).ok()?, file, 1.0).ok()?;
    rows.get(cell).copied()
}

/// Returns a message about the inverted cells `bad` of the mesh in `file`: their number, and the place of the
/// first, for which the file is read again.
pub fn inverted(file: &Path, bad: &InvertedElement) -> String {
    let row = row_of_cell(file, bad.element).map_or_else(String::new, |row| row.to_string());
    match (bad.inverted, bad.cells) {
        (some, all) if some == all => {
            format!(
                "all {all} cells are inverted (first: {row}): the order of their corners is mirrored; \
                 reverse the order with tissuebench mesh convert --turn"
            )
        }
        (1, all) => format!("1 of {all} cells is inverted ({row})"),
        (some, all) => format!("{some} of {all} cells are inverted (first: {row})"),
    }
}
