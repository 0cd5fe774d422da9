//! Nodes of faces and cells, by their numbers in the file.

use std::fmt::Write;

use geometry::{Facet, Mesh};

/// Writes the nodes of a face and a line break.
pub(super) fn face_nodes(out: &mut String, mesh: &Mesh, facet: Facet) {
    for node in mesh.facet_nodes(facet) {
        let _ = write!(out, " {}", node + 1);
    }
    out.push('\n');
}

/// Writes the nodes of a cell in Gmsh's order and a line break.
pub(super) fn cell_nodes(out: &mut String, mesh: &Mesh, cell: usize) {
    let nodes = mesh.cell(cell);
    for &local in mesh.kind(cell).entry().files.gmsh_order {
        let _ = write!(out, " {}", nodes[local] + 1);
    }
    out.push('\n');
}
