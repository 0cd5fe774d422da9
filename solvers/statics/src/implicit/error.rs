//! What can end a solution in time.

use crate::{SolveError, StaticError};

/// Why a solution in time cannot start or ended early.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TimeError {
    /// The problem itself, or the equilibrium of a step.
    #[error(transparent)]
    Static(#[from] StaticError),
    /// A parameter that is not usable.
    #[error("{what} is {value}; {need}")]
    Parameter {
        /// Which one.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What it should be.
        need: &'static str,
    },
    /// A node without mass, or with a negative one.
    #[error("node {node} has the mass {mass:.3e} kg; it must be positive")]
    NodalMass {
        /// The node.
        node: usize,
        /// Its entry on the diagonal of the mass matrix, kg.
        mass: f64,
    },
    /// The mass matrix cannot be inverted for the accelerations at the start: too few integration points.
    #[error(
        "no accelerations at the start: relative residual {residual:.1e} after {iterations} iterations with the mass \
         matrix; a mass table with more points per node is needed"
    )]
    SingularMass {
        /// Iterations of conjugate gradients.
        iterations: usize,
        /// Residual reached.
        residual: f64,
    },
    /// A step differs from a more exact one by more than what is allowed.
    #[error("local error {error:.2e} m of the step, allowed {allowed:.2e} m")]
    Inaccurate {
        /// Estimate, m.
        error: f64,
        /// Limit, m.
        allowed: f64,
    },
    /// Steps were cut back to nothing.
    #[error("stopped at {time:.6e} s: a step of {step:.1e} s failed too ({cause})")]
    Stalled {
        /// Time reached, s.
        time: f64,
        /// Step that failed, s.
        step: f64,
        /// Why the last trial failed.
        cause: Box<TimeError>,
    },
}

impl From<SolveError> for TimeError {
    fn from(error: SolveError) -> TimeError {
        TimeError::Static(error.into())
    }
}
