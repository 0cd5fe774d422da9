//! Converts cells to cells of other shapes, and linear to quadratic cells.

use std::collections::HashMap;

use super::parts::{divided, rebuilt};
use super::wedges::to_wedges;
use crate::element::CellKind;
use crate::mesh::{Facet, Mesh};

const TET: CellKind = CellKind::Tet4;
const WEDGE: CellKind = CellKind::Wedge6;

/// Whether [`converted`] returns a mesh.
pub fn is_convertible(mesh: &Mesh, kind: CellKind) -> bool {
    converted(mesh.clone(), kind).is_some()
}

/// Converts a mesh to cells of `kind`, or returns `None` if a cell cannot be converted. Any cell can become
/// straight-edged tet4, most meshes of hex8 can become wedge6, and cells that can become linear cells can
/// become the quadratic cells of the same shape unless they are quadratic. New nodes lie halfway along their
/// edges.
pub fn converted(mesh: Mesh, kind: CellKind) -> Option<Mesh> {
    if mesh.uniform_kind() == Some(kind) {
        return Some(mesh);
    }
    if kind.order() == 2 {
        let linear =
            kind.of_order(1).filter(|_| (0..mesh.cell_count()).all(|c| mesh.kind(c).order() == 1))?;
        return converted(mesh, linear).map(|mesh| raise_order(&mesh));
    }
    match kind {
        TET => Some(to_tets(&mesh)),
        WEDGE => to_wedges(&mesh),
        _ => None,
    }
}

/// Divides a mesh into linear tetrahedra. Every hexahedron becomes six; tetrahedra keep their corners.
/// Regions and groups are kept; nodes that only quadratic cells used are dropped.
///
/// Each other cell is a cone from its lowest-numbered node over the opposite faces. Every face is cut
/// through its lowest-numbered node (Dompierre et al. 1999), so neighbours agree on the cut and the mesh is
/// conforming for any arrangement. In a box numbered along its axes this is Kuhn's subdivision.
pub fn to_tets(mesh: &Mesh) -> Mesh {
    let (nodes, first) = cut_all(mesh);
    divided(mesh, TET, nodes, &first)
}

/// Divides a mesh into the linear tetrahedra of [`to_tets`], in one region. All nodes keep their numbers;
/// nodes along the edges of quadratic cells belong to no tetrahedron.
pub fn tets_on_nodes(mesh: &Mesh) -> Mesh {
    let (nodes, _) = cut_all(mesh);
    let kinds = vec![TET; nodes.len() / 4];
    Mesh::from_flat(mesh.points().to_vec(), kinds, nodes).expect("parts of valid cells are valid")
}

/// Returns the corners of the tetrahedra of all cells; cell `c` has the tetrahedra `first[c]..first[c + 1]`.
fn cut_all(mesh: &Mesh) -> (Vec<u32>, Vec<usize>) {
    let (mut nodes, mut first) = (Vec::new(), vec![0]);
    for cell in 0..mesh.cell_count() {
        cut(mesh.kind(cell), mesh.cell(cell), &mut nodes);
        first.push(nodes.len() / 4);
    }
    (nodes, first)
}

fn cut(kind: CellKind, nodes: &[u32], tets: &mut Vec<u32>) {
    let corners = &nodes[..kind.corner_count()];
    if corners.len() == 4 {
        tets.extend(corners);
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
        tets.extend((2..n.len()).flat_map(|i| [around(0), around(i), around(i - 1), lowest]));
    }
}

/// Raises cells to the quadratic kind of the same shape; quadratic cells are unchanged. New nodes lie halfway
/// along their edges. They are numbered after the existing nodes, in the order in which cells first use them.
/// A group of nodes gains the new node of an edge if it has both ends.
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
    let mut raised = with_cell_groups(rebuilt(mesh, points, kinds, nodes, regions, groups), mesh);
    for (name, of) in mesh.node_groups() {
        let has = |node: &u32| of.binary_search(node).is_ok();
        let halfway = middle.iter().filter(|((a, b), _)| has(a) && has(b)).map(|(_, &node)| node);
        raised = raised.with_node_group(name, of.iter().copied().chain(halfway).collect());
    }
    raised
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
    let turned = with_cell_groups(rebuilt(mesh, mesh.points().to_vec(), kinds, nodes, regions, groups), mesh);
    mesh.node_groups().fold(turned, |turned, (name, of)| turned.with_node_group(name, of.to_vec()))
}

fn ordered(a: u32, b: u32) -> (u32, u32) {
    (a.min(b), a.max(b))
}
