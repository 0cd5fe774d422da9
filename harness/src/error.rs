//! Why a run gave no numbers, which key of the scene that is about, and which exit code it means.

use cases::scene::{ErrorKind, Scene, SceneError};

/// What stopped a run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Failure {
    /// At one key of a scene; prints as `file:line: key 'path': 'found' problem; help`.
    #[error("{0}")]
    Scene(Box<SceneError>),
    /// Known to be about a part of the scene whose file and line are still to be looked up.
    #[error("{}", .0.problem)]
    At(Box<Finding>),
    /// Input that is no scene makes no sense.
    #[error("{0}")]
    Input(String),
    /// Tables of a cloud could not be made.
    #[error(transparent)]
    Efg(#[from] efg::EfgError),
    /// Assembly or solution failed.
    #[error(transparent)]
    Solve(#[from] statics::SolveError),
    /// A static procedure reached no load.
    #[error(transparent)]
    Static(Box<statics::StaticError>),
    /// Explicit dynamics could not start or go on.
    #[error(transparent)]
    Explicit(Box<explicit::ExplicitError>),
    /// Implicit dynamics could not start or go on.
    #[error(transparent)]
    InTime(Box<statics::TimeError>),
    /// The method could not run or did not converge.
    #[error("{0}")]
    Run(String),
    /// A solver outside this program gave no numbers.
    #[error("{0}")]
    Foreign(Box<Foreign>),
}

/// What became of a run of a solver outside this program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForeignStatus {
    /// It does not take the problem, and says so itself.
    Refused,
    /// It found no equilibrium.
    Stalled,
    /// It broke, or what it answers is no answer.
    Failed,
    /// It took longer than it may.
    TimedOut,
    /// The problem asks for what its adapter does not offer, or it is not installed here.
    NotOffered,
    /// Its answer is of another problem.
    Stale,
}

impl ForeignStatus {
    /// The word in records and tables.
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

/// Why a solver outside this program gave no numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Foreign {
    /// What became of it.
    pub status: ForeignStatus,
    /// Why.
    pub reason: String,
    /// The same at the key of the scene that it is about.
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

/// A failure that knows its part of the scene, not yet the place in the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Whose fault it is: what exit code it means.
    pub kind: ErrorKind,
    /// The part of the scene.
    pub key: Key,
    /// What is wrong.
    pub problem: String,
    /// What would be right.
    pub help: Option<String>,
}

/// A part of a scene as code sees it that knows neither the scene nor the method's place in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Key {
    /// A key of the scene, such as `support[0].where`.
    Scene(String),
    /// A key below the method; the method itself if empty.
    Method(&'static str),
    /// A key below the size that mesh or cloud were made in; the size itself if empty.
    Size(&'static str),
    /// A key below the size of the background cells.
    Background(&'static str),
}

impl Failure {
    /// Input that makes no sense at a key.
    pub fn input(key: Key, problem: impl Into<String>, help: &str) -> Failure {
        Failure::at(ErrorKind::Invalid, key, problem, help)
    }

    /// Sound input that can't be had yet.
    pub fn unavailable(key: Key, problem: impl Into<String>, help: &str) -> Failure {
        Failure::at(ErrorKind::NotAvailable, key, problem, help)
    }

    pub(crate) fn at(kind: ErrorKind, key: Key, problem: impl Into<String>, help: &str) -> Failure {
        let help = (!help.is_empty()).then(|| help.to_string());
        Failure::At(Box::new(Finding { kind, key, problem: problem.into(), help }))
    }

    /// Place of the key that it is about, `file:line`; empty where none is known.
    pub(crate) fn place(&self) -> String {
        let error = match self {
            Failure::Scene(error) => Some(error),
            Failure::Foreign(foreign) => foreign.at.as_ref(),
            _ => None,
        };
        error.map_or(String::new(), |error| format!("{}:{}", error.file, error.line))
    }

    /// Bad input at a key of a scene.
    pub(crate) fn of_scene(scene: &Scene, kind: ErrorKind, key: &str, problem: &str, help: &str) -> Failure {
        let help = (!help.is_empty()).then_some(help);
        Failure::Scene(Box::new(scene.error(kind, key, problem, help)))
    }

    /// The same failure of the background cells' size where it was of a size.
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

    /// The exit code of a program that met this.
    pub fn exit_code(&self) -> u8 {
        match self.kind() {
            ErrorKind::Invalid => 2,
            ErrorKind::NotAvailable | ErrorKind::NotRun => 3,
        }
    }

    /// The status of a run that this ended early, its numbers kept up to there.
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

    /// The status of a run that ended with this, in its JSON object.
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
            Ok(error) => Failure::Efg(*error),
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
