//! Closed surface with rounded edges: a ball of the radius r is added to it all round, and a ball of the
//! radius r that rolls over the result fills its grooves.
//!
//! Both are needed for a normal without jumps. Over convex edges the distance `D` from the surface is smooth,
//! and the tool's distance is `D - r`. Over a groove the nearest flank changes at the bisector, where a point
//! would be pushed to and fro. There the tool's distance is `r - |y - x|` with `y` the position of the ball's
//! centre nearest to `x`: the nearest of all positions with `D >= 2 r`. It lies at the distance 2 r from two
//! flanks, or from three.

use std::sync::Arc;

use geometry::{Point3, Surface, closest_on_triangle};
use shape::{Matrix3, Vector3};

use super::signed_distance::{Distance, Shape, size};
use crate::error::ContactError;

/// Closed surface, such as the model of an instrument, about the middle of its bounding box, with all edges
/// and corners rounded and all grooves filled.
#[derive(Clone)]
pub struct RoundedSurface {
    surface: Arc<Surface>,
    /// Whether the surface is convex and has no groove.
    is_convex: bool,
    /// Middle of the surface's bounding box, m.
    middle: Vector3,
    radius: f64,
    inradius: f64,
}

/// Part of the ball's radius to which its centre is found.
const CENTRE: f64 = 1e-12;

/// Largest number of flanks that one ball meets.
const FLANKS: usize = 6;

/// Largest number of linearisations of the distances from edges.
const LINEARISATIONS: usize = 60;

impl RoundedSurface {
    /// Makes a tool of a surface and the radius of the balls (m).
    ///
    /// # Errors
    ///
    /// The radius is not positive.
    pub fn new(surface: Arc<Surface>, radius: f64) -> Result<RoundedSurface, ContactError> {
        size("the radius", radius)?;
        let [low, high] = surface.bounds();
        let middle = nalgebra::center(&low, &high).coords;
        let inradius = surface.depth() + radius;
        Ok(RoundedSurface { is_convex: surface.is_convex(), middle, surface, radius, inradius })
    }

    /// Middle of the surface's bounding box (m), the origin of the tool's frame.
    pub fn middle(&self) -> Vector3 {
        self.middle
    }

    /// Corners of the surface, moved outwards by the radius (m, in the tool's frame), and its triangles.
    pub(super) fn skin(&self) -> (Vec<Vector3>, Vec<[u32; 3]>) {
        let grown = |p: &Point3| p.coords + self.surface.foot(p).gradient * self.radius - self.middle;
        (self.surface.points().iter().map(grown).collect(), self.surface.triangles().to_vec())
    }

    /// Kept out of the loops of the other shapes, which take a hundredth of its time.
    #[inline(never)]
    fn distance(&self, p: &Vector3) -> Distance {
        let x = Point3::from(p + self.middle);
        let foot = self.surface.foot(&x);
        let grown =
            Distance { value: foot.distance - self.radius, gradient: foot.gradient, hessian: foot.hessian };
        let reach = 2.0 * self.radius;
        if self.is_convex || foot.distance >= reach {
            return grown;
        }
        let centre = x + foot.gradient * (reach - foot.distance);
        let (at, flank) = self.surface.closest(&centre);
        if (centre - at).norm() >= reach * (1.0 - CENTRE) {
            return grown;
        }
        // A ball that finds no place in a groove of many flanks leaves it open.
        self.filled(&x, centre, vec![foot.triangle, flank]).unwrap_or(grown)
    }

    /// Distance from the ball that meets these flanks (triangles) of a groove and others, starting from a
    /// centre that is too close to one of them.
    fn filled(&self, x: &Point3, mut centre: Point3, mut flanks: Vec<usize>) -> Option<Distance> {
        let reach = 2.0 * self.radius;
        while flanks.len() <= FLANKS {
            let mut normals = Vec::new();
            for _ in 0..LINEARISATIONS {
                let planes: Vec<(Vector3, f64)> = (flanks.iter())
                    .map(|&flank| {
                        let at = closest_on_triangle(&centre, &self.surface.corners(flank));
                        let normal = (centre - at).normalize();
                        (normal, normal.dot(&(at - x)) + reach)
                    })
                    .collect();
                let (step, met) = nearest_beyond(&planes)?;
                let moved = (x + step - centre).norm();
                centre = x + step;
                normals = met;
                if moved <= CENTRE * reach {
                    break;
                }
            }
            let (at, flank) = self.surface.closest(&centre);
            if (centre - at).norm() >= reach * (1.0 - 1e3 * CENTRE) {
                return Some(self.of_ball(x, &centre, &normals));
            }
            if flanks.contains(&flank) {
                return None;
            }
            flanks.push(flank);
        }
        None
    }

