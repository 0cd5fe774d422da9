//! Creating, replacing and removing files.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

use crate::identity::{spare, written};
use crate::kind::irregular;

/// Creates or empties a file whose name the user gave. A pipe or a device is opened as it is.
///
/// # Errors
/// The file is an input of this process or a pipe without a reader, or the system refuses.
pub fn create(path: &Path) -> io::Result<File> {
    spare(path)?;
    let opened = without_waiting(OpenOptions::new().write(true).create(true).truncate(true)).open(path);
    let file = opened.map_err(|bad| match fs::metadata(path) {
        Ok(of) if !of.is_file() && !of.is_dir() && bad.kind() != ErrorKind::PermissionDenied => {
            io::Error::new(bad.kind(), format!("is {} without a reader: {bad}", irregular(&of)))
        }
        _ => bad,
    })?;
    #[cfg(unix)]
    rustix::fs::fcntl_setfl(&file, rustix::fs::OFlags::empty())?;
    written(&file, path);
    Ok(file)
}

/// Writes a file whose name the user gave.
///
/// # Errors
/// As [`create`], and if the disk is full.
pub fn write(path: &Path, bytes: impl AsRef<[u8]>) -> io::Result<()> {
    create(path)?.write_all(bytes.as_ref())
}

/// Tests whether a file can be written, long before there are data to write.
///
/// # Errors
/// As [`create`].
pub fn try_create(path: &Path) -> io::Result<()> {
    spare(path)?;
    let exists = match fs::metadata(path) {
        // The reader of a pipe would take a test write for the end of the data.
        Ok(of) if !of.is_file() && !of.is_dir() => return Ok(()),
        found => found.is_ok(),
    };
    without_waiting(OpenOptions::new().append(true).create(true)).open(path)?;
    if exists { Ok(()) } else { fs::remove_file(path) }
}

/// Writes a new file next to `path` and renames it, so that the file at `path` is always complete. A link at
/// `path` is replaced, not followed.
///
/// # Errors
/// The file is an input of this process, a device or a pipe, or the system refuses.
pub fn replace(path: &Path, write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> io::Result<()> {
    spare(path)?;
    if let Some(of) =
        fs::symlink_metadata(path).ok().filter(|of| !of.is_file() && !of.is_dir() && !of.is_symlink())
    {
        let problem = format!("is {}; give a regular file", irregular(&of));
        return Err(io::Error::new(ErrorKind::InvalidInput, problem));
    }
    let mut partial = path.as_os_str().to_owned();
    partial.push(".partial");
    let partial = PathBuf::from(partial);
    remove(&partial).or_else(|bad| if bad.kind() == ErrorKind::NotFound { Ok(()) } else { Err(bad) })?;
    let all = || {
        // The file must be new: a link that was put there in the meantime is not followed.
        let mut file = BufWriter::new(OpenOptions::new().write(true).create_new(true).open(&partial)?);
        written(file.get_ref(), &partial);
        write(&mut file)?;
        file.flush()?;
        drop(file);
        fs::rename(&partial, path)
    };
    all().inspect_err(|_| {
        let _ = fs::remove_file(&partial);
    })
}

/// Removes a file. Of a link, the link itself is removed, not its target.
///
/// # Errors
/// The file is an input of this process, or the system refuses.
pub fn remove(path: &Path) -> io::Result<()> {
    spare(path)?;
    fs::remove_file(path)
}

/// Opens a lock file, which only names the holders of locks, and creates it if it does not exist. Links are
/// not followed.
///
/// # Errors
/// The file is a link, a pipe, a device or an input of this process, or the system refuses.
pub fn create_lock(path: &Path) -> io::Result<File> {
    spare(path)?;
    let mut options = OpenOptions::new();
    options.read(true).write(true).create(true).truncate(false);
    let file = at_itself(&mut options).open(path)?;
    if file.metadata()?.is_file() {
        return Ok(file);
    }
    Err(io::Error::new(ErrorKind::InvalidInput, "is not a regular file"))
}

/// Sets the flags with which opening a pipe does not wait for its other end.
pub(crate) fn without_waiting(options: &mut OpenOptions) -> &mut OpenOptions {
    #[cfg(unix)]
    {
        use std::os::unix::fs::OpenOptionsExt;
        options
            .custom_flags((rustix::fs::OFlags::NONBLOCK | rustix::fs::OFlags::NOCTTY).bits().cast_signed());
    }
    options
}

/// Sets the flags with which opening does not wait and does not follow a link.
fn at_itself(options: &mut OpenOptions) -> &mut OpenOptions {
    #[cfg(unix)]
    {
        use std::os::unix::fs::OpenOptionsExt;
        options
            .custom_flags((rustix::fs::OFlags::NONBLOCK | rustix::fs::OFlags::NOFOLLOW).bits().cast_signed());
    }
    options
}
