//! Triangulation of planar polygons by ear clipping, in projection along their normals.

use robust::{Coord, orient2d};

use crate::{Point3, Vector3};

/// Largest number of corners of a polygon that is not a fan; the time grows with the third power at worst.
const MOST: usize = 1000;

/// Length of a normal, relative to the terms of its sum, below which it is rounding.
const CANCELLED: f64 = 1e-9;

/// Reason for which a polygon cannot be triangulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PolygonFault {
    /// Two edges cross or touch away from a common corner; edges are numbered from 1 by their first corners.
    Crosses([usize; 2]),
    /// The polygon is concave and has too many corners.
    Corners(usize),
}

/// A projected corner with its index in the polygon.
#[derive(Clone, Copy)]
struct Corner {
    at: Coord<f64>,
    place: usize,
}

/// Divides a polygon into triangles with its orientation, as indices into its corners. Adjacent corners at
/// the same position are merged, and fewer than three remaining corners give no triangles.
pub(crate) fn cut(corners: &[Point3]) -> Result<Vec<[usize; 3]>, PolygonFault> {
    if corners.len() == 3 {
        return Ok(vec![[0, 1, 2]]);
    }
    let mut polygon = in_plane(corners);
    if polygon.len() < 3 {
        return Ok(Vec::new());
    }
    let area: f64 = fan(&polygon).map(|[a, b, c]| orient2d(a.at, b.at, c.at)).sum();
    if area < 0.0 {
        // Mirrored, as seen from the other side.
        polygon.iter_mut().for_each(|corner| corner.at.x = -corner.at.x);
    }
    if polygon.len() == 3 || is_fan(&polygon) {
        return Ok(fan(&polygon).map(|triangle| triangle.map(|corner| corner.place)).collect());
    }
    if polygon.len() > MOST {
        return Err(PolygonFault::Corners(polygon.len()));
    }
    match crossing(&polygon) {
        Some(edges) => Err(PolygonFault::Crosses(edges)),
        None => Ok(ears(polygon)),
    }
}

/// Projects the corners by dropping the coordinate with the largest normal component. The remaining
/// coordinates are numbers of the file, so signs are exact.
fn in_plane(corners: &[Point3]) -> Vec<Corner> {
    let next = |i: usize| corners[(i + 1) % corners.len()];
    let kept: Vec<usize> = (0..corners.len()).filter(|&i| corners[i] != next(i)).collect();
    let middle = corners[0];
    let crosses = || kept.iter().map(|&i| (corners[i] - middle).cross(&(next(i) - middle)));
    // The sum over the edges is twice the projected area along each axis (Newell), for any shape of polygon.
    let mut normal: Vector3 = crosses().sum();
    // In a self-crossing polygon the terms may cancel; then the largest of them gives the plane.
    if normal.norm() < CANCELLED * crosses().map(|cross| cross.norm()).sum::<f64>() {
        normal = crosses().max_by(|a, b| a.norm().total_cmp(&b.norm())).unwrap_or(normal);
    }
    let axis = normal.iamax();
    let flat = |place: usize| {
        let p = corners[place];
        Corner { at: Coord { x: p[(axis + 1) % 3], y: p[(axis + 2) % 3] }, place }
    };
    kept.into_iter().map(flat).collect()
}

/// Triangles around the first corner.
fn fan(p: &[Corner]) -> impl Iterator<Item = [Corner; 3]> {
    (1..p.len() - 1).map(|i| [p[0], p[i], p[i + 1]])
}

/// Whether the triangles around the first corner fill the polygon: each has the right orientation, and all
/// lie on one side of the first edge.
fn is_fan(p: &[Corner]) -> bool {
    let left = |a: Corner, b: Corner, c: Corner| orient2d(a.at, b.at, c.at) > 0.0;
    fan(p).all(|[a, b, c]| left(a, b, c) && left(a, p[1], c))
}

/// The first two edges that meet other than at a common corner.
fn crossing(p: &[Corner]) -> Option<[usize; 2]> {
    let count = p.len();
    let edge = |i: usize| [p[i].at, p[(i + 1) % count].at];
    for i in 0..count {
        for j in i + 1..count {
            let meet = if j == i + 1 {
                folds(edge(i)[0], edge(i)[1], edge(j)[1])
            } else if (j + 1) % count == i {
                folds(edge(j)[0], edge(j)[1], edge(i)[1])
            } else {
                touch(edge(i), edge(j))
            };
            if meet {
                return Some([p[i].place + 1, p[j].place + 1]);
            }
        }
    }
    None
}

/// Whether the edge from `b` folds back onto the edge from `a`.
fn folds(a: Coord<f64>, b: Coord<f64>, c: Coord<f64>) -> bool {
    let back = (a.x - b.x) * (c.x - b.x) + (a.y - b.y) * (c.y - b.y) > 0.0;
    back && orient2d(a, b, c) == 0.0
}

/// Whether two edges share a point.
fn touch([a, b]: [Coord<f64>; 2], [c, d]: [Coord<f64>; 2]) -> bool {
    let apart = |a: f64, b: f64, c: f64, d: f64| a.max(b) < c.min(d) || c.max(d) < a.min(b);
    if apart(a.x, b.x, c.x, d.x) || apart(a.y, b.y, c.y, d.y) {
        return false;
    }
    let one_side = |a, b, c, d| {
        let (c, d) = (orient2d(a, b, c), orient2d(a, b, d));
        (c > 0.0 && d > 0.0) || (c < 0.0 && d < 0.0)
    };
    !one_side(a, b, c, d) && !one_side(c, d, a, b)
}

/// Repeatedly cuts off a corner whose triangle contains no other corner. A simple polygon always has such a
/// corner.
fn ears(mut p: Vec<Corner>) -> Vec<[usize; 3]> {
    let mut triangles = Vec::with_capacity(p.len() - 2);
    let mut at = 0;
    while p.len() > 3 {
        let count = p.len();
        let around = |i: usize| [p[(i + count - 1) % count], p[i % count], p[(i + 1) % count]];
        let is_ear = |&i: &usize| is_ear(around(i), &p);
        let Some(ear) = (at..at + count).find(is_ear) else { break };
        triangles.push(around(ear).map(|corner| corner.place));
        p.remove(ear % count);
        // Skipping a corner avoids repeated use of the same corner, which would give thin triangles.
        at = ear % count + 1;
    }
    triangles.extend(fan(&p).map(|triangle| triangle.map(|corner| corner.place)));
    triangles
}

fn is_ear([a, b, c]: [Corner; 3], p: &[Corner]) -> bool {
    let side = |a: Corner, b: Corner, c: Corner| orient2d(a.at, b.at, c.at);
    let own = |corner: &Corner| [a.place, b.place, c.place].contains(&corner.place);
    let within = |&q: &Corner| side(a, b, q) >= 0.0 && side(b, c, q) >= 0.0 && side(c, a, q) >= 0.0;
    side(a, b, c) > 0.0 && !p.iter().any(|corner| !own(corner) && within(corner))
}
