//! Writing of meshes in any format.

use std::path::Path;

use geometry::Mesh;

use crate::error::FileError;
use crate::format::Format;
use crate::open::check_unit;
use crate::{abaqus, gmsh, surface, vtu};

/// Writes a mesh in the [`Format`] of the file's suffix: `.msh` (Gmsh 2.2), `.inp` or `.vtu`, or its boundary
/// as `.stl`. `unit` is the length of the file's unit in metres.
///
/// # Errors
/// Another suffix, a name that the format cannot represent, or a file that cannot be written.
pub fn write(mesh: &Mesh, file: &Path, unit: f64) -> Result<(), FileError> {
    write_as(mesh, file, unit, Format::of(file)?)
}

/// Writes a mesh as [`write()`] does, in an explicit format. Except in STL, numbers are written so that they
/// read back to the same bits for `unit = 1`, and otherwise to the rounding of one division and one product.
///
/// # Errors
/// A name that the format cannot represent, or a file that cannot be written.
pub fn write_as(mesh: &Mesh, file: &Path, unit: f64, format: Format) -> Result<(), FileError> {
    check_unit(file, unit)?;
    let bytes = match format {
        Format::Gmsh(version) => gmsh::write::text(mesh, unit, version).map(String::into_bytes),
        Format::Abaqus => abaqus::write::text(mesh, unit).map(String::into_bytes),
        Format::Vtu => vtu::write::bytes(mesh, unit),
        Format::Stl => Ok(surface::write(mesh, unit)),
    };
    let bytes = bytes.map_err(|name| FileError::Name { file: file.to_path_buf(), name })?;
    disk::write(file, bytes).map_err(|source| FileError::Io { file: file.to_path_buf(), source })
}
