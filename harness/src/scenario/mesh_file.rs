//! Mesh files of bodies and methods.

use cases::scene::MeshFile;
use geometry::{Mesh, pieces};

use crate::error::{Failure, Key};

/// Reads a mesh file and joins its pieces if the scene requests it.
pub(super) fn read(file: &MeshFile, key: Key) -> Result<Mesh, Failure> {
    let mesh = mesh_files::read(&file.path, file.unit)
        .map_err(|bad| Failure::input(key, format!("can't be read: {bad}"), mesh_files::READ))?;
    let pieces = if file.join { pieces::count(&mesh) } else { 1 };
    if pieces == 1 {
        return Ok(mesh);
    }
    pieces::join(&mesh).map(|(mesh, _)| mesh).ok_or_else(|| {
        let problem =
            format!("joins nothing: the {pieces} pieces of {} have no coincident faces", file.path.display());
        let help = "leave it out, or mesh the parts with matching faces at their interfaces";
        Failure::input(Key::Scene("body.join".into()), problem, help)
    })
}
