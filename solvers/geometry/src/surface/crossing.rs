//! Checks whether triangles cross or touch away from their common corners, with exact signs (Shewchuk 1997).

use std::cmp::Ordering;

use rayon::prelude::*;
use robust::{Coord, Coord3D, orient2d, orient3d};

use super::error::SurfaceProblem;
use super::soup::Soup;
use super::tree::{Tree, bounds};
use crate::Point3;

/// Smallest number of triangles per parallel task.
const CHUNK: usize = 256;

/// Limits on the pairs of triangles whose boxes touch: in total, and per triangle. In a surface, each
/// triangle touches about 20 others; in a random arrangement, all others.
const FEW: u64 = 1_000_000;
const MANY: u64 = 100;

/// Rejects triangles that cross. `parts` returns the connected part of each triangle.
pub(super) fn refuse(soup: &Soup, parts: impl Fn() -> Vec<u32>) -> Result<(), SurfaceProblem> {
    let tree = Tree::new(&soup.points, &soup.triangles);
    let count = soup.triangles.len();
    let near = |first: usize, found: &mut dyn FnMut(usize)| {
        let (low, high) = bounds(soup.corners(first).into_iter());
        tree.touching(&low, &high, |second| {
            if second as usize > first {
                found(second as usize);
            }
        });
    };
    let number = |first: usize| {
        let mut number = 0u64;
        near(first, &mut |_| number += 1);
        number
    };
    let all: u64 = (0..count).into_par_iter().with_min_len(CHUNK).map(number).sum();
    if all > FEW + MANY * count as u64 {
        return Err(SurfaceProblem::Tangled { triangles: count, pairs: all });
    }
    // One crossing per triangle suffices: 300 bodies in one place cross 400,000 times.
    let crosses = |first: &usize| {
        let mut crossed = false;
        near(*first, &mut |second| crossed = crossed || cross(soup, *first, second));
        crossed
    };
    let crossed: Vec<usize> = (0..count).into_par_iter().with_min_len(CHUNK).filter(crosses).collect();
    let Some(&first) = crossed.first() else { return Ok(()) };
    let mut second = usize::MAX;
    near(first, &mut |other| {
        if other < second && cross(soup, first, other) {
            second = other;
        }
    });
    Err(SurfaceProblem::Crossing {
        triangles: [first, second].map(|t| soup.faces[t]),
        at: soup.middle(first),
        places: crossed.len(),
        bodies: {
            let parts = parts();
            parts[first] != parts[second]
        },
    })
}

/// Whether two triangles share a point other than their common corners.
fn cross(soup: &Soup, first: usize, second: usize) -> bool {
    let (a, b) = (soup.triangles[first], soup.triangles[second]);
    let position = |p: u32| soup.points[p as usize];
    let own = |of: [u32; 3], other: [u32; 3]| (0..3).find(|&i| !other.contains(&of[i]));
    let edge = |t: [u32; 3], i: usize| [position(t[i]), position(t[(i + 1) % 3])];
    let (corners_a, corners_b) = (a.map(position), b.map(position));
    match a.iter().filter(|p| b.contains(p)).count() {
        0 => {
            (0..3).any(|i| pierces(edge(a, i), corners_b) || pierces(edge(b, i), corners_a))
                || overlap(corners_a, corners_b)
        }
        // Each triangle may cross the other with the edge opposite to the common corner.
        1 => {
            let opposite = |t: [u32; 3], other: [u32; 3]| {
                let common = (0..3).find(|&i| other.contains(&t[i])).unwrap_or(0);
                edge(t, (common + 1) % 3)
            };
            pierces(opposite(a, b), corners_b)
                || pierces(opposite(b, a), corners_a)
                || overlap(corners_a, corners_b)
        }
        // Neighbours cross only if one is folded onto the other.
        2 => match (own(a, b), own(b, a)) {
            (Some(i), Some(j)) => {
                folded(position(a[(i + 1) % 3]), position(a[(i + 2) % 3]), corners_a[i], corners_b[j])
            }
            _ => false,
        },
        _ => true,
    }
}

fn sign(x: f64) -> i32 {
    match x.total_cmp(&0.0) {
        _ if x == 0.0 => 0,
        Ordering::Less => -1,
        _ => 1,
    }
}

fn side(a: Point3, b: Point3, c: Point3, d: Point3) -> i32 {
    let [a, b, c, d] = [a, b, c, d].map(|p| Coord3D { x: p.x, y: p.y, z: p.z });
    sign(orient3d(a, b, c, d))
}

/// Whether a line segment meets a triangle without lying in its plane.
fn pierces([p, q]: [Point3; 2], [a, b, c]: [Point3; 3]) -> bool {
    let (above, below) = (side(a, b, c, p), side(a, b, c, q));
    if above * below > 0 || (above == 0 && below == 0) {
        return false;
    }
    let around = [side(p, q, a, b), side(p, q, b, c), side(p, q, c, a)];
    around.iter().all(|&s| s >= 0) || around.iter().all(|&s| s <= 0)
}

/// Axis along which the projected area of three points is largest; `None` for collinear points.
fn widest([a, b, c]: [Point3; 3]) -> Option<usize> {
    let normal = (b - a).cross(&(c - a)).abs();
    (normal.amax() > 0.0).then(|| normal.imax())
}

fn flat(p: Point3, axis: usize) -> Coord<f64> {
    Coord { x: p[(axis + 1) % 3], y: p[(axis + 2) % 3] }
}

/// Whether two coplanar triangles overlap: edges cross, or a corner lies inside.
fn overlap(a: [Point3; 3], b: [Point3; 3]) -> bool {
    if b.iter().any(|&p| side(a[0], a[1], a[2], p) != 0) {
        return false;
    }
    let Some(axis) = widest(a) else { return false };
    let (a, b) = (a.map(|p| flat(p, axis)), b.map(|p| flat(p, axis)));
    let turn = |p, q, r| sign(orient2d(p, q, r));
    let edges = |t: [Coord<f64>; 3]| [0, 1, 2].map(|i| [t[i], t[(i + 1) % 3]]);
    let crossed = edges(a).into_iter().any(|[p, q]| {
        edges(b)
            .into_iter()
            .any(|[r, s]| turn(p, q, r) * turn(p, q, s) < 0 && turn(r, s, p) * turn(r, s, q) < 0)
    });
    let within = |t: [Coord<f64>; 3], p: Coord<f64>| {
        let turns = edges(t).map(|[q, r]| turn(q, r, p));
        turns.iter().all(|&s| s > 0) || turns.iter().all(|&s| s < 0)
    };
    crossed || b.iter().any(|&p| within(a, p)) || a.iter().any(|&p| within(b, p))
}

/// Whether two triangles at the edge from p to q overlap in one plane.
fn folded(p: Point3, q: Point3, a: Point3, b: Point3) -> bool {
    if side(p, q, a, b) != 0 {
        return false;
    }
    // Slivers without area overlap with everything and are exempt.
    let (Some(axis), Some(_)) = (widest([p, q, a]), widest([p, q, b])) else { return false };
    let turn = |r| sign(orient2d(flat(p, axis), flat(q, axis), flat(r, axis)));
    turn(a) * turn(b) > 0
}
