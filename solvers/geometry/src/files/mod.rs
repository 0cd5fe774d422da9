//! Mesh files in and out: Gmsh (.msh 1, 2.2, 4.0, 4.1), Abaqus and CalculiX (.inp), VTK (.vtu, .vtk). Closed
//! surfaces: STL, OBJ, PLY.
//!
//! Groups and sets are kept: those of cells become regions, those of faces facet groups. Every reader fills a
//! `Content`, which alone builds the mesh. All formats are therefore checked for the same errors, which are
//! reported with the place and number in the file.

mod abaqus;
mod content;
mod error;
mod format;
mod gmsh;
mod left_out;
mod lines;
mod middles;
mod names;
mod numbers;
mod overlap;
mod rows;
mod surface;
mod vtk;
mod vtk_cells;
mod vtu;

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use crate::Mesh;
use content::{Content, Unused};
use error::Parsed;

pub use error::{FileError, Place, Problem};
pub use format::Format;
pub use gmsh::GmshVersion;
pub use left_out::{Kind, LeftOut, left_out, summary};
pub use rows::{Row, inverted, row_of_cell};
pub use surface::{SURFACES, is_surface, read_surface, read_surface_bytes};
pub use vtu::write::{Values, solution_vtu, surface_vtu};

/// Mesh formats accepted by [`read`], for messages.
pub const READ: &str =
    "give a mesh file: Gmsh .msh (1, 2.2, 4.0 or 4.1), Abaqus or CalculiX .inp, VTK .vtu or .vtk";

/// Whether a file is a mesh according to its suffix, in contexts that also accept lists of points.
pub fn is_mesh(file: &Path) -> bool {
    ["msh", "inp", "vtu", "vtk"].iter().any(|known| suffix(file) == *known)
}

fn suffix(file: &Path) -> String {
    file.extension().map(|s| s.to_string_lossy().to_lowercase()).unwrap_or_default()
}

/// Files included by a mesh file, by their names in it, as far as they can be read. Most files include none.
pub fn included(file: &Path) -> Vec<PathBuf> {
    let folder = file.parent().map(Path::to_path_buf).unwrap_or_default();
    let is_deck = suffix(file) == "inp";
    if is_deck { abaqus::included(file, &folder) } else { Vec::new() }
}

/// Reads a mesh file; its content, not its name, determines the format. `unit` is the length of the file's
/// unit in metres (0.001 for millimetres).
///
/// Points, lines and parts of a file that do not belong to a mesh are skipped. Nodes that only these or sets
/// use are dropped; a node that nothing uses is an error. Nodes and cells keep the order of the file.
///
/// # Errors
/// A file in none of the formats, with a violation of its format, with an unused node or without a valid
/// mesh. The error has the line or byte and the number of the node or element in the file.
pub fn read(file: &Path, unit: f64) -> Result<Mesh, FileError> {
    Ok(read_bytes(&bytes(file)?, file, unit)?.0)
}

/// Reads a mesh as [`read`] does, from memory. Also returns the place and element number of every cell in the
/// file. `file` is the name used in errors.
///
/// # Errors
/// As for [`read`].
pub fn read_bytes(bytes: &[u8], file: &Path, unit: f64) -> Result<(Mesh, Vec<Row>), FileError> {
    check_unit(file, unit)?;
    let at = |(place, problem)| FileError::At { file: file.to_path_buf(), place, problem };
    let content = parse(bytes, file).map_err(at)?;
    content.into_mesh(unit, file, Unused::Refused)
}

