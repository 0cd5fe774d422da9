//! Creating, replacing and removing.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

use crate::identity::{spare, written};
use crate::kind::irregular;

/// Makes or empties the file of a name that a person gave. A pipe or a device is written to as it is.
///
/// # Errors
/// An input of this process, a pipe that nobody reads, or what the system has against it.
pub fn create(path: &Path) -> io::Result<File> {
    spare(path)?;
    let opened = without_waiting(OpenOptions::new().write(true).create(true).truncate(true)).open(path);
    let file = opened.map_err(|bad| match fs::metadata(path) {
        Ok(of) if !of.is_file() && !of.is_dir() && bad.kind() != ErrorKind::PermissionDenied => {
            io::Error::new(bad.kind(), format!("is {} that nobody reads: {bad}", irregular(&of)))
        }
        _ => bad,
    })?;
    #[cfg(unix)]
    rustix::fs::fcntl_setfl(&file, rustix::fs::OFlags::empty())?;
    written(&file, path);
    Ok(file)
}

/// Writes the file of a name that a person gave.
///
/// # Errors
/// As [`create`], or a disk that is full.
pub fn write(path: &Path, bytes: impl AsRef<[u8]>) -> io::Result<()> {
    create(path)?.write_all(bytes.as_ref())
}

/// Tries whether a file can be written, long before there is something to write.
///
/// # Errors
/// As [`create`].
pub fn try_create(path: &Path) -> io::Result<()> {
    spare(path)?;
    let exists = match fs::metadata(path) {
        // Who reads a pipe would take a trial for its end.
        Ok(of) if !of.is_file() && !of.is_dir() => return Ok(()),
        found => found.is_ok(),
    };
    without_waiting(OpenOptions::new().append(true).create(true)).open(path)?;
    if exists { Ok(()) } else { fs::remove_file(path) }
}

/// Writes a file beside its place and renames it, so that what stands there is never half of it. A link there
/// is replaced, not followed.
///
/// # Errors
/// An input of this process, a device or a pipe, or what the system has against it.
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
        // A new file: what another has put there in the meantime is not followed.
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

/// Removes a file; a link itself, not the file it leads to.
///
/// # Errors
/// An input of this process, or what the system has against it.
pub fn remove(path: &Path) -> io::Result<()> {
    spare(path)?;
    fs::remove_file(path)
}

/// Opens a file that only locks and names their holders, made where there is none. A link is not followed.
///
/// # Errors
/// A link, a pipe, a device, an input of this process, or what the system has against it.
pub fn create_lock(path: &Path) -> io::Result<File> {
    spare(path)?;
    let mut options = OpenOptions::new();
    options.read(true).write(true).create(true).truncate(false);
    let file = at_itself(&mut options).open(path)?;
    if file.metadata()?.is_file() {
        return Ok(file);
    }
    Err(io::Error::new(ErrorKind::InvalidInput, "is no regular file"))
}

/// Without waiting for another end of a pipe.
pub(crate) fn without_waiting(options: &mut OpenOptions) -> &mut OpenOptions {
    #[cfg(unix)]
    {
        use std::os::unix::fs::OpenOptionsExt;
        options
            .custom_flags((rustix::fs::OFlags::NONBLOCK | rustix::fs::OFlags::NOCTTY).bits().cast_signed());
    }
    options
}

/// The same, and not through a link.
fn at_itself(options: &mut OpenOptions) -> &mut OpenOptions {
    #[cfg(unix)]
    {
        use std::os::unix::fs::OpenOptionsExt;
        options
            .custom_flags((rustix::fs::OFlags::NONBLOCK | rustix::fs::OFlags::NOFOLLOW).bits().cast_signed());
    }
    options
}
