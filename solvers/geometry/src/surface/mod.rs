//! Closed triangulated surfaces: distance, inside test, and checks that a surface is closed.
//!
//! The sign of the distance is that of the pseudo-normal at the closest point, the angle-weighted sum of the
//! adjacent normals (Baerentzen and Aanaes 2005). It is correct for closest points on faces, edges and
//! corners.

mod change;
mod closed;
mod crossing;
mod digits;
mod error;
mod faults;
mod foot;
mod groups;
mod needles;
mod nested;
mod of_mesh;
mod orientation;
mod polygon;
mod regions;
mod repair;
mod samples;
mod shape;
mod sides;
mod soup;
mod treated;
mod treatment;
mod tree;
mod walls;
mod winding;
mod wrap;

pub use change::Change;
pub use error::SurfaceProblem;
pub use foot::Foot;
pub use groups::{Groups, Set};
pub use of_mesh::{BoundaryFaces, triangles_of};
pub use polygon::PolygonFault;
pub(crate) use samples::{farthest, samples};
pub use soup::Soup;
pub use treated::{Gaps, Treated};
pub use treatment::Treatment;
use tree::Closest;
pub(crate) use tree::Tree;
pub use wrap::WrapProblem;

use needles::Across;

use crate::triangle::Feature;
use crate::{Point3, Vector3};

/// A closed surface with triangles that are counter-clockwise as seen from outside; positions in metres.
pub struct Surface {
    points: Vec<Point3>,
    triangles: Vec<[u32; 3]>,
    groups: Groups,
    normals: Normals,
    tree: Tree,
    volume: f64,
    /// Cumulative area of the triangles, m^2.
    areas: Vec<f64>,
    regions: Vec<Region>,
}

/// A part of the inside of a surface.
pub struct Region {
    /// Name: that of a group of triangles of this region alone, or a number.
    pub name: String,
    /// Closed surface of the region, with the walls to other regions.
    pub surface: Surface,
}

/// Normals of faces, edges and corners, of arbitrary length.
struct Normals {
    faces: Vec<Vector3>,
    edges: Vec<[Vector3; 3]>,
    corners: Vec<Vector3>,
}

impl Surface {
    /// Creates a surface of these triangles, with lengths multiplied by `unit` (m). If the triangles cross,
    /// needles without area are replaced together with their neighbours.
    ///
    /// # Errors
    /// Too few triangles, too many parts, or a surface that is open, crosses itself or is inside out. The
    /// error has the triangle and the position in the unit of the triangles.
    pub fn new(soup: Soup, unit: f64) -> Result<Surface, SurfaceProblem> {
        let (soup, neighbours) = closed::closed(soup, closed::neighbours)?;
        let (soup, neighbours) = without_crossings(soup, neighbours)?;
        nested::refuse(&soup, &neighbours)?;
        Ok(Surface::of(soup, &neighbours, unit))
    }

    /// The surface of triangles that were checked.
    fn of(soup: Soup, neighbours: &[[u32; 3]], unit: f64) -> Surface {
        let Soup { points, triangles, groups, .. } = soup;
        let groups = groups.without_empty();
        let points: Vec<Point3> = points.iter().map(|p| Point3::from(p.coords * unit)).collect();
        let normals = Normals::new(&points, &triangles, neighbours);
        let tree = Tree::new(&points, &triangles);
        let corners = |t: &[u32; 3]| t.map(|p| points[p as usize]);
        let [low, high] = tree.bounds();
        let middle = nalgebra::center(&low, &high);
        let volume = triangles.iter().map(|t| {
            let [a, b, c] = corners(t).map(|p| p - middle);
            a.dot(&b.cross(&c)) / 6.0
        });
        let volume = volume.sum();
        let mut sum = 0.0;
        let areas = triangles.iter().map(|t| {
            let [a, b, c] = corners(t);
            sum += 0.5 * (b - a).cross(&(c - a)).norm();
            sum
        });
        let areas = areas.collect();
        Surface { volume, areas, points, triangles, groups, normals, tree, regions: Vec::new() }
    }

    /// Regions inside the surface; empty for a single body, and for bodies that touch no other.
    pub fn regions(&self) -> &[Region] {
        &self.regions
    }

    /// Positions of the corners, m.
    pub fn points(&self) -> &[Point3] {
        &self.points
    }

    /// Corners of the triangles.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Named groups of triangles, without empty groups.
    pub fn groups(&self) -> &Groups {
        &self.groups
    }

    /// Positions of a triangle's corners, m.
    pub fn corners(&self, triangle: usize) -> [Point3; 3] {
        self.triangles[triangle].map(|p| self.points[p as usize])
    }

    /// Enclosed volume, m^3.
    pub fn volume(&self) -> f64 {
        self.volume
    }

    /// Area, m^2.
    pub fn area(&self) -> f64 {
        self.areas.last().copied().unwrap_or(0.0)
    }

    /// Lowest and highest corner of the bounding box, m.
    pub fn bounds(&self) -> [Point3; 2] {
        self.tree.bounds()
    }

