//! A model that is imported, and the parts of its scene that do not depend on the program.

use std::path::Path;

use super::document::{Part, quoted};
use super::finding::Finding;
use super::units::Units;

/// A scene made from a model.
#[derive(Debug)]
pub struct Imported {
    /// Text of the scene.
    pub scene: String,
    /// Parts of the model that are not in the scene.
    pub left_out: Vec<Finding>,
}

/// A model that is imported.
pub(super) struct Model<'a> {
    /// File name in findings.
    pub file: &'a str,
    /// Path as the scene writes it.
    pub path: &'a str,
    pub units: Units,
    /// Step that is imported, from 1; the last unless given.
    pub step: Option<usize>,
}

impl Model<'_> {
    /// Size of the method that takes the mesh of the model.
    pub fn size(&self) -> String {
        format!("{{ file = {}, unit = {} }}", quoted(self.path), quoted(self.units.length()))
    }
}

/// The title of a scene, with the parts of the model that it leaves out. `what` is imported, such as "the
/// deck".
pub(super) fn head(model: &Model, what: &str, left_out: &[Finding]) -> Part {
    let name = Path::new(model.path).file_name().unwrap_or_default().to_string_lossy();
    let mut part = Part::new("").note(format!(
        "Imported from {what} {name} by tissuebench. Its numbers are taken to be in {}.",
        model.units.words()
    ));
    if !left_out.is_empty() {
        part = part.note("Left out:");
    }
    for Finding { line, what, .. } in left_out {
        part = part.note(format!("* line {line}: {what}"));
    }
    part.key("title", quoted(&format!("{} {name}", what.trim_start_matches("the "))))
}
