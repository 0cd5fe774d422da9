//! Findings about one file, each with its key.

use std::cell::RefCell;
use std::path::{Component, Path, PathBuf};
use std::rc::Rc;

use catalogue::{Problem, nearest};

use super::conform::join;
use super::document::{Origin, sorted};
use super::error::{ErrorKind, SceneError};

/// Collector of findings about one file, at the table that is being read. Keys are relative to this table;
/// the empty key is the table itself.
pub(crate) struct Report<'o> {
    origin: &'o Origin,
    /// Key of the table; empty for the whole file.
    table: String,
    /// Errors, each with its key in the scene: an error in a shared method names the key of its own file.
    found: Rc<RefCell<Vec<(String, SceneError)>>>,
}

impl<'o> Report<'o> {
    pub fn new(origin: &'o Origin) -> Report<'o> {
        Report { origin, table: String::new(), found: Rc::default() }
    }

    /// The collector at a table below this table.
    pub fn at(&self, key: &str) -> Report<'o> {
        Report { origin: self.origin, table: self.key(key), found: self.found.clone() }
    }

    /// Reads every entry of a list by `read`; the entries that could not be read are left out.
    pub fn each<K, V>(&self, key: &str, list: Vec<K>, read: impl Fn(K, &Report) -> Option<V>) -> Vec<V> {
        let entry = |(i, keys)| read(keys, &self.at(&format!("{key}[{i}]")));
        list.into_iter().enumerate().filter_map(entry).collect()
    }

    /// The whole key in the file.
    fn key(&self, key: &str) -> String {
        if key.is_empty() { self.table.clone() } else { join(&self.table, key) }
    }

    pub fn add(&self, key: &str, problem: Problem) {
        let key = self.key(key);
        let error = self.origin.error(ErrorKind::Invalid, &key, problem);
        self.found.borrow_mut().push((key, error));
    }

    /// Adds the errors of another file, which is the value of `key`.
    pub fn add_of_file(&self, key: &str, errors: Vec<SceneError>) {
        let key = self.key(key);
        self.found.borrow_mut().extend(errors.into_iter().map(|error| (key.clone(), error)));
    }

    pub fn missing(&self, key: &str, help: &str) {
        self.add(key, Problem::new("is missing").help(help));
    }

    pub fn require(&self, holds: bool, key: &str, problem: &str, help: &str) {
        if !holds {
            self.add(key, Problem::new(problem).help(help));
        }
    }

    /// Requires a positive value, and returns the value.
    pub fn positive(&self, key: &str, value: f64) -> f64 {
        self.require(value > 0.0, key, "is not positive", "give a value above zero");
        value
    }

    /// Whether a finding at `key` is recorded.
    pub fn has(&self, key: &str) -> bool {
        let key = self.key(key);
        self.found.borrow().iter().any(|(noted, _)| *noted == key)
    }

    /// Whether the file has `key`.
    pub fn is_given(&self, key: &str) -> bool {
        self.origin.has(&self.key(key))
    }

    /// Location of the table in the file, `file:line`.
    pub fn location(&self) -> String {
        let place = self.origin.error(ErrorKind::Invalid, &self.table, Problem::new(""));
        format!("{}:{}", place.file, place.line)
    }

    /// Path given as the value of `key`; a relative path is resolved from the folder of the file that
    /// contains the key.
    pub fn path(&self, text: &str, key: &str) -> PathBuf {
        beside(self.origin.file_of(&self.key(key)), text)
    }

    pub fn origin(&self) -> &'o Origin {
        self.origin
    }

    /// Whether there are no findings.
    pub fn is_clean(&self) -> bool {
        self.found.borrow().is_empty()
    }

    pub fn finish(self) -> Vec<SceneError> {
        sorted(self.found.take().into_iter().map(|(_, error)| error).collect())
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
