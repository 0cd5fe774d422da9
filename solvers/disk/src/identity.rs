//! Input files of this process, identified by device and inode.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{File, Metadata};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Identity of a file, whatever its names: device and inode. On systems without these, the path without
/// links.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Identity(#[cfg(unix)] (u64, u64), #[cfg(not(unix))] PathBuf);

impl Identity {
    /// Returns the identity of the file or folder at a path; `None` if there is none.
    pub fn of(path: &Path) -> Option<Identity> {
        #[cfg(unix)]
        return Some(Identity::from(&std::fs::metadata(path).ok()?));
        #[cfg(not(unix))]
        path.canonicalize().ok().map(Identity)
    }

    #[cfg(unix)]
    fn from(of: &Metadata) -> Identity {
        use std::os::unix::fs::MetadataExt;
        Identity((of.dev(), of.ino()))
    }
}

/// Input files with the path of their first use, and files written by this process.
struct Known {
    inputs: BTreeMap<Identity, PathBuf>,
    written: BTreeSet<Identity>,
}

fn known() -> MutexGuard<'static, Known> {
    static KNOWN: Mutex<Known> = Mutex::new(Known { inputs: BTreeMap::new(), written: BTreeSet::new() });
    KNOWN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Marks a file as an input of this process, read or yet to be read. From then on no output replaces the
/// file. An output of this process that is read again does not count as an input.
pub fn input(path: &Path) {
    let Some(identity) = Identity::of(path) else { return };
    let mut known = known();
    if !known.written.contains(&identity) {
        known
            .inputs
            .entry(identity)
            .or_insert_with(|| std::path::absolute(path).unwrap_or_else(|_| path.into()));
    }
}

/// Marks a file as created or emptied by this process.
pub(crate) fn written(file: &File, path: &Path) {
    #[cfg(unix)]
    let identity = file.metadata().ok().filter(Metadata::is_file).map(|of| Identity::from(&of));
    #[cfg(not(unix))]
    let identity = file.metadata().ok().filter(Metadata::is_file).and_then(|_| Identity::of(path));
    let _ = path;
    let Some(identity) = identity else { return };
    let mut known = known();
    known.inputs.remove(&identity);
    known.written.insert(identity);
}

/// Checks that an output file is not an input file.
///
/// # Errors
/// The file is an input of this process; the message names it.
pub fn spare(out: &Path) -> io::Result<()> {
    let Some(identity) = Identity::of(out) else { return Ok(()) };
    let known = known();
    match known.inputs.get(&identity) {
        // The inode of a deleted file may be reused by a new file.
        Some(name) if Identity::of(name).as_ref() == Some(&identity) => {
            let problem = format!("is the input file {}; give another name", name.display());
            Err(io::Error::new(io::ErrorKind::InvalidInput, problem))
        }
        _ => Ok(()),
    }
}
