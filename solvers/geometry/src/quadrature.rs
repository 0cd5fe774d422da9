//! Quadrature rules on the reference tetrahedron, triangle, prism, cube and square.
//!
//! Simplex rules are fully symmetric, so that an integral does not depend on the order of a cell's corners.
//! All weights are positive, and all points lie strictly inside. Cube and square rules are tensor products of
//! Gauss-Legendre rules, prism rules are products of one with a triangle rule. Weights sum to the measure of
//! the reference cell.

mod divided;
mod gauss;
mod prism;
mod simplex;

pub use divided::Parts;
pub use gauss::{gauss_legendre, hex, quad};
pub use prism::{PRISM_RULES, prism};
pub use simplex::{TET_RULES, TRI_RULES, tet, tri};

/// Points and weights on a reference cell of dimension `D`.
#[derive(Clone, Debug, PartialEq)]
pub struct Rule<const D: usize> {
    /// Positions in reference coordinates: on the unit simplex (the barycentric coordinates of corners 1 to
    /// `D`) or in `[-1, 1]^D`.
    pub points: Vec<[f64; D]>,
    /// One weight per point. Their sum is the reference measure (tetrahedron 1/6, triangle 1/2, prism 1,
    /// cube 8, square 4).
    pub weights: Vec<f64>,
}

impl<const D: usize> Rule<D> {
    /// Number of points.
    pub fn len(&self) -> usize {
        self.weights.len()
    }

    /// Whether the rule has no points.
    pub fn is_empty(&self) -> bool {
        self.weights.is_empty()
    }
}
