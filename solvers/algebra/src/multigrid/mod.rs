//! Conjugate gradients with a multigrid preconditioner: smoothed aggregation with the six rigid motions.
//!
//! The finest level has blocks of 3 x 3. The nodes of the other levels are aggregates that move as rigid
//! bodies, with blocks of 6 x 6. The first coarse level of a quadratic mesh is its linear mesh ([`Coarser`]).
//! Each level is smoothed by forward and backward sweeps of block Gauss-Seidel in chunks. The coarsest level
//! is solved directly. The hierarchy is stored in single precision, but its coarse matrices are computed in
//! double precision. The iteration and its residual are in double precision.
//!
//! Nearly incompressible stiffnesses are split: see [`pressure`].
//!
//! Source: Vanek, Mandel and Brezina 1996, Computing 56, 179.

mod aggregate;
mod coarsest;
mod conjugate;
mod galerkin;
mod graph;
mod hierarchy;
mod level;
mod lower_triangle;
mod operator;
mod patch;
mod pressure;
mod row_sets;
mod sweep;
mod tangents;
#[cfg(test)]
mod tests;
mod transfer;

use shape::{Coarser, Point3, Vector3};

use crate::error::AlgebraError;
use crate::linear_solver::{FactorError, SolverPath};
use crate::stiffness::Stiffness;
use hierarchy::Hierarchy;
use level::Cycle;
use pressure::Pressures;

pub use conjugate::Iterations;
pub use pressure::PressureGroup;
pub use tangents::TangentLevels;

/// Multigrid hierarchy of a stiffness, for any number of right-hand sides.
pub struct Multigrid {
    hierarchy: Hierarchy,
    /// Pressures, and the stiffness from which the hierarchy was built.
    pressures: Option<Box<(Pressures, Stiffness)>>,
    /// Largest number of iterations with pressures.
    most: usize,
}

/// Largest number of iterations with pressures, if no other is given.
const MOST: usize = 2_000;

fn path(with_pressures: bool) -> SolverPath {
    if with_pressures { SolverPath::MultigridPressures } else { SolverPath::Multigrid }
}

impl Multigrid {
    /// Builds the hierarchy of a positive definite stiffness.
    ///
    /// `nodes` are the node positions, m. `held` marks the constrained degrees of freedom `3 node + axis`.
    /// `linear` is the linear mesh of the next level, for quadratic elements. `patch` lists the nodes on weak
    /// supports, ascending.
    ///
    /// # Errors
    ///
    /// [`FactorError`] if the coarsest matrix cannot be factored.
    pub fn new(
        stiffness: &Stiffness,
        nodes: &[Point3],
        held: Vec<bool>,
        linear: Option<&Coarser>,
        patch: &[u32],
    ) -> Result<Multigrid, FactorError> {
        let hierarchy = Hierarchy::new(stiffness, nodes, held, linear, patch)?;
        Ok(Multigrid { hierarchy, pressures: None, most: MOST })
    }

    /// Limits the iterations with pressures: they are given up as soon as their rate shows that they need
    /// more than `most`.
    pub fn at_most(self, most: usize) -> Multigrid {
        Multigrid { most, ..self }
    }

    /// Adds pressures as unknowns, for a nearly incompressible stiffness.
    ///
    /// `without` is the stiffness from which the hierarchy was built. The stiffness to be solved adds
    /// `excess / volume row row^T` for every group. The pressures of the groups are iterated with the
    /// displacements.
    pub fn with_pressures(self, without: Stiffness, groups: &[PressureGroup]) -> Multigrid {
        let pressures = Pressures::new(groups, &self.hierarchy.held);
        Multigrid { pressures: Some(Box::new((pressures, without))), ..self }
    }

    /// Returns the solver path under which a solution is recorded.
    pub fn path(&self) -> SolverPath {
        path(self.pressures.is_some())
    }

    /// Number of unknowns.
    pub fn dim(&self) -> usize {
        self.hierarchy.free
    }

    /// Degrees of freedom and matrix entries of each level, finest first.
    pub fn levels(&self) -> &[(usize, usize)] {
        &self.hierarchy.levels
    }

    /// Operator complexity: matrix entries of all levels over those of the finest.
    pub fn complexity(&self) -> f64 {
        self.levels().iter().map(|level| level.1 as f64).sum::<f64>() / self.levels()[0].1 as f64
    }

    /// Whether the nodes on weak supports are solved together. Residuals are then relative to the forces in
    /// the body; otherwise also to the far larger forces by which a penalty moves a support.
    pub fn has_patch(&self) -> bool {
        self.hierarchy.finest.has_patch()
    }

    /// Solves `K x = b` in place, to a relative residual of `tolerance` ([`Iterations::residual`]) or to one
    /// of rounding. Entries of `b` at constrained degrees of freedom are ignored. With pressures
    /// ([`Multigrid::with_pressures`]), these and the displacements are iterated together.
    ///
    /// A W-cycle computes a residual on a coarse level from a solution there. If the softest motions have
    /// 1e-8 of the stiffness, as in a slender beam, this residual is all rounding in single precision, and
    /// the cycle is not positive. The solve is then repeated with V-cycles.
    ///
    /// # Errors
    ///
    /// [`AlgebraError::Residual`] if the iteration does not reach the tolerance.
    pub fn solve(
        &self,
        stiffness: &Stiffness,
        b: &mut [Vector3],
        tolerance: f64,
    ) -> Result<Iterations, AlgebraError> {
        // Runs on a thread of the pool: called from outside, each of an iteration's loops would have to wake
        // a thread.
        rayon::scope(|_| match &self.pressures {
            Some(both) => {
                let (pressures, without) = &**both;
                self.hierarchy.release(b);
                pressures.solve(&self.hierarchy, (without, stiffness), b, (tolerance, self.most))
            }
            None => self
                .hierarchy
                .iterate(stiffness, b, tolerance, Cycle::W)
                .or_else(|_| self.hierarchy.iterate(stiffness, b, tolerance, Cycle::V)),
        })
    }
}
