//! Physical groups: their tags and names.

use std::fmt::Write;

use geometry::Mesh;

/// Physical tag of a region.
fn region_tag(region: u16) -> usize {
    usize::from(region) + 1
}

/// Physical tags of each cell, with that of its region first.
pub(super) fn cell_tags(mesh: &Mesh) -> Vec<Vec<usize>> {
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
pub(super) fn group_tag(mesh: &Mesh, group: usize) -> usize {
    mesh.region_names().len() + mesh.cell_groups().count() + group + 1
}

pub(super) fn physical_names(out: &mut String, mesh: &Mesh) {
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
