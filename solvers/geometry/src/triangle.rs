//! Closest point on a triangle.

use crate::Point3;

/// The feature of a triangle that is closest to a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Feature {
    Corner(usize),
    /// The edge from this corner to the next.
    Edge(usize),
    Face,
}

/// The point of a triangle that is closest to `p`.
pub fn closest_on_triangle(p: &Point3, corners: &[Point3; 3]) -> Point3 {
    closest_on(p, corners).1
}

/// The closest point on a triangle and the feature that it lies on (Ericson, Real-Time Collision Detection,
/// 5.1.5).
pub(crate) fn closest_on(p: &Point3, [a, b, c]: &[Point3; 3]) -> (Feature, Point3) {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return (Feature::Corner(0), *a);
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return (Feature::Corner(1), *b);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return (Feature::Edge(0), a + ab * (d1 / (d1 - d3)));
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return (Feature::Corner(2), *c);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return (Feature::Edge(2), a + ac * (d2 / (d2 - d6)));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return (Feature::Edge(1), b + (c - b) * t);
    }
    let sum = va + vb + vc;
    // For a triangle without area rounding decides; the edge is as close as the face.
    if !(sum > 0.0) {
        return (Feature::Edge(0), a + ab * (d1 / ab.norm_squared()).clamp(0.0, 1.0));
    }
    (Feature::Face, a + ab * (vb / sum) + ac * (vc / sum))
}
