//! Connected pieces of a mesh, which share no nodes: their number, their coincident faces, and joining them
//! along these.

use std::collections::HashMap;

use crate::Point3;
use crate::mesh::{Facet, Mesh};

/// Largest distance of coinciding nodes of two pieces, relative to the shortest edge of the adjacent faces.
/// Files round coordinates to five digits.
const SAME: f64 = 1e-3;

/// Disjoint sets of nodes, each represented by its lowest node.
struct Sets(Vec<u32>);

impl Sets {
    fn new(nodes: usize) -> Sets {
        Sets((0..nodes as u32).collect())
    }

    fn of(&mut self, mut node: u32) -> u32 {
        while self.0[node as usize] != node {
            self.0[node as usize] = self.0[self.0[node as usize] as usize];
            node = self.0[node as usize];
        }
        node
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.of(a), self.of(b));
        self.0[a.max(b) as usize] = a.min(b);
    }

    /// Joins the nodes of each cell.
    fn pieces(mesh: &Mesh) -> Sets {
        let mut sets = Sets::new(mesh.points().len());
        for cell in 0..mesh.cell_count() {
            let nodes = mesh.cell(cell);
            nodes[1..].iter().for_each(|&node| sets.join(nodes[0], node));
        }
        sets
    }
}

/// Number of connected pieces of a mesh. Cells of different pieces share no node.
pub fn count(mesh: &Mesh) -> usize {
    let mut sets = Sets::pieces(mesh);
    let mut roots: Vec<u32> = (0..mesh.cell_count()).map(|cell| sets.of(mesh.cell(cell)[0])).collect();
    roots.sort_unstable();
    roots.dedup();
    roots.len()
}

/// Number of faces of one piece that coincide with a face of another.
pub fn coincident(mesh: &Mesh) -> usize {
    if count(mesh) > 1 { Twins::new(mesh).pairs.len() } else { 0 }
}

/// Merges the nodes of coincident faces of different pieces. Returns the mesh and the number of such faces,
/// or `None` if no faces coincide. Nodes that only touch, at a vertex or along an edge, stay apart, and so do
/// the two sides of a slit within a piece.
pub fn join(mesh: &Mesh) -> Option<(Mesh, usize)> {
    let Twins { mut same, pairs } = Twins::new(mesh);
    let faces = pairs.len();
    if faces == 0 {
        return None;
    }
    let mut merged = Sets::new(mesh.points().len());
    for node in pairs.iter().flatten().flat_map(|&facet| mesh.facet_nodes(facet)) {
        let first = same.of(node);
        merged.join(first, node);
    }
    let mut number = vec![0; mesh.points().len()];
    let mut points = Vec::new();
    for node in 0..number.len() as u32 {
        let first = merged.of(node);
        number[node as usize] = if first == node {
            points.push(mesh.points()[node as usize]);
            points.len() as u32 - 1
        } else {
            number[first as usize]
        };
    }
    Some((mesh.renumbered(points, |node| number[node as usize]), faces))
}

/// Coinciding nodes of different pieces, and the pairs of faces that coincide.
struct Twins {
    same: Sets,
    pairs: Vec<[Facet; 2]>,
}

impl Twins {
    fn new(mesh: &Mesh) -> Twins {
        let mut pieces = Sets::pieces(mesh);
        let boundary = mesh.boundary();
        let reach = reaches(mesh, &boundary);
        let nodes: Vec<u32> =
            (0..reach.len() as u32).filter(|&node| reach[node as usize].is_finite()).collect();
        let widest = nodes.iter().map(|&node| reach[node as usize]).fold(0.0, f64::max);
        // Boxes are wide enough that coinciding nodes lie in the same or in neighbouring boxes.
        let place = |x: &Point3| [x.x, x.y, x.z].map(|c| (c / widest).floor() as i64);
        let mut boxes: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
        let mut same = Sets::new(reach.len());
        for &node in &nodes {
            let x = mesh.points()[node as usize];
            let [i, j, k] = place(&x);
            for [a, b, c] in around() {
                let at = [i.saturating_add(a), j.saturating_add(b), k.saturating_add(c)];
                for &other in boxes.get(&at).into_iter().flatten() {
                    let near = reach[node as usize].min(reach[other as usize]);
                    let apart = pieces.of(node) != pieces.of(other);
                    if apart && (mesh.points()[other as usize] - x).norm() <= near {
                        same.join(node, other);
                    }
                }
            }
            boxes.entry([i, j, k]).or_default().push(node);
        }
        let mut seen: HashMap<Vec<u32>, Facet> = HashMap::new();
        let mut pairs = Vec::new();
        for &facet in &boundary {
            let mut key: Vec<u32> = corners(mesh, facet).map(|node| same.of(node)).collect();
            key.sort_unstable();
            let other = *seen.entry(key).or_insert(facet);
            // The sides of a slit have the same key if their nodes coincide with those of another piece.
            if pieces.of(mesh.cell(other.cell as usize)[0]) != pieces.of(mesh.cell(facet.cell as usize)[0]) {
                pairs.push([other, facet]);
            }
        }
        Twins { same, pairs }
    }
}

