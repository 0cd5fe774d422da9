//! Derivatives of the distance from a closed surface, and its largest depth.

use super::Surface;
use crate::triangle::Feature;
use crate::{Matrix3, Point3, Vector3};

/// Part of the surface's size within which a position counts as lying on the surface: the direction to the
/// closest point is noise.
const NEAR: f64 = 1e-9;

/// Deviation of a pseudo-normal from the normal of a triangle below which its edge or corner is flat. The
/// angle between the triangles is then less than 3e-5.
const FLAT: f64 = 1e-10;

/// Accuracy of the depth.
const DEPTH: f64 = 0.1;

/// Largest number of boxes in which the deepest position is searched: some tenths of a second.
const MOST_BOXES: usize = 100_000;

/// Signed distance from a surface with its derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foot {
    /// Signed distance, m; negative inside.
    pub distance: f64,
    /// Unit gradient.
    pub gradient: Vector3,
    /// Hessian (3, 3), 1/m.
    pub hessian: Matrix3,
    /// Triangle with the closest point.
    pub triangle: usize,
}

impl Surface {
    /// Signed distance with its derivatives: over a face the Hessian is zero, over an edge with the unit
    /// tangent `t` it is `(I - n n^T - t t^T) / d`, and over a corner `(I - n n^T) / d`. At edges and corners
    /// themselves the gradient is the pseudo-normal, and the infinite Hessian is left out.
    pub fn foot(&self, p: &Point3) -> Foot {
        let closest = self.tree.closest(p, f64::INFINITY).expect("a surface has triangles");
        let distance = self.signed(p, &closest);
        let triangle = closest.triangle as usize;
        let face = self.normals.faces[triangle];
        let pseudo = self.normal(&closest).try_normalize(0.0).unwrap_or(face);
        let [low, high] = self.bounds();
        let is_near = distance.abs() <= NEAR * (high - low).norm();
        if closest.feature == Feature::Face || pseudo.dot(&face) > 1.0 - FLAT || is_near {
            return Foot { distance, gradient: pseudo, hessian: Matrix3::zeros(), triangle };
        }
        let gradient = (p - closest.at) / distance;
        let mut across = Matrix3::identity() - gradient * gradient.transpose();
        if let Feature::Edge(edge) = closest.feature {
            let corners = self.corners(triangle);
            let tangent = (corners[(edge + 1) % 3] - corners[edge]).normalize();
            across -= tangent * tangent.transpose();
        }
        Foot { distance, gradient, hessian: across / distance, triangle }
    }

    /// Whether no edge is concave, to 1e-9 of the surface's size.
    pub fn is_convex(&self) -> bool {
        let [low, high] = self.bounds();
        let slack = NEAR * (high - low).norm();
        // An edge is convex if the corners of both triangles lie below the plane of its pseudo-normal.
        let is_below = |triangle: usize, edge: usize| {
            let corners = self.corners(triangle);
            let normal = self.normals.edges[triangle][edge].try_normalize(0.0);
            normal.is_none_or(|normal| normal.dot(&(corners[(edge + 2) % 3] - corners[edge])) <= slack)
        };
        (0..self.triangles.len()).all(|triangle| (0..3).all(|edge| is_below(triangle, edge)))
    }

    /// Depth of the innermost position (m), the radius of the largest ball inside, from 10 % below to exact.
    /// It is found by halving boxes: the distance changes at most as fast as the position. Of a thin sheet
    /// every position between both faces is nearly as deep, and the search ends at 100,000 boxes with the
    /// depth found until then, which is never too large.
    pub fn depth(&self) -> f64 {
        let [low, high] = self.bounds();
        let mut deepest: f64 = 0.0;
        let mut open = vec![(nalgebra::center(&low, &high), (high - low) * 0.5)];
        while (1..=MOST_BOXES).contains(&open.len()) {
            let depths: Vec<f64> = open.iter().map(|(middle, _)| -self.signed_distance(middle)).collect();
            deepest = depths.iter().copied().fold(deepest, f64::max);
            let may_be_deeper = |((_, half), depth): &(&(Point3, Vector3), &f64)| {
                *depth + half.norm() > (1.0 + DEPTH) * deepest
            };
            open = (open.iter().zip(&depths))
                .filter(may_be_deeper)
                .flat_map(|(&(middle, half), _)| {
                    let axis = half.imax();
                    let mut part = half;
                    part[axis] *= 0.5;
                    let mut step = Vector3::zeros();
                    step[axis] = part[axis];
                    [(middle - step, part), (middle + step, part)]
                })
                .collect();
        }
        deepest
    }
}
