//! Folders: one for each call, which is gone with it, and one for what a person has installed.

use std::collections::BTreeSet;
use std::fs::DirBuilder;
use std::hash::{BuildHasher, RandomState};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Says where installed things go, in place of the usual folder of the system.
const DATA: &str = "TISSUEBENCH_DATA";

/// How often a folder is removed in which processes that are being ended still write, and the time between.
const TRIES: usize = 50;
const PAUSE: Duration = Duration::from_millis(10);

/// Folders that are there now.
static FOLDERS: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn folders() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    FOLDERS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A folder of its own that is removed at the end.
#[derive(Debug)]
pub(crate) struct Folder(PathBuf);

impl Folder {
    /// Makes one where the system has its temporary files: under a name that nobody can know before, for this
    /// user alone.
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

    /// A folder in it, made now.
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

/// Makes a new folder that other users can't enter.
fn private(path: &Path) -> io::Result<()> {
    let mut builder = DirBuilder::new();
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    builder.create(path)
}

/// Removes all folders, and lets no other one be made: for a program that is about to exit, and has ended
/// what it started.
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

/// Where adapters have what was installed for them: `TISSUEBENCH_DATA`, or else `tissuebench` among the data of this person.
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
