//! Entries of the catalogue.

use crate::names::suggest;
use crate::parameter::Parameter;
use crate::problem::Problem;
use crate::values::Values;

/// Constructor of a `T` from checked values.
pub type Build<T> = fn(&Values) -> Result<T, Problem>;

/// Named object of the catalogue. `B` is the type of its constructor, such as [`Build`].
#[derive(Clone, Copy, Debug)]
pub struct Entry<B> {
    /// Name in files and tables.
    pub name: &'static str,
    /// Meaning, in one line.
    pub meaning: &'static str,
    /// Source, such as a paper; empty if none is needed.
    pub source: &'static str,
    /// Parameters that the constructor takes.
    pub parameters: &'static [Parameter],
    /// Constructor.
    pub build: B,
}

/// Entries are equal if their names are.
impl<B> PartialEq for Entry<B> {
    fn eq(&self, other: &Entry<B>) -> bool {
        self.name == other.name
    }
}

impl<B> Entry<B> {
    /// Returns the parameter with that name.
    pub fn parameter(&self, name: &str) -> Option<&'static Parameter> {
        self.parameters.iter().find(|parameter| parameter.name == name)
    }
}

impl<T> Entry<Build<T>> {
    /// Returns the entry with another constructor.
    pub const fn built_by<U>(self, build: Build<U>) -> Entry<Build<U>> {
        let Entry { name, meaning, source, parameters, .. } = self;
        Entry { name, meaning, source, parameters, build }
    }
}

/// Returns the entry with that name.
///
/// # Errors
///
/// The name is not known; the help gives the nearest name.
pub fn find<B>(entries: &'static [Entry<B>], name: &str) -> Result<&'static Entry<B>, Problem> {
    entries
        .iter()
        .find(|entry| entry.name == name)
        .ok_or_else(|| Problem::new("is not known").found(name).help(suggest(name, &names(entries))))
}

/// Returns the names of all entries, in their order.
pub fn names<B>(entries: &[Entry<B>]) -> Vec<&'static str> {
    entries.iter().map(|entry| entry.name).collect()
}
