//! Local refinement of tetrahedra by bisection of their longest edges.
//!
//! Edges are marked on the skeleton of the mesh: with any edge of a face its longest edge is marked too, and
//! likewise for cells. Each cell is then bisected at its marked edges, from the longest to the shortest. The
//! cut of a face depends on its own marked edges alone, so that neighbours agree (Plaza and Carey, Appl.
//! Numer. Math. 32 (2000) 195-218).

use std::collections::{BTreeMap, HashMap};

use super::convert::to_tets;
use super::parts::rebuilt;
use crate::element::CellKind;
use crate::mesh::{Facet, Mesh};
use crate::{Point3, Vector3};

/// Corners of the edges of a tetrahedron.
const EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

/// Names of facet groups, as an index into the list of all combinations; 0 for none.
type Names = u32;

/// A tetrahedron during the refinement.
#[derive(Clone, Copy)]
struct Tet {
    nodes: [u32; 4],
    /// Cell of the original mesh that contains it.
    of: u32,
    /// Names of the faces opposite to each node.
    names: [Names; 4],
}

/// Nodes and middles of edges.
struct Skeleton {
    points: Vec<Point3>,
    middles: BTreeMap<[u32; 2], u32>,
}

impl Skeleton {
    /// Key by which edges are ordered: the length, and the nodes where lengths are equal.
    fn key(&self, [a, b]: [u32; 2]) -> (f64, [u32; 2]) {
        let ends = [a.min(b), a.max(b)];
        let [from, to]: [Vector3; 2] = ends.map(|node| self.points[node as usize].coords);
        ((to - from).norm_squared(), ends)
    }

    /// The longest of some edges.
    fn longest(&self, edges: impl Iterator<Item = [u32; 2]>) -> Option<(f64, [u32; 2])> {
        edges.map(|edge| self.key(edge)).max_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
    }

    fn is_marked(&self, [a, b]: [u32; 2]) -> bool {
        self.middles.contains_key(&[a.min(b), a.max(b)])
    }

    /// Marks an edge, whose middle becomes a node. Returns whether this is new.
    fn mark(&mut self, ends: [u32; 2]) -> bool {
        if self.is_marked(ends) {
            return false;
        }
        let [a, b] = ends.map(|node| self.points[node as usize]);
        self.middles.insert(ends, self.points.len() as u32);
        self.points.push(nalgebra::center(&a, &b));
        true
    }

    /// Marks the longest edges of the faces and the cell that have marked edges. Returns whether any is new.
    fn close(&mut self, tet: &Tet) -> bool {
        let edges = EDGES.map(|ends| ends.map(|k| tet.nodes[k]));
        let mut changed = false;
        for opposite in (0..=4).rev() {
            let of = |ends: &&[u32; 2]| opposite == 4 || !ends.contains(&tet.nodes[opposite]);
            if edges.iter().filter(of).any(|&ends| self.is_marked(ends))
                && let Some((_, ends)) = self.longest(edges.iter().filter(of).copied())
            {
                changed |= self.mark(ends);
            }
        }
        changed
    }

    /// Bisects a tetrahedron at its marked edges, from the longest to the shortest.
    fn cut(&self, tet: Tet, parts: &mut Vec<Tet>) {
        let edges = EDGES.map(|ends| ends.map(|k| tet.nodes[k]));
        let Some((_, ends)) = self.longest(edges.into_iter().filter(|&ends| self.is_marked(ends))) else {
            parts.push(tet);
            return;
        };
        for (kept, lost) in [(ends[0], ends[1]), (ends[1], ends[0])] {
            let mut part = tet;
            for k in 0..4 {
                if tet.nodes[k] == lost {
                    part.nodes[k] = self.middles[&ends];
                }
                if tet.nodes[k] == kept {
                    part.names[k] = 0;
                }
            }
            self.cut(part, parts);
        }
    }
}

