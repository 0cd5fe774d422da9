//! What can go wrong between records and a report.

use std::path::PathBuf;

use thiserror::Error;

/// Why records couldn't be written, read or rendered.
#[derive(Debug, Error)]
pub enum ReportError {
    /// A folder without results.
    #[error("{path} holds no results (no provenance.json); `tissuebench run SCENE --out {path}` or `tissuebench verify --out {path}` writes some", path = .0.display())]
    NoResults(PathBuf),
    /// A folder whose study or run was begun and has not ended.
    #[error("{path} is incomplete: the results of {of} were begun there and are not all written; run it again, a study with --resume to keep what is finished", path = .path.display())]
    Incomplete {
        /// The folder.
        path: PathBuf,
        /// Name of the study's or scene's file.
        of: String,
    },
    /// Results without a number.
    #[error("{} holds no records: there is nothing to {to}", path.display())]
    Nothing {
        /// The folder.
        path: PathBuf,
        /// The action that was asked for.
        to: &'static str,
    },
    /// A record holds a number that isn't finite.
    #[error("{case}, {method}: {field} of {quantity} is {value}, which isn't a finite number")]
    NotFinite {
        /// Case of the record.
        case: String,
        /// Method of the record.
        method: String,
        /// Quantity of the record.
        quantity: String,
        /// Which number of the record.
        field: &'static str,
        /// The number.
        value: f64,
    },
    /// Two records of one run are of the same quantity, phase, step, mode, statistic and repeat.
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
    /// A surface field's arrays don't fit together.
    #[error("surface field of {case}, {method}: {reason}")]
    Field {
        /// Case of the field.
        case: String,
        /// Method of the field.
        method: String,
        /// What doesn't fit.
        reason: String,
    },
    /// A file or folder couldn't be written.
    #[error("{} can't be written: {source}", path.display())]
    Unwritten {
        /// The file or folder.
        path: PathBuf,
        /// The system's answer.
        source: std::io::Error,
    },
    /// A file or folder couldn't be read.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The system's answer.
        source: std::io::Error,
    },
    /// A file's content isn't what it should be.
    #[error("{}: {reason}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// A figure couldn't be drawn.
    #[error("figure {name}: {reason}")]
    Figure {
        /// Name of the figure.
        name: String,
        /// What went wrong.
        reason: String,
    },
    /// The report page couldn't be filled in.
    #[error("report page: {0}")]
    Page(#[from] serde_json::Error),
}
