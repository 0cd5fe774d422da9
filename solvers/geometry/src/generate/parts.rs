//! Meshes whose cells are parts of the cells of another mesh.

use crate::Point3;
use crate::element::CellKind;
use crate::mesh::{Facet, Mesh};

/// Mesh of the parts of the cells of a mesh, all of one kind. `nodes` has the nodes of all parts; cell `c`
/// has the parts `first[c]..first[c + 1]`. Regions and groups are kept, unused nodes are dropped.
pub(super) fn divided(mesh: &Mesh, kind: CellKind, mut nodes: Vec<u32>, first: &[usize]) -> Mesh {
    let parts = nodes.len() / kind.node_count();
    let mut regions = Vec::with_capacity(parts);
    for cell in 0..mesh.cell_count() {
        regions.resize(first[cell + 1], mesh.region(cell));
    }
    let groups: Vec<(String, Vec<Facet>)> = mesh
        .group_names()
        .map(|name| {
            let facets = mesh.group(name).unwrap_or_default();
            let within = facets.iter().flat_map(|&f| facets_within(mesh, f, kind, &nodes, first)).collect();
            (name.to_string(), within)
        })
        .collect();

    let mut number = vec![u32::MAX; mesh.points().len()];
    for &node in &nodes {
        number[node as usize] = 0;
    }
    let mut points = Vec::new();
    for (node, slot) in number.iter_mut().enumerate().filter(|(_, slot)| **slot == 0) {
        *slot = points.len() as u32;
        points.push(mesh.points()[node]);
    }
    nodes.iter_mut().for_each(|node| *node = number[*node as usize]);
    let mut whole = rebuilt(mesh, points, vec![kind; parts], nodes, regions, groups);
    for (name, of) in mesh.node_groups() {
        let kept = of.iter().map(|&node| number[node as usize]).filter(|&node| node != u32::MAX);
        whole = whole.with_node_group(name, kept.collect());
    }
    mesh.cell_groups().fold(whole, |whole, (name, of)| {
        let parts = of.iter().flat_map(|&cell| first[cell as usize] as u32..first[cell as usize + 1] as u32);
        whole.with_cell_group(name, parts.collect())
    })
}

/// The faces of a cell's parts that lie in one face of the cell.
fn facets_within(mesh: &Mesh, facet: Facet, kind: CellKind, nodes: &[u32], first: &[usize]) -> Vec<Facet> {
    let corners: Vec<u32> = mesh.facet_corners(facet).collect();
    let cell = facet.cell as usize;
    let mut found = Vec::new();
    for part in first[cell]..first[cell + 1] {
        let own = &nodes[part * kind.node_count()..];
        for (face, local) in kind.faces().iter().enumerate() {
            if local.iter().all(|&l| corners.contains(&own[l])) {
                found.push(Facet { cell: part as u32, face: face as u8 });
            }
        }
    }
    found
}

/// Builds a mesh with the region names of `source`. The mesh is valid because `source` is.
pub(super) fn rebuilt(
    source: &Mesh,
    points: Vec<Point3>,
    kinds: Vec<CellKind>,
    nodes: Vec<u32>,
    regions: Vec<u16>,
    groups: Vec<(String, Vec<Facet>)>,
) -> Mesh {
    let mut mesh = Mesh::from_flat(points, kinds, nodes)
        .expect("cells of a valid mesh stay valid")
        .with_regions(regions, source.region_names().to_vec());
    for (name, facets) in groups {
        mesh = mesh.with_group(&name, facets).expect("facets of a valid mesh stay valid");
    }
    mesh
}
