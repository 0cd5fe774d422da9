//! Arrays of values of cells or nodes in a file.

use crate::error::Place;

/// Array of a file that holds values of cells or nodes.
#[derive(Clone)]
pub(crate) struct DataArray {
    pub name: String,
    pub place: Place,
    pub of_cells: bool,
    pub components: usize,
    /// Element or node numbers of the file, in any order; empty unless the array is requested.
    pub numbers: Vec<u64>,
    /// Values, all components of one number after another; empty unless the array is requested.
    pub values: Vec<f64>,
}

impl DataArray {
    /// The array of consecutive numbers from `first` on.
    pub fn numbered_from(mut self, first: u64) -> DataArray {
        let count = self.values.len() / self.components.max(1);
        self.numbers = (first..first + count as u64).collect();
        self
    }
}
