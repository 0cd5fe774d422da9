//! Folders of results.

use std::path::Path;

use records::RunSet;
use reports::{Rendered, ReportError};

use super::errors::{fail, unreported};
use crate::study::folder::{self, Folder};

/// Claims the results folder for a scene or study, and prints which results it replaces. Returns an exit code
/// on failure.
pub(super) fn take(file: &Path, out: &Path) -> Result<Folder, u8> {
    let folder = folder::take(file, out).map_err(|failure| fail(&failure))?;
    if let Some(what) = folder::replaced(out) {
        eprintln!("{}: replaces the results of {what}", out.display());
    }
    folder.begin(file).map_err(|failure| fail(&failure))?;
    Ok(folder)
}

/// Renders the report of a folder of results and returns the exit code.
pub(super) fn report(results: &Path, out: &Path, history: Option<&Path>, quiet: bool) -> u8 {
    rendered(reports::render_over_commits(results, out, history), quiet)
}

/// Writes a folder of results with its report and returns the exit code.
pub(super) fn write_results(out: &Path, set: &RunSet, history: Option<&Path>, quiet: bool) -> u8 {
    rendered(reports::write_with_report(out, set, history), quiet)
}

fn rendered(done: Result<Rendered, ReportError>, quiet: bool) -> u8 {
    match done {
        Ok(rendered) => {
            if !quiet {
                eprintln!("{} files; open {}", rendered.files.len(), rendered.page.display());
            }
            0
        }
        Err(bad) => unreported(bad),
    }
}
