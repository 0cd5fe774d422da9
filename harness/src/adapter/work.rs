//! Folders: one for each call, which is gone with it, and one for what a person has installed.

use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};

/// Says where installed things go, in place of the usual folder of the system.
const DATA: &str = "TISSUEBENCH_DATA";

/// A folder of its own that is removed at the end.
#[derive(Debug)]
pub(crate) struct Folder(PathBuf);

impl Folder {
    /// Makes one where the system has its temporary files.
    pub(crate) fn new() -> Result<Folder, String> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("tissuebench-{}-{number}", std::process::id()));
        // What a process of the same number left is nobody's now.
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).map_err(|bad| format!("{}: can't be made: {bad}", path.display()))?;
        Ok(Folder(path))
    }

    /// A folder in it, made now.
    pub(crate) fn inside(&self, name: &str) -> Result<PathBuf, String> {
        let path = self.0.join(name);
        std::fs::create_dir_all(&path).map_err(|bad| format!("{}: can't be made: {bad}", path.display()))?;
        Ok(path)
    }

    #[cfg(test)]
    fn path(&self) -> &std::path::Path {
        &self.0
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
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
