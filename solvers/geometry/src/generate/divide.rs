//! Meshes whose cells are eighths of the cells of another mesh.

use std::collections::HashMap;

use super::parts::rebuilt;
use crate::Point3;
use crate::element::{CellKind, Element, map, with_element};
use crate::mesh::{Facet, Mesh};

/// Number of parts of a cell.
const PARTS: usize = 8;
/// Corners of the four tetrahedra around the middle of a tetrahedron, as pairs of its corners between which
/// they lie (Bey 1995).
const INNER: [[[usize; 2]; 4]; 4] = [
    [[0, 1], [0, 2], [0, 3], [1, 3]],
    [[0, 1], [0, 2], [1, 3], [1, 2]],
    [[0, 2], [0, 3], [1, 3], [2, 3]],
    [[0, 2], [1, 2], [2, 3], [1, 3]],
];

/// Divides every cell into eight cells of its kind, with nodes where the cell's shape functions map those
/// of the reference cell. Regions and groups are kept. A group of nodes gains the new nodes of each edge
/// and face of which it has all nodes.
pub fn divide(mesh: &Mesh) -> Mesh {
    let mut patterns = HashMap::new();
    let mut numbers = HashMap::new();
    let (mut points, mut kinds, mut nodes) = (Vec::new(), Vec::new(), Vec::new());
    for cell in 0..mesh.cell_count() {
        let kind = mesh.kind(cell);
        let pattern = patterns.entry(kind).or_insert_with(|| Pattern::new(kind));
        let (own, at): (_, Vec<Point3>) = (mesh.cell(cell), mesh.cell_points(cell).copied().collect());
        for (xi, weights) in pattern.nodes.iter().flatten() {
            let mut key: Vec<(u32, u8)> =
                own.iter().zip(weights).filter(|(_, w)| **w > 0).map(|(&node, &w)| (node, w)).collect();
            key.sort_unstable();
            nodes.push(*numbers.entry(key).or_insert_with(|| {
                points.push(map(kind, &at, *xi).0);
                points.len() as u32 - 1
            }));
        }
        kinds.resize(kinds.len() + PARTS, kind);
    }
    let regions = (0..PARTS * mesh.cell_count()).map(|part| mesh.region(part / PARTS)).collect();
    let within = |f: &Facet| {
        let parts = &patterns[&mesh.kind(f.cell as usize)].faces[usize::from(f.face)];
        let first = PARTS as u32 * f.cell;
        parts.iter().map(move |&[part, face]| Facet { cell: first + u32::from(part), face })
    };
    let groups = mesh.group_names().map(|name| {
        (name.to_string(), mesh.group(name).unwrap_or_default().iter().flat_map(within).collect())
    });
    let mut divided = rebuilt(mesh, points, kinds, nodes, regions, groups.collect());
    for (name, cells) in mesh.cell_groups() {
        let parts = cells.iter().flat_map(|&cell| (0..PARTS as u32).map(move |k| PARTS as u32 * cell + k));
        divided = divided.with_cell_group(name, parts.collect());
    }
    let edges = middles(mesh);
    for (name, of) in mesh.node_groups() {
        let has = |node: u32| of.binary_search(&node).is_ok();
        let within = numbers.iter().filter(|(key, _)| match key[..] {
            [(a, _), (b, _)] => has(a) && has(b) && edges.get(&[a, b]).is_none_or(|&middle| has(middle)),
            _ => key.iter().all(|&(node, _)| has(node)),
        });
        let nodes = within.map(|(_, &number)| number).collect();
        divided = divided.with_node_group(name, nodes);
    }
    divided
}

/// The middle node of each edge of quadratic cells, by its ends in ascending order.
fn middles(mesh: &Mesh) -> HashMap<[u32; 2], u32> {
    let of_cell = |cell: usize| {
        let (kind, nodes) = (mesh.kind(cell), mesh.cell(cell));
        let ends = move |&[a, b]: &[usize; 2]| [nodes[a].min(nodes[b]), nodes[a].max(nodes[b])];
        kind.edges().iter().map(ends).zip(nodes[kind.corner_count()..].iter().copied())
    };
    (0..mesh.cell_count()).flat_map(of_cell).collect()
}

/// The parts of the reference cell of one kind.
struct Pattern {
    /// Reference coordinates of each part's nodes, and the values there of the linear shape functions of
    /// the cell's corners in 64ths. The nodes with such values are the same node in all cells.
    nodes: Vec<Vec<([f64; 3], Vec<u8>)>>,
    /// Parts and their faces that lie in each face of the cell.
    faces: Vec<Vec<[u8; 2]>>,
}

