//! Converts hexahedra to tetrahedra, and linear to quadratic cells.

use std::collections::HashMap;

use crate::{CellKind, Facet, Mesh};

/// Corner faces of a hexahedron as in [`CellKind::faces`], and corner faces of a tetrahedron.
const HEX: CellKind = CellKind::Hex8;
const TET: CellKind = CellKind::Tet4;

/// Whether every cell can be converted to `kind`. Any cell can become straight-edged tet4. In addition, tet4
/// can become tet10, and hex8 can become hex20 or tet10.
pub fn is_convertible(mesh: &Mesh, kind: CellKind) -> bool {
    let all = |kinds: &[CellKind]| (0..mesh.cell_count()).all(|c| kinds.contains(&mesh.kind(c)));
    all(&[kind])
        || match kind {
            CellKind::Tet4 => true,
            CellKind::Tet10 => all(&[CellKind::Tet4, CellKind::Hex8]),
            CellKind::Hex8 => false,
            CellKind::Hex20 => all(&[CellKind::Hex8]),
        }
}

/// Converts a mesh to cells of `kind`, or returns `None` if a cell cannot be converted ([`is_convertible`]).
/// New nodes lie halfway along their edges.
pub fn converted(mesh: Mesh, kind: CellKind) -> Option<Mesh> {
    is_convertible(&mesh, kind).then(|| match kind {
        _ if mesh.uniform_kind() == Some(kind) => mesh,
        CellKind::Tet4 => to_tets(&mesh),
        CellKind::Tet10 => raise_order(&to_tets(&mesh)),
        CellKind::Hex8 | CellKind::Hex20 => raise_order(&mesh),
    })
}

/// Divides a mesh into linear tetrahedra. Every hexahedron becomes six; tetrahedra keep their corners.
/// Regions and groups are kept; nodes that only quadratic cells used are dropped.
///
/// Each hexahedron is a cone from its lowest-numbered node over the three opposite faces. Every face is cut
/// through its lowest-numbered node (Dompierre et al. 1999), so neighbours agree on the cut and the mesh is
/// conforming for any arrangement. In a box numbered along its axes this is Kuhn's subdivision.
pub fn to_tets(mesh: &Mesh) -> Mesh {
    let mut cells: Vec<[u32; 4]> = Vec::new();
    let mut regions = Vec::new();
    let mut first = Vec::with_capacity(mesh.cell_count() + 1);
    for cell in 0..mesh.cell_count() {
        first.push(cells.len());
        let nodes = mesh.cell(cell);
        if mesh.kind(cell).is_tet() {
            cells.push([nodes[0], nodes[1], nodes[2], nodes[3]]);
        } else {
            cut_hexahedron(&nodes[..8], &mut cells);
        }
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

fn cut_hexahedron(nodes: &[u32], cells: &mut Vec<[u32; 4]>) {
    let lowest = *nodes.iter().min().unwrap_or(&0);
    for face in HEX.faces() {
        let n: [u32; 4] = std::array::from_fn(|i| nodes[face[i]]);
        if n.contains(&lowest) {
            continue;
        }
        let start = (0..4).min_by_key(|&i| n[i]).unwrap_or(0);
        let around = |i: usize| n[(start + i) % 4];
        // Seen from outside, the face is counter-clockwise. From the apex inside it is clockwise: the
        // reversed face gives a positive volume.
        cells.push([around(0), around(2), around(1), lowest]);
        cells.push([around(0), around(3), around(2), lowest]);
    }
}

/// The faces of a cell's tetrahedra that lie in one face of the cell.
fn facets_within(mesh: &Mesh, facet: Facet, cells: &[[u32; 4]], first: &[usize]) -> Vec<Facet> {
    let corners: Vec<u32> = mesh.facet_nodes(facet).take(4).collect();
    let cell = facet.cell as usize;
    if mesh.kind(cell).is_tet() {
        return vec![Facet { cell: first[cell] as u32, face: facet.face }];
    }
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

/// Raises cells to quadratic order with the same corners: tet4 becomes tet10, hex8 becomes hex20, quadratic
/// cells are unchanged. New nodes lie halfway along their edges. They are numbered after the existing nodes,
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
        kinds.push(match kind {
            CellKind::Tet4 => CellKind::Tet10,
            CellKind::Hex8 => CellKind::Hex20,
            quadratic => quadratic,
        });
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
    let (mut kinds, mut nodes, mut faces) = (Vec::new(), Vec::new(), HashMap::new());
    for cell in 0..mesh.cell_count() {
        let (kind, own) = (mesh.kind(cell), mesh.cell(cell));
        let corners: &[usize] = if kind.is_tet() { &[0, 2, 1, 3] } else { &[0, 3, 2, 1, 4, 7, 6, 5] };
        kinds.push(kind);
        nodes.extend(corners.iter().map(|&corner| own[corner]));
        if kind.order() == 2 {
            // A mid-edge node keeps its edge.
            nodes.extend(kind.edges().iter().map(|&[a, b]| {
                let ends = [corners[a], corners[b]];
                let edge = kind.edges().iter().position(|edge| ends.iter().all(|end| edge.contains(end)));
                own[kind.corner_count() + edge.unwrap_or(0)]
            }));
        }
        // Maps each old face to the new face with the same corners.
        let count = kind.face_kind().corner_count();
        faces.entry(kind.is_tet()).or_insert_with(|| {
            kind.faces()
                .iter()
                .map(|face| {
                    let same =
                        |new: &&[usize]| new[..count].iter().all(|&c| face[..count].contains(&corners[c]));
                    kind.faces().iter().position(|new| same(&&new[..])).unwrap_or(0) as u8
                })
                .collect::<Vec<u8>>()
        });
    }
    let regions = (0..mesh.cell_count()).map(|cell| mesh.region(cell)).collect();
    let moved =
        |f: &Facet| Facet { face: faces[&mesh.kind(f.cell as usize).is_tet()][f.face as usize], ..*f };
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
