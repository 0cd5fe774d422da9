//! Finds corners and edges of the body that a tool meets before the faces around them.
//!
//! The contact points of a face lie inside the face. A tool pressed on the tip of a pyramid would penetrate
//! deeply before touching the first of them, and so would a tool pressed on the rim of a coarse mesh, however
//! blunt. Faces around such a corner receive contact points at their corners and edges.

use std::collections::BTreeMap;

use contact::{Drive, ON_THE_WAY, Tool};
use geometry::{Facet, Mesh, Point3, Vector3};

use crate::discretise::place;
use crate::scenario::PlacedTool;

/// Scalar product of two unit normals above which the faces count as flat.
const FLAT: f64 = 0.8;
/// Slope, relative to the tool's direction, above which a face falls away from a corner or an edge.
const SLOPE: f64 = 0.35;
/// Part of the distance to a face's centre over which the slope is measured.
const INWARD: f64 = 0.25;
/// Sampled positions on an edge, as fractions of its length.
const PLACES: [f64; 3] = [0.25, 0.5, 0.75];
/// Iterations of the search for the closure at contact, and its tolerance relative to the body's size.
const STEPS: usize = 60;
const REACHED: f64 = 1e-9;

/// A face with its corners, its centre (m) and its unit normal.
struct Face {
    corners: Vec<u32>,
    middle: Point3,
    normal: Vector3,
}

/// Marks the facets around corners and edges that the tool meets first, among the facets for which `passes`
/// is true. `points` are the contact points.
pub(super) fn mark(
    mesh: &Mesh,
    facets: &[Facet],
    passes: impl Fn(Facet) -> bool,
    points: &[Point3],
    PlacedTool { tool, drive, curve, .. }: &PlacedTool,
    sharp: &mut [bool],
) {
    let faces: Vec<Face> = facets.iter().map(|&facet| face(mesh, facet)).collect();
    let mut around: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (k, face) in faces.iter().enumerate().filter(|(k, _)| passes(facets[*k])) {
        face.corners.iter().for_each(|&corner| around.entry(corner).or_default().push(k));
    }
    let (low, high) = place::bounds(mesh);
    let farthest = curve.as_ref().map_or(1.0, |curve| curve.largest());
    let way = |x: &Point3| way(tool, x, (high - low).norm());
    let first = |x: &Point3, edge: Option<Vector3>, owners: &[usize]| {
        let bent = |&a: &usize| owners.iter().any(|&b| faces[a].normal.dot(&faces[b].normal) < FLAT);
        if !owners.iter().any(bent) {
            return false;
        }
        let Some(met) = way(x) else { return false };
        owners.iter().all(|&k| {
            let inward = faces[k].middle - x;
            let inward = INWARD * (inward - edge.map_or(Vector3::zeros(), |edge| edge * edge.dot(&inward)));
            way(&(x + inward)).is_none_or(|later| later - met > SLOPE * inward.norm())
        })
    };
    let at = |node: u32| mesh.points()[node as usize];
    // A corner is missed if the tool meets it before all contact points. The tool then penetrates too deeply
    // for a step to be accepted, or it stops before it meets them.
    let touched = points.iter().filter_map(way).fold(f64::INFINITY, f64::min);
    let missed = |x: &Point3| {
        let met = way(x).filter(|met| *met < touched);
        let squares = points.iter().map(|p| (p - x).norm_squared());
        met.is_some_and(|met| {
            touched - met > ON_THE_WAY * squares.fold(f64::INFINITY, f64::min).sqrt()
                || matches!(*drive, Drive::Closure(end) if met < end * farthest && end * farthest < touched)
        })
    };
    for (&corner, owners) in &around {
        if first(&at(corner), None, owners) || missed(&at(corner)) {
            owners.iter().for_each(|&k| sharp[k] = true);
        }
        // Each edge is visited at its lower corner.
        let edges = owners.iter().flat_map(|&k| beside(&faces[k].corners, corner));
        let mut ends: Vec<u32> = edges.filter(|&end| end > corner).collect();
        ends.sort_unstable();
        ends.dedup();
        for end in ends {
            let owners: Vec<usize> = owners.iter().copied().filter(|k| around[&end].contains(k)).collect();
            let from = at(corner);
            let along = at(end) - at(corner);
            let places = PLACES.map(|part| from + along * part);
            if places.iter().any(|x| first(x, Some(along.normalize()), &owners)) {
                owners.iter().for_each(|&k| sharp[k] = true);
            }
        }
    }
}

fn face(mesh: &Mesh, facet: Facet) -> Face {
    let corners: Vec<u32> = mesh.facet_corners(facet).collect();
    let count = corners.len();
    let at: Vec<Vector3> = corners.iter().map(|&node| mesh.points()[node as usize].coords).collect();
    let normal = (at[2] - at[0]).cross(&(at[count - 1] - at[1]));
    let middle = Point3::from(at.iter().sum::<Vector3>() / count as f64);
    Face { corners, middle, normal: normal.try_normalize(0.0).unwrap_or_default() }
}

/// Returns the two neighbours of a corner in a face.
fn beside(corners: &[u32], corner: u32) -> [u32; 2] {
    let n = corners.len();
    let k = corners.iter().position(|&c| c == corner).unwrap_or(0);
    [corners[(k + 1) % n], corners[(k + n - 1) % n]]
}

/// Returns the closure (m) at which a tool meets the fixed point `x` of a body of size `size` (m); `None` if
/// the tool passes by.
fn way(tool: &Tool, x: &Point3, size: f64) -> Option<f64> {
    let mut closure = 0.0;
    let rate = tool.rate(std::iter::once(*x), 0.0);
    let farthest = tool.gap(0.0, x) + 2.0 * size;
    for _ in 0..STEPS {
        let gap = tool.gap(closure, x);
        if gap <= REACHED * size {
            return Some(closure);
        }
        // No part of the tool is nearer than the gap.
        closure += gap / rate;
        if closure > farthest {
            return None;
        }
    }
    None
}
