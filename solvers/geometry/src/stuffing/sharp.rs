//! Moves nodes of a stuffed mesh onto sharp edges and corners of its surface.
//!
//! The lattice rounds a sharp edge off: edges of the mesh pass from one of its sides to the other. The
//! nearer end of each moves to the sharp edge, along its own side, if the angles stay within their bounds;
//! else the other end. A node that cannot move all the way moves a part of it. Surfaces without sharp edges
//! keep their meshes.

use std::collections::{BTreeMap, BTreeSet};

use super::edges::{Edges, foot};
use super::fitted::has_angles;
use crate::mesh::{Facet, Mesh};
use crate::surface::Surface;
use crate::{Point3, Vector3};

/// Largest move, over the length of the edge of the mesh.
const FARTHEST: f64 = 1.0;
/// Fractions of a move that are tried.
const PARTS: [f64; 4] = [1.0, 0.75, 0.5, 0.25];

struct Sharpened<'a> {
    mesh: &'a Mesh,
    points: Vec<Point3>,
    /// Cells of each node of the faces.
    cells: BTreeMap<u32, Vec<usize>>,
}

/// Moves nodes of the faces, which lie on the surface, to its sharp edges.
pub(super) fn sharpened(mesh: Mesh, facets: &[Facet], surface: &Surface, edges: &Edges) -> Mesh {
    if edges.is_empty() {
        return mesh;
    }
    let mut cells: BTreeMap<u32, Vec<usize>> =
        mesh.facet_group_nodes(facets).into_iter().map(|node| (node, Vec::new())).collect();
    for cell in 0..mesh.cell_count() {
        for node in mesh.cell(cell) {
            if let Some(list) = cells.get_mut(node) {
                list.push(cell);
            }
        }
    }
    let mut sides: Vec<[u32; 2]> = facets
        .iter()
        .flat_map(|&facet| {
            let nodes: Vec<u32> = mesh.facet_nodes(facet).collect();
            [[0, 1], [1, 2], [2, 0]].map(|pair| pair.map(|k| nodes[k]))
        })
        .map(|[a, b]| [a.min(b), a.max(b)])
        .collect();
    sides.sort_unstable();
    sides.dedup();
    let mut sharpened = Sharpened { mesh: &mesh, points: mesh.points().to_vec(), cells };
    sharpened.reach_corners(edges, &sides);
    for part in PARTS {
        sharpened.reach_edges(edges, surface, &sides, part);
    }
    let points = sharpened.points;
    mesh.at(points)
}

impl Sharpened<'_> {
    /// Moves the nearest node to each corner.
    fn reach_corners(&mut self, edges: &Edges, sides: &[[u32; 2]]) {
        for corner in edges.corners() {
            let length = |[a, b]: &[u32; 2]| nalgebra::distance(&self.at(*a), &self.at(*b));
            let apart = |node: u32| nalgebra::distance(&self.at(node), &corner);
            let near =
                sides.iter().filter(|side| side.iter().any(|&node| apart(node) < FARTHEST * length(side)));
            let mut near: Vec<u32> = near.flatten().copied().collect();
            near.sort_by(|&a, &b| apart(a).total_cmp(&apart(b)).then(a.cmp(&b)));
            near.dedup();
            for node in near {
                if self.moves(node, corner - self.at(node), 1.0) {
                    break;
                }
            }
        }
    }

    /// Moves ends of edges of the mesh that pass a sharp edge.
    fn reach_edges(&mut self, edges: &Edges, surface: &Surface, sides: &[[u32; 2]], part: f64) {
        let mut found: Vec<(f64, [u32; 2], [Vector3; 2])> = Vec::new();
        for side in sides {
            let ends = side.map(|node| self.at(node));
            let length = nalgebra::distance(&ends[0], &ends[1]);
            let Some(edge) = edges.between(surface, &ends) else { continue };
            let by = ends.map(|end| foot(&end, &edge) - end);
            let least = by[0].norm().min(by[1].norm());
            if least < FARTHEST * length {
                found.push((least, *side, by));
            }
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut moved = BTreeSet::new();
        for (_, side, by) in found {
            if side.iter().any(|node| moved.contains(node)) {
                continue;
            }
            let order = if by[0].norm() <= by[1].norm() { [0, 1] } else { [1, 0] };
            for end in order {
                if self.moves(side[end], by[end], part) {
                    moved.insert(side[end]);
                    break;
                }
            }
        }
    }

    fn at(&self, node: u32) -> Point3 {
        self.points[node as usize]
    }

    /// Moves a node by a part of the way if its cells stay sound.
    fn moves(&mut self, node: u32, by: Vector3, part: f64) -> bool {
        let from = self.at(node);
        self.points[node as usize] = from + by * part;
        let is_sound = |&cell: &usize| {
            let corners: Vec<Point3> = self.mesh.cell(cell).iter().map(|&node| self.at(node)).collect();
            has_angles(self.mesh.kind(cell), &corners)
        };
        let sound = self.cells[&node].iter().all(is_sound);
        if !sound {
            self.points[node as usize] = from;
        }
        sound
    }
}
