//! Cells of a mesh by their rows in the file that it was read from.

use std::fmt;
use std::path::Path;

use super::order::{Element, element};
use crate::quality::InvertedElement;

/// Where a file has a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Row {
    /// Line number from 1.
    pub line: usize,
    /// The number that the file gives the element.
    pub tag: u64,
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}, tag {}", self.line, self.tag)
    }
}

/// The row of a cell in a file that [`read`](super::read) takes; `None` if the file has no such cell.
pub fn row_of_cell(file: &Path, cell: usize) -> Option<Row> {
    let text = std::fs::read_to_string(file).ok()?;
    let solid = |(index, line): (usize, &str)| {
        let mut numbers = line.split_whitespace().map(str::parse::<u64>);
        let (tag, kind) = (numbers.next()?.ok()?, numbers.next()?.ok()?);
        matches!(element(kind), Some(Element::Cell(_))).then_some(Row { line: index + 1, tag })
    };
    let section = text.lines().enumerate().skip_while(|(_, line)| line.trim() != "$Elements");
    section.filter_map(solid).nth(cell)
}

/// How many cells of a file are inverted, and where the first one is.
pub fn inverted(file: &Path, bad: &InvertedElement) -> String {
    let row = row_of_cell(file, bad.element).map_or_else(String::new, |row| row.to_string());
    match (bad.inverted, bad.cells) {
        (some, all) if some == all => {
            format!("all {all} cells are inverted (first: {row}): the order of their corners is mirrored")
        }
        (1, all) => format!("1 of {all} cells is inverted ({row})"),
        (some, all) => format!("{some} of {all} cells are inverted (first: {row})"),
    }
}
