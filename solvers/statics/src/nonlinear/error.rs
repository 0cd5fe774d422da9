//! Errors that end a nonlinear solution.

use algebra::AlgebraError;
use contact::ContactError;
use shape::Point3;

use crate::error::SolveError;

/// An inverted quadrature point.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("quadrature point {point} is inverted: J = {det:.3e}")]
pub struct Inverted {
    /// Index of the quadrature point.
    pub point: usize,
    /// Value of `J = det F` at the point.
    pub det: f64,
}

/// Location of the largest residual of a failed step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Worst {
    /// Node.
    pub node: usize,
    /// Its reference position, m.
    pub at: Point3,
    /// Unbalanced force at the node, N.
    pub force: f64,
}

impl From<AlgebraError> for StaticError {
    fn from(error: AlgebraError) -> StaticError {
        StaticError::Solve(error.into())
    }
}

/// Reason why a static solution ended early.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StaticError {
    /// An error of the problem itself or of one of its linear systems.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// Contact with a tool that is not valid.
    #[error("tool[{tool}]: {cause}")]
    Contact {
        /// Index of the tool.
        tool: usize,
        /// Reason.
        cause: ContactError,
    },
    /// An inverted point.
    #[error(transparent)]
    Inverted(#[from] Inverted),
    /// A pressure that no dilation gives at a point (mixed method).
    #[error("no volume change gives the pressure {pressure:.3e} Pa at quadrature point {point}")]
    NoDilation {
        /// Quadrature point.
        point: usize,
        /// Pressure, Pa.
        pressure: f64,
    },
    /// A tangent that no tested shift of the diagonal makes definite.
    #[error(
        "the body is unstable at this step: the tangent is not positive definite, even with the diagonal \
         doubled, and gives no descent direction towards a stable equilibrium"
    )]
    Unstable,
    /// Newton's method did not converge.
    #[error(
        "no equilibrium after {iterations} iterations: relative residual {residual:.2e} (limit \
         {tolerance:.0e}), largest at node {} near {}: {:.2e} N; smallest J \
         {smallest:.3} at quadrature point {smallest_at}",
        worst.node, shape::position_alone(&worst.at), worst.force
    )]
    NotConverged {
        /// Iterations done.
        iterations: usize,
        /// Relative residual reached.
        residual: f64,
        /// Required relative residual.
        tolerance: f64,
        /// Location of the largest residual.
        worst: Worst,
        /// Smallest J of all points.
        smallest: f64,
        /// The point with the smallest J.
        smallest_at: usize,
    },
    /// A load step that failed at the smallest allowed length.
    #[error("stopped at {time:.4} of the load: even a step of {step:.1e} failed ({cause})")]
    Stalled {
        /// Applied load fraction reached, 0 to 1.
        time: f64,
        /// Length of the failed step as a load fraction.
        step: f64,
        /// Reason for the failure of the last trial.
        cause: Box<StaticError>,
    },
    /// Supports that act after a time do not hold the body.
    #[error("stopped at {time:.4} of the load, after which {cause}")]
    Loose {
        /// Applied load fraction reached, 0 to 1.
        time: f64,
        /// Motion that nothing prevents.
        cause: Box<StaticError>,
    },
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
}

impl StaticError {
    /// Returns the step below which cutting back is given up after this error. The result is `smallest` in
    /// general, at most `shortest` if a tool went too deep or through the body, and infinity if a tool
    /// overlaps the body without a force, because shorter steps do not help.
    pub(crate) fn finest(&self, smallest: f64, shortest: f64) -> f64 {
        match self {
            StaticError::Contact { cause: ContactError::Overlap { .. }, .. } => f64::INFINITY,
            StaticError::Contact { cause, .. } if cause.is_too_far() => smallest.min(shortest),
            _ => smallest,
        }
    }
}
