//! What is wrong with a scene or a study: where, which key, what was found and what would be right.

use std::fmt;

/// Whether a file is wrong, or right but ahead of what can run, or beyond its method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorKind {
    /// The input is wrong: exit code 2.
    Invalid,
    /// The input is well formed, but asks for something that can't run yet: exit code 3.
    NotAvailable,
    /// The input is well formed, but the method could not run on it or did not converge: exit code 3.
    NotRun,
}

/// Why a file can't be read, in words.
pub(crate) fn unread(bad: &std::io::Error) -> String {
    match bad.kind() {
        std::io::ErrorKind::NotFound => "there is no such file".into(),
        std::io::ErrorKind::IsADirectory => "it is a folder".into(),
        std::io::ErrorKind::PermissionDenied => "permission denied".into(),
        std::io::ErrorKind::InvalidData => "it is no text".into(),
        _ => bad.to_string(),
    }
}

/// One finding about an input file. Prints as `file:line: key 'path': 'found' problem; help`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneError {
    /// Invalid, or not available yet.
    pub kind: ErrorKind,
    /// File name as given by the caller.
    pub file: String,
    /// Line, from 1; 0 when the file could not be read at all.
    pub line: usize,
    /// Column in characters, from 1; 0 when the file could not be read at all.
    pub column: usize,
    /// Path of the key, such as `method[1].size.spacing` (tables of a list count from 0); empty for a syntax error.
    pub key: String,
    /// The value as the file has it.
    pub found: Option<String>,
    /// What is wrong with it.
    pub problem: String,
    /// What would be right.
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
