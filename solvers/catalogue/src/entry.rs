//! Entries of the catalogue.

use crate::names::suggest;
use crate::parameter::Parameter;
use crate::problem::Problem;

/// Something that a person can name. `B` is the constructor that its kind shares, a function of checked [`Values`].
///
/// [`Values`]: crate::Values
#[derive(Clone, Copy, Debug)]
pub struct Entry<B> {
    /// Name in files and tables.
    pub name: &'static str,
    /// What it is, in one line.
    pub meaning: &'static str,
    /// Where it is from; empty for what needs no source.
    pub source: &'static str,
    /// What it takes.
    pub parameters: &'static [Parameter],
    /// Makes it.
    pub build: B,
}

/// Entries are the same where their names are.
impl<B> PartialEq for Entry<B> {
    fn eq(&self, other: &Entry<B>) -> bool {
        self.name == other.name
    }
}

impl<B> Entry<B> {
    /// The parameter of that name.
    pub fn parameter(&self, name: &str) -> Option<&'static Parameter> {
        self.parameters.iter().find(|parameter| parameter.name == name)
    }
}

/// The entry of that name, or the nearest name.
pub fn find<B>(entries: &'static [Entry<B>], name: &str) -> Result<&'static Entry<B>, Problem> {
    entries
        .iter()
        .find(|entry| entry.name == name)
        .ok_or_else(|| Problem::new("is not known").found(name).help(suggest(name, &names(entries))))
}

/// The names of all entries, in their order.
pub fn names<B>(entries: &[Entry<B>]) -> Vec<&'static str> {
    entries.iter().map(|entry| entry.name).collect()
}
