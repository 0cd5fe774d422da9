//! Shortest paths along the edges of a background of linear tetrahedra.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use geometry::{CellKind, Mesh, edges};
use shape::Point3;

/// Smallest barycentric coordinate of a point in a face. A path may touch the edges of the face, with
/// rounding below zero.
const ON_EDGE: f64 = -1e-9;

/// Vertices and the straight links between them: edges, and links through a face between the two opposite
/// vertices.
pub(super) struct Graph {
    points: Vec<Point3>,
    offsets: Vec<usize>,
    ends: Vec<u32>,
}

impl Graph {
    pub fn new(mesh: &Mesh, corners: &[[u32; 4]]) -> Graph {
        let mut links = edges(mesh);
        let of_cell = |of: &[u32; 4]| {
            let of = *of;
            (0..4).map(move |k| {
                let mut face = CellKind::Tet4.faces()[k].iter().map(|&c| of[c]).collect::<Vec<_>>();
                let opposite = of.into_iter().find(|vertex| !face.contains(vertex));
                face.sort_unstable();
                ([face[0], face[1], face[2]], opposite.unwrap_or(of[0]))
            })
        };
        let mut faces: Vec<([u32; 3], u32)> = corners.iter().flat_map(of_cell).collect();
        faces.sort_unstable();
        let points = mesh.points().to_vec();
        let through = |two: &[([u32; 3], u32)]| {
            let [(face, a), (other, b)] = two else { return None };
            (face == other && crosses(&points, *face, *a, *b)).then_some((*a.min(b), *a.max(b)))
        };
        links.extend(faces.windows(2).filter_map(through));
        let mut offsets = vec![0; points.len() + 1];
        links.iter().flat_map(|&(a, b)| [a, b]).for_each(|vertex| offsets[vertex as usize + 1] += 1);
        (0..points.len()).for_each(|vertex| offsets[vertex + 1] += offsets[vertex]);
        let mut next = offsets.clone();
        let mut ends = vec![0; 2 * links.len()];
        for (a, b) in links.iter().flat_map(|&(a, b)| [(a, b), (b, a)]) {
            ends[next[a as usize]] = b;
            next[a as usize] += 1;
        }
        Graph { points, offsets, ends }
    }

    pub fn vertices(&self) -> usize {
        self.points.len()
    }

    pub fn place(&self, vertex: u32) -> &Point3 {
        &self.points[vertex as usize]
    }
}

/// Whether the line between two vertices passes through a face.
fn crosses(points: &[Point3], face: [u32; 3], from: u32, to: u32) -> bool {
    let [p, q, r] = face.map(|vertex| points[vertex as usize]);
    let (from, to) = (points[from as usize], points[to as usize]);
    let normal = (q - p).cross(&(r - p));
    let along = to - from;
    let at = from + along * (normal.dot(&(p - from)) / normal.dot(&along));
    let part = |a: &Point3, b: &Point3| (b - a).cross(&(at - a)).dot(&normal) / normal.norm_squared();
    [part(&p, &q), part(&q, &r), part(&r, &p)].iter().all(|&part| part >= ON_EDGE)
}

/// Lengths of the shortest paths from a point. The buffers are reused from point to point.
pub(super) struct Ways {
    lengths: Vec<f64>,
    reached: Vec<u32>,
    /// Open vertices by the bits of their lengths, which have the same order as the lengths.
    open: BinaryHeap<Reverse<(u64, u32)>>,
}

impl Ways {
    pub fn new(vertices: usize) -> Ways {
        Ways { lengths: vec![f64::INFINITY; vertices], reached: Vec::new(), open: BinaryHeap::new() }
    }

    /// Computes the lengths of the shortest paths (Dijkstra 1959) from a point to all vertices, for
    /// [`Ways::to`]. The point lies in the cell with these corners. Paths longer than `farthest` are not
    /// searched. `length` returns the length of a link, in metres or relative to a support; `farthest` has
    /// the same unit.
    pub fn walk(
        &mut self,
        graph: &Graph,
        from: &Point3,
        corners: &[u32; 4],
        length: impl Fn(&Point3, &Point3) -> f64,
        farthest: f64,
    ) {
        self.reached.drain(..).for_each(|vertex| self.lengths[vertex as usize] = f64::INFINITY);
        corners.iter().for_each(|&vertex| self.reach(vertex, length(graph.place(vertex), from), farthest));
        while let Some(Reverse((bits, vertex))) = self.open.pop() {
            let at = f64::from_bits(bits);
            if at > self.lengths[vertex as usize] {
                continue;
            }
            for &end in &graph.ends[graph.offsets[vertex as usize]..graph.offsets[vertex as usize + 1]] {
                self.reach(end, at + length(graph.place(vertex), graph.place(end)), farthest);
            }
        }
    }

    fn reach(&mut self, vertex: u32, at: f64, farthest: f64) {
        let length = &mut self.lengths[vertex as usize];
        if at < *length && at <= farthest {
            if *length == f64::INFINITY {
                self.reached.push(vertex);
            }
            *length = at;
            self.open.push(Reverse((at.to_bits(), vertex)));
        }
    }

    /// Returns the length of the shortest path to a vertex from the point of the last [`Ways::walk`], in the
    /// unit of its `length`. The length is infinite if there is no path up to its `farthest`.
    pub fn to(&self, vertex: u32) -> f64 {
        self.lengths[vertex as usize]
    }
}
