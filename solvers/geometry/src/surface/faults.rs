//! Diagnosis of edges without exactly two triangles of consistent orientation, with hints for a repair.

use std::collections::HashMap;

use super::error::SurfaceProblem;
use super::orientation;
use super::sides::Side;
use super::soup::{Soup, WELD};
use super::tree::bounds;
use crate::{Point3, Vector3};

/// Largest extent of a hole that a repair closes, over the diagonal of the surface, and its largest number of
/// edges.
const SMALL: f64 = 0.1;
const FEW: usize = 500;
/// Largest number of edges of a hole that are searched for corners on them.
const SEARCHED: usize = 1000;

/// Whether a repair closes a hole of this number of edges, by its extent and the diagonal of the surface. A
/// hole of three edges lacks one triangle, whatever its extent.
pub(super) fn is_small(edges: usize, across: f64, diagonal: f64) -> bool {
    edges == 3 || (edges <= FEW && across <= SMALL * diagonal)
}

/// Problem of the edge with the sides `around`, which are not two of consistent orientation. `sides` are
/// those of all edges.
pub(super) fn of_edge(soup: &Soup, sides: &[Side], around: &[Side]) -> SurfaceProblem {
    let triangles: Vec<u32> = around.iter().map(|side| soup.faces[side.triangle as usize]).collect();
    let ends = around[0].edge.map(|p| soup.points[p as usize]);
    match triangles[..] {
        [_] => open(soup, sides),
        [a, b] => {
            let (turned, orientable) = turned(soup, sides);
            let all = soup.triangles.len();
            SurfaceProblem::Turned { triangles: [a, b], ends, turned, all, orientable }
        }
        _ => {
            let corners = |side: &Side| {
                let corners = soup.triangles[side.triangle as usize];
                // The order begins at the lowest corner. Two copies of a face that two parts share differ in
                // orientation.
                let first = (0..3).min_by_key(|&k| corners[k]).unwrap_or(0);
                [0, 1, 2].map(|k| corners[(first + k) % 3])
            };
            let pairs = (1..around.len()).flat_map(|b| (0..b).map(move |a| [a, b]));
            let twice = pairs.clone().find(|&[a, b]| corners(&around[a]) == corners(&around[b]));
            let twice = twice.map(|pair| pair.map(|k| triangles[k]));
            SurfaceProblem::Branched { triangles, ends, twice }
        }
    }
}

/// Problem of the first hole of a surface in which every edge has one or two triangles.
fn open(soup: &Soup, sides: &[Side]) -> SurfaceProblem {
    let diagonal = soup.diagonal();
    let alone = |around: &[Side]| (around.len() == 1).then(|| around[0]);
    let edges: Vec<Side> = sides.chunk_by(|a, b| a.edge == b.edge).filter_map(alone).collect();
    let mut at_corner: HashMap<u32, Vec<usize>> = HashMap::new();
    for (k, side) in edges.iter().enumerate() {
        side.edge.iter().for_each(|&corner| at_corner.entry(corner).or_default().push(k));
    }
    let place = |corner: u32| soup.points[corner as usize];
    let mut hole_of = vec![usize::MAX; edges.len()];
    let (mut holes, mut small) = (0, true);
    for start in 0..edges.len() {
        let mut next = if hole_of[start] == usize::MAX { vec![start] } else { continue };
        let mut own = Vec::new();
        while let Some(k) = next.pop() {
            if std::mem::replace(&mut hole_of[k], holes) == usize::MAX {
                own.extend(edges[k].edge.map(place));
                next.extend(edges[k].edge.iter().flat_map(|corner| &at_corner[corner]));
                next.retain(|&k| hole_of[k] == usize::MAX);
            }
        }
        let count = own.len() / 2;
        let (low, high) = bounds(own.into_iter());
        small &= is_small(count, (high - low).norm(), diagonal);
        holes += 1;
    }
    let hole: Vec<Side> =
        edges.iter().zip(&hole_of).filter(|(_, hole)| **hole == 0).map(|(s, _)| *s).collect();
    let middle = hole.iter().flat_map(|side| side.edge).map(|corner| place(corner).coords).sum::<Vector3>();
    let tolerance = WELD * diagonal;
    let ends = |side: &Side| side.edge.map(place);
    let corners = || hole.iter().flat_map(|side| side.edge).take(2 * SEARCHED).map(place);
    let passed = |side: &&Side| corners().any(|corner| lies_on(&corner, &ends(side), tolerance));
    let first = hole.iter().take(SEARCHED).find(passed).unwrap_or(&hole[0]);
    SurfaceProblem::Open {
        triangle: soup.faces[first.triangle as usize],
        ends: ends(first),
        corner: corners().find(|corner| lies_on(corner, &ends(first), tolerance)).map(Box::new),
        edges: edges.len(),
        holes,
        hole: hole.len(),
        at: Point3::from(middle / (2 * hole.len()) as f64),
        small,
    }
}

/// Whether a point lies on a line segment, away from its ends.
pub(super) fn lies_on(p: &Point3, [a, b]: &[Point3; 2], tolerance: f64) -> bool {
    let (along, from) = (b - a, p - a);
    let part = from.dot(&along) / along.norm_squared();
    let between = part * along.norm() > tolerance && (1.0 - part) * along.norm() > tolerance;
    between && (from - along * part).norm() <= tolerance
}

/// Faces of the file whose orientation has to be reversed for a consistent orientation with a positive
/// volume. Also returns whether a consistent orientation exists.
fn turned(soup: &Soup, sides: &[Side]) -> (Vec<u32>, bool) {
    let mut orientation = orientation::consistent(soup, sides);
    let origin = soup.points[soup.triangles[0][0] as usize];
    let mut volumes = vec![0.0; orientation.parts];
    for (triangle, turned) in orientation.turned.iter().enumerate() {
        let [a, b, c] = soup.corners(triangle).map(|p| p - origin);
        let sign = if *turned { -1.0 } else { 1.0 };
        volumes[orientation.part[triangle] as usize] += sign * a.dot(&b.cross(&c));
    }
    let inwards: Vec<bool> = volumes.iter().map(|&volume| volume < 0.0).collect();
    orientation.turn_parts(&inwards);
    let mut faces: Vec<u32> = orientation.reversed().into_iter().map(|t| soup.faces[t]).collect();
    faces.sort_unstable();
    (faces, orientation.orientable)
}
