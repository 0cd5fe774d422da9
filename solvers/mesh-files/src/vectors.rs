//! Vectors of the cells or nodes of a mesh file, by the name of their array.

use std::path::Path;

use geometry::{Mesh, Vector3};

use crate::content::Unused;
use crate::data_array::DataArray;
use crate::error::{FileError, Parsed, Place, Problem};
use crate::open::{bytes, check_unit};
use crate::read::parse;
use crate::rows::Row;

/// A vector for each cell or for each node of a mesh, as its file gives them.
#[derive(Clone, Debug, PartialEq)]
pub struct Vectors {
    /// Whether the vectors belong to cells, not to nodes.
    pub of_cells: bool,
    /// Number of each cell or node in the file.
    pub numbers: Vec<u64>,
    /// Vector of each cell or node of the mesh, of any length; `None` if the file has none for it.
    pub vectors: Vec<Option<Vector3>>,
}

/// Reads a mesh as [`read`](crate::read()) does, with the vectors of one array: cell or point data of VTK
/// files, `$ElementData` or `$NodeData` of Gmsh files, `<ElementData type="fiber">` of FEBio models.
///
/// The vectors are not checked, because a body may need only some of them.
///
/// # Errors
/// As for [`read`](crate::read()); or if the file has no array of this name, two of them, or one that does not have
/// three components.
pub fn read_vectors(file: &Path, unit: f64, name: &str) -> Result<(Mesh, Vectors), FileError> {
    read_vectors_bytes(&bytes(file)?, file, unit, name)
}

/// Reads a mesh with vectors as [`read_vectors`] does, from memory. `file` is the name used in errors.
///
/// # Errors
/// As for [`read_vectors`].
pub fn read_vectors_bytes(
    bytes: &[u8],
    file: &Path,
    unit: f64,
    name: &str,
) -> Result<(Mesh, Vectors), FileError> {
    check_unit(file, unit)?;
    let at = |(place, problem)| FileError::At { file: file.to_path_buf(), place, problem };
    let mut content = parse(bytes, file, Some(name)).map_err(at)?;
    let arrays = std::mem::take(&mut content.arrays);
    let array = select(arrays, name).map_err(|problem| match problem {
        (Some(place), problem) => at((place, problem)),
        (None, problem) => FileError::Array { file: file.to_path_buf(), problem },
    })?;
    let nodes = content.used_nodes();
    let (mesh, rows) = content.into_mesh(unit, file, Unused::Refused)?;
    let vectors = array.vectors(&rows.cells, nodes).map_err(at)?;
    Ok((mesh, vectors))
}

/// Finds the only array of a name, which has to have three components. Pieces of one array are joined.
fn select(arrays: Vec<DataArray>, name: &str) -> Result<DataArray, (Option<Place>, Problem)> {
    let known = |array: &&DataArray| array.components == 3 && array.name != name;
    let mut names: Vec<String> = arrays.iter().filter(known).map(|array| array.name.clone()).collect();
    names.sort_unstable();
    names.dedup();
    let mut found = arrays.into_iter().filter(|array| array.name == name);
    let array = name.to_string();
    let Some(mut first) = found.next() else { return Err((None, Problem::NoArray { array, known: names })) };
    for next in found {
        if next.of_cells != first.of_cells || next.components != first.components {
            return Err((Some(next.place), Problem::TwoArrays { array }));
        }
        first.numbers.extend(next.numbers);
        first.values.extend(next.values);
    }
    match first.components {
        3 => Ok(first),
        found => Err((Some(first.place), Problem::Components { array, found })),
    }
}

impl DataArray {
    /// Vectors of the cells with these rows, or of the nodes with these numbers.
    fn vectors(&self, rows: &[Row], nodes: Vec<u64>) -> Parsed<Vectors> {
        let numbers = if self.of_cells { rows.iter().map(|row| row.tag).collect() } else { nodes };
        let mut order: Vec<usize> = (0..self.numbers.len()).collect();
        order.sort_by_key(|&k| self.numbers[k]);
        if let Some(pair) = order.windows(2).find(|pair| self.numbers[pair[0]] == self.numbers[pair[1]]) {
            let what = if self.of_cells { "a vector for element" } else { "a vector for node" };
            return Err((self.place, Problem::Duplicate { what, number: self.numbers[pair[0]] }));
        }
        let vector = |number: &u64| {
            let k = order.binary_search_by_key(number, |&k| self.numbers[k]).ok()?;
            Some(Vector3::from_column_slice(&self.values[3 * order[k]..][..3]))
        };
        let vectors = numbers.iter().map(vector).collect();
        Ok(Vectors { of_cells: self.of_cells, numbers, vectors })
    }
}
