//! Findings about one file, each at its key.

use std::path::{Path, PathBuf};

use catalogue::nearest;

use super::document::{Origin, sorted};
use catalogue::Problem;

use super::error::{ErrorKind, SceneError};

/// Collects findings about one file.
pub(crate) struct Report<'o> {
    origin: &'o Origin,
    errors: Vec<SceneError>,
}

impl<'o> Report<'o> {
    pub fn new(origin: &'o Origin) -> Report<'o> {
        Report { origin, errors: Vec::new() }
    }

    pub fn add(&mut self, key: &str, problem: Problem) {
        self.errors.push(self.origin.error(ErrorKind::Invalid, key, problem));
    }

    /// Whether something is noted at `key`.
    pub fn has(&self, key: &str) -> bool {
        self.errors.iter().any(|error| error.key == key)
    }

    /// Whether nothing is noted.
    pub fn is_clean(&self) -> bool {
        self.errors.is_empty()
    }

    pub fn finish(self) -> Vec<SceneError> {
        sorted(self.errors)
    }

    pub fn origin(&self) -> &Origin {
        self.origin
    }

    /// A path of the file, relative ones taken from its folder.
    pub fn path(&self, text: &str) -> PathBuf {
        let folder = Path::new(self.origin.file()).parent().unwrap_or(Path::new(""));
        folder.join(text)
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

/// The nearest of the ids there are, as help.
pub(crate) fn which<'a>(id: &str, known: impl Iterator<Item = &'a str> + Clone) -> String {
    let list = known.clone().collect::<Vec<_>>().join(", ");
    match nearest(id, known) {
        Some(near) => format!("did you mean '{near}'? (there are {list})"),
        None => format!("there are {list}"),
    }
}