/// Bisects tetrahedra, given or of the cells of [`to_tets`], until the longest edge of each is at most the
/// length `longest` (m) of the tetrahedron of the given mesh that contains it. Regions and groups are kept. A
/// group of nodes gains the middle of an edge if it has both ends.
pub fn bisect(mesh: &Mesh, longest: &[f64]) -> Mesh {
    let mesh = &to_tets(mesh);
    let (combinations, mut tets) = tets_with_names(mesh);
    let mut skeleton = Skeleton { points: mesh.points().to_vec(), middles: BTreeMap::new() };
    let mut groups: Vec<(String, Vec<u32>)> =
        mesh.node_groups().map(|(name, nodes)| (name.to_string(), nodes.to_vec())).collect();
    loop {
        for tet in &tets {
            let edges = EDGES.map(|ends| ends.map(|k| tet.nodes[k]));
            let limit = longest[tet.of as usize];
            if let Some((_, ends)) = skeleton.longest(edges.into_iter()).filter(|(l, _)| *l > limit * limit) {
                skeleton.mark(ends);
            }
        }
        if skeleton.middles.is_empty() {
            break;
        }
        // No `any`, which would stop at the first cell with a change.
        while tets.iter().fold(false, |changed, tet| changed | skeleton.close(tet)) {}
        let mut parts = Vec::with_capacity(2 * tets.len());
        tets.iter().for_each(|tet| skeleton.cut(*tet, &mut parts));
        tets = parts;
        for (_, nodes) in &mut groups {
            let has = |node: &u32| nodes.binary_search(node).is_ok();
            let middles = skeleton.middles.iter().filter(|(ends, _)| ends.iter().all(has));
            let middles: Vec<u32> = middles.map(|(_, &middle)| middle).collect();
            nodes.extend(middles);
            nodes.sort_unstable();
        }
        skeleton.middles.clear();
    }
    let nodes = tets.iter().flat_map(|tet| tet.nodes).collect();
    let regions = tets.iter().map(|tet| mesh.region(tet.of as usize)).collect();
    let mut facets: BTreeMap<String, Vec<Facet>> =
        mesh.group_names().map(|n| (n.into(), Vec::new())).collect();
    for (cell, tet) in tets.iter().enumerate() {
        for face in 0..4u8 {
            for name in &combinations[tet.names[opposite(face)] as usize] {
                let facet = Facet { cell: cell as u32, face };
                facets.entry(name.clone()).or_default().push(facet);
            }
        }
    }
    let kinds = vec![CellKind::Tet4; tets.len()];
    let mut refined = rebuilt(mesh, skeleton.points, kinds, nodes, regions, facets.into_iter().collect());
    for (name, of) in mesh.cell_groups() {
        let within = |tet: &Tet| of.binary_search(&tet.of).is_ok();
        let cells = tets.iter().zip(0..).filter(|(tet, _)| within(tet)).map(|(_, cell)| cell);
        refined = refined.with_cell_group(name, cells.collect());
    }
    groups.into_iter().fold(refined, |mesh, (name, nodes)| mesh.with_node_group(&name, nodes))
}

/// Corner of a tetrahedron opposite to a face.
fn opposite(face: u8) -> usize {
    let corners = CellKind::Tet4.face_corners(usize::from(face));
    (0..4).find(|corner| !corners.contains(corner)).expect("a face has three of four corners")
}

