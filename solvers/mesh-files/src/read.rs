//! Reading of meshes in any format.

use std::path::{Path, PathBuf};

use geometry::Mesh;
use geometry::quality::InvertedElement;

use crate::content::{Content, Unused};
use crate::error::{FileError, Parsed, Place, Problem};
use crate::left_out::LeftOut;
use crate::open::{bytes, check_unit, suffix};
use crate::rows::{Row, Rows};
use crate::text::{unknown, unmarked};
use crate::{abaqus, febio, gmsh, surface, vtk, vtu};

/// Mesh formats accepted by [`read`], for messages.
pub const READ: &str =
    "give a mesh file: Gmsh .msh (1, 2.2, 4.0 or 4.1), Abaqus or CalculiX .inp, FEBio .feb, VTK .vtu or .vtk";

/// Whether a file is a mesh according to its suffix, in contexts that also accept lists of points.
pub fn is_mesh(file: &Path) -> bool {
    ["msh", "inp", "feb", "vtu", "vtk"].iter().any(|known| suffix(file) == *known)
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
/// use are dropped; a node that nothing uses is an error, except in a deck with a step. Nodes and cells keep
/// the order of the file.
///
/// # Errors
/// A file in none of the formats, with a violation of its format, with an unused node or without a valid
/// mesh. The error has the line or byte and the number of the node or element in the file.
pub fn read(file: &Path, unit: f64) -> Result<Mesh, FileError> {
    Ok(read_rows(&bytes(file)?, file, unit)?.0)
}

/// Reads a mesh as [`read`] does, with the numbers and places of its nodes and cells in the file.
///
/// # Errors
/// As for [`read`].
pub fn read_numbered(file: &Path, unit: f64) -> Result<(Mesh, Rows), FileError> {
    read_rows(&bytes(file)?, file, unit)
}

/// Reads a mesh as [`read`] does, from memory. Also returns the place and element number of every cell in the
/// file. `file` is the name used in errors.
///
/// # Errors
/// As for [`read`].
pub fn read_bytes(bytes: &[u8], file: &Path, unit: f64) -> Result<(Mesh, Vec<Row>), FileError> {
    read_rows(bytes, file, unit).map(|(mesh, rows)| (mesh, rows.cells))
}

fn read_rows(bytes: &[u8], file: &Path, unit: f64) -> Result<(Mesh, Rows), FileError> {
    check_unit(file, unit)?;
    let at = |(place, problem)| FileError::At { file: file.to_path_buf(), place, problem };
    let content = parse(bytes, file, None).map_err(at)?;
    content.into_mesh(unit, file, Unused::Refused)
}

/// Reads a mesh as [`read`] does, and drops unused nodes instead of rejecting them.
///
/// # Errors
/// As for [`read`], except unused nodes.
pub fn read_without_unused(file: &Path, unit: f64) -> Result<Mesh, FileError> {
    check_unit(file, unit)?;
    let at = |(place, problem)| FileError::At { file: file.to_path_buf(), place, problem };
    let content = parse(&bytes(file)?, file, None).map_err(at)?;
    Ok(content.into_mesh(unit, file, Unused::LeftOut)?.0)
}

/// Row of a cell in a file that [`read`] accepts; `None` if the file has no such cell.
fn row_of_cell(file: &Path, cell: usize) -> Option<Row> {
    let (_, rows) = read_bytes(&bytes(file).ok()?, file, 1.0).ok()?;
    rows.get(cell).copied()
}

/// Returns a message about the inverted cells `bad` of the mesh in `file`: their number, and the place of the
/// first, for which the file is read again.
pub fn inverted(file: &Path, bad: &InvertedElement) -> String {
    let row = row_of_cell(file, bad.element).map_or_else(String::new, |row| row.to_string());
    match (bad.inverted, bad.cells) {
        (some, all) if some == all => {
            format!(
                "all {all} cells are inverted (first: {row}): the order of their corners is mirrored; \
                 reverse the order with tissuebench mesh convert --turn"
            )
        }
        (1, all) => format!("1 of {all} cells is inverted ({row})"),
        (some, all) => format!("{some} of {all} cells are inverted (first: {row})"),
    }
}

/// Returns the parts of a file that its mesh omits or changes; empty for a surface or for a file that cannot
/// be read.
pub fn left_out(file: &Path) -> Vec<LeftOut> {
    let content = bytes(file).ok().and_then(|bytes| parse(&bytes, file, None).ok());
    content.map(Content::into_left_out).unwrap_or_default()
}

/// Parses a file by its first characters: `$` for Gmsh, `*KEYWORD` for Abaqus, `<` for XML (FEBio or VTK), `#
/// vtk` for legacy VTK. The values of the array `wanted` are kept.
pub(crate) fn parse(bytes: &[u8], file: &Path, wanted: Option<&str>) -> Parsed<Content> {
    let whole = bytes;
    let bytes = unmarked(bytes);
    let start = bytes.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(bytes.len());
    match &bytes[start..] {
        [b'$', next, ..] if next.is_ascii_alphabetic() => gmsh::parse(bytes, wanted),
        [b'*', ..] => abaqus::parse(bytes, file),
        [b'<', ..] if febio::is_model(bytes) => febio::parse(bytes, wanted),
        [b'<', ..] if vtu::is_surface(bytes) => Err((Place::Line(1), Problem::Surface)),
        [b'<', ..] => vtu::parse(bytes, wanted),
        rest if rest.starts_with(b"# vtk") => vtk::parse(bytes, wanted),
        _ if surface::holds_surface(whole, file) => Err((Place::Line(1), Problem::Surface)),
        _ => unknown(bytes),
    }
}
