//! Cuts of lattice edges by a surface, and the lattice points moved to such cuts.

use std::collections::HashMap;

use rayon::prelude::*;

use super::stencil::Side;
use crate::Point3;
use crate::surface::Surface;

/// Fraction of a long or short edge within which a point is moved to the cut. These values give the best
/// angles (Labelle and Shewchuk 2007, table 1).
const LONG: f64 = 0.24999;
const SHORT: f64 = 0.41189;
/// Smallest number of edges per parallel task.
const CHUNK: usize = 32;

/// The lattice with points moved to the surface, and the remaining cuts.
pub(super) struct Cuts {
    /// Points of the lattice, followed by the cuts.
    pub points: Vec<Point3>,
    /// Side of the surface on which each lattice point lies.
    pub sides: Vec<Side>,
    /// Index of each cut among the points, by the ends of its edge (inside, outside).
    pub nodes: HashMap<[u32; 2], u32>,
}

/// An edge that the surface cuts.
struct Edge {
    inside: u32,
    outside: u32,
    long: bool,
    /// Position of the cut, as a fraction of the edge from its inner end.
    cut: f64,
}

impl Cuts {
    /// Moves points and cuts edges. `distances` (m) are the signed distances of the points from the surface,
    /// negative inside.
    pub(super) fn new(
        surface: &Surface,
        tets: &[[u32; 4]],
        mut points: Vec<Point3>,
        distances: &[f64],
    ) -> Cuts {
        let side = |&distance: &f64| match distance {
            d if d < 0.0 => Side::Inside,
            0.0 => Side::On,
            _ => Side::Outside,
        };
        let mut sides: Vec<Side> = distances.iter().map(side).collect();
        let mut edges = edges(tets, &sides);
        edges.par_iter_mut().with_min_len(CHUNK).for_each(|edge| {
            let end = |p: u32| (&points[p as usize], distances[p as usize]);
            edge.cut = surface.cut(end(edge.inside), end(edge.outside));
        });
        let at = |points: &[Point3], edge: &Edge| {
            let (from, to) = (points[edge.inside as usize], points[edge.outside as usize]);
            from + (to - from) * edge.cut
        };
        let cuts: Vec<Point3> = edges.iter().map(|edge| at(&points, edge)).collect();
        let whole = |sides: &[Side], edge: &Edge| {
            sides[edge.inside as usize] == Side::Inside && sides[edge.outside as usize] == Side::Outside
        };
        for (point, around) in at_ends(&edges) {
            let near = around.into_iter().filter(|&edge| whole(&sides, &edges[edge as usize]));
            let near = near.filter_map(|edge| {
                let Edge { inside, long, cut, .. } = edges[edge as usize];
                let part = if inside == point { cut } else { 1.0 - cut };
                let (limit, length) = if long { (LONG, 1.0) } else { (SHORT, 0.75f64.sqrt()) };
                (part < limit).then_some((part * length, edge))
            });
            if let Some((_, edge)) = near.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))) {
                (points[point as usize], sides[point as usize]) = (cuts[edge as usize], Side::On);
            }
        }
        let mut nodes = HashMap::new();
        for (edge, cut) in edges.iter().zip(cuts) {
            if whole(&sides, edge) {
                nodes.insert([edge.inside, edge.outside], points.len() as u32);
                points.push(cut);
            }
        }
        Cuts { points, sides, nodes }
    }
}

/// Edges of regular tetrahedra from a point inside to a point outside, without duplicates.
fn edges(tets: &[[u32; 4]], sides: &[Side]) -> Vec<Edge> {
    let mut edges = Vec::new();
    for tet in tets {
        for (i, j) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
            let long = i / 2 == j / 2;
            match [tet[i], tet[j]].map(|p| (p, sides[p as usize])) {
                [(a, Side::Inside), (b, Side::Outside)] | [(b, Side::Outside), (a, Side::Inside)] => {
                    edges.push((a, b, long));
                }
                _ => {}
            }
        }
    }
    edges.sort_unstable();
    edges.dedup();
    let edge = |(inside, outside, long)| Edge { inside, outside, long, cut: 0.5 };
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
