//! Records which adapters have passed their check on this machine in their present state.

use std::path::PathBuf;

use super::find::Found;
use super::run::version;
use super::work::data_folder;

fn file(adapter: &Found) -> Option<PathBuf> {
    Some(data_folder()?.join("adapters").join(&adapter.manifest.name).join("checked"))
}

/// Returns a hash of everything the check depends on: the adapter's files and its solver's version.
fn state(adapter: &Found) -> String {
    let mut hasher = blake3::Hasher::new();
    for (name, bytes) in adapter.files() {
        hasher.update(name.as_bytes()).update(&(bytes.len() as u64).to_le_bytes()).update(&bytes);
    }
    hasher.update(version(adapter).unwrap_or_default().as_bytes());
    format!("{}\n", hasher.finalize().to_hex())
}

/// Records whether an adapter passed its check. If the record cannot be written, the adapter counts as
/// unchecked.
pub(crate) fn note(adapter: &Found, passed: bool) {
    let Some(file) = file(adapter) else { return };
    if !passed {
        let _ = disk::remove(&file);
        return;
    }
    let folder = file.parent().map(std::fs::create_dir_all);
    if let Err(bad) = folder.unwrap_or(Ok(())).and_then(|()| disk::write(&file, state(adapter))) {
        eprintln!("tissuebench: {}: can't be written: {bad}; the adapter remains unchecked", file.display());
    }
}

/// Whether an adapter has passed its check in its present state.
pub(crate) fn is_checked(adapter: &Found) -> bool {
    let noted = file(adapter).and_then(|file| disk::read_text(&file, disk::Kind::MESSAGE).ok());
    noted.is_some_and(|noted| noted == state(adapter))
}
