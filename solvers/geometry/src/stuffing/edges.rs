//! Sharp edges of a surface, which a stuffed mesh rounds off.

use std::collections::{BTreeMap, HashMap};

use crate::surface::Surface;
use crate::{Point3, Vector3};

/// Cosine of the angle between the normals of two triangles beyond which their edge is sharp.
const SHARP: f64 = 0.5;

/// Cosine of the angle between two edges beyond which they meet at a corner.
const STRAIGHT: f64 = 0.7;

/// Distance from an edge, over the length of an edge of the mesh, below which a node lies on it.
const ON: f64 = 1e-6;

/// Ends of the sharp edges.
pub(super) struct Edges(Vec<[Point3; 2]>);

impl Edges {
    pub(super) fn of(surface: &Surface) -> Edges {
        let mut first = HashMap::new();
        let mut sharp = Vec::new();
        for (triangle, corners) in surface.triangles().iter().enumerate() {
            for (a, b) in [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (corners[i], corners[j])) {
                let Some(other) = first.insert([a.min(b), a.max(b)], triangle) else { continue };
                if normal(surface, other).dot(&normal(surface, triangle)) < SHARP {
                    sharp.push([a, b].map(|corner| surface.points()[corner as usize]));
                }
            }
        }
        Edges(sharp)
    }

    /// Whether there are no sharp edges.
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Points at which a sharp edge ends, branches or turns.
    pub(super) fn corners(&self) -> Vec<Point3> {
        let mut at: BTreeMap<[u64; 3], Vec<(Point3, Vector3)>> = BTreeMap::new();
        for [a, b] in &self.0 {
            for (from, to) in [(a, b), (b, a)] {
                let key = [from.x, from.y, from.z].map(f64::to_bits);
                at.entry(key).or_default().push((*from, (to - from).normalize()));
            }
        }
        let turns = |lines: &[(Point3, Vector3)]| lines.len() != 2 || lines[0].1.dot(&lines[1].1) > -STRAIGHT;
        at.into_values().filter(|lines| turns(lines)).map(|lines| lines[0].0).collect()
    }

    /// The edges away from the outer surface.
    pub(super) fn inside(self, outer: &Surface) -> Edges {
        let is_inside = |[a, b]: &[Point3; 2]| {
            let middle = nalgebra::center(a, b);
            outer.signed_distance(&middle) < -ON * nalgebra::distance(a, b)
        };
        Edges(self.0.into_iter().filter(is_inside).collect())
    }

    /// The sharp edge between two points on its different sides; `None` if there is none, or if a point
    /// lies on it.
    pub(super) fn between(&self, surface: &Surface, ends: &[Point3; 2]) -> Option<[Point3; 2]> {
        let [a, b] = ends.map(|end| normal(surface, surface.closest(&end).1));
        if self.0.is_empty() || a.dot(&b) >= SHARP {
            return None;
        }
        let middle = nalgebra::center(&ends[0], &ends[1]);
        let nearest = self.0.iter().min_by(|a, b| distance(&middle, a).total_cmp(&distance(&middle, b)))?;
        let length = nalgebra::distance(&ends[0], &ends[1]);
        ends.iter().all(|end| distance(end, nearest) > ON * length).then_some(*nearest)
    }

    /// Whether a face of the mesh cuts off an edge: its nodes lie on both sides of one that is near.
    pub(super) fn are_cut(&self, surface: &Surface, nodes: &[Vector3]) -> bool {
        if self.0.is_empty() {
            return false;
        }
        let normals: Vec<Vector3> =
            nodes.iter().map(|node| normal(surface, surface.closest(&Point3::from(*node)).1)).collect();
        if normals.iter().all(|a| normals.iter().all(|b| a.dot(b) >= SHARP)) {
            return false;
        }
        let middle = Point3::from(nodes.iter().sum::<Vector3>() / nodes.len() as f64);
        let longest =
            nodes.iter().flat_map(|a| nodes.iter().map(move |b| (a - b).norm())).fold(0.0, f64::max);
        self.0.iter().any(|edge| distance(&middle, edge) < longest)
    }
}

fn normal(surface: &Surface, triangle: usize) -> Vector3 {
    let [a, b, c] = surface.corners(triangle);
    (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_default()
}

/// Distance of a point from a segment.
fn distance(p: &Point3, segment: &[Point3; 2]) -> f64 {
    nalgebra::distance(p, &foot(p, segment))
}

/// Closest point of a segment.
pub(super) fn foot(p: &Point3, [a, b]: &[Point3; 2]) -> Point3 {
    let along = b - a;
    let part = ((p - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
    a + along * part
}