fn corners(mesh: &Mesh, facet: Facet) -> impl Iterator<Item = u32> + '_ {
    mesh.facet_corners(facet)
}

/// Largest distance (m) of a coinciding node, for each node of the boundary; infinite inside.
fn reaches(mesh: &Mesh, boundary: &[Facet]) -> Vec<f64> {
    let mut reach = vec![f64::INFINITY; mesh.points().len()];
    for &facet in boundary {
        let x: Vec<Point3> = corners(mesh, facet).map(|node| mesh.points()[node as usize]).collect();
        let edges = x.iter().zip(x.iter().cycle().skip(1)).map(|(a, b)| (a - b).norm());
        let shortest = edges.fold(f64::INFINITY, f64::min);
        for node in mesh.facet_nodes(facet) {
            reach[node as usize] = reach[node as usize].min(SAME * shortest);
        }
    }
    reach
}

/// Offsets of a box and its neighbours.
fn around() -> impl Iterator<Item = [i64; 3]> {
    (0..27).map(|k| [k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CellKind;
    use crate::generate::box_mesh;

    /// Two boxes side by side along x, with a gap of `off` (m).
    fn two(kind: CellKind, off: f64, cells: [usize; 3]) -> Mesh {
        let block = |low: f64, cells: [usize; 3]| {
            let min = Point3::new(low, 0.0, 0.0);
            let max = Point3::new(low + 1.0, 1.0, 1.0);
            box_mesh(kind, min, max, cells, [1.0; 3], None).unwrap()
        };
        let (a, b) = (block(0.0, [3, 2, 2]), block(1.0 + off, cells));
        let points: Vec<Point3> = a.points().iter().chain(b.points()).copied().collect();
        let shift = a.points().len() as u32;
        let of = |mesh: &Mesh, by: u32| -> Vec<(CellKind, Vec<u32>)> {
            (0..mesh.cell_count()).map(|c| (kind, mesh.cell(c).iter().map(|n| n + by).collect())).collect()
        };
        Mesh::new(points, &[of(&a, 0), of(&b, shift)].concat()).unwrap()
    }

    #[test]
    fn blocks_whose_faces_coincide_are_joined_with_all_nodes_of_these() {
        for (kind, faces, merged) in [
            (CellKind::Hex8, 4, 9),
            (CellKind::Hex20, 4, 21),
            (CellKind::Tet4, 8, 9),
            (CellKind::Tet10, 8, 25),
        ] {
            let apart = two(kind, 1e-9, [2, 2, 2]);
            assert_eq!((count(&apart), coincident(&apart)), (2, faces), "{kind:?}");
            let (joined, found) = join(&apart).unwrap();
            assert_eq!((found, count(&joined), coincident(&joined)), (faces, 1, 0), "{kind:?}");
            assert_eq!(joined.points().len(), apart.points().len() - merged, "{kind:?}");
            assert_eq!(joined.boundary().len(), apart.boundary().len() - 2 * faces, "{kind:?}");
            crate::quality::check(&joined).unwrap();
        }
    }

    #[test]
    fn what_is_apart_or_has_other_faces_is_not_joined() {
        let far = two(CellKind::Hex8, 1e-2, [2, 2, 2]);
        assert_eq!((count(&far), coincident(&far)), (2, 0));
        assert!(join(&far).is_none() && join(&two(CellKind::Hex8, 0.0, [2, 3, 3])).is_none());
    }
}
