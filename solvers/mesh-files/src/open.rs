//! Access to a file: its suffix, its bytes and the unit of its lengths.

use std::path::Path;

use crate::error::FileError;

/// Suffix of a file's name, in lower case.
pub(crate) fn suffix(file: &Path) -> String {
    file.extension().map(|s| s.to_string_lossy().to_lowercase()).unwrap_or_default()
}

/// Reads a whole file up to the size limit of meshes.
pub(crate) fn bytes(file: &Path) -> Result<Vec<u8>, FileError> {
    disk::read(file, disk::Kind::MESH).map_err(|source| FileError::Io { file: file.to_path_buf(), source })
}

/// Refuses a unit that is not a positive number.
pub(crate) fn check_unit(file: &Path, unit: f64) -> Result<(), FileError> {
    let known = unit > 0.0 && unit.is_finite();
    if known { Ok(()) } else { Err(FileError::Unit { file: file.to_path_buf(), unit }) }
}
