//! Output formats, and the choice of a format by file name.

use std::path::Path;

use crate::error::FileError;
use crate::gmsh::write::GmshVersion;
use crate::open::suffix;

/// An output format of meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Text .msh file of Gmsh.
    Gmsh(GmshVersion),
    /// Flat .inp deck of Abaqus and CalculiX.
    Abaqus,
    /// VTK .vtu file.
    Vtu,
    /// Binary .stl file of the boundary alone.
    Stl,
}

impl Format {
    /// Returns the format that belongs to a file's suffix; `.msh` is Gmsh 2.2.
    ///
    /// # Errors
    /// A suffix that belongs to no format.
    pub fn of(file: &Path) -> Result<Format, FileError> {
        Ok(match suffix(file).as_str() {
            "msh" => Format::Gmsh(GmshVersion::default()),
            "inp" => Format::Abaqus,
            "vtu" => Format::Vtu,
            "stl" => Format::Stl,
            _ => return Err(FileError::Suffix { file: file.to_path_buf() }),
        })
    }
}