impl Pattern {
    fn new(kind: CellKind) -> Pattern {
        let linear = kind.of_order(1).expect("every shape has a linear kind");
        let weights = |xi: [f64; 3]| -> Vec<u8> {
            with_element!(linear, E, N => E::shape(xi).map(|value| (64.0 * value).round() as u8).to_vec())
        };
        let middle = |a: [f64; 3], b: [f64; 3]| std::array::from_fn(|k| 0.5 * (a[k] + b[k]));
        let nodes: Vec<Vec<_>> = parts(kind)
            .into_iter()
            .map(|corners| {
                let edges = kind.edges().iter().map(|&[a, b]| middle(corners[a], corners[b]));
                let all = corners.iter().copied().chain(edges).take(kind.node_count());
                all.map(|xi| (xi, weights(xi))).collect()
            })
            .collect();
        let lies = |part: usize, own: usize, face: usize| {
            let corners = kind.face_corners(face);
            let of_face = |(corner, &w): (usize, &u8)| w == 0 || corners.contains(&corner);
            kind.face_corners(own).iter().all(|&k| nodes[part][k].1.iter().enumerate().all(of_face))
        };
        let count = kind.faces().len();
        let mut faces = vec![Vec::new(); count];
        for (part, own) in (0..PARTS).flat_map(|part| (0..count).map(move |own| (part, own))) {
            let within = (0..count).filter(|&face| lies(part, own, face));
            within.for_each(|face| faces[face].push([part as u8, own as u8]));
        }
        Pattern { nodes, faces }
    }
}

/// Reference coordinates of the corners of the eight parts of a cell.
fn parts(kind: CellKind) -> Vec<Vec<[f64; 3]>> {
    let corners = &kind.entry().nodes[..kind.corner_count()];
    let between = |a: [f64; 3], b: [f64; 3]| std::array::from_fn(|k| 0.5 * (a[k] + b[k]));
    let about = |a: &[f64; 3]| corners.iter().map(|b| between(*a, *b)).collect();
    // One part at each corner.
    let mut parts: Vec<Vec<_>> = corners.iter().map(about).collect();
    match corners.len() {
        4 => parts.extend(
            INNER.iter().map(|ends| ends.iter().map(|&[a, b]| between(corners[a], corners[b])).collect()),
        ),
        // The wedges between those of the three corners, at the bottom and at the top.
        6 => parts.extend([corners[0][2], corners[3][2]].map(|end| {
            let at = |k: usize, level: f64| {
                let [x, y, _] = between(corners[(k + 1) % 3], corners[(k + 2) % 3]);
                [x, y, 0.5 * (level + end)]
            };
            let [bottom, top] = [corners[0][2], corners[3][2]];
            (0..3).map(|k| at(k, bottom)).chain((0..3).map(|k| at(k, top))).collect()
        })),
        _ => {}
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::{box_mesh, raise_order};
    use crate::quality;

    #[test]
    fn the_eighths_of_a_mesh_fill_it_and_share_their_faces() {
        for kind in CellKind::ALL {
            let [low, high] = [Point3::origin(), Point3::new(1.0, 2.0, 3.0)];
            let mesh = box_mesh(kind, low, high, [2, 1, 2], [1.0; 3], None).unwrap();
            let corner = mesh.group("z-max").map(|facets| mesh.facet_group_nodes(facets)).unwrap();
            let mesh = mesh.with_node_group("top", corner);
            let halves = divide(&mesh);
            quality::check_inversion(&halves).unwrap_or_else(|bad| panic!("{kind:?}: {bad:?}"));
            let volume: f64 = quality::volumes(&halves).iter().sum();
            assert!((volume - 6.0).abs() < 1e-12, "{kind:?}: {volume}");
            assert_eq!(halves.boundary().len(), 4 * mesh.boundary().len(), "{kind:?}");
            for name in mesh.group_names() {
                let [before, after] = [&mesh, &halves].map(|mesh| mesh.group(name).unwrap().len());
                assert_eq!(after, 4 * before, "{kind:?}: {name}");
            }
            let of_faces = halves.facet_group_nodes(halves.group("z-max").unwrap());
            assert_eq!(halves.node_group("top"), Some(&of_faces[..]), "{kind:?}");
            let even = box_mesh(kind, low, high, [4, 2, 4], [1.0; 3], None).unwrap();
            assert_eq!(halves.points().len(), even.points().len(), "{kind:?}");
            if kind.order() == 1 {
                let raised =
                    [&halves, &divide(&raise_order(&mesh))].map(|mesh| raise_order(mesh).points().len());
                assert_eq!(raised[0], raised[1], "{kind:?}");
            }
        }
    }
}
