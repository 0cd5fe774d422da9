//! Errors in writing, reading and comparing records.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// Reason for which records could not be written, read or compared.
#[derive(Debug, Error)]
pub enum RecordError {
    /// A folder without results.
    #[error("{path} holds no results (no provenance.json); write results with `tissuebench run SCENE --out {path}` or \
             `tissuebench verify --out {path}`", path = .0.display())]
    NoResults(PathBuf),
    /// A folder whose study or run was started but has not finished.
    #[error("{path} is incomplete: some results of {of} are missing; repeat the run, or continue a study with --resume", path = .path.display())]
    Incomplete {
        /// The folder.
        path: PathBuf,
        /// File name of the study or scene.
        of: String,
    },
    /// Results without records.
    #[error("{} holds no records: there is nothing to {to}", path.display())]
    Nothing {
        /// The folder.
        path: PathBuf,
        /// Requested action.
        to: &'static str,
    },
    /// A record with a number that is not finite.
    #[error("{case}, {method}: {field} of {quantity} is {value}, which is not a finite number")]
    NotFinite {
        /// Case of the record.
        case: String,
        /// Method of the record.
        method: String,
        /// Quantity of the record.
        quantity: String,
        /// Field of the record.
        field: &'static str,
        /// Value of the field.
        value: f64,
    },
    /// Two records of one run with the same quantity, phase, step, mode, statistic and repeat.
    #[error("{case}, {method}: {quantity} was recorded twice in run {run}")]
    Twice {
        /// Case of the record.
        case: String,
        /// Method of the record.
        method: String,
        /// Quantity of the record.
        quantity: String,
        /// Id of the run.
        run: String,
    },
    /// Inconsistent arrays of a surface field.
    #[error("surface field of {case}, {method}: {reason}")]
    Field {
        /// Case of the field.
        case: String,
        /// Method of the field.
        method: String,
        /// Description of the inconsistency.
        reason: String,
    },
    /// A file or folder that could not be written.
    #[error("{} can't be written: {source}", path.display())]
    Unwritten {
        /// The file or folder.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// A file or folder that could not be read.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// A file with invalid content.
    #[error("{}: {reason}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// Description of the problem.
        reason: String,
    },
    /// A data frame that could not be created or written.
    #[error("records: {0}")]
    Frame(#[from] polars::error::PolarsError),
}

/// Error of a file or folder that could not be written.
pub(crate) fn unwritten(path: &Path, source: io::Error) -> RecordError {
    RecordError::Unwritten { path: path.into(), source }
}
