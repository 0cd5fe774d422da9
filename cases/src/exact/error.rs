//! Errors in constructing an exact solution.

use catalogue::Problem;

/// Error for constants that a solution does not accept.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ExactError {
    /// A parameter out of its range.
    #[error("'{name}' of {solution} is {value}; it must be {need}")]
    BadParameter {
        /// Name of the solution.
        solution: &'static str,
        /// Name of the parameter.
        name: &'static str,
        /// Value of the parameter, SI.
        value: f64,
        /// Valid values.
        need: String,
    },
    /// An impossible modulus or Poisson's ratio.
    #[error("'{what}' is {value}; it must be {need}")]
    Material {
        /// "young" or "poisson".
        what: &'static str,
        /// Value of the constant.
        value: f64,
        /// Valid values.
        need: &'static str,
    },
}

/// The problem at the parameter given by a scene.
impl From<ExactError> for Problem {
    fn from(bad: ExactError) -> Problem {
        match bad {
            ExactError::BadParameter { solution, name, need, .. } => {
                Problem::new(format!("does not go with {solution}"))
                    .help(format!("it must be {need}"))
                    .of(name)
            }
            ExactError::Material { .. } => Problem::new(format!("can't be built: {bad}")),
        }
    }
}
