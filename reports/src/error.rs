//! Errors of rendering.

use records::RecordError;
use thiserror::Error;

/// Reason for which records could not be rendered.
#[derive(Debug, Error)]
pub enum ReportError {
    /// Records that could not be read or written.
    #[error(transparent)]
    Records(#[from] RecordError),
    /// A figure that could not be drawn.
    #[error("figure {name}: {reason}")]
    Figure {
        /// Name of the figure.
        name: String,
        /// Description of the problem.
        reason: String,
    },
    /// A report page that could not be filled in.
    #[error("report page: {0}")]
    Page(#[from] serde_json::Error),
}
