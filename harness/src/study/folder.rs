//! The folder that results go to: those of one study or scene, which another one does not replace.

use std::collections::BTreeSet;
use std::io;
use std::path::Path;

/// What the results in a folder are called: the name of the study's or scene's file.
pub(crate) fn source(file: &Path) -> String {
    file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

/// Makes the folder before anything is solved, so that no finished run loses its results.
///
/// # Errors
/// A file of that name, a folder that can't be written, or one with the results of another scene or study.
pub(crate) fn ready(file: &Path, out: &Path) -> Result<(), String> {
    free_for(file, out)?;
    if out.exists() && !out.is_dir() {
        return Err(format!("--out {}: is a file; give a folder", out.display()));
    }
    writable(out).map_err(|bad| format!("--out {}: {bad}; give a folder that can be written", out.display()))
}

/// Refuses a file that can't be written where it is to go, as [`ready`] does for folders.
pub(crate) fn ready_file(out: &Path) -> Result<(), String> {
    if out.is_dir() {
        return Err(format!("--out {}: is a folder; give a file", out.display()));
    }
    let exists = out.exists();
    let opened = std::fs::OpenOptions::new().append(true).create(true).open(out);
    let tried = opened.and_then(|_| if exists { Ok(()) } else { std::fs::remove_file(out) });
    tried.map_err(|bad| format!("--out {}: {bad}; give a file that can be written", out.display()))
}

/// What the results in a folder are of, all of which a new run replaces; `None` where there are none.
pub(crate) fn replaced(out: &Path) -> Option<String> {
    let held = reports::read_run(out).ok()?;
    let methods: BTreeSet<_> = held.plans.iter().map(|plan| (&plan.case, &plan.method)).collect();
    let scenes: BTreeSet<_> = methods.iter().map(|(case, _)| case).collect();
    match (scenes.len(), methods.len()) {
        (0, _) => None,
        (1, 1) => Some("1 method".into()),
        (1, count) => Some(format!("{count} methods")),
        (scenes, _) => Some(format!("{scenes} scenes")),
    }
}

/// Refuses a folder with the results of another file.
fn free_for(file: &Path, out: &Path) -> Result<(), String> {
    let (here, wanted) = (reports::source_of(out), source(file));
    match here {
        Some(here) if here != wanted => Err(format!(
            "{} holds the results of {here}; give those of {wanted} a folder of their own, such as --out {}-{}",
            out.display(),
            out.display(),
            file.file_stem().unwrap_or_default().to_string_lossy()
        )),
        _ => Ok(()),
    }
}

/// Makes the folder and a file in it, which alone shows that one can be made.
fn writable(folder: &Path) -> io::Result<()> {
    std::fs::create_dir_all(folder)?;
    let trial = folder.join(".tissuebench-trial");
    std::fs::write(&trial, "")?;
    std::fs::remove_file(trial)
}
