//! Cuts of lattice edges by a surface, and the lattice points moved to such cuts.

use std::collections::HashMap;

use rayon::prelude::*;

use super::stencil::Side;
use crate::Point3;

/// Fraction of a long or short edge within which a point is moved to the cut. These values give the best
/// angles (Labelle and Shewchuk 2007, table 1).
const LONG: f64 = 0.24999;
const SHORT: f64 = 0.41189;
/// Smallest number of edges per parallel task.
const CHUNK: usize = 32;

/// Tetrahedra with corners on both sides of a surface.
pub(super) struct Cells {
    /// Tetrahedra of the lattice that may be cut.
    pub regular: Vec<[u32; 4]>,
    /// Tetrahedra that may not: each edge that the surface crosses gets a moved point at an end.
    pub others: Vec<[u32; 4]>,
}

/// Cuts of edges, and the points that move to a cut.
pub(super) struct Cuts {
    /// Side of the surface on which each point lies.
    pub sides: Vec<Side>,
    /// Points that move, ascending, and where to.
    pub moved: Vec<(u32, Point3)>,
    /// Index of each remaining cut, by the ends of its edge (inside, outside). Cuts are numbered on from the
    /// points.
    pub nodes: HashMap<[u32; 2], u32>,
    /// Positions of these cuts.
    pub added: Vec<Point3>,
}

/// An edge that the surface cuts.
struct Edge {
    inside: u32,
    outside: u32,
    kind: Kind,
    /// Position of the cut, as a fraction of the edge from its inner end.
    cut: f64,
}

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    /// An edge of a tetrahedron that may not be cut.
    Uncut,
    /// A short edge of the lattice.
    Short,
    /// A long edge of the lattice.
    Long,
}

impl Cuts {
    /// Finds the cuts. `distances` (m) are the signed distances of the points from the surface, negative
    /// inside. `cut` returns the position of a cut as a fraction of the edge from its inner end. `long` is
    /// the length of the long edges of the lattice, m.
    pub(super) fn new(
        cells: &Cells,
        points: &[Point3],
        distances: &[f64],
        long: f64,
        cut: impl Fn([u32; 2]) -> f64 + Sync,
    ) -> Cuts {
        let side = |&distance: &f64| match distance {
            d if d < 0.0 => Side::Inside,
            0.0 => Side::On,
            _ => Side::Outside,
        };
        let mut sides: Vec<Side> = distances.iter().map(side).collect();
        let mut edges = edges(cells, &sides);
        edges.par_iter_mut().with_min_len(CHUNK).for_each(|edge| {
            edge.cut = cut([edge.inside, edge.outside]);
        });
        let at = |edge: &Edge| {
            let (from, to) = (points[edge.inside as usize], points[edge.outside as usize]);
            from + (to - from) * edge.cut
        };
        let cuts: Vec<Point3> = edges.iter().map(at).collect();
        let whole = |sides: &[Side], edge: &Edge| {
            sides[edge.inside as usize] == Side::Inside && sides[edge.outside as usize] == Side::Outside
        };
        let mut moved = Vec::new();
        for (point, around) in at_ends(&edges) {
            let near = around.into_iter().filter(|&edge| whole(&sides, &edges[edge as usize]));
            let near = near.filter_map(|edge| {
                let Edge { inside, outside, kind, cut } = edges[edge as usize];
                let part = if inside == point { cut } else { 1.0 - cut };
                let (is_near, length) = match kind {
                    Kind::Long => (part < LONG, 1.0),
                    Kind::Short => (part < SHORT, 0.75f64.sqrt()),
                    Kind::Uncut => {
                        let [from, to] = [inside, outside].map(|p| points[p as usize]);
                        (part <= 0.5, nalgebra::distance(&from, &to) / long)
                    }
                };
                is_near.then_some((part * length, edge))
            });
            if let Some((_, edge)) = near.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))) {
                sides[point as usize] = Side::On;
                moved.push((point, cuts[edge as usize]));
            }
        }
        let (mut nodes, mut added) = (HashMap::new(), Vec::new());
        for (edge, cut) in edges.iter().zip(cuts) {
            if whole(&sides, edge) {
                nodes.insert([edge.inside, edge.outside], (points.len() + added.len()) as u32);
                added.push(cut);
            }
        }
        Cuts { sides, moved, nodes, added }
    }
}

/// Edges of tetrahedra from a point inside to a point outside, without duplicates.
fn edges(cells: &Cells, sides: &[Side]) -> Vec<Edge> {
    let mut edges = Vec::new();
    let regular = cells.regular.iter().map(|tet| (tet, true));
    for (tet, is_regular) in regular.chain(cells.others.iter().map(|tet| (tet, false))) {
        for (i, j) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
            let kind = match is_regular {
                false => Kind::Uncut,
                true if i / 2 == j / 2 => Kind::Long,
                true => Kind::Short,
            };
            match [tet[i], tet[j]].map(|p| (p, sides[p as usize])) {
                [(a, Side::Inside), (b, Side::Outside)] | [(b, Side::Outside), (a, Side::Inside)] => {
                    edges.push((a, b, kind));
                }
                _ => {}
            }
        }
    }
    edges.sort_unstable();
    edges.dedup_by_key(|edge| (edge.0, edge.1));
    let edge = |(inside, outside, kind)| Edge { inside, outside, kind, cut: 0.5 };
    edges.into_iter().map(edge).collect()
}

/// End points of the edges, ascending, each with the indices of its edges.
fn at_ends(edges: &[Edge]) -> Vec<(u32, Vec<u32>)> {
    let ends =
        edges.iter().enumerate().flat_map(|(at, edge)| [(edge.inside, at as u32), (edge.outside, at as u32)]);
    let mut ends: Vec<(u32, u32)> = ends.collect();
    ends.sort_unstable();
    let at_point = ends.chunk_by(|a, b| a.0 == b.0);
    at_point.map(|list| (list[0].0, list.iter().map(|(_, edge)| *edge).collect())).collect()
}
