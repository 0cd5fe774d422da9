//! Surface files: STL (text and binary), OBJ, PLY (text and binary), OFF, VTK's .vtp and Medit's .mesh. STL
//! is also written.

mod medit;
mod obj;
mod off;
mod ply;
mod stl;

use std::path::{Path, PathBuf};

use geometry::Surface;
use geometry::surface::{Soup, Treated, Treatment};

use crate::error::{FileError, SurfaceError};
use crate::open::{bytes, check_unit, suffix};
use crate::text::{self, unknown};
use crate::vtu;

pub(super) use stl::write;

/// Surface formats accepted by [`read_surface`], for messages.
pub const SURFACES: &str =
    "give a closed surface: STL (.stl), OBJ (.obj), PLY (.ply), OFF (.off), VTK (.vtp) or Medit (.mesh)";

/// Reads a closed surface; the content of the file determines the format. `unit` is the length of the file's
/// unit in metres.
///
/// # Errors
/// A file in none of the formats or with a violation of its format, with the line or byte. A surface that is
/// open, crosses itself or is inside out, with the triangles and the position.
pub fn read_surface(file: &Path, unit: f64) -> Result<Surface, SurfaceError> {
    read_surface_bytes(&bytes(file)?, file, unit)
}

/// Reads a closed surface as [`read_surface`] does, from memory; `file` is the name used in errors.
///
/// # Errors
/// As for [`read_surface`].
pub fn read_surface_bytes(bytes: &[u8], file: &Path, unit: f64) -> Result<Surface, SurfaceError> {
    Ok(read_treated_bytes(bytes, file, unit, Treatment::AsGiven)?.surface)
}

/// Reads a surface that need not be closed, and repairs or wraps it.
///
/// # Errors
/// As for [`read_surface`], for the faults that the treatment leaves; a size of a wrap that does not fit the
/// surface.
pub fn read_treated(file: &Path, unit: f64, treatment: Treatment) -> Result<Treated, SurfaceError> {
    read_treated_bytes(&bytes(file)?, file, unit, treatment)
}

/// Reads a surface as [`read_treated`] does, from memory; `file` is the name used in errors.
///
/// # Errors
/// As for [`read_treated`].
pub fn read_treated_bytes(
    bytes: &[u8],
    file: &Path,
    unit: f64,
    treatment: Treatment,
) -> Result<Treated, SurfaceError> {
    check_unit(file, unit)?;
    treated(triangles(bytes, file)?, file, unit, treatment)
}

/// Reads the closed surfaces of several files as [`read_treated`] does, as one surface. Each of them names
/// its triangles, and faces are numbered on from file to file.
///
/// # Errors
/// As for [`read_treated`].
pub fn read_together(files: &[PathBuf], unit: f64, treatment: Treatment) -> Result<Treated, SurfaceError> {
    let [first, _, ..] = files else { return read_treated(&files[0], unit, treatment) };
    check_unit(first, unit)?;
    let read = |file: &PathBuf| {
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Ok((name, triangles(&bytes(file)?, file)?))
    };
    let soups = files.iter().map(read).collect::<Result<Vec<_>, SurfaceError>>()?;
    let names: Vec<String> = files.iter().map(|file| file.display().to_string()).collect();
    treated(Soup::of_files(soups), Path::new(&names.join(", ")), unit, treatment)
}

fn triangles(bytes: &[u8], file: &Path) -> Result<Soup, FileError> {
    let bytes = unmarked(bytes);
    let soup = match kind(bytes, file) {
        Some(Kind::Stl) => stl::parse(bytes),
        Some(Kind::Obj) => obj::parse(bytes),
        Some(Kind::Ply) => ply::parse(bytes),
        Some(Kind::Off) => off::parse(bytes),
        Some(Kind::Medit) => medit::parse(bytes),
        Some(Kind::Vtp) => vtu::surface(bytes),
        None => unknown(bytes),
    };
    soup.map_err(|(place, problem)| FileError::At { file: file.to_path_buf(), place, problem })
}

fn treated(soup: Soup, file: &Path, unit: f64, treatment: Treatment) -> Result<Treated, SurfaceError> {
    Surface::treated(soup, unit, treatment).map_err(|problem| SurfaceError::Surface {
        file: file.to_path_buf(),
        repaired: treatment == Treatment::Repair,
        problem: Box::new(problem),
    })
}

/// Whether a file holds a surface, according to its first bytes; false for a file that cannot be read.
pub fn is_surface(file: &Path) -> bool {
    bytes(file).is_ok_and(|bytes| holds_surface(&bytes, file))
}

pub(super) fn holds_surface(bytes: &[u8], file: &Path) -> bool {
    kind(unmarked(bytes), file).is_some()
}

/// Removes the byte order mark of a text. A binary file is unchanged, because its comment may begin with any
/// bytes.
fn unmarked(bytes: &[u8]) -> &[u8] {
    if stl::is_binary(bytes) { bytes } else { text::unmarked(bytes) }
}

enum Kind {
    Stl,
    Obj,
    Ply,
    Off,
    Medit,
    Vtp,
}

/// Format of a surface, `None` for other content.
fn kind(bytes: &[u8], file: &Path) -> Option<Kind> {
    let start = bytes.iter().position(|b| !b.is_ascii_whitespace())?;
    let begins = |word: &[u8]| bytes[start..].get(..word.len()).is_some_and(|b| b.eq_ignore_ascii_case(word));
    if begins(b"ply\n") || begins(b"ply\r") {
        Some(Kind::Ply)
    } else if stl::is_binary(bytes) || begins(b"solid") {
        Some(Kind::Stl)
    } else if off::is_text(&bytes[start..]) {
        Some(Kind::Off)
    } else if medit::is_text(&bytes[start..]) {
        Some(Kind::Medit)
    } else if begins(b"<") && vtu::is_surface(bytes) {
        Some(Kind::Vtp)
    } else if obj::is_text(&bytes[start..]) {
        Some(Kind::Obj)
    } else {
        // A truncated binary file may begin with any bytes.
        let other = begins(b"$") || begins(b"*") || begins(b"<") || begins(b"# vtk");
        (suffix(file) == "stl" && !other).then_some(Kind::Stl)
    }
}
