//! Abaqus and CalculiX .inp decks: the mesh with its sets and surfaces, flat or in parts and instances.
//!
//! The region of an element is the set of its `*SOLID SECTION`. In a deck without sections the region is the
//! smallest set that contains the element, the last of equally large sets, or else "body". Content that an
//! instance adds to its part, even the whole mesh, belongs to this instance alone. `*SURFACE`, `*NSET` and
//! sets of shells on the faces of solids become facet groups. Names that occur in several instances become
//! `INSTANCE.NAME`. Reading ends at the first `*STEP`, except for the
//! element faces of `*DLOAD`, which become facet groups. Before this line, a keyword unknown to both programs
//! is rejected. (Abaqus keywords reference; CalculiX CrunchiX manual, chapter 7.)

mod assembly;
mod cards;
mod deck;
mod include;
mod keywords;
mod kinds;
mod model;
mod names;
mod ranges;
mod scope;
pub(super) mod write;

use std::path::{Path, PathBuf};

pub use model::{DeckCard, deck_cards, load_group};

use crate::content::Content;
use crate::error::Parsed;
use crate::text::text;

pub(super) fn parse(bytes: &[u8], file: &Path) -> Parsed<Content> {
    let folder = file.parent().map(Path::to_path_buf).unwrap_or_default();
    let mut deck = deck::Deck::new(&folder);
    deck.read(&text(bytes)?, 0)?;
    deck.finish()
}

/// Files included by a deck, in the order of their lines.
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
