//! The formats that are written, and which a file's name means.

use std::path::Path;

use super::{FileError, GmshVersion, suffix};

/// A format that meshes are written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Gmsh's .msh in text.
    Gmsh(GmshVersion),
    /// A flat deck of Abaqus and CalculiX, .inp.
    Abaqus,
    /// VTK's .vtu.
    Vtu,
    /// The boundary alone, as binary .stl.
    Stl,
}

impl Format {
    /// The format of a file's suffix; of Gmsh's versions 2.2.
    ///
    /// # Errors
    /// A suffix that none has.
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
