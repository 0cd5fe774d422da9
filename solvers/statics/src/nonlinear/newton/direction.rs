//! The step of an iteration.

use algebra::{Factorization, Unsymmetric};

use super::modal::Modal;
use crate::nonlinear::system::Skew;

/// A tangent ready to be solved, over the free unknowns and the displacements of the tools that have a
/// border.
pub(super) enum Factored {
    /// The assembled tangent, iterated, with its skew part.
    Iterated(Skew),
    Symmetric(Factorization),
    Unsymmetric(Unsymmetric),
    /// The tangent of the coefficients of a few modes.
    Modal(Modal),
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
            Factored::Symmetric(_) | Factored::Iterated(_) | Factored::Modal(_) => true,
            Factored::Unsymmetric(f) => f.stable(),
        }
    }

    /// Whether a factor in single precision proves the tangent to be definite.
    pub fn is_clear(&self) -> bool {
        matches!(self, Factored::Unsymmetric(f) if f.is_clear())
    }
}
