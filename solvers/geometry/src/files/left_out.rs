//! Parts of a file that a mesh does not have, so that nobody takes it for the model that the file is.

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

use super::error::Place;

/// A part of a file that is not in the mesh, or not as the file has it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// Its line.
    pub place: Place,
    /// Its name: a keyword of a deck, an array.
    pub what: String,
    /// How it matters.
    pub kind: Kind,
}

/// How a part that is left out matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Joins or carries parts of the body: without it the answer is another.
    Joins,
    /// Material, supports, loads or steps: a scene has its own.
    Model,
    /// Numbers of cells that may mean regions.
    Regions,
    /// Other numbers of cells or nodes.
    Values,
    /// Read, but in another way than it is written.
    Changed,
}

impl Kind {
    fn words(self) -> &'static str {
        match self {
            Kind::Joins => "joins or carries parts of the body, which changes the answer",
            Kind::Model => "a scene has its own",
            Kind::Regions => "whole numbers: name the array 'region' to have regions",
            Kind::Values => "not used",
            Kind::Changed => "",
        }
    }
}

impl fmt::Display for LeftOut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.kind {
            Kind::Changed => write!(f, "{}", self.what),
            kind => write!(f, "{}: {} ({})", self.place, self.what, kind.words()),
        }
    }
}

/// Parts of the same kind and name in a line each, with all their places.
pub fn summary(parts: &[LeftOut]) -> Vec<String> {
    let mut groups: BTreeMap<(Kind, &str), Vec<String>> = BTreeMap::new();
    for part in parts {
        groups.entry((part.kind, &part.what)).or_default().push(part.place.to_string());
    }
    let line = |((kind, what), places): ((Kind, &str), Vec<String>)| match kind {
        Kind::Changed => what.to_string(),
        _ => format!("{what} ({})", places.join(", ")),
    };
    groups.into_iter().map(line).collect()
}

/// Parts of a file that its mesh leaves out; none of a surface or of a file that can't be read.
pub fn left_out(file: &Path) -> Vec<LeftOut> {
    let content = super::bytes(file).ok().and_then(|bytes| super::parse(&bytes, file).ok());
    content.map(super::Content::into_left_out).unwrap_or_default()
}
