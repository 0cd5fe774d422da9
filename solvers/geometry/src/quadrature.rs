//! Quadrature rules on the reference tetrahedron, triangle, cube and square.
//!
//! Simplex rules are fully symmetric, so that an integral does not depend on the order in which a cell lists its
//! corners; all weights are positive and all points lie strictly inside. Cube and square rules are tensor products
//! of Gauss-Legendre. Weights sum to the measure of the reference cell.

mod divided;
mod gauss;
mod simplex;

pub use divided::Parts;
pub use gauss::{gauss_legendre, hex, quad};
pub use simplex::{TET_RULES, TRI_RULES, tet, tri};

/// Points and weights on a reference cell of dimension `D`.
#[derive(Clone, Debug, PartialEq)]
pub struct Rule<const D: usize> {
    /// Positions in reference coordinates: unit simplex (first `D` of the barycentric coordinates belonging to
    /// corners 1, 2, ..) or `[-1, 1]^D`.
    pub points: Vec<[f64; D]>,
    /// One weight per point; they sum to the reference measure (tetrahedron 1/6, triangle 1/2, cube 8, square 4).
    pub weights: Vec<f64>,
}

impl<const D: usize> Rule<D> {
    /// Number of points.
    pub fn len(&self) -> usize {
        self.weights.len()
    }

    /// True without points.
    pub fn is_empty(&self) -> bool {
        self.weights.is_empty()
    }
}
