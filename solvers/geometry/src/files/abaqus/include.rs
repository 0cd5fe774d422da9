//! Files that a deck includes: which, and how much of them.

use std::path::{Component, Path, PathBuf};

use disk::Kind;

/// Files that include files: a deck that includes itself ends here.
pub(super) const DEEPEST: usize = 8;
/// Most files that a deck includes: eight files that each include the next ten times would be a hundred
/// million.
const MOST: usize = 1000;

/// Files that a deck has included so far.
#[derive(Default)]
pub(super) struct Includes {
    files: usize,
    bytes: u64,
}

impl Includes {
    /// Reads one more file; where it is, with its bytes, or why it is not read. All files together are no
    /// larger than one may be.
    pub(super) fn read(&mut self, folder: &Path, name: &str) -> Result<(PathBuf, Vec<u8>), &'static str> {
        let path = within(folder, name)?;
        self.files += 1;
        if self.files > MOST {
            return Err("a deck includes at most a thousand files");
        }
        let left = Kind::MESH.most().saturating_sub(self.bytes);
        let bytes = disk::read(&path, Kind::MESH.at_most(left))
            .map_err(|_| "it is no regular file that can be read, or too large")?;
        self.bytes += bytes.len() as u64;
        Ok((path, bytes))
    }
}

/// A file in the folder of the deck. Links are resolved before it is judged: one may lead anywhere.
fn within(folder: &Path, name: &str) -> Result<PathBuf, &'static str> {
    const OUTSIDE: &str = "it has to lie in the folder of the deck";
    if !Path::new(name).components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir)) {
        return Err(OUTSIDE);
    }
    let path = folder.join(name);
    let home = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    match (path.canonicalize(), home.canonicalize()) {
        (Ok(file), Ok(home)) if file.starts_with(&home) => Ok(path),
        (Ok(_), Ok(_)) => Err(OUTSIDE),
        _ => Err("there is no such file that can be read"),
    }
}
