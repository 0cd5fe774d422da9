//! What can end a nonlinear solution.

use algebra::AlgebraError;
use contact::ContactError;
use shape::Point3;

use crate::SolveError;

/// A point turned inside out.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("quadrature point {point} is inverted: J = {det:.3e}")]
pub struct Inverted {
    /// Quadrature point.
    pub point: usize,
    /// Its `J = det F`.
    pub det: f64,
}

/// Where the residual of a failed step is largest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Worst {
    /// Node.
    pub node: usize,
    /// Its reference position, m.
    pub at: Point3,
    /// Force out of balance there, N.
    pub force: f64,
}

impl From<AlgebraError> for StaticError {
    fn from(error: AlgebraError) -> StaticError {
        StaticError::Solve(error.into())
    }
}

/// Why a static solution ended before its time.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StaticError {
    /// The problem itself, or a linear system of it.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// Contact with a tool has no meaning.
    #[error("tool[{tool}]: {cause}")]
    Contact {
        /// Its index.
        tool: usize,
        /// Why.
        cause: ContactError,
    },
    /// An inverted point.
    #[error(transparent)]
    Inverted(#[from] Inverted),
    /// No dilation gives the pressure asked for at a point (mixed method).
    #[error("no volume change gives the pressure {pressure:.3e} Pa at quadrature point {point}")]
    NoDilation {
        /// Quadrature point.
        point: usize,
        /// Pressure, Pa.
        pressure: f64,
    },
    /// No shift of the diagonal makes a tangent definite on the way.
    #[error(
        "the body is unstable here: its tangent is not positive definite, not even with the diagonal doubled, and \
         shows no way down to a stable equilibrium"
    )]
    Unstable,
    /// Newton's method did not converge.
    #[error(
        "no equilibrium after {iterations} iterations: relative residual {residual:.2e} (limit {tolerance:.0e}), \
         largest at node {} near ({:.4}, {:.4}, {:.4}) m with {:.2e} N; smallest J {smallest:.3} at quadrature \
         point {smallest_at}",
        worst.node, worst.at.x, worst.at.y, worst.at.z, worst.force
    )]
    NotConverged {
        /// Iterations done.
        iterations: usize,
        /// Relative residual reached.
        residual: f64,
        /// Limit asked for.
        tolerance: f64,
        /// Where it is largest.
        worst: Worst,
        /// Smallest J of all points.
        smallest: f64,
        /// The point with the smallest J.
        smallest_at: usize,
    },
    /// Load steps were cut back to nothing.
    #[error("stopped at {time:.4} of the load: a step of {step:.1e} failed too ({cause})")]
    Stalled {
        /// Part of the load that was carried, 0 to 1.
        time: f64,
        /// Step that failed, part of the load.
        step: f64,
        /// Why the last trial failed.
        cause: Box<StaticError>,
    },
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
}

impl StaticError {
    /// The step below which cutting back is given up after this: `smallest`, where a tool went too deep or all the way through no
    /// more than `shortest`, and none is short enough where it stands in the body without a force.
    pub(crate) fn finest(&self, smallest: f64, shortest: f64) -> f64 {
        match self {
            StaticError::Contact { cause: ContactError::Overlap { .. }, .. } => f64::INFINITY,
            StaticError::Contact { cause, .. } if cause.is_too_far() => smallest.min(shortest),
            _ => smallest,
        }
    }
}
