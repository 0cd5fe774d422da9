//! Opening and reading files.

use std::fs::{File, Metadata, OpenOptions};
use std::io::{self, ErrorKind, Read};
use std::path::Path;

use crate::identity::input;
use crate::kind::{Kind, irregular};
use crate::write::without_waiting;

/// Opens a regular file for reading, up to the size limit of its kind.
///
/// # Errors
/// The file does not exist, cannot be opened, is not regular or is larger than its kind allows.
pub fn open(path: &Path, kind: Kind) -> io::Result<impl Read> {
    Ok(opened(path, kind)?.0.take(kind.most))
}

/// Reads a regular file.
///
/// # Errors
/// As [`open`].
pub fn read(path: &Path, kind: Kind) -> io::Result<Vec<u8>> {
    let (file, length) = opened(path, kind)?;
    let mut bytes = Vec::with_capacity(length as usize);
    // The file may grow while it is read, and kernel files report no length.
    file.take(kind.most + 1).read_to_end(&mut bytes)?;
    fits(bytes.len() as u64, kind)?;
    Ok(bytes)
}

/// Reads a regular text file.
///
/// # Errors
/// As [`open`], and if the file is not UTF-8.
pub fn read_text(path: &Path, kind: Kind) -> io::Result<String> {
    let no_text = |_| io::Error::new(ErrorKind::InvalidData, "stream did not contain valid UTF-8");
    String::from_utf8(read(path, kind)?).map_err(no_text)
}

/// Opens a file and returns its length, bytes. The type is checked before opening, because opening a device
/// or a pipe has effects. It is checked again on the open file, which may be another by then.
fn opened(path: &Path, kind: Kind) -> io::Result<(File, u64)> {
    regular(&std::fs::metadata(path)?, kind)?;
    let file = without_waiting(OpenOptions::new().read(true)).open(path)?;
    let length = regular(&file.metadata()?, kind)?;
    if kind.input {
        input(path);
    }
    Ok((file, length))
}

fn regular(of: &Metadata, kind: Kind) -> io::Result<u64> {
    if of.is_dir() {
        return Err(ErrorKind::IsADirectory.into());
    }
    if !of.is_file() {
        let problem = format!("is {}; give a regular file", irregular(of));
        return Err(io::Error::new(ErrorKind::InvalidInput, problem));
    }
    fits(of.len(), kind)
}

fn fits(bytes: u64, kind: Kind) -> io::Result<u64> {
    if bytes <= kind.most {
        return Ok(bytes);
    }
    let problem = format!("has more than {} bytes, the size limit of {}", kind.most, kind.name);
    Err(io::Error::new(ErrorKind::FileTooLarge, problem))
}
