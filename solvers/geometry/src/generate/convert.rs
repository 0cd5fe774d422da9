//! Converts hexahedra to tetrahedra, and linear to quadratic cells.

use std::collections::HashMap;

use crate::{CellKind, Facet, Mesh};

const TET: CellKind = CellKind::Tet4;

/// Whether every cell can be converted to `kind`. Any cell can become straight-edged tet4, linear cells can
/// become tet10, and a linear cell can become the quadratic cell of the same shape.
pub fn is_convertible(mesh: &Mesh, kind: CellKind) -> bool {
    let all = |is: &dyn Fn(CellKind) -> bool| (0..mesh.cell_count()).all(|cell| is(mesh.kind(cell)));
    let linear = kind.of_order(1);
    let from_linear = kind.order() == 2 && all(&|own| own.order() == 1);
    all(&|own| own == kind)
        || kind == TET
        || from_linear && (linear == Some(TET) || all(&|own| Some(own) == linear))
}

/// Converts a mesh to cells of `kind`, or returns `None` if a cell cannot be converted ([`is_convertible`]).
/// New nodes lie halfway along their edges.
pub fn converted(mesh: Mesh, kind: CellKind) -> Option<Mesh> {
    is_convertible(&mesh, kind).then(|| match kind {
        _ if mesh.uniform_kind() == Some(kind) => mesh,
        TET => to_tets(&mesh),
        _ if kind.of_order(1) == Some(TET) => raise_order(&to_tets(&mesh)),
        _ => raise_order(&mesh),
    })
}

/// Divides a mesh into linear tetrahedra. Every hexahedron becomes six; tetrahedra keep their corners.
/// Regions and groups are kept; nodes that only quadratic cells used are dropped.
///
/// Each other cell is a cone from its lowest-numbered node over the opposite faces. Every face is cut
/// through its lowest-numbered node (Dompierre et al. 1999), so neighbours agree on the cut and the mesh is
/// conforming for any arrangement. In a box numbered along its axes this is Kuhn's subdivision.
pub fn to_tets(mesh: &Mesh) -> Mesh {
    let mut cells: Vec<[u32; 4]> = Vec::new();
    let mut regions = Vec::new();
    let mut first = Vec::with_capacity(mesh.cell_count() + 1);
    for cell in 0..mesh.cell_count() {
        first.push(cells.len());
        cut(mesh.kind(cell), mesh.cell(cell), &mut cells);
        regions.resize(cells.len(), mesh.region(cell));
    }
    first.push(cells.len());

    let groups: Vec<(String, Vec<Facet>)> = mesh
        .group_names()
        .map(|name| {
            let facets = mesh.group(name).unwrap_or_default();
            let tets = facets.iter().flat_map(|&f| facets_within(mesh, f, &cells, &first)).collect();
            (name.to_string(), tets)
        })
        .collect();

    let mut number = vec![u32::MAX; mesh.points().len()];
    for &node in cells.iter().flatten() {
        number[node as usize] = 0;
    }
    let mut points = Vec::new();
    for (node, slot) in number.iter_mut().enumerate().filter(|(_, slot)| **slot == 0) {
        *slot = points.len() as u32;
        points.push(mesh.points()[node]);
    }
    let nodes = cells.iter().flatten().map(|&n| number[n as usize]).collect();
    let tets = rebuilt(mesh, points, vec![TET; cells.len()], nodes, regions, groups);
    mesh.cell_groups().fold(tets, |tets, (name, of)| {
        tets.with_cell_group(
            name,
            of.iter()
                .flat_map(|&cell| first[cell as usize] as u32..first[cell as usize + 1] as u32)
                .collect(),
        )
    })
}

fn cut(kind: CellKind, nodes: &[u32], cells: &mut Vec<[u32; 4]>) {
    let corners = &nodes[..kind.corner_count()];
    if let &[a, b, c, d] = corners {
        cells.push([a, b, c, d]);
        return;
    }
    let lowest = *corners.iter().min().unwrap_or(&0);
    for face in 0..kind.faces().len() {
        let n: Vec<u32> = kind.face_corners(face).iter().map(|&corner| nodes[corner]).collect();
        if n.contains(&lowest) {
            continue;
        }
        let start = (0..n.len()).min_by_key(|&i| n[i]).unwrap_or(0);
        let around = |i: usize| n[(start + i) % n.len()];
        // Seen from outside, the face is counter-clockwise. From the apex inside it is clockwise: the
        // reversed face gives a positive volume.
        cells.extend((2..n.len()).map(|i| [around(0), around(i), around(i - 1), lowest]));
    }
}

