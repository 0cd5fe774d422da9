//! The writer of version 2.2 in text: regions and facet groups become physical groups by their names.

use std::fmt::Write;

use super::order::{order, type_numbers};
use crate::Mesh;

/// The file's text, in lengths of `unit` metres; or a name that it can't hold.
pub(in crate::files) fn text(mesh: &Mesh, unit: f64) -> Result<String, String> {
    let names = mesh.region_names().iter().map(String::as_str).chain(mesh.group_names());
    if let Some(name) = names.into_iter().find(|n| n.is_empty() || n.contains(['"', '\n', '\r'])) {
        return Err(name.into());
    }
    let mut out = String::from("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n");
    // Writing to a string can't fail.
    macro_rules! line {
        ($($arg:tt)*) => { let _ = writeln!(out, $($arg)*); };
    }
    let regions = mesh.region_names();
    let groups: Vec<&str> = mesh.group_names().collect();
    line!("$PhysicalNames\n{}", regions.len() + groups.len());
    for (tag, name) in groups.iter().enumerate() {
        line!("2 {} \"{name}\"", regions.len() + tag + 1);
    }
    for (tag, name) in regions.iter().enumerate() {
        line!("3 {} \"{name}\"", tag + 1);
    }
    line!("$EndPhysicalNames\n$Nodes\n{}", mesh.points().len());
    for (node, p) in mesh.points().iter().enumerate() {
        line!("{} {} {} {}", node + 1, p.x / unit, p.y / unit, p.z / unit);
    }
    let group = |name: &str| mesh.group(name).unwrap_or_default();
    let faces: usize = groups.iter().map(|name| group(name).len()).sum();
    line!("$EndNodes\n$Elements\n{}", faces + mesh.cell_count());
    let mut number = 0;
    for (tag, name) in groups.iter().enumerate() {
        let tag = regions.len() + tag + 1;
        for &facet in group(name) {
            number += 1;
            let kind = type_numbers(mesh.kind(facet.cell as usize)).1;
            let _ = write!(out, "{number} {kind} 2 {tag} {tag}");
            for node in mesh.facet_nodes(facet) {
                let _ = write!(out, " {}", node + 1);
            }
            out.push('\n');
        }
    }
    for cell in 0..mesh.cell_count() {
        number += 1;
        let (kind, tag, nodes) = (mesh.kind(cell), u32::from(mesh.region(cell)) + 1, mesh.cell(cell));
        let _ = write!(out, "{number} {} 2 {tag} {tag}", type_numbers(kind).0);
        for &local in order(kind) {
            let _ = write!(out, " {}", nodes[local] + 1);
        }
        out.push('\n');
    }
    out.push_str("$EndElements\n");
    Ok(out)
}
