//! Errors of factorisations and solves.

/// Reason why a system has no trustworthy solution.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum AlgebraError {
    /// A pivot is so small relative to its diagonal entry that the solution would be noise.
    #[error(
        "the stiffness matrix is numerically singular: smallest ratio of pivot to diagonal {ratio:e} (limit \
         {limit:e})"
    )]
    NearlySingular {
        /// Smallest ratio of pivot to diagonal entry.
        ratio: f64,
        /// Smallest admissible ratio.
        limit: f64,
    },
    /// The indefinite factorisation met a zero pivot, even with its regularisation.
    #[error("zero pivot in the factorisation of the system with constraint rows")]
    ZeroPivot,
    /// The solution does not satisfy its equations: constraints are dependent, contradictory or badly scaled.
    #[error("relative residual {residual:e} after the solve (limit {limit:e})")]
    Residual {
        /// Relative residual found.
        residual: f64,
        /// Largest admissible residual.
        limit: f64,
    },
    /// The solution does not even solve a nearby system: the constraints are dependent, contradictory or
    /// badly scaled.
    #[error(
        "the solution of the linear system is inaccurate: backward error {backward_error:e} (limit \
         {limit:e}), relative residual {residual:e}"
    )]
    BackwardError {
        /// Smallest relative change of matrix and right-hand side that makes the solution exact.
        backward_error: f64,
        /// Relative residual.
        residual: f64,
        /// Largest admissible backward error.
        limit: f64,
    },
    /// The matrix is so close to singular that rounding takes every digit.
    #[error(
        "the stiffness matrix is numerically singular: the solution has {digits:.1} correct digits (backward \
         error {backward_error:e})"
    )]
    NoDigits {
        /// Expected number of correct decimal digits.
        digits: f64,
        /// Smallest relative change of matrix and right-hand side that makes the solution exact.
        backward_error: f64,
    },
    /// The eigenvalue decomposition did not converge.
    #[error("the eigenvalues of {dofs} degrees of freedom did not converge")]
    NoEigenvalues {
        /// Number of degrees of freedom.
        dofs: usize,
    },
    /// The nested-dissection ordering failed.
    #[error("METIS could not order the matrix (status {status})")]
    Ordering {
        /// Status returned by METIS.
        status: i32,
    },
    /// Memory is exhausted, or the factor is too large to index.
    #[error("the matrix of {dofs} degrees of freedom is too large to factor: {why}")]
    TooLarge {
        /// Number of degrees of freedom.
        dofs: usize,
        /// Reason given by the library.
        why: String,
    },
}
