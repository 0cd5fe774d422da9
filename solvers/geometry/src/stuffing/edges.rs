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

    /// Whether a triangle of the mesh cuts off an edge: its corners lie on both sides of one that is near.
    pub(super) fn are_cut(&self, surface: &Surface, corners: &[Point3; 3]) -> bool {
        if self.0.is_empty() {
            return false;
        }
        let [a, b, c] = corners.map(|corner| normal(surface, surface.closest(&corner).1));
        if a.dot(&b).min(b.dot(&c)).min(c.dot(&a)) >= SHARP {
            return false;
        }
        let [a, b, c] = corners.map(|corner| corner.coords);
        let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
        let middle = Point3::from((a + b + c) / 3.0);
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
