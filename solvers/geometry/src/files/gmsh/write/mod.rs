//! Writers of versions 2.2 and 4.1 in text. Regions and facet groups become physical groups of the same
//! names.

mod text2;
mod text4;

use std::fmt::Write;

use crate::{Facet, Mesh};

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
pub(in crate::files) fn text(mesh: &Mesh, unit: f64, version: GmshVersion) -> Result<String, String> {
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

/// Physical tag of a region.
fn region_tag(region: u16) -> usize {
    usize::from(region) + 1
}

/// Physical tags of each cell, with that of its region first.
fn cell_tags(mesh: &Mesh) -> Vec<Vec<usize>> {
    let mut tags: Vec<Vec<usize>> =
        (0..mesh.cell_count()).map(|cell| vec![region_tag(mesh.region(cell))]).collect();
    for ((_, cells), tag) in mesh.cell_groups().zip(further_tags(mesh)) {
        let new = cells.iter().filter(|&&cell| mesh.region(cell as usize) as usize + 1 != tag);
        new.for_each(|&cell| tags[cell as usize].push(tag));
    }
    tags
}

/// Physical tags of the groups of cells. A group has the tag of the region of the same name, if there is one,
/// or else a tag after those of the regions.
fn further_tags(mesh: &Mesh) -> impl Iterator<Item = usize> {
    let regions = mesh.region_names();
    mesh.cell_groups().enumerate().map(move |(at, (name, _))| {
        regions.iter().position(|region| region == name).unwrap_or(regions.len() + at) + 1
    })
}

/// Physical tag of a facet group by its index. The tags follow those of the cells, so that all tags are
/// distinct.
fn group_tag(mesh: &Mesh, group: usize) -> usize {
    mesh.region_names().len() + mesh.cell_groups().count() + group + 1
}

fn physical_names(out: &mut String, mesh: &Mesh) {
    // Writing to a string cannot fail.
    let regions = mesh.region_names().len();
    let further: Vec<(usize, &str)> = further_tags(mesh)
        .zip(mesh.cell_groups().map(|(name, _)| name))
        .filter(|(tag, _)| *tag > regions)
        .collect();
    let _ = writeln!(out, "$PhysicalNames\n{}", regions + further.len() + mesh.group_names().count());
    for (group, name) in mesh.group_names().enumerate() {
        let _ = writeln!(out, "2 {} \"{name}\"", group_tag(mesh, group));
    }
    for (region, name) in mesh.region_names().iter().enumerate() {
        let _ = writeln!(out, "3 {} \"{name}\"", region_tag(region as u16));
    }
    for (tag, name) in further {
        let _ = writeln!(out, "3 {tag} \"{name}\"");
    }
    out.push_str("$EndPhysicalNames\n");
}

/// Writes the nodes of a face and a line break.
fn face_nodes(out: &mut String, mesh: &Mesh, facet: Facet) {
    for node in mesh.facet_nodes(facet) {
        let _ = write!(out, " {}", node + 1);
    }
    out.push('\n');
}

/// Writes the nodes of a cell in Gmsh's order and a line break.
fn cell_nodes(out: &mut String, mesh: &Mesh, cell: usize) {
    let nodes = mesh.cell(cell);
    for &local in mesh.kind(cell).entry().files.gmsh_order {
        let _ = write!(out, " {}", nodes[local] + 1);
    }
    out.push('\n');
}
