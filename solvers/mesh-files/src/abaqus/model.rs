//! Cards of a deck for readers of its model, outside of this crate.

use super::cards::{cards, split};
use crate::error::{Place, Problem};
use crate::text::{text, unmarked};

/// A keyword line of a deck with its data lines, split at commas.
#[derive(Clone, Debug)]
pub struct DeckCard {
    /// Line of the keyword.
    pub line: usize,
    /// Keyword in upper case and its full spelling.
    pub keyword: String,
    /// Parameters in upper case, with their values.
    pub parameters: Vec<(String, String)>,
    /// Data lines with their line numbers.
    pub data: Vec<(usize, Vec<String>)>,
}

impl DeckCard {
    /// Value of a parameter, empty for a parameter without a value.
    pub fn get(&self, key: &str) -> Option<&str> {
        self.parameters.iter().find(|(known, _)| known == key).map(|(_, value)| value.as_str())
    }
}

/// Splits a deck into cards.
///
/// # Errors
/// The line and the problem of a text that is no deck.
pub fn deck_cards(bytes: &[u8]) -> Result<Vec<DeckCard>, (usize, String)> {
    let line = |place: &Place| match place {
        Place::Line(line) => *line,
        _ => 0,
    };
    let fault = |(place, problem): (Place, Problem)| (line(&place), problem.to_string());
    let text = text(unmarked(bytes)).map_err(fault)?;
    let cards = cards(&text).map_err(fault)?;
    let owned = |card: &super::cards::Card| DeckCard {
        line: line(&card.place),
        keyword: card.keyword.clone(),
        parameters: card.parameters().to_vec(),
        data: card.data.iter().map(|(place, words)| (line(place), split(words))).collect(),
    };
    Ok(cards.iter().map(owned).collect())
}

/// Name of the group of the element faces that a `*DLOAD` loads.
pub fn load_group(of: &str, label: &str) -> String {
    format!("{label} of {of}")
}