    /// Distance from the ball about a centre, held by flanks of these normals: it moves along with a single
    /// one and along the edge between two. Where a flank is an edge or a corner, its curvature is left out of
    /// the Hessian.
    fn of_ball(&self, x: &Point3, centre: &Point3, normals: &[Vector3]) -> Distance {
        let length = (centre - x).norm();
        let gradient = (centre - x) / length;
        let across = Matrix3::identity() - gradient * gradient.transpose();
        let held = match normals {
            [_] => Matrix3::zeros(),
            [a, b] => {
                let along = a.cross(b).normalize();
                across - along * along.transpose()
            }
            _ => across,
        };
        Distance { value: self.radius - length, gradient, hessian: -held / length }
    }
}

/// Shortest vector `v` with `n . v >= d` for all pairs of unit normals and distances, and the normals of
/// those that it meets as equalities, at most three. All such sets are tried: a ball meets few flanks.
fn nearest_beyond(planes: &[(Vector3, f64)]) -> Option<(Vector3, Vec<Vector3>)> {
    let count = planes.len();
    let mut best: Option<(Vector3, Vec<Vector3>)> = None;
    for set in (1u32..1 << count).filter(|set| set.count_ones() <= 3) {
        let chosen: Vec<(Vector3, f64)> =
            (0..count).filter(|k| set >> k & 1 == 1).map(|k| planes[k]).collect();
        // v = sum l_i n_i with n_i . v = d_i.
        let mut gram = Matrix3::identity();
        let mut right = Vector3::zeros();
        for (i, (a, d)) in chosen.iter().enumerate() {
            right[i] = *d;
            chosen.iter().enumerate().for_each(|(j, (b, _))| gram[(i, j)] = a.dot(b));
        }
        // Flanks in one plane are one flank.
        let Some(inverse) = gram.try_inverse().filter(|_| gram.determinant() > 1e-9) else { continue };
        let share = inverse * right;
        let v: Vector3 = chosen.iter().zip(share.iter()).map(|((n, _), l)| n * *l).sum();
        let slack = 1e-12 * v.norm();
        let is_beyond = planes.iter().all(|(n, d)| n.dot(&v) >= d - slack);
        if is_beyond && best.as_ref().is_none_or(|(other, _)| v.norm_squared() < other.norm_squared()) {
            best = Some((v, chosen.into_iter().map(|(n, _)| n).collect()));
        }
    }
    best
}

impl Shape for RoundedSurface {
    fn foot(&self, p: &Vector3) -> (f64, Vector3) {
        let Distance { value, gradient, .. } = self.distance(p);
        (value, gradient)
    }

    fn hessian(&self, p: &Vector3) -> Matrix3 {
        self.distance(p).hessian
    }

    fn half_extents(&self) -> Vector3 {
        let [low, high] = self.surface.bounds();
        ((high - low) * 0.5).add_scalar(self.radius)
    }

    fn inradius(&self) -> f64 {
        self.inradius
    }

    fn outline(&self, _body: f64) -> Vec<Vector3> {
        self.skin().0
    }

    fn is_convex(&self) -> bool {
        self.is_convex
    }

    fn check(&self) -> Result<(), ContactError> {
        Ok(())
    }
}

impl std::fmt::Debug for RoundedSurface {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let triangles = self.surface.triangles().len();
        write!(to, "RoundedSurface {{ {triangles} triangles, radius: {} }}", self.radius)
    }
}

impl PartialEq for RoundedSurface {
    fn eq(&self, other: &RoundedSurface) -> bool {
        let same = self.surface.points() == other.surface.points()
            && self.surface.triangles() == other.surface.triangles();
        same && self.radius == other.radius
    }
}

#[cfg(test)]
mod tests {
    use geometry::surface::Soup;

    use super::*;
    use crate::{RoundedBox, ToolShape};

    /// Surface of a box about `middle`.
    fn boxed(half: [f64; 3], middle: [f64; 3]) -> Arc<Surface> {
        let mut soup = Soup::default();
        for k in 0..8usize {
            let side = |a: usize| if (k >> a) & 1 == 1 { half[a] } else { -half[a] };
            soup.points.push(Point3::new(middle[0] + side(0), middle[1] + side(1), middle[2] + side(2)));
        }
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        for (number, quad) in quads.iter().enumerate() {
            soup.face(number, quad).unwrap();
        }
        Arc::new(Surface::new(soup, 1.0).unwrap())
    }

    /// Between the faces of a sheet every position is nearly as deep, so that the search is cut off.
    #[test]
    fn the_depth_of_a_thin_sheet_is_found_in_bounded_work() {
        let half = [25e-3, 25e-3, 5e-5];
        let turn = nalgebra::Rotation3::new(Vector3::new(0.4, -0.7, 0.2));
        let flat = boxed(half, [0.0; 3]);
        let points = flat.points().iter().map(|p| turn * p).collect();
        let mut soup = Soup { points, ..Soup::default() };
        for (number, &triangle) in flat.triangles().iter().enumerate() {
            soup.triangle(number, triangle);
        }
        let depth = Surface::new(soup, 1.0).unwrap().depth();
        assert!((0.5 * half[2]..=half[2] * (1.0 + 1e-9)).contains(&depth), "{depth}");
    }

