//! History of a study over commits: a summary of each result, and the steps that exceed noise.
//!
//! A history is a folder with one small file for each result added, `0007-1a2b3c4d5e6f.toml`. It contains the
//! errors, the repeats of the times, the program and the machine.

mod summary;
mod trend;

use std::path::{Path, PathBuf};

use records::{RecordError, RunSet};

pub use summary::{RunNumbers, Summary};
pub use trend::{ErrorStep, Point, Step, Trend};

use crate::error::ReportError;

/// Adds results to a history, with a label in addition to their commit. Returns the path of the new file.
///
/// # Errors
/// A folder that cannot be read or written.
pub fn add(history: &Path, set: &RunSet, label: &str) -> Result<PathBuf, ReportError> {
    let last = files(history)?.last().map_or(0, |(number, _)| *number);
    let commit: String = set.provenance.program.commit.chars().take(12).collect();
    let path = history.join(format!("{:04}-{commit}.toml", last + 1));
    std::fs::create_dir_all(history)
        .map_err(|source| RecordError::Unwritten { path: history.into(), source })?;
    Summary { label: label.into(), ..Summary::of(set) }.save(&path)?;
    Ok(path)
}

/// Returns a trend for each study on each machine of a history, in the order of their first results.
///
/// # Errors
/// A folder or a file that cannot be read.
pub fn trends(history: &Path) -> Result<Vec<Trend>, ReportError> {
    let read = files(history)?.into_iter().map(|(number, path)| Ok((number, Summary::load(&path)?)));
    Ok(trend::trends(read.collect::<Result<_, RecordError>>()?))
}

/// Checks that a folder contains a history.
///
/// # Errors
/// A folder without a history, or with a history that cannot be read.
pub fn check(history: &Path) -> Result<(), ReportError> {
    if !trends(history)?.is_empty() {
        return Ok(());
    }
    let reason = "the folder holds no history; `tissuebench history add` starts one".into();
    Err(RecordError::Content { path: history.into(), reason }.into())
}

/// Trends of a history for a report, beginning with those of the report's study.
pub(crate) fn shown(history: &Path, source: &str) -> Result<Vec<Trend>, ReportError> {
    check(history)?;
    let mut found = trends(history)?;
    found.sort_by_key(|trend| trend.source != source);
    Ok(found)
}

/// Files of a history with their numbers; empty for a folder that does not exist.
fn files(history: &Path) -> Result<Vec<(u32, PathBuf)>, ReportError> {
    let unread = |source| RecordError::Io { path: history.into(), source };
    if !history.exists() {
        return Ok(Vec::new());
    }
    let mut found = Vec::new();
    for entry in std::fs::read_dir(history).map_err(unread)? {
        let path = entry.map_err(unread)?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let number = name.split_once('-').and_then(|(number, _)| number.parse().ok());
        if let (Some(number), true) = (number, name.ends_with(".toml")) {
            found.push((number, path));
        }
    }
    // Two branches may have used the same number.
    found.sort();
    Ok(found)
}
