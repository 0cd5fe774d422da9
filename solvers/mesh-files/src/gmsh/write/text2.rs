//! Writer of version 2.2: an element for each facet of each group, then an element for each physical tag of
//! each cell.

use std::fmt::Write;

use geometry::Mesh;

use super::groups::{cell_tags, group_tag, physical_names};
use super::nodes::{cell_nodes, face_nodes};

pub(super) fn text(mesh: &Mesh, unit: f64) -> String {
    let mut out = String::from("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n");
    // Writing to a string cannot fail.
    macro_rules! line {
        ($($arg:tt)*) => { let _ = writeln!(out, $($arg)*); };
    }
    physical_names(&mut out, mesh);
    line!("$Nodes\n{}", mesh.points().len());
    for (node, p) in mesh.points().iter().enumerate() {
        line!("{} {} {} {}", node + 1, p.x / unit, p.y / unit, p.z / unit);
    }
    let group = |name: &str| mesh.group(name).unwrap_or_default();
    let faces: usize = mesh.group_names().map(|name| group(name).len()).sum();
    let tags = cell_tags(mesh);
    line!("$EndNodes\n$Elements\n{}", faces + tags.iter().map(Vec::len).sum::<usize>());
    let mut number = 0;
    for (at, name) in mesh.group_names().enumerate() {
        let tag = group_tag(mesh, at);
        for &facet in group(name) {
            number += 1;
            let kind = mesh.facet_kind(facet).gmsh();
            let _ = write!(out, "{number} {kind} 2 {tag} {tag}");
            face_nodes(&mut out, mesh, facet);
        }
    }
    for (cell, tags) in tags.iter().enumerate() {
        let kind = mesh.kind(cell).entry().files.gmsh;
        let entity = tags[0];
        for tag in tags {
            number += 1;
            let _ = write!(out, "{number} {kind} 2 {tag} {entity}");
            cell_nodes(&mut out, mesh, cell);
        }
    }
    out.push_str("$EndElements\n");
    out
}
