//! The convex hull of a cloud as seen by targets: within, near or beyond.

use geometry::closest_on_triangle;
use shape::{Point3, Vector3};

use crate::delaunay::{Delaunay, FACES, NONE};
use crate::lanes::{LANES, Lanes, dot};

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
    facets: Vec<Facet>,
    /// Slopes of the facets by eights, filled up with zeros.
    slopes: Vec<[Lanes; 3]>,
}

struct Facet {
    corners: [Point3; 3],
    /// `slope . (x - middle)` is 1 in the plane of the facet.
    slope: Vector3,
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
        let mut facets = Vec::new();
        for (corners, neighbours) in mesh.cells.iter().zip(&mesh.neighbours) {
            for k in (0..4).filter(|&k| neighbours[k] == NONE) {
                let [a, b, c] = FACES[k].map(|i| nodes[corners[i] as usize]);
                let normal = (b - a).cross(&(c - a));
                let longest = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
                if normal.norm() > THIN * longest {
                    facets.push(Facet { corners: [a, b, c], slope: normal / normal.dot(&(a - middle)) });
                }
            }
        }
        let slopes = facets
            .chunks(LANES)
            .map(|eight| {
                let of = |lane: usize, axis: usize| eight.get(lane).map_or(0.0, |f: &Facet| f.slope[axis]);
                [0, 1, 2].map(|axis| Lanes(std::array::from_fn(|lane| of(lane, axis))))
            })
            .collect();
        Hull { middle, facets, slopes }
    }

    /// Where a target is, by the facets it lies beyond; the closest point of a convex body is on one of those.
    #[inline(always)]
    pub(crate) fn place(&self, x: &Point3) -> Place {
        let r = x - self.middle;
        let lanes = [r.x, r.y, r.z].map(Lanes::all);
        // A loop: what a fold is handed would not be inlined, and then not on wide registers.
        let mut highest = Lanes::all(0.0);
        for slope in &self.slopes {
            highest = highest.max(dot(slope, &lanes));
        }
        let highest = highest.0.into_iter().fold(0.0, f64::max);
        if highest < 1.0 - DEPTH {
            return Place::Inside;
        }
        let mut closest = (f64::INFINITY, *x);
        if highest > 1.0 {
            for Facet { corners, .. } in self.facets.iter().filter(|f| f.slope.dot(&r) > 1.0) {
                let y = closest_on_triangle(x, corners);
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
