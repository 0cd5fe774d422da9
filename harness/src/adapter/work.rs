//! Folders: a temporary folder for each call, and the folder of the user's installed adapters.

use std::collections::BTreeSet;
use std::fs::DirBuilder;
use std::hash::{BuildHasher, RandomState};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Environment variable with the folder for installations, in place of the system's usual folder.
const DATA: &str = "TISSUEBENCH_DATA";

/// Attempts to remove a folder in which processes being killed may still write, and the pause between
/// attempts.
const TRIES: usize = 50;
const PAUSE: Duration = Duration::from_millis(10);

/// Temporary folders that exist now.
static FOLDERS: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn folders() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    FOLDERS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A temporary folder that is removed when dropped.
#[derive(Debug)]
pub(crate) struct Folder(PathBuf);

impl Folder {
    /// Creates a folder among the system's temporary files. Its name is unpredictable and only this user can
    /// enter it.
    pub(crate) fn new() -> Result<Folder, String> {
        let mut folders = folders();
        loop {
            let name = RandomState::new().hash_one(std::process::id());
            let path = std::env::temp_dir().join(format!("tissuebench-{name:016x}"));
            match private(&path) {
                Err(bad) if bad.kind() == ErrorKind::AlreadyExists => {}
                Err(bad) => return Err(format!("{}: can't be made: {bad}", path.display())),
                Ok(()) => {
                    folders.insert(path.clone());
                    return Ok(Folder(path));
                }
            }
        }
    }

    /// Creates a subfolder.
    pub(crate) fn inside(&self, name: &str) -> Result<PathBuf, String> {
        let path = self.0.join(name);
        private(&path).map_err(|bad| format!("{}: can't be made: {bad}", path.display()))?;
        Ok(path)
    }

    pub(crate) fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
        folders().remove(&self.0);
    }
}

/// Creates a folder that other users cannot enter.
fn private(path: &Path) -> io::Result<()> {
    #[cfg_attr(not(unix), allow(unused_mut))]
    let mut builder = DirBuilder::new();
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    builder.create(path)
}

/// Removes all temporary folders and blocks the creation of others. Called just before the program exits,
/// after its child processes were killed.
pub(crate) fn remove_all() {
    let folders = folders();
    for path in folders.iter() {
        for _ in 0..TRIES {
            match std::fs::remove_dir_all(path) {
                Err(bad) if bad.kind() != ErrorKind::NotFound => std::thread::sleep(PAUSE),
                _ => break,
            }
        }
    }
    std::mem::forget(folders);
}

/// Returns the folder for installed adapters: `TISSUEBENCH_DATA` if set, otherwise `tissuebench` in the
/// user's data folder (`XDG_DATA_HOME` or `~/.local/share`).
pub(crate) fn data_folder() -> Option<PathBuf> {
    let of = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    of(DATA).or_else(|| {
        let data = of("XDG_DATA_HOME").or_else(|| Some(of("HOME")?.join(".local/share")));
        Some(data?.join("tissuebench"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_gone_with_its_call() {
        let [one, two] = [Folder::new().unwrap(), Folder::new().unwrap()];
        let inside = one.inside("problem").unwrap();
        std::fs::write(inside.join("a"), "a").unwrap();
        assert!(one.path() != two.path() && inside.is_dir());
        drop(one);
        assert!(!inside.exists() && two.path().is_dir());
    }
}
