//! Parts of a file that are not in its mesh, reported so that the mesh is not mistaken for the complete
//! model.

use std::collections::BTreeMap;
use std::fmt;

use crate::error::Place;

/// A part of a mesh file that is not in the mesh, or that is read differently from the format.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// Place of the part.
    pub place: Place,
    /// Name of the part, such as a keyword or an array.
    pub what: String,
    /// Category of the part, by the consequence for the result.
    pub kind: Kind,
}

/// Category of a part of a file that is omitted or changed, by the consequence for the result of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// The part joins or supports parts of the body, so its omission changes the result.
    Joins,
    /// Material, supports, loads or steps, which a scene defines itself.
    Model,
    /// Whole numbers of cells that may denote regions.
    Regions,
    /// Other values of cells or nodes.
    Values,
    /// The part is read, but differently from the format.
    Changed,
}

impl Kind {
    fn words(self) -> &'static str {
        match self {
            Kind::Joins => "joins or supports parts of the body, so the result changes",
            Kind::Model => "defined by the scene instead",
            Kind::Regions => "whole numbers; if these are regions, name the array 'region'",
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

/// Describes omitted parts, one line for each kind and name, with all places.
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
