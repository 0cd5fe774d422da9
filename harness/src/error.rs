//! Why a run gave no numbers, and which exit code that is.

/// What stopped a run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Failure {
    /// The input asks for something that makes no sense: exit code 2.
    #[error("{0}")]
    Input(String),
    /// The input is sound but beyond what can run: exit code 3.
    #[error("{0}")]
    Unsupported(String),
    /// The method could not run or did not converge: exit code 3.
    #[error("{0}")]
    Run(String),
}

impl Failure {
    /// The exit code of a program that met this.
    pub fn exit_code(&self) -> u8 {
        match self {
            Failure::Input(_) => 2,
            Failure::Unsupported(_) | Failure::Run(_) => 3,
        }
    }
}

macro_rules! run_failures {
    ($($error:ty),*) => {$(
        impl From<$error> for Failure {
            fn from(error: $error) -> Failure {
                Failure::Run(error.to_string())
            }
        }
    )*};
}

run_failures!(
    fem::FemError,
    efg::EfgError,
    interp::InterpError,
    shape::ShapeError,
    mechanics::SolveError,
    geometry::MeshError,
    geometry::generate::GenerateError
);