/// Reads a mesh as [`read`] does, and drops unused nodes instead of rejecting them.
///
/// # Errors
/// As for [`read`], except unused nodes.
pub fn read_without_unused(file: &Path, unit: f64) -> Result<Mesh, FileError> {
    check_unit(file, unit)?;
    let at = |(place, problem)| FileError::At { file: file.to_path_buf(), place, problem };
    let content = parse(&bytes(file)?, file).map_err(at)?;
    Ok(content.into_mesh(unit, file, Unused::LeftOut)?.0)
}

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
        Format::Gmsh(version) => gmsh::text(mesh, unit, version).map(String::into_bytes),
        Format::Abaqus => abaqus::write::text(mesh, unit).map(String::into_bytes),
        Format::Vtu => vtu::write::bytes(mesh, unit),
        Format::Stl => Ok(surface::write(mesh, unit)),
    };
    let bytes = bytes.map_err(|name| FileError::Name { file: file.to_path_buf(), name })?;
    disk::write(file, bytes).map_err(|source| FileError::Io { file: file.to_path_buf(), source })
}

fn check_unit(file: &Path, unit: f64) -> Result<(), FileError> {
    let known = unit > 0.0 && unit.is_finite();
    if known { Ok(()) } else { Err(FileError::Unit { file: file.to_path_buf(), unit }) }
}

fn bytes(file: &Path) -> Result<Vec<u8>, FileError> {
    disk::read(file, disk::Kind::MESH).map_err(|source| FileError::Io { file: file.to_path_buf(), source })
}

/// Parses a file by its first characters: `$` for Gmsh, `*KEYWORD` for Abaqus, `<` for XML, `# vtk` for
/// legacy VTK.
fn parse(bytes: &[u8], file: &Path) -> Parsed<Content> {
    let whole = bytes;
    let bytes = unmarked(bytes);
    let start = bytes.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(bytes.len());
    match &bytes[start..] {
        [b'$', next, ..] if next.is_ascii_alphabetic() => gmsh::parse(bytes),
        [b'*', ..] => abaqus::parse(bytes, file),
        [b'<', ..] => vtu::parse(bytes),
        rest if rest.starts_with(b"# vtk") => vtk::parse(bytes),
        _ if surface::holds_surface(whole, file) => Err((Place::Line(1), Problem::Surface)),
        _ => unknown(bytes),
    }
}

/// Removes the byte order mark at the beginning and the zero bytes that some programs append to a text.
fn unmarked(bytes: &[u8]) -> &[u8] {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let end = bytes.iter().position(|&b| b == 0).unwrap_or(bytes.len());
    let behind_text = bytes[end..].iter().all(|&b| b == 0 || b.is_ascii_whitespace());
    if behind_text { &bytes[..end] } else { bytes }
}

/// Returns the error for a file in none of the formats, with its first line.
fn unknown<T>(bytes: &[u8]) -> Parsed<T> {
    let start = bytes.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(bytes.len());
    let line = bytes[start..].split(|&b| b == b'\n').next().unwrap_or_default();
    let found = String::from_utf8_lossy(&line[..line.len().min(40)]).trim().to_string();
    Err((Place::Line(line_of(bytes, start)), Problem::Format { found }))
}

/// Decodes a text in UTF-8, or else in Latin-1, in which every byte is a character.
fn text(bytes: &[u8]) -> Parsed<Cow<'_, str>> {
    let Err(bad) = std::str::from_utf8(bytes) else { return Ok(String::from_utf8_lossy(bytes)) };
    if bytes.contains(&0) {
        let place = Place::Line(line_of(bytes, bad.valid_up_to()));
        return Err((place, Problem::Expected { expected: "text", found: "other bytes".into() }));
    }
    Ok(bytes.iter().map(|&byte| char::from(byte)).collect())
}

/// Line number, from 1, of a byte.
fn line_of(bytes: &[u8], at: usize) -> usize {
    1 + bytes[..at.min(bytes.len())].iter().filter(|&&b| b == b'\n').count()
}

/// Numbers in ascending order, with commas.
fn ascending<T: Ord + ToString, const N: usize>(mut numbers: [T; N]) -> String {
    numbers.sort_unstable();
    numbers.map(|number| number.to_string()).join(", ")
}
