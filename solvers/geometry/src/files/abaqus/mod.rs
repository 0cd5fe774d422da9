//! Abaqus and CalculiX .inp decks: the mesh with its sets and surfaces, flat or in parts and instances.
//!
//! An element's region is the set of its `*SOLID SECTION`; without sections the smallest set it is in, of equally large ones the last;
//! else "body". What an instance adds to its part, be it the whole mesh, is its own. `*SURFACE`, `*NSET` and sets of shells on the faces of solids become facet groups. What several instances call the same
//! is named `INSTANCE.NAME`. Reading ends at the first `*STEP`;
//! before it a keyword that neither program has is refused. (Abaqus keywords reference; CalculiX
//! CrunchiX manual, chapter 7.)

mod assembly;
mod cards;
mod deck;
mod include;
mod keywords;
mod kinds;
mod names;
mod ranges;
mod scope;
pub(super) mod write;

use std::path::{Path, PathBuf};

use super::content::Content;
use super::error::Parsed;
use super::text;

pub(super) fn parse(bytes: &[u8], file: &Path) -> Parsed<Content> {
    let folder = file.parent().map(Path::to_path_buf).unwrap_or_default();
    let mut deck = deck::Deck::new(&folder);
    deck.read(&text(bytes)?, 0)?;
    deck.finish()
}

/// Files below a deck, in the order of their lines.
pub(super) fn included(file: &Path, folder: &Path) -> Vec<PathBuf> {
    let Ok(bytes) = disk::read(file, disk::Kind::MESH) else { return Vec::new() };
    let mut found = Vec::new();
    add_included(&bytes, folder, 0, &mut include::Includes::default(), &mut found);
    found
}

fn add_included(
    bytes: &[u8],
    folder: &Path,
    depth: usize,
    read: &mut include::Includes,
    found: &mut Vec<PathBuf>,
) {
    let Ok(text) = text(bytes) else { return };
    let cards = cards::cards(&text).unwrap_or_default();
    let names = cards.iter().filter(|card| card.keyword == "INCLUDE").filter_map(|card| card.get("INPUT"));
    for name in names.filter(|_| depth < include::DEEPEST) {
        if let Ok((path, bytes)) = read.read(folder, name) {
            found.push(path);
            add_included(&bytes, folder, depth + 1, read, found);
        }
    }
}