    /// The closest point of the surface, m, and its triangle.
    pub fn closest(&self, p: &Point3) -> (Point3, usize) {
        let closest = self.tree.closest(p, f64::INFINITY);
        closest.map_or((*p, 0), |closest| (closest.at, closest.triangle as usize))
    }

    /// Signed distance from the surface, m; negative inside.
    pub fn signed_distance(&self, p: &Point3) -> f64 {
        self.distance_within(p, f64::INFINITY).unwrap_or(f64::INFINITY)
    }

    /// Signed distance as [`Surface::signed_distance`], or `None` if the surface is not closer than `within`.
    fn distance_within(&self, p: &Point3, within: f64) -> Option<f64> {
        Some(self.signed(p, &self.tree.closest(p, within)?))
    }

    /// Distance of a position from its closest point, with the sign.
    fn signed(&self, p: &Point3, closest: &Closest) -> f64 {
        if closest.square == 0.0 {
            return 0.0;
        }
        let normal = self.normal(closest);
        let distance = closest.square.sqrt();
        let away = (p - closest.at).dot(normal);
        // The offset from the closest point is along the normal, unless the surface has triangles without
        // area.
        let doubtful = away.abs() <= 1e-6 * distance * normal.norm();
        let inside =
            if doubtful { nested::winding(&self.points, &self.triangles, p) > 0.5 } else { away < 0.0 };
        if inside { -distance } else { distance }
    }

    /// Pseudo-normal at a closest point, of arbitrary length.
    fn normal(&self, closest: &Closest) -> &Vector3 {
        let triangle = closest.triangle as usize;
        match closest.feature {
            Feature::Face => &self.normals.faces[triangle],
            Feature::Edge(edge) => &self.normals.edges[triangle][edge],
            Feature::Corner(corner) => &self.normals.corners[self.triangles[triangle][corner] as usize],
        }
    }

    /// Fraction of the line from a point inside to a point outside at which it meets the surface: the zero of
    /// the distance, which is known at both ends.
    pub(crate) fn cut(&self, inside: (&Point3, f64), outside: (&Point3, f64)) -> f64 {
        let line = outside.0 - inside.0;
        zero([inside.1, outside.1], line.norm(), |t, reach| {
            let at = inside.0 + line * t;
            self.distance_within(&at, 1.001 * reach).unwrap_or_else(|| self.signed_distance(&at))
        })
    }
}

/// Zero of a signed distance along a line of the given length, as a fraction of the line. `ends` are the
/// distances at the ends, the first of which is negative. `distance` is called with a fraction and the
/// largest distance possible there.
pub(crate) fn zero(ends: [f64; 2], length: f64, distance: impl Fn(f64, f64) -> f64) -> f64 {
    let (mut low, mut high) = ((0.0, ends[0]), (1.0, ends[1]));
    // Illinois method: the value at an end that is retained twice is halved, so that both ends converge.
    let mut last = 0;
    for _ in 0..60 {
        let t: f64 = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
        let t = if t > low.0 && t < high.0 { t } else { 0.5 * (low.0 + high.0) };
        // The distance changes at most as fast as the position.
        let reach = (low.1.abs() + (t - low.0) * length).max(high.1 + (high.0 - t) * length);
        let distance = distance(t, reach);
        if distance.abs() <= 1e-9 * length || (high.0 - low.0) < 1e-12 {
            return t;
        }
        if distance < 0.0 {
            low = (t, distance);
            high.1 *= if last == -1 { 0.5 } else { 1.0 };
            last = -1;
        } else {
            high = (t, distance);
            low.1 *= if last == 1 { 0.5 } else { 1.0 };
            last = 1;
        }
    }
    0.5 * (low.0 + high.0)
}

/// Rejects triangles that cross, after needles are replaced.
fn without_crossings(soup: Soup, neighbours: Across) -> Result<(Soup, Across), SurfaceProblem> {
    // Needles are searched only after a crossing was found, because most surfaces have none.
    let Err(crossing) = crossing::refuse(&soup, || nested::parts(&neighbours)) else {
        return Ok((soup, neighbours));
    };
    let (soup, neighbours) = needles::cut(&soup, &neighbours).ok_or(crossing)??;
    crossing::refuse(&soup, || nested::parts(&neighbours))?;
    Ok((soup, neighbours))
}

impl Normals {
    fn new(points: &[Point3], triangles: &[[u32; 3]], neighbours: &[[u32; 3]]) -> Normals {
        let unit = |v: Vector3| v.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
        let faces: Vec<Vector3> = triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|p| points[p as usize]);
                unit((b - a).cross(&(c - a)))
            })
            .collect();
        let edges = neighbours.iter().zip(&faces).map(|(near, face)| near.map(|t| face + faces[t as usize]));
        let edges = edges.collect();
        let mut corners = vec![Vector3::zeros(); points.len()];
        for (t, face) in triangles.iter().zip(&faces) {
            let p = t.map(|p| points[p as usize]);
            for corner in 0..3 {
                let arms = [1, 2].map(|next| unit(p[(corner + next) % 3] - p[corner]));
                corners[t[corner] as usize] += face * arms[0].dot(&arms[1]).clamp(-1.0, 1.0).acos();
            }
        }
        Normals { faces, edges, corners }
    }
}
