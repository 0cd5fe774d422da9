//! Mesh files in and out: Gmsh (.msh 1, 2.2, 4.0, 4.1), Abaqus and CalculiX (.inp), VTK (.vtu, .vtk); closed surfaces: STL, OBJ, PLY.
//!
//! Groups and sets are kept: those of cells as regions, those of faces as facet groups. Every reader fills one `Content`,
//! which alone makes the mesh, so that every format is refused for the same faults, each by the place and the number that the
//! file has for it.

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

/// What [`read`] takes, for messages.
pub const READ: &str =
    "give a mesh file: Gmsh .msh (1, 2.2, 4.0 or 4.1), Abaqus or CalculiX .inp, VTK .vtu or .vtk";

/// Whether a file is a mesh by its name, where it may be a list of points too.
pub fn is_mesh(file: &Path) -> bool {
    ["msh", "inp", "vtu", "vtk"].iter().any(|known| suffix(file) == *known)
}

fn suffix(file: &Path) -> String {
    file.extension().map(|s| s.to_string_lossy().to_lowercase()).unwrap_or_default()
}

/// The files that a mesh file includes, by their names in it, as far as they can be read; most have none.
pub fn included(file: &Path) -> Vec<PathBuf> {
    let folder = file.parent().map(Path::to_path_buf).unwrap_or_default();
    let is_deck = suffix(file) == "inp";
    if is_deck { abaqus::included(file, &folder) } else { Vec::new() }
}

/// Reads a mesh file by what it holds, whatever its name; `unit` is the length of the file's unit in metres (0.001 for millimetres).
///
/// Points, lines and parts of a file that are no mesh are read over, and so are nodes that only these or sets name. Nodes and cells keep
/// the order of the file.
///
/// # Errors
/// A file that is none of the formats, broken, or no valid mesh: with the line or the byte, and the file's own number of the node or
/// the element.
pub fn read(file: &Path, unit: f64) -> Result<Mesh, FileError> {
    Ok(read_bytes(&bytes(file)?, file, unit)?.0)
}

/// As [`read`], from memory, with the place of every cell; `file` is the name used in errors.
pub fn read_bytes(bytes: &[u8], file: &Path, unit: f64) -> Result<(Mesh, Vec<Row>), FileError> {
    check_unit(file, unit)?;
    let at = |(place, problem)| FileError::At { file: file.to_path_buf(), place, problem };
    let content = parse(bytes, file).map_err(at)?;
    content.into_mesh(unit, file, Unused::Refused)
}

/// As [`read`], but nodes that nothing names are left out.
pub fn read_without_unused(file: &Path, unit: f64) -> Result<Mesh, FileError> {
    check_unit(file, unit)?;
    let at = |(place, problem)| FileError::At { file: file.to_path_buf(), place, problem };
    let content = parse(&bytes(file)?, file).map_err(at)?;
    Ok(content.into_mesh(unit, file, Unused::LeftOut)?.0)
}

/// Writes a mesh in the [`Format`] of the file's suffix: `.msh` (Gmsh 2.2), `.inp` or `.vtu`, or its boundary as `.stl`.
///
/// # Errors
/// Another suffix, a name that the format can't hold, or a folder that can't be written.
pub fn write(mesh: &Mesh, file: &Path, unit: f64) -> Result<(), FileError> {
    write_as(mesh, file, unit, Format::of(file)?)
}

/// As [`write()`], in a format of one's own choice. Numbers of all but STL are written so that they read back to the same bits (for
/// `unit = 1`; else to the rounding of one division and one product).
///
/// # Errors
/// A name that the format can't hold, or a folder that can't be written.
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

/// By what a file begins with: `$` is Gmsh's, `*KEYWORD` Abaqus's, `<` XML, `# vtk` VTK's older format.
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

/// The bytes without the mark of the encoding that some editors put in front, and without the zeros that some
/// programs write behind a text.
fn unmarked(bytes: &[u8]) -> &[u8] {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let end = bytes.iter().position(|&b| b == 0).unwrap_or(bytes.len());
    let behind_text = bytes[end..].iter().all(|&b| b == 0 || b.is_ascii_whitespace());
    if behind_text { &bytes[..end] } else { bytes }
}

/// Names what a file begins with that is none of the formats.
fn unknown<T>(bytes: &[u8]) -> Parsed<T> {
    let start = bytes.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(bytes.len());
    let line = bytes[start..].split(|&b| b == b'\n').next().unwrap_or_default();
    let found = String::from_utf8_lossy(&line[..line.len().min(40)]).trim().to_string();
    Err((Place::Line(line_of(bytes, start)), Problem::Format { found }))
}

/// The text of a file in UTF-8, or else in Latin-1, in which every byte is a letter.
fn text(bytes: &[u8]) -> Parsed<Cow<'_, str>> {
    let Err(bad) = std::str::from_utf8(bytes) else { return Ok(String::from_utf8_lossy(bytes)) };
    if bytes.contains(&0) {
        let place = Place::Line(line_of(bytes, bad.valid_up_to()));
        return Err((place, Problem::Expected { expected: "text", found: "other bytes".into() }));
    }
    Ok(bytes.iter().map(|&byte| char::from(byte)).collect())
}

/// The number of the line, from 1, that holds a byte.
fn line_of(bytes: &[u8], at: usize) -> usize {
    1 + bytes[..at.min(bytes.len())].iter().filter(|&&b| b == b'\n').count()
}
