//! Errors of implicit dynamics.

use crate::error::SolveError;
use crate::nonlinear::StaticError;

/// Reason why implicit dynamics cannot start or ended early.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TimeError {
    /// An error of the problem itself or of the equilibrium of a step.
    #[error(transparent)]
    Static(#[from] StaticError),
    /// A parameter that is not usable.
    #[error("{what} is {value}; {need}")]
    Parameter {
        /// Name of the parameter.
        what: &'static str,
        /// Its value.
        value: f64,
        /// Requirement on the value.
        need: &'static str,
    },
    /// A node whose mass is zero or negative.
    #[error("node {node} has the mass {mass:.3e} kg; it must be positive")]
    NodalMass {
        /// The node.
        node: usize,
        /// Its entry on the diagonal of the mass matrix, kg.
        mass: f64,
    },
    /// The mass matrix cannot be inverted for the initial accelerations: there are too few integration
    /// points.
    #[error(
        "the initial accelerations did not converge: relative residual {residual:.1e} after {iterations} \
         iterations with the mass matrix; a mass table with more points per node is needed"
    )]
    SingularMass {
        /// Iterations of conjugate gradients.
        iterations: usize,
        /// Relative residual reached.
        residual: f64,
    },
    /// A step whose estimated local error exceeds the limit.
    #[error("the local error of the step is {error:.2e} m; at most {allowed:.2e} m is allowed")]
    Inaccurate {
        /// Estimate, m.
        error: f64,
        /// Limit, m.
        allowed: f64,
    },
    /// A step that failed at the smallest allowed length.
    #[error("stopped at {time:.6e} s: even a step of {step:.1e} s failed ({cause})")]
    Stalled {
        /// Time reached, s.
        time: f64,
        /// Step that failed, s.
        step: f64,
        /// Reason for the failure of the last trial.
        cause: Box<TimeError>,
    },
}

impl From<SolveError> for TimeError {
    fn from(error: SolveError) -> TimeError {
        TimeError::Static(error.into())
    }
}
