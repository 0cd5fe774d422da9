//! Writers of versions 2.2 and 4.1 in text. Regions and facet groups become physical groups of the same
//! names.

mod groups;
mod nodes;
mod text2;
mod text4;

use geometry::Mesh;

/// An output version of Gmsh's format.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GmshVersion {
    /// Version 2.2, which most other programs read.
    #[default]
    Two,
    /// Version 4.1, with entities.
    FourOne,
}

/// Returns the text of the file with lengths in units of `unit` metres.
///
/// # Errors
/// A name that the format cannot represent.
pub(crate) fn text(mesh: &Mesh, unit: f64, version: GmshVersion) -> Result<String, String> {
    let further = mesh.cell_groups().map(|(name, _)| name);
    let names = mesh.region_names().iter().map(String::as_str).chain(further).chain(mesh.group_names());
    if let Some(name) = names.into_iter().find(|n| n.is_empty() || n.contains(['"', '\n', '\r'])) {
        return Err(name.into());
    }
    Ok(match version {
        GmshVersion::Two => text2::text(mesh, unit),
        GmshVersion::FourOne => text4::text(mesh, unit),
    })
}