/// The combinations of facet groups, and the tetrahedra with those of their faces.
fn tets_with_names(mesh: &Mesh) -> (Vec<Vec<String>>, Vec<Tet>) {
    let mut of_facet: HashMap<Facet, Vec<String>> = HashMap::new();
    for name in mesh.group_names() {
        for facet in mesh.group(name).unwrap_or_default() {
            of_facet.entry(*facet).or_default().push(name.to_string());
        }
    }
    let mut combinations = vec![Vec::new()];
    let tets = (0..mesh.cell_count()).map(|cell| {
        let nodes = mesh.cell(cell).try_into().expect("four corners each");
        let mut names = [0; 4];
        for face in 0..4u8 {
            let Some(own) = of_facet.get(&Facet { cell: cell as u32, face }) else { continue };
            let known = combinations.iter().position(|known| known == own);
            names[opposite(face)] = known.unwrap_or_else(|| {
                combinations.push(own.clone());
                combinations.len() - 1
            }) as Names;
        }
        Tet { nodes, of: cell as u32, names }
    });
    let tets = tets.collect();
    (combinations, tets)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::box_mesh;
    use crate::quality;

    fn cube() -> Mesh {
        let [low, high] = [Point3::origin(), Point3::new(1.0, 1.0, 1.0)];
        let mesh = box_mesh(CellKind::Tet4, low, high, [2, 2, 2], [1.0; 3], None).unwrap();
        let top = mesh.facet_group_nodes(mesh.group("z-max").unwrap());
        mesh.with_node_group("top", top)
    }

    /// Towards a corner, over 9 bisections: a conforming mesh of the same volume and faces, in which angles
    /// stay above half of those of the first mesh.
    #[test]
    fn a_mesh_is_refined_towards_a_corner() {
        let mut mesh = cube();
        let angle = |mesh: &Mesh| {
            let of = |cell: usize| {
                let at: Vec<Point3> = mesh.cell_points(cell).copied().collect();
                quality::dihedrals(CellKind::Tet4, &at).0
            };
            (0..mesh.cell_count()).map(of).fold(f64::INFINITY, f64::min)
        };
        let first = angle(&mesh);
        for round in 1..=3 {
            let size = |cell: usize| {
                let far = mesh.cell_points(cell).map(|p| p.coords.norm()).fold(f64::INFINITY, f64::min);
                if far < 0.1 { 0.9 * 0.5f64.powi(round) } else { 9.0 }
            };
            mesh = bisect(&mesh, &(0..mesh.cell_count()).map(size).collect::<Vec<_>>());
        }
        quality::check_inversion(&mesh).unwrap();
        assert!(angle(&mesh) > 0.5 * first, "{} {first}", angle(&mesh));
        let volume: f64 = quality::volumes(&mesh).iter().sum();
        assert!((volume - 1.0).abs() < 1e-12, "{volume}");
        let area = |facets: &[Facet]| -> f64 {
            let of = |facet: &Facet| {
                let at: Vec<Point3> = mesh.facet_nodes(*facet).map(|n| mesh.points()[n as usize]).collect();
                0.5 * (at[1] - at[0]).cross(&(at[2] - at[0])).norm()
            };
            facets.iter().map(of).sum()
        };
        // Facets without a neighbour cover the cube's surface only if all others are shared.
        assert!((area(&mesh.boundary()) - 6.0).abs() < 1e-12);
        for name in mesh.group_names() {
            assert!((area(mesh.group(name).unwrap()) - 1.0).abs() < 1e-12, "{name}");
        }
        let top = mesh.facet_group_nodes(mesh.group("z-max").unwrap());
        assert_eq!(mesh.node_group("top"), Some(&top[..]));
        let edges = (0..mesh.cell_count()).map(|cell| {
            let at: Vec<Point3> = mesh.cell_points(cell).copied().collect();
            EDGES.map(|[a, b]| (at[a] - at[b]).norm()).into_iter().fold(0.0, f64::max)
        });
        let (least, most) = edges.fold((9.0f64, 0.0f64), |(least, most), e| (least.min(e), most.max(e)));
        assert!(least <= 0.9 / 8.0 && most > 0.8, "{least} {most}");
        assert!(mesh.points().len() < 400, "{}", mesh.points().len());
    }

    /// Without a limit below the sizes nothing changes.
    #[test]
    fn small_cells_stay() {
        let mesh = cube();
        let same = bisect(&mesh, &vec![1.0; mesh.cell_count()]);
        assert_eq!(same.points(), mesh.points());
        assert_eq!(same.cell_count(), mesh.cell_count());
    }
}
