//! Folders of results.

use std::path::Path;

use records::{RunSet, ro_crate};
use reports::{Rendered, ReportError, Statements, read_statements};

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

/// Renders the report of a folder of results, with statements from a file, and returns the exit code.
pub(super) fn report(results: &Path, out: &Path, history: Option<&Path>, statements: Option<&Path>) -> u8 {
    let read = statements.map_or_else(|| Ok(Statements::default()), read_statements);
    let done = read.map_err(ReportError::from);
    let code = rendered(done.and_then(|read| reports::render_with(results, out, history, &read)), false);
    // A report in the folder of results has replaced files that the folder's description lists.
    let whole = |path: &Path| path.canonicalize().ok();
    let inside = whole(out).zip(whole(results)).is_some_and(|(out, results)| out.starts_with(results));
    if code == 0 && inside { described(results) } else { code }
}

/// Describes a folder of complete results, after its last file is written, and returns the exit code.
pub(super) fn described(out: &Path) -> u8 {
    ro_crate::describe(out).map_or_else(unreported, |()| 0)
}

/// Releases the folder of a study. The last process to leave it cleans up and describes the results, if they
/// are complete. Returns the exit code.
pub(super) fn close(folder: Folder, out: &Path, code: u8, clean: impl FnOnce()) -> u8 {
    let mut last = 0;
    folder.close(|| {
        clean();
        if !records::is_incomplete(out) {
            last = described(out);
        }
    });
    if code == 0 { last } else { code }
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
