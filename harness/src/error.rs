//! Errors of a run: the scene key each refers to and the exit code each means.

use cases::scene::{ErrorKind, Scene, SceneError};

/// Reason why a run stopped.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Failure {
    /// Error at one key of a scene; prints as `file:line: key 'path': 'found' problem; help`.
    #[error("{0}")]
    Scene(Box<SceneError>),
    /// Error in a part of the scene whose file and line are not looked up yet.
    #[error("{}", .0.problem)]
    At(Box<Finding>),
    /// Invalid input that is not part of a scene.
    #[error("{0}")]
    Input(String),
    /// Failure to build the tables of a cloud.
    #[error(transparent)]
    Efg(Box<efg::EfgError>),
    /// Failed assembly or solution.
    #[error(transparent)]
    Solve(Box<statics::SolveError>),
    /// Static procedure that reached no load.
    #[error(transparent)]
    Static(Box<statics::StaticError>),
    /// Explicit dynamics that could not start or continue.
    #[error(transparent)]
    Explicit(Box<explicit::ExplicitError>),
    /// Implicit dynamics that could not start or continue.
    #[error(transparent)]
    InTime(Box<statics::TimeError>),
    /// Method that could not run or did not converge.
    #[error("{0}")]
    Run(String),
    /// External solver that returned no numbers.
    #[error("{0}")]
    Foreign(Box<Foreign>),
}

/// Result of a run of an external solver that returned no numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForeignStatus {
    /// The solver reported that it does not accept the problem.
    Refused,
    /// The solver found no equilibrium.
    Stalled,
    /// The solver crashed, exceeded its memory limit, or returned an invalid answer.
    Failed,
    /// The solver exceeded its time limit.
    TimedOut,
    /// The adapter lacks a feature of the problem, or the solver is not installed.
    NotOffered,
    /// The answer belongs to another problem.
    Stale,
}

impl ForeignStatus {
    /// Returns the word used in records and tables.
    pub fn name(self) -> &'static str {
        match self {
            ForeignStatus::Refused => "refused",
            ForeignStatus::Stalled => "stalled",
            ForeignStatus::Failed => "failed",
            ForeignStatus::TimedOut => "timed-out",
            ForeignStatus::NotOffered => "not-offered",
            ForeignStatus::Stale => "stale",
        }
    }
}

/// Reason why an external solver returned no numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Foreign {
    /// Status of the run.
    pub status: ForeignStatus,
    /// Reason in words.
    pub reason: String,
    /// The same reason as an error at its key of the scene.
    pub(crate) at: Option<Box<SceneError>>,
}

impl Foreign {
    pub(crate) fn new(status: ForeignStatus, reason: impl Into<String>) -> Foreign {
        Foreign { status, reason: reason.into(), at: None }
    }
}

impl std::fmt::Display for Foreign {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match &self.at {
            Some(error) => error.fmt(f),
            None => f.write_str(&self.reason),
        }
    }
}

impl From<Foreign> for Failure {
    fn from(foreign: Foreign) -> Failure {
        Failure::Foreign(Box::new(foreign))
    }
}

/// A failure in a known part of the scene, before its file and line are looked up.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Kind of the error, from which its exit code follows.
    pub kind: ErrorKind,
    /// Part of the scene that the error concerns.
    pub key: Key,
    /// The problem in words.
    pub problem: String,
    /// The remedy in words.
    pub help: Option<String>,
}

