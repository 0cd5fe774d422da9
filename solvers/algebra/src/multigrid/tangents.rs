//! One hierarchy for a sequence of similar matrices, such as the tangents of Newton's method.

use shape::{Coarser, Point3, Vector3};

use super::conjugate::Iterations;
use super::hierarchy::Hierarchy;
use super::level::Cycle;
use super::pressure::{Inner, PressureGroup, Pressures};
use crate::linear_solver::{FactorError, SolverPath};
use crate::stiffness::Stiffness;

/// Relative residual to which [`TangentLevels::proves_definite`] iterates. A direction of negative curvature
/// keeps its part of an irregular right-hand side: about `1 / sqrt(n)`, 1e-3 for a million unknowns.
const PROVED: f64 = 1e-5;

/// Multigrid hierarchy of one tangent, which serves as the preconditioner of similar tangents.
pub struct TangentLevels {
    hierarchy: Hierarchy,
    pressures: Pressures,
}

impl TangentLevels {
    /// Builds the hierarchy of a positive definite matrix, with the arguments of
    /// [`Multigrid::new`](super::Multigrid::new).
    ///
    /// # Errors
    ///
    /// [`FactorError`] if the coarsest matrix cannot be factored.
    pub fn new(
        stiffness: &Stiffness,
        nodes: &[Point3],
        held: Vec<bool>,
        linear: Option<&Coarser>,
    ) -> Result<TangentLevels, FactorError> {
        let hierarchy = Hierarchy::new(stiffness, nodes, held, linear, &[])?;
        let pressures = Pressures::new(&[], &hierarchy.held);
        Ok(TangentLevels { hierarchy, pressures })
    }

    /// Returns the solver path under which a solution is recorded.
    pub fn path(&self) -> SolverPath {
        super::path(!self.pressures.is_empty())
    }

    /// Sets the pressures of the next tangent, which replace `excess / volume row row^T` of every group.
    pub fn set_pressures(&mut self, groups: &[PressureGroup]) {
        self.pressures = Pressures::new(groups, &self.hierarchy.held);
    }

    /// Solves `K x = b` in place by GCR, to a residual of `goal |b|`, or as far as `most` iterations lead.
    /// `product` computes the product with K without the terms of the pressures; this matrix may be
    /// unsymmetric. Entries of `b` at constrained degrees of freedom are ignored.
    ///
    /// Returns the number of iterations and whether the goal is reached.
    pub fn solve(
        &self,
        product: &(dyn Fn(&[Vector3], &mut [Vector3]) + Sync),
        b: &mut [Vector3],
        goal: f64,
        most: usize,
    ) -> (usize, bool) {
        self.hierarchy.release(b);
        let inner = Inner { hierarchy: &self.hierarchy, product, most };
        rayon::scope(|_| self.pressures.solve_roughly(&inner, b, goal))
    }

    /// Returns the number of conjugate-gradient iterations that prove a symmetric matrix positive definite;
    /// `None` if they do not.
    ///
    /// While no direction has negative curvature, all Ritz values are positive, and the residual polynomial,
    /// the product of `1 - lambda / ritz`, is at least one for a negative eigenvalue. The part of the
    /// right-hand side along its eigenvector therefore stays in the residual. If the residual falls below
    /// this part, there is no negative eigenvalue.
    pub fn proves_definite(&self, stiffness: &Stiffness) -> Option<usize> {
        // A fixed sequence without pattern: multiples of the golden ratio.
        let entry = |i: usize| (i as f64 * 0.618_033_988_749_895).fract() - 0.5;
        let nodes = stiffness.pattern().node_count();
        let mut b: Vec<Vector3> = (0..nodes).map(|i| Vector3::from_fn(|a, _| entry(3 * i + a))).collect();
        let proof = rayon::scope(|_| self.hierarchy.iterate(stiffness, &mut b, PROVED, Cycle::V));
        proof.ok().map(|Iterations { count, .. }| count)
    }
}
