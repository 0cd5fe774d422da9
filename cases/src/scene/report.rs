//! Findings about one file, each with its key.

use std::path::{Component, Path, PathBuf};

use catalogue::nearest;

use super::document::{Origin, sorted};
use catalogue::Problem;

use super::error::{ErrorKind, SceneError};

/// Collects findings about one file.
pub(crate) struct Report<'o> {
    origin: &'o Origin,
    errors: Vec<SceneError>,
    /// Keys of the errors in the scene; an error in a shared method has the key of its own file instead.
    keys: Vec<String>,
}

impl<'o> Report<'o> {
    pub fn new(origin: &'o Origin) -> Report<'o> {
        Report { origin, errors: Vec::new(), keys: Vec::new() }
    }

    pub fn add(&mut self, key: &str, problem: Problem) {
        self.errors.push(self.origin.error(ErrorKind::Invalid, key, problem));
        self.keys.push(key.to_string());
    }

    /// Whether a finding at `key` is recorded.
    pub fn has(&self, key: &str) -> bool {
        self.keys.iter().any(|noted| noted == key)
    }

    /// Whether there are no findings.
    pub fn is_clean(&self) -> bool {
        self.errors.is_empty()
    }

    pub fn finish(self) -> Vec<SceneError> {
        sorted(self.errors)
    }

    pub fn origin(&self) -> &Origin {
        self.origin
    }

    /// Path given as the value of `key`; a relative path is resolved from the folder of the file that
    /// contains the key.
    pub fn path(&self, text: &str, key: &str) -> PathBuf {
        beside(self.origin.file_of(key), text)
    }

    pub fn missing(&mut self, key: &str, help: &str) {
        self.add(key, Problem::new("is missing").help(help));
    }

    pub fn require(&mut self, holds: bool, key: &str, problem: &str, help: &str) {
        if !holds {
            self.add(key, Problem::new(problem).help(help));
        }
    }
}

/// Joins a path to the folder of a file, without steps back: `studies/../scenes` is `scenes`, unless a link
/// leads elsewhere.
pub(crate) fn beside(file: &str, path: &str) -> PathBuf {
    let whole = Path::new(file).parent().unwrap_or(Path::new("")).join(path);
    let mut short = PathBuf::new();
    for part in whole.components() {
        match (part, short.components().next_back()) {
            (Component::ParentDir, Some(Component::Normal(_))) => drop(short.pop()),
            _ => short.push(part),
        }
    }
    let real = |path: &Path| path.canonicalize().ok();
    if real(&short) == real(&whole) { short } else { whole }
}

/// Help for an unknown id: the nearest known id, and the list of all.
pub(crate) fn which<'a>(id: &str, known: impl Iterator<Item = &'a str> + Clone) -> String {
    let list = known.clone().collect::<Vec<_>>().join(", ");
    match nearest(id, known) {
        Some(near) => format!("did you mean '{near}'? (there are {list})"),
        None => format!("there are {list}"),
    }
}
