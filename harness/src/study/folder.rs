//! The folder that results go to: those of one study or scene, which another one does not replace.

use std::path::Path;

/// What the results in a folder are called: the name of the study's or scene's file.
pub(crate) fn source(file: &Path) -> String {
    file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

/// Refuses a folder with the results of another file.
pub(crate) fn free_for(file: &Path, out: &Path) -> Result<(), String> {
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
