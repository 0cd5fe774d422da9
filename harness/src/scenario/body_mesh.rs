//! The mesh of a method on the scene's body, checked for inversion.

use cases::scene::{Body, Element, Jitter, Size};
use geometry::generate::raise_order;
use geometry::{CellKind, Mesh, quality};

use super::body::{inverted, joined, unchecked};
use super::mesh_file::read;
use super::same_body;
use crate::error::{Failure, Key};

/// Meshes the body in cells of one kind and checks them for inversion.
///
/// # Errors
/// Returns an error if the size or jitter does not apply to the body, if the mesh has too many nodes or
/// inverted cells, or if a mesh file is of another body.
pub fn mesh(body: &Body, kind: CellKind, size: &Size, jitter: Option<Jitter>) -> Result<Mesh, Failure> {
    sound(body, unchecked(body, kind, size, jitter)?, size, jitter)
}

/// Returns a mesh of the body with the names of its surfaces: that of its file, or one of few cells.
///
/// # Errors
/// Returns an error if the file cannot be read, or if the body is too thin for few cells.
pub(crate) fn coarse(body: &Body) -> Result<Mesh, Failure> {
    match body {
        Body::File(file) if !mesh_files::is_surface(&file.path) => read(file, Key::Scene("body.path".into())),
        _ => mesh(body, CellKind::Tet4, &Size::Level(1), None),
    }
}

/// Checks a mesh for inversion, and that a mesh file is of the body.
fn sound(body: &Body, mesh: Mesh, size: &Size, jitter: Option<Jitter>) -> Result<Mesh, Failure> {
    quality::check_inversion(&mesh).map_err(|bad| inverted(bad, size, jitter))?;
    if let Size::File(file) = size {
        same_body::check(body, file, &mesh)?;
    }
    Ok(mesh)
}

/// Meshes the body in cells of one kind, or takes the cells of a file as they are.
///
/// # Errors
/// As for [`mesh`], or if cells of several kinds are not of a file or not of one order.
pub(super) fn mesh_of(
    body: &Body,
    element: Element,
    size: &Size,
    jitter: Option<Jitter>,
) -> Result<Mesh, Failure> {
    if let Some(kind) = element.kind() {
        return mesh(body, kind, size, jitter);
    }
    let Size::File(file) = size else {
        let problem = format!("makes cells of one kind, not {}", element.name());
        return Err(Failure::input(Key::Size(""), problem, "take a mesh: size = { file = \"...\" }"));
    };
    let read = read(&joined(body, file), Key::Size("file"))?;
    let of_order = |order| (0..read.cell_count()).all(|cell| read.kind(cell).order() == order);
    let mesh = match element.order() {
        order if of_order(order) => read,
        2 if of_order(1) => raise_order(&read),
        order => {
            let (found, other) =
                (if of_order(2) { "quadratic cells" } else { "cells of both orders" }, 3 - order);
            let problem = format!("holds {found}, not {}", element.name());
            let help = format!("take element = \"{}\", or cells of one order", Element::mixed(other).name());
            return Err(Failure::input(Key::Size("file"), problem, &help));
        }
    };
    sound(body, mesh, size, jitter)
}
