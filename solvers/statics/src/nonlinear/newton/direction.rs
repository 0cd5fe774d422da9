//! The step of an iteration.

use algebra::{AlgebraError, Factorization, Unsymmetric};

/// A factored tangent over the free unknowns and the displacements of the tools that have a border.
pub(super) enum Factored {
    Symmetric(Factorization),
    Unsymmetric(Unsymmetric),
}

/// A Newton step with the factor that gave it.
pub(super) struct Direction {
    /// Increments of the free unknowns.
    pub step: Vec<f64>,
    /// Increments of the displacements of force-driven tools.
    pub closures: Vec<f64>,
    /// Whether the tangent was positive definite, force-driven tools included.
    pub definite: bool,
    /// Whether `definite` was found with a factor of this very tangent and beyond rounding.
    pub proven: bool,
    pub factored: Factored,
    /// Tools whose borders the factor contains.
    pub tools: Vec<usize>,
}

impl Factored {
    /// Whether force-driven tools leave the tangent definite, provided it is definite with these tools
    /// constrained.
    pub fn stable(&self) -> bool {
        match self {
            Factored::Symmetric(_) => true,
            Factored::Unsymmetric(f) => f.stable(),
        }
    }

    /// Whether a factor in single precision proves the tangent to be definite.
    pub fn is_clear(&self) -> bool {
        matches!(self, Factored::Unsymmetric(f) if f.is_clear())
    }

    /// Solves in place and returns the number of iterations.
    pub fn solve(&self, b: &mut [f64], goal: f64) -> Result<usize, AlgebraError> {
        match self {
            Factored::Symmetric(f) => f.solve(b).map(|_| 0),
            Factored::Unsymmetric(f) => f.solve(b, goal),
        }
    }
}
