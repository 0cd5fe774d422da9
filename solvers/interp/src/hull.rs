//! The convex hull of a cloud as seen by targets: within, near or beyond.

use shape::{Point3, Vector3};

use crate::delaunay::{Delaunay, FACES, NONE};

/// Targets nearer to the hull than this (1 is on the hull, 0 the middle of the cloud) are drawn in to here: on the hull itself
/// cells of the Voronoi diagram are not bounded, and rounding grows with the inverse of the depth, while what is
/// left out is of the order of the depth.
pub(crate) const DEPTH: f64 = 1e-6;
/// Beyond the hull by less than this is rounding.
const ROUNDING: f64 = 1e-12;
/// Twice the area of a facet over its longest side squared below which it has no plane to speak of; its neighbours
/// hide it.
const THIN: f64 = 1e-10;

/// Facets of the hull, the middle of the nodes within.
pub(crate) struct Hull {
    middle: Point3,
    /// `slope . (x - middle)` is 1 in the plane of the facet.
    slopes: Vec<Vector3>,
    facets: Vec<[Point3; 3]>,
}

/// A target and the hull.
pub(crate) enum Place {
    /// Well within.
    Inside,
    /// Drawn in to here, from the hull or from beyond it.
    Near {
        /// A point within.
        inner: Point3,
        /// The target is beyond the hull, by more than rounding.
        outside: bool,
    },
}

impl Hull {
    pub(crate) fn new(nodes: &[Point3], mesh: &Delaunay) -> Hull {
        let middle = Point3::from(nodes.iter().map(|x| x.coords).sum::<Vector3>() / nodes.len() as f64);
        let mut hull = Hull { middle, slopes: Vec::new(), facets: Vec::new() };
        for (corners, neighbours) in mesh.cells.iter().zip(&mesh.neighbours) {
            for k in (0..4).filter(|&k| neighbours[k] == NONE) {
                let [a, b, c] = FACES[k].map(|i| nodes[corners[i] as usize]);
                let normal = (b - a).cross(&(c - a));
                let longest = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
                if normal.norm() > THIN * longest {
                    hull.slopes.push(normal / normal.dot(&(a - middle)));
                    hull.facets.push([a, b, c]);
                }
            }
        }
        hull
    }

    /// Where a target is, by the facets it lies beyond; the closest point of a convex body is on one of those.
    pub(crate) fn place(&self, x: &Point3) -> Place {
        let r = x - self.middle;
        let highest = self.slopes.iter().fold(0.0, |most: f64, slope| most.max(slope.dot(&r)));
        if highest < 1.0 - DEPTH {
            return Place::Inside;
        }
        let mut closest = (f64::INFINITY, *x);
        if highest > 1.0 {
            for (_, [a, b, c]) in
                self.slopes.iter().zip(&self.facets).filter(|(slope, _)| slope.dot(&r) > 1.0)
            {
                let y = closest_of_triangle(x, a, b, c);
                let square = (y - x).norm_squared();
                if square < closest.0 {
                    closest = (square, y);
                }
            }
        }
        let inner = closest.1 + (self.middle - closest.1) * DEPTH;
        Place::Near { inner, outside: highest > 1.0 + ROUNDING }
    }
}

/// Closest point of a triangle (Ericson 2005, section 5.1.5).
fn closest_of_triangle(x: &Point3, a: &Point3, b: &Point3, c: &Point3) -> Point3 {
    let (ab, ac) = (b - a, c - a);
    let from = |corner: &Point3| (ab.dot(&(x - corner)), ac.dot(&(x - corner)));
    let ((d1, d2), (d3, d4), (d5, d6)) = (from(a), from(b), from(c));
    if d1 <= 0.0 && d2 <= 0.0 {
        return *a;
    }
    if d3 >= 0.0 && d4 <= d3 {
        return *b;
    }
    if d6 >= 0.0 && d5 <= d6 {
        return *c;
    }
    let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let sum = va + vb + vc;
    a + ab * (vb / sum) + ac * (vc / sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_closest_point_of_a_triangle_is_closest() {
        let [a, b, c] = [Point3::new(0.0, 0.0, 0.0), Point3::new(1.0, 0.2, 0.1), Point3::new(0.3, 0.9, -0.2)];
        for i in 0..200 {
            let t = i as f64;
            let x = Point3::new((3.1 * t).sin(), (7.7 * t).cos(), (1.3 * t).sin()) * 2.0;
            let y = closest_of_triangle(&x, &a, &b, &c);
            // No point of a fine grid over the triangle is closer, and one is about as close.
            let n = 60;
            let grid = (0..=n).flat_map(|i| (0..=n - i).map(move |j| (i, j)));
            let best = grid
                .map(|(i, j)| a + (b - a) * (i as f64 / n as f64) + (c - a) * (j as f64 / n as f64))
                .map(|p| (p - x).norm())
                .fold(f64::INFINITY, f64::min);
            let found = (y - x).norm();
            assert!(found <= best + 1e-12 && found > best - 0.02, "{i}: {found} {best}");
        }
    }
}