/// The faces of a cell's tetrahedra that lie in one face of the cell.
fn facets_within(mesh: &Mesh, facet: Facet, cells: &[[u32; 4]], first: &[usize]) -> Vec<Facet> {
    let corners: Vec<u32> = mesh.facet_corners(facet).collect();
    let cell = facet.cell as usize;
    let mut found = Vec::new();
    for tet in first[cell]..first[cell + 1] {
        for (face, local) in TET.faces().iter().enumerate() {
            if local.iter().all(|&l| corners.contains(&cells[tet][l])) {
                found.push(Facet { cell: tet as u32, face: face as u8 });
            }
        }
    }
    found
}

/// Raises cells to the quadratic kind of the same shape; quadratic cells are unchanged. New nodes lie halfway along their edges. They are numbered after the existing nodes,
/// in the order in which cells first use them.
pub fn raise_order(mesh: &Mesh) -> Mesh {
    let mut points = mesh.points().to_vec();
    let mut middle: HashMap<(u32, u32), u32> = HashMap::new();
    // Existing mid-edge nodes, so that a mixed-order mesh stays conforming.
    for cell in (0..mesh.cell_count()).filter(|&c| mesh.kind(c).order() == 2) {
        let (kind, nodes) = (mesh.kind(cell), mesh.cell(cell));
        for (edge, &[a, b]) in kind.edges().iter().enumerate() {
            middle.insert(ordered(nodes[a], nodes[b]), nodes[kind.corner_count() + edge]);
        }
    }
    let mut kinds = Vec::with_capacity(mesh.cell_count());
    let mut nodes = Vec::new();
    for cell in 0..mesh.cell_count() {
        let (kind, list) = (mesh.kind(cell), mesh.cell(cell));
        nodes.extend_from_slice(list);
        kinds.push(kind.of_order(2).expect("every shape has a quadratic kind"));
        if kind.order() == 2 {
            continue;
        }
        for &[a, b] in kind.edges() {
            let (a, b) = ordered(list[a], list[b]);
            nodes.push(*middle.entry((a, b)).or_insert_with(|| {
                points.push(nalgebra::center(&points[a as usize], &points[b as usize]));
                points.len() as u32 - 1
            }));
        }
    }
    let regions = (0..mesh.cell_count()).map(|c| mesh.region(c)).collect();
    let groups = mesh
        .group_names()
        .map(|name| (name.to_string(), mesh.group(name).unwrap_or_default().to_vec()))
        .collect();
    with_cell_groups(rebuilt(mesh, points, kinds, nodes, regions, groups), mesh)
}

/// Copies the cell groups of `of` to a mesh with the same cells.
fn with_cell_groups(mesh: Mesh, of: &Mesh) -> Mesh {
    of.cell_groups().fold(mesh, |mesh, (name, cells)| mesh.with_cell_group(name, cells.to_vec()))
}

/// Returns the mesh with the corners of each cell in mirrored order, which corrects the orientation of a
/// mirrored mesh.
pub fn turned(mesh: &Mesh) -> Mesh {
    let (mut kinds, mut nodes) = (Vec::new(), Vec::new());
    // Mirrored node order of each kind, and the new face with the corners of each old face.
    let mut orders = HashMap::new();
    for cell in 0..mesh.cell_count() {
        let (kind, own) = (mesh.kind(cell), mesh.cell(cell));
        let (order, _): &(Vec<usize>, Vec<u8>) = orders.entry(kind).or_insert_with(|| {
            let order = kind.mirrored();
            let count = kind.faces().len();
            let is = |old: usize, new: usize| {
                let (old, new) = (kind.face_corners(old), kind.face_corners(new));
                old.len() == new.len() && new.iter().all(|&corner| old.contains(&order[corner]))
            };
            let new = |old| (0..count).find(|&new| is(old, new)).unwrap_or(0) as u8;
            let faces = (0..count).map(new).collect();
            (order, faces)
        });
        kinds.push(kind);
        nodes.extend(order.iter().map(|&node| own[node]));
    }
    let regions = (0..mesh.cell_count()).map(|cell| mesh.region(cell)).collect();
    let moved = |f: &Facet| Facet { face: orders[&mesh.kind(f.cell as usize)].1[f.face as usize], ..*f };
    let groups = mesh
        .group_names()
        .map(|name| (name.to_string(), mesh.group(name).unwrap_or_default().iter().map(moved).collect()));
    let groups = groups.collect();
    with_cell_groups(rebuilt(mesh, mesh.points().to_vec(), kinds, nodes, regions, groups), mesh)
}

fn ordered(a: u32, b: u32) -> (u32, u32) {
    (a.min(b), a.max(b))
}

/// Builds a mesh with the region names of `source`. The mesh is valid because `source` is.
fn rebuilt(
    source: &Mesh,
    points: Vec<crate::Point3>,
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
