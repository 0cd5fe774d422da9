//! Errors in a scene or a study: the place, the key, the value found and the value that would be right.

use std::fmt;

/// Kind of an error: a wrong file, an unsupported request, or a method that failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorKind {
    /// The input is wrong: exit code 2.
    Invalid,
    /// The input is well formed, but asks for something that is not supported yet: exit code 3.
    NotAvailable,
    /// The input is well formed, but the method could not run or did not converge: exit code 3.
    NotRun,
}

/// Describes why a file can't be read.
pub(crate) fn unread(bad: &std::io::Error) -> String {
    match bad.kind() {
        std::io::ErrorKind::NotFound => "there is no such file".into(),
        std::io::ErrorKind::IsADirectory => "the path is a folder".into(),
        std::io::ErrorKind::PermissionDenied => "permission denied".into(),
        std::io::ErrorKind::InvalidData => "the file is not text".into(),
        _ => bad.to_string(),
    }
}

/// One finding about an input file. Prints as `file:line: key 'path': 'found' problem; help`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneError {
    /// Kind of the error.
    pub kind: ErrorKind,
    /// File name as given by the caller.
    pub file: String,
    /// Line, from 1; 0 if the file could not be read at all.
    pub line: usize,
    /// Column in characters, from 1; 0 if the file could not be read at all.
    pub column: usize,
    /// Path of the key, such as `method[1].size.spacing` (tables of a list count from 0); empty for a syntax
    /// error.
    pub key: String,
    /// The value as written in the file.
    pub found: Option<String>,
    /// Description of the problem.
    pub problem: String,
    /// Suggested correction.
    pub help: Option<String>,
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:", self.file)?;
        if self.line > 0 {
            write!(f, "{}:", self.line)?;
        }
        if !self.key.is_empty() {
            write!(f, " key '{}':", self.key)?;
        }
        if let Some(found) = &self.found {
            write!(f, " '{found}'")?;
        }
        write!(f, " {}", self.problem)?;
        match &self.help {
            Some(help) => write!(f, "; {help}"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for SceneError {}
