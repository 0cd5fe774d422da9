//! Errors of commands: their messages and exit codes.

use std::fmt::Display;
use std::io::ErrorKind::InvalidInput;
use std::path::Path;

use cases::scene::{ErrorKind, SceneError};
use records::RecordError;
use reports::ReportError;

use crate::error::Failure;

/// Error of an invalid input.
pub(super) fn input(error: impl Display) -> Failure {
    Failure::Input(error.to_string())
}

/// Refuses an output that is one of the input files.
pub(super) fn spare(out: &Path) -> Result<(), Failure> {
    disk::spare(out).map_err(|bad| input(format!("{}: {bad}", out.display())))
}

/// Prints a failure and returns the exit code.
pub(super) fn fail(failure: &Failure) -> u8 {
    eprintln!("tissuebench: {failure}");
    failure.exit_code()
}

/// Prints the errors of an input file. Returns 2, or 3 if the file only uses features not available yet.
pub(super) fn refuse(errors: &[SceneError]) -> u8 {
    for error in errors {
        eprintln!("{error}");
    }
    if errors.iter().all(|e| e.kind == ErrorKind::NotAvailable) { 3 } else { 2 }
}

/// Prints why results could not be read or written, and returns the exit code.
pub(super) fn unreported(bad: impl Into<ReportError>) -> u8 {
    let bad = bad.into();
    eprintln!("tissuebench: {bad}");
    match &bad {
        // The output is an input, or not a regular file.
        ReportError::Records(RecordError::Unwritten { source, .. }) if source.kind() == InvalidInput => 2,
        ReportError::Records(RecordError::Incomplete { .. } | RecordError::Unwritten { .. }) => 5,
        _ => 2,
    }
}
