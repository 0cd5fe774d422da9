//! Sharp edges of a surface, which a stuffed mesh rounds off.

use std::collections::HashMap;

use crate::surface::Surface;
use crate::{Point3, Vector3};

/// Cosine of the angle between the normals of two triangles beyond which their edge is sharp.
const SHARP: f64 = 0.5;

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
fn distance(p: &Point3, [a, b]: &[Point3; 2]) -> f64 {
    let along = b - a;
    let part = ((p - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
    (p - a - along * part).norm()
}
