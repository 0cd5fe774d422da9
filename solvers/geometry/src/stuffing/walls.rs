//! Divides the tetrahedra inside a surface among its regions.
//!
//! One region after the other is separated from the rest by the signed distance of the wall between them.
//! Whole tetrahedra of the lattice are cut as along the outer surface, here into the parts on both sides:
//! the rules for diagonals do not depend on the side, so the parts fit together, at the same proven angles.
//! All other tetrahedra, along the outer surface and earlier walls, are not cut a second time: of each edge
//! that the wall crosses, the nearer end becomes a node of the wall. Such nodes move to the wall later, as
//! far as the angles allow.

use std::collections::HashMap;

use rayon::prelude::*;

use super::cuts::{Cells, Cuts};
use super::stencil::{Side, Tet};
use crate::surface::{Region, Surface, zero};
use crate::{Point3, Vector3};

/// Smallest number of points per parallel task.
const CHUNK: usize = 64;

/// The walls between regions.
#[derive(Clone, Copy)]
pub(super) struct Walls<'a>(pub &'a [Region]);

impl Walls<'_> {
    /// Signed distance of a point from the wall between two regions, m; negative in the first. It is that
    /// from the region outside of which the point lies: its own region also ends at the outer surface.
    pub(super) fn between(&self, first: usize, second: usize, p: &Point3) -> f64 {
        let [own, other] = [first, second].map(|region| self.0[region].surface.signed_distance(p));
        if own < other { -other } else { own }
    }

    /// Signed distance as [`Walls::between`] of a region and all later ones.
    fn beyond(&self, region: usize, p: &Point3) -> f64 {
        let own = self.0[region].surface.signed_distance(p);
        let others = self.0[region + 1..].iter().map(|other| other.surface.signed_distance(p));
        let other = others.fold(f64::INFINITY, f64::min);
        if own < other { -other } else { own }
    }

    /// Closest point of the wall between two regions.
    pub(super) fn closest(&self, first: usize, second: usize, p: &Point3) -> Point3 {
        let [own, other] = [first, second].map(|region| &self.0[region].surface);
        let surface = if own.signed_distance(p) < other.signed_distance(p) { other } else { own };
        surface.closest(p).0
    }

    /// Whether a wall or the outer surface is closer to a point than `within` (m).
    pub(super) fn are_near(&self, p: &Point3, within: f64) -> bool {
        self.0.iter().any(|region| region.surface.signed_distance(p).abs() < within)
    }
}

/// Tetrahedra inside a surface.
pub(super) struct Clipped {
    /// Points of the lattice, some of them moved to the surface, followed by the cuts of its edges.
    pub points: Vec<Point3>,
    pub tets: Vec<[u32; 4]>,
    /// Whether a tetrahedron is one of the lattice along the surface and walls, with all corners inside.
    pub is_whole: Vec<bool>,
    /// Sides of the lattice points.
    pub sides: Vec<Side>,
    /// Length of the long edges of the lattice, m.
    pub long: f64,
}

/// Tetrahedra with their regions.
pub(super) struct Divided {
    /// Points of the tetrahedra before, followed by nodes on the walls.
    pub points: Vec<Point3>,
    pub tets: Vec<[u32; 4]>,
    pub regions: Vec<u16>,
    /// Moves (m) of points to walls.
    pub moves: HashMap<u32, Vector3>,
}

/// Divides tetrahedra among the regions.
pub(super) fn divided(surface: &Surface, clipped: Clipped) -> Divided {
    let Clipped { mut points, tets, is_whole, sides, long } = clipped;
    let walls = Walls(surface.regions());
    if walls.0.is_empty() {
        let regions = vec![0; tets.len()];
        return Divided { points, tets, regions, moves: HashMap::new() };
    }
    let (whole, other): (Vec<_>, Vec<_>) = tets.into_iter().zip(is_whole).partition(|(_, whole)| *whole);
    let mut rest = Cells { regular: tets_of(whole), others: tets_of(other) };
    let (mut tets, mut regions, mut moves) = (Vec::new(), Vec::new(), HashMap::new());
    let last = walls.0.len() - 1;
    for region in 0..last {
        let distance = |p: &Point3| walls.beyond(region, p);
        let distances: Vec<f64> = points.par_iter().with_min_len(CHUNK).map(distance).collect();
        let cut = |[inside, outside]: [u32; 2]| {
            let [from, to] = [inside, outside].map(|p| points[p as usize]);
            let ends = [inside, outside].map(|p| distances[p as usize]);
            let line = to - from;
            zero(ends, line.norm(), |t, _| distance(&(from + line * t)))
        };
        let cuts = Cuts::new(&rest, &points, &distances, long, cut);
        points.extend(&cuts.added);
        for (point, to) in &cuts.moved {
            if sides.get(*point as usize) == Some(&Side::Inside) {
                moves.entry(*point).or_insert(to - points[*point as usize]);
            }
        }
        let (own, others) = separated(rest, &points, &cuts, distance);
        regions.resize(tets.len() + own.len(), region as u16);
        tets.extend(own);
        rest = others;
    }
    tets.extend(rest.regular.into_iter().chain(rest.others));
    regions.resize(tets.len(), last as u16);
    Divided { points, tets, regions, moves }
}

fn tets_of(list: Vec<([u32; 4], bool)>) -> Vec<[u32; 4]> {
    list.into_iter().map(|(tet, _)| tet).collect()
}

/// Returns the tetrahedra on the inner side of the cuts, and those on the outer side.
fn separated(
    cells: Cells,
    points: &[Point3],
    cuts: &Cuts,
    distance: impl Fn(&Point3) -> f64,
) -> (Vec<[u32; 4]>, Cells) {
    let (mut inner, mut outer) = (Vec::new(), Cells { regular: Vec::new(), others: Vec::new() });
    let side = |point: u32| cuts.sides[point as usize];
    let is_inner = |tet: &[u32; 4]| match tet.iter().map(|&point| side(point)).find(|&side| side != Side::On)
    {
        Some(side) => side == Side::Inside,
        None => {
            distance(&Point3::from(tet.map(|p| points[p as usize].coords).iter().sum::<Vector3>() / 4.0))
                < 0.0
        }
    };
    // The same diagonal from both sides, also if both are equally long.
    let apart = |a: u32, b: u32| (nalgebra::distance(&points[a as usize], &points[b as usize]), a.min(b));
    for corners in cells.regular {
        let sides = corners.map(side);
        if sides == [Side::Outside; 4] {
            outer.regular.push(corners);
        } else if sides.contains(&Side::Inside) && sides.contains(&Side::Outside) {
            let tet = Tet { corners, sides };
            tet.inside(|a, b| cuts.nodes[&[a, b]], apart, |part| inner.push(part));
            let turned = Tet { corners, sides: sides.map(Side::turned) };
            turned.inside(|a, b| cuts.nodes[&[b, a]], apart, |part| outer.others.push(part));
        } else if is_inner(&corners) {
            inner.push(corners);
        } else {
            outer.others.push(corners);
        }
    }
    for tet in cells.others {
        if is_inner(&tet) { inner.push(tet) } else { outer.others.push(tet) }
    }
    (inner, outer)
}