/// A part of a scene, named by code that knows neither the scene nor the method's index in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Key {
    /// A key of the scene, such as `support[0].where`.
    Scene(String),
    /// A key below the method; empty for the method itself.
    Method(&'static str),
    /// A key below the size of the mesh or cloud; empty for the size itself.
    Size(&'static str),
    /// A key below the size of the background cells; empty for the size itself.
    Background(&'static str),
}

impl Failure {
    /// Returns an invalid-input error at `key`.
    pub fn input(key: Key, problem: impl Into<String>, help: &str) -> Failure {
        Failure::at(ErrorKind::Invalid, key, problem, help)
    }

    /// Returns an error for valid input that is not supported yet.
    pub fn unavailable(key: Key, problem: impl Into<String>, help: &str) -> Failure {
        Failure::at(ErrorKind::NotAvailable, key, problem, help)
    }

    pub(crate) fn at(kind: ErrorKind, key: Key, problem: impl Into<String>, help: &str) -> Failure {
        let help = (!help.is_empty()).then(|| help.to_string());
        Failure::At(Box::new(Finding { kind, key, problem: problem.into(), help }))
    }

    /// Returns the location of the error in the scene as `file:line`; empty if unknown.
    pub(crate) fn place(&self) -> String {
        let error = match self {
            Failure::Scene(error) => Some(error),
            Failure::Foreign(foreign) => foreign.at.as_ref(),
            _ => None,
        };
        error.map_or(String::new(), |error| format!("{}:{}", error.file, error.line))
    }

    /// Returns an error of `kind` at `key` of `scene`.
    pub(crate) fn of_scene(scene: &Scene, kind: ErrorKind, key: &str, problem: &str, help: &str) -> Failure {
        let help = (!help.is_empty()).then_some(help);
        Failure::Scene(Box::new(scene.error(kind, key, problem, help)))
    }

    /// Moves an error at the size of the method to the size of the background cells.
    pub(crate) fn of_background(mut self) -> Failure {
        if let Failure::At(finding) = &mut self
            && let Key::Size(below) = finding.key
        {
            finding.key = Key::Background(below);
        }
        self
    }

    fn kind(&self) -> ErrorKind {
        match self {
            Failure::Scene(error) => error.kind,
            Failure::At(finding) => finding.kind,
            Failure::Input(_) => ErrorKind::Invalid,
            Failure::Foreign(foreign) if foreign.status == ForeignStatus::NotOffered => {
                ErrorKind::NotAvailable
            }
            Failure::Foreign(_)
            | Failure::Efg(_)
            | Failure::Solve(_)
            | Failure::Static(_)
            | Failure::Explicit(_)
            | Failure::InTime(_)
            | Failure::Run(_) => ErrorKind::NotRun,
        }
    }

    /// Returns the exit code of a program that stops with this failure.
    pub fn exit_code(&self) -> u8 {
        match self.kind() {
            ErrorKind::Invalid => 2,
            ErrorKind::NotAvailable | ErrorKind::NotRun => 3,
        }
    }

    /// Returns the status of a run that this failure ended early; its results up to that point are kept.
    pub fn early_status(&self) -> &'static str {
        use explicit::ExplicitError::{ContactAt, Inverted, InvertedAt, LightTool, NotFinite, StepTooLarge};
        let Failure::Explicit(error) = self else { return "stalled" };
        match **error {
            Inverted(_) | InvertedAt { .. } => "inverted",
            StepTooLarge { .. } => "step-too-large",
            NotFinite { .. } => "not-finite",
            ContactAt { .. } | LightTool { .. } => "contact-lost",
            _ => "stalled",
        }
    }

    /// Returns the status of a run that ended with this failure, for its JSON object.
    pub fn status(&self) -> &'static str {
        if let Failure::Foreign(foreign) = self {
            return foreign.status.name();
        }
        match self.kind() {
            ErrorKind::Invalid => "bad-input",
            ErrorKind::NotAvailable => "not-available",
            ErrorKind::NotRun => "could-not-run",
        }
    }
}

impl From<efg::EfgError> for Failure {
    fn from(error: efg::EfgError) -> Failure {
        Failure::Efg(Box::new(error))
    }
}

impl From<statics::SolveError> for Failure {
    fn from(error: statics::SolveError) -> Failure {
        Failure::Solve(Box::new(error))
    }
}

impl From<statics::StaticError> for Failure {
    fn from(error: statics::StaticError) -> Failure {
        Failure::Static(Box::new(error))
    }
}

impl From<explicit::ExplicitError> for Failure {
    fn from(error: explicit::ExplicitError) -> Failure {
        Failure::Explicit(Box::new(error))
    }
}

impl From<statics::TimeError> for Failure {
    fn from(error: statics::TimeError) -> Failure {
        match error {
            statics::TimeError::Static(error) => error.into(),
            error => Failure::InTime(Box::new(error)),
        }
    }
}

impl From<shape::SourceError> for Failure {
    fn from(error: shape::SourceError) -> Failure {
        match error.downcast::<efg::EfgError>() {
            Ok(error) => Failure::Efg(error),
            Err(other) => Failure::Run(other.to_string()),
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

run_failures!(fem::FemError, shape::ShapeError);

impl From<interp::InterpError> for Failure {
    fn from(error: interp::InterpError) -> Failure {
        let key = Key::Scene("output.transfer".into());
        Failure::at(ErrorKind::NotRun, key, format!("can't be made: {error}"), "")
    }
}
