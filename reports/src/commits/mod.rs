//! A study over commits: what is kept of each of its results, and which steps from one to the next are outside of noise.
//!
//! A history is a folder with one small file for each results that were added, `0007-1a2b3c4d5e6f.toml`: their errors, the repeats of
//! their times, the program and the machine.

mod summary;
mod trend;

use std::path::{Path, PathBuf};

pub use summary::{RunNumbers, Summary};
pub use trend::{ErrorStep, Point, Step, Trend};

use crate::error::ReportError;
use crate::figures::{OVER_COMMITS as TITLE, over_commits};
use crate::run_set::RunSet;

/// Adds results to a history, with what they are called beside their commit; returns the file.
///
/// # Errors
/// A folder that can't be read or written.
pub fn add(history: &Path, set: &RunSet, label: &str) -> Result<PathBuf, ReportError> {
    let last = files(history)?.last().map_or(0, |(number, _)| *number);
    let commit: String = set.provenance.program.commit.chars().take(12).collect();
    let path = history.join(format!("{:04}-{commit}.toml", last + 1));
    std::fs::create_dir_all(history)
        .map_err(|source| ReportError::Unwritten { path: history.into(), source })?;
    Summary { label: label.into(), ..Summary::of(set) }.save(&path)?;
    Ok(path)
}

/// What a history shows, a trend for each study on each machine, in the order of their first results.
///
/// # Errors
/// A folder or a file that can't be read.
pub fn trends(history: &Path) -> Result<Vec<Trend>, ReportError> {
    let read = files(history)?.into_iter().map(|(number, path)| Ok((number, Summary::load(&path)?)));
    Ok(trend::trends(read.collect::<Result<_, ReportError>>()?))
}

/// Refuses a folder that holds no history, or none that can be read.
///
/// # Errors
/// That one.
pub fn check(history: &Path) -> Result<(), ReportError> {
    if !trends(history)?.is_empty() {
        return Ok(());
    }
    let reason = "it holds no history; `tissuebench history add` begins one".into();
    Err(ReportError::Content { path: history.into(), reason })
}

/// The trends of a history that a report shows, those of its own study first.
pub(crate) fn shown(history: &Path, source: &str) -> Result<Vec<Trend>, ReportError> {
    check(history)?;
    let mut found = trends(history)?;
    found.sort_by_key(|trend| trend.source != source);
    Ok(found)
}

/// Errors and times of trends over commits, as SVG.
///
/// # Errors
/// A drawing that can't be made.
pub fn svg(trends: &[Trend]) -> Result<String, ReportError> {
    over_commits(trends).svg("history", TITLE)
}

/// The files of a history by their numbers; none of a folder that is not there yet.
fn files(history: &Path) -> Result<Vec<(u32, PathBuf)>, ReportError> {
    let unread = |source| ReportError::Io { path: history.into(), source };
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
    // Two branches may have given the same number.
    found.sort();
    Ok(found)
}
