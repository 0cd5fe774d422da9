//! Files included by a deck, and limits on their number and size.

use std::path::{Component, Path, PathBuf};

use disk::Kind;

/// Largest depth of nested includes; a deck that includes itself ends here.
pub(super) const DEEPEST: usize = 8;
/// Largest number of files that a deck may include. Eight files that each include the next one ten times
/// would give a hundred million.
const MOST: usize = 1000;

/// Number and size of the files included so far.
#[derive(Default)]
pub(super) struct Includes {
    files: usize,
    bytes: u64,
}

impl Includes {
    /// Reads another file and returns its path and bytes, or the reason for its rejection. All files together
    /// may be as large as a single mesh file.
    pub(super) fn read(&mut self, folder: &Path, name: &str) -> Result<(PathBuf, Vec<u8>), &'static str> {
        let path = within(folder, name)?;
        self.files += 1;
        if self.files > MOST {
            return Err("a deck may include at most a thousand files");
        }
        let left = Kind::MESH.most().saturating_sub(self.bytes);
        let bytes = disk::read(&path, Kind::MESH.at_most(left))
            .map_err(|_| "the file is not a readable regular file, or is too large")?;
        self.bytes += bytes.len() as u64;
        Ok((path, bytes))
    }
}

/// Path of a file in the folder of the deck. Links are resolved before the check, because they may lead
/// outside.
fn within(folder: &Path, name: &str) -> Result<PathBuf, &'static str> {
    const OUTSIDE: &str = "the file has to lie in the folder of the deck";
    if !Path::new(name).components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir)) {
        return Err(OUTSIDE);
    }
    let path = folder.join(name);
    let home = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    match (path.canonicalize(), home.canonicalize()) {
        (Ok(file), Ok(home)) if file.starts_with(&home) => Ok(path),
        (Ok(_), Ok(_)) => Err(OUTSIDE),
        _ => Err("the file does not exist or cannot be read"),
    }
}
