//! Groups of nodes of a mesh, and the faces that have all their corners among some nodes.

use geometry::{Facet, Mesh};

/// New numbers of those nodes that the mesh has; `used` maps the old numbers, with `u32::MAX` for dropped nodes.
pub(super) fn within(used: &[u32], nodes: &[u32]) -> Vec<u32> {
    nodes.iter().map(|&node| used[node as usize]).filter(|&node| node != u32::MAX).collect()
}

/// Adds a group of nodes, unless the faces of the same name have all its nodes.
pub(super) fn with_further_nodes(mesh: Mesh, name: &str, nodes: Vec<u32>, faces: &[Facet]) -> Mesh {
    let of_faces = mesh.facet_group_nodes(faces);
    if nodes.iter().all(|node| of_faces.binary_search(node).is_ok()) {
        return mesh;
    }
    let known = mesh.node_group(name).unwrap_or_default().to_vec();
    mesh.with_node_group(name, [known, nodes].concat())
}

/// Boundary faces with all corners among the given nodes.
pub(super) fn faces_of(mesh: &Mesh, nodes: &[u32]) -> Vec<Facet> {
    let mut within = vec![false; mesh.points().len()];
    nodes.iter().for_each(|&node| within[node as usize] = true);
    let all = |facet: &Facet| mesh.facet_corners(*facet).all(|node| within[node as usize]);
    mesh.boundary().iter().copied().filter(all).collect()
}

/// Boundary faces of a cell; `boundary` is sorted by cell.
pub(super) fn of_cell(boundary: &[Facet], cell: u32) -> impl Iterator<Item = Facet> {
    let start = boundary.partition_point(|facet| facet.cell < cell);
    boundary[start..].iter().take_while(move |facet| facet.cell == cell).copied()
}
