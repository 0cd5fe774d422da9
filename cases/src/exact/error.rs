//! What makes an exact solution impossible to build.

use catalogue::Problem;

/// Constants that a solution refuses.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ExactError {
    /// A parameter outside of its range.
    #[error("'{name}' of {solution} is {value}; it must be {need}")]
    BadParameter {
        /// The solution.
        solution: &'static str,
        /// The parameter.
        name: &'static str,
        /// Its value, SI.
        value: f64,
        /// What would do.
        need: String,
    },
    /// A modulus or Poisson's ratio that no material has.
    #[error("'{what}' is {value}; it must be {need}")]
    Material {
        /// "young" or "poisson".
        what: &'static str,
        /// Its value.
        value: f64,
        /// What would do.
        need: &'static str,
    },
}

/// At the parameter that a scene gives.
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