    #[test]
    fn the_surface_of_a_box_is_the_rounded_box() {
        let (core, radius) = ([3e-3, 5e-3, 2e-3], 1e-3);
        let surface: ToolShape = RoundedSurface::new(boxed(core, [0.1, -0.2, 0.3]), radius).unwrap().into();
        let exact: ToolShape = RoundedBox { half: core.map(|half| half + radius), radius }.into();
        assert!((surface.inradius() - exact.inradius()).abs() < 0.1 * exact.inradius());
        assert!((surface.bounds().1 - exact.bounds().1).norm() < 1e-12);
        let mut met = [0; 3];
        for k in 0..4000 {
            // Positions all round, faces, edges and corners, inside and outside.
            let part = |a: f64| 2.0 * (f64::from(k) * a).fract() - 1.0;
            let p = Vector3::new(6e-3 * part(0.618_034), 8e-3 * part(0.754_877), 5e-3 * part(0.569_840));
            let beyond = (0..3).filter(|&a| p[a].abs() > core[a]).count();
            // Inside, the nearest face changes at the diagonals, where rounding decides.
            if beyond == 0 {
                let mut depths = [0, 1, 2].map(|a| core[a] - p[a].abs());
                depths.sort_by(f64::total_cmp);
                if depths[1] - depths[0] < 1e-9 {
                    continue;
                }
            } else {
                met[beyond - 1] += 1;
            }
            let (found, right) = (surface.distance(&p), exact.distance(&p));
            assert!((found.value - right.value).abs() < 1e-12, "{p}: {} {}", found.value, right.value);
            assert!((found.gradient - right.gradient).norm() < 1e-9, "{p}");
            let scale = right.hessian.norm().max(1.0 / core[2]);
            assert!((found.hessian - right.hessian).norm() < 1e-6 * scale, "{p}");
        }
        assert!(met.iter().all(|&count| count > 100), "{met:?}");
    }

    /// A groove of two planes at right angles along y, with its bottom at z = 0.
    fn grooved() -> ToolShape {
        let profile = [[-10.0, 10.0], [-10.0, -10.0], [10.0, -10.0], [10.0, 10.0], [0.0, 0.0]];
        let mut soup = Soup::default();
        for y in [-10.0, 10.0] {
            soup.points.extend(profile.map(|[x, z]| Point3::new(x, y, z) * 1e-3));
        }
        for k in 0..5 {
            let next = (k + 1) % 5;
            soup.face(k as usize, &[k, k + 5, next + 5, next]).unwrap();
        }
        for k in 0..3 {
            soup.triangle(5, [4, k, k + 1]);
            soup.triangle(6, [9, k + 6, k + 5]);
        }
        RoundedSurface::new(Arc::new(Surface::new(soup, 1.0).unwrap()), 1e-3).unwrap().into()
    }

    #[test]
    fn a_ball_fills_a_groove_and_the_normal_turns_without_a_jump() {
        let tool = grooved();
        // The centre of the ball is 2 mm from both flanks: sqrt(2) 2 mm over the bottom.
        let centre = 2e-3 * 2f64.sqrt();
        for (x, z) in [(0.0, 1.5e-3), (0.3e-3, 1.6e-3), (-0.4e-3, 1.2e-3), (0.0, 0.2e-3)] {
            let offset = Vector3::new(-x, 0.0, centre - z);
            let found = tool.distance(&Vector3::new(x, 0.0, z));
            assert!((found.value - (1e-3 - offset.norm())).abs() < 1e-14, "{x} {z}: {}", found.value);
            assert!((found.gradient - offset.normalize()).norm() < 1e-10);
        }
        // Across the groove at one height: gradient and Hessian are derivatives of the value throughout.
        let h = 1e-8;
        for k in -300..=300 {
            let p = Vector3::new(1.003e-5 * f64::from(k), 1e-3, 2.2e-3);
            let here = tool.distance(&p);
            for a in 0..3 {
                let mut step = Vector3::zeros();
                step[a] = h;
                let [after, before] = [tool.distance(&(p + step)), tool.distance(&(p - step))];
                let slope = (after.value - before.value) / (2.0 * h);
                assert!((slope - here.gradient[a]).abs() < 2e-5, "{k} {a}: {slope} {}", here.gradient[a]);
                // The gradient has no jump, also where the ball begins to touch the other flank.
                assert!((after.gradient - before.gradient).norm() < 4.0 * h / 1e-3, "{k} {a}");
            }
        }
    }
}
