//! Convex hull of a cloud, and the position of targets relative to it.

use geometry::closest_on_triangle;
use lanes::LANES;
use shape::{Point3, Vector3};

use crate::delaunay::{Delaunay, FACES, NONE};
use crate::lanes::{Lanes, dot};

/// Relative depth to which targets on or near the hull are moved inwards (distances from 0 at the middle of
/// the cloud to 1 on the hull). On the hull itself, cells of the Voronoi diagram are unbounded. Rounding
/// grows with the inverse of the depth, whereas the error of the shift is of the order of the depth.
pub(crate) const DEPTH: f64 = 1e-6;
/// Distance beyond the hull that counts as rounding.
const ROUNDING: f64 = 1e-12;
/// Ratio of twice a facet's area to its longest side squared below which the facet has no well-defined plane.
/// Its neighbours cover it.
const THIN: f64 = 1e-10;

/// Facets of the hull, and the mean position of the nodes, which lies inside.
pub(crate) struct Hull {
    middle: Point3,
    facets: Vec<Facet>,
    /// Slopes of the facets in groups of eight, padded with zeros.
    slopes: Vec<[Lanes; 3]>,
}

struct Facet {
    corners: [Point3; 3],
    /// Vector for which `slope . (x - middle)` is 1 in the plane of the facet.
    slope: Vector3,
}

/// Position of a target relative to the hull.
pub(crate) enum Place {
    /// Well inside.
    Inside,
    /// On, near or beyond the hull, and moved inwards.
    Near {
        /// Point inside the hull that replaces the target.
        inner: Point3,
        /// Whether the target is beyond the hull by more than rounding.
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

    /// Returns the position of a target relative to the hull. The closest point of a convex body lies on one
    /// of the facets that separate the target from the body.
    #[inline(always)]
    pub(crate) fn place(&self, x: &Point3) -> Place {
        let r = x - self.middle;
        let lanes = [r.x, r.y, r.z].map(Lanes::all);
        // A loop, because a closure passed to a fold would not be inlined and not be compiled for wide
        // registers.
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
