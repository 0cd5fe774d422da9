//! Cards of a deck: a keyword line with its parameters and the data lines below.

use super::keywords;
use crate::error::{Parsed, Place, Problem};

/// A keyword line with the data below it.
pub(super) struct Card<'a> {
    pub(super) place: Place,
    /// Upper-case keyword with single spaces; a known keyword in its full spelling.
    pub(super) keyword: String,
    parameters: Vec<(String, String)>,
    /// Data lines with their places, without blank lines and comments.
    pub(super) data: Vec<(Place, &'a str)>,
}

/// Splits a deck into cards.
pub(super) fn cards(text: &str) -> Parsed<Vec<Card<'_>>> {
    let mut cards: Vec<Card> = Vec::new();
    let mut head: Option<(Place, String)> = None;
    for (index, line) in text.lines().enumerate() {
        let place = Place::Line(index + 1);
        let line = line.trim();
        if line.starts_with("**") || line.is_empty() {
            continue;
        }
        if let Some((begun, mut so_far)) = head.take() {
            so_far.push_str(line);
            (head, cards) = closed(begun, so_far, cards)?;
        } else if line.starts_with('*') {
            (head, cards) = closed(place, line.into(), cards)?;
        } else if let Some(card) = cards.last_mut() {
            card.data.push((place, line));
        } else {
            return Err((
                place,
                Problem::Expected { expected: "a keyword", found: line.chars().take(40).collect() },
            ));
        }
    }
    match head {
        Some((place, _)) => {
            Err((place, Problem::End { expected: "the rest of a keyword line that ends with a comma" }))
        }
        None => Ok(cards),
    }
}

type Open<'a> = (Option<(Place, String)>, Vec<Card<'a>>);

/// Finishes a keyword line, or keeps it open if it ends with a comma and so continues on the next line.
fn closed(place: Place, line: String, mut cards: Vec<Card>) -> Parsed<Open> {
    if line.ends_with(',') {
        return Ok((Some((place, line)), cards));
    }
    let mut parts = split(&line).into_iter();
    let keyword = parts.next().unwrap_or_default();
    let keyword: Vec<&str> = keyword.trim_start_matches('*').split_whitespace().collect();
    let parameters = parts.filter(|part| !part.is_empty()).map(|part| match part.split_once('=') {
        Some((key, value)) => (key.trim().to_ascii_uppercase(), unquoted(value)),
        None => (part.to_ascii_uppercase(), String::new()),
    });
    let keyword = keyword.join(" ").to_ascii_uppercase();
    let keyword = keywords::known(&keyword).map_or(keyword, String::from);
    let card = Card { place, keyword, parameters: parameters.collect(), data: Vec::new() };
    cards.push(card);
    Ok((None, cards))
}

/// Splits a line at commas outside of quotes.
pub(super) fn split(line: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut quoted = false;
    for c in line.chars() {
        match c {
            '"' => {
                quoted = !quoted;
                words.last_mut().expect("one at least").push(c);
            }
            ',' if !quoted => words.push(String::new()),
            _ => words.last_mut().expect("one at least").push(c),
        }
    }
    words.into_iter().map(|word| word.trim().to_string()).collect()
}

/// Removes the quotes around a name.
pub(super) fn unquoted(name: &str) -> String {
    let name = name.trim();
    name.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')).unwrap_or(name).to_string()
}

impl Card<'_> {
    /// Value of a parameter, empty for a parameter without a value.
    pub(super) fn get(&self, key: &str) -> Option<&str> {
        self.parameters.iter().find(|(known, _)| known == key).map(|(_, value)| value.as_str())
    }

    /// All parameters with their values.
    pub(super) fn parameters(&self) -> &[(String, String)] {
        &self.parameters
    }

    /// Values of all parameters.
    pub(super) fn values(&self) -> Vec<String> {
        self.parameters.iter().map(|(_, value)| value.clone()).collect()
    }

    /// Value of a required parameter.
    pub(super) fn need(&self, key: &'static str) -> Parsed<&str> {
        match self.get(key).filter(|value| !value.is_empty()) {
            Some(value) => Ok(value),
            None => {
                Err((self.place, Problem::Expected { expected: key, found: format!("*{}", self.keyword) }))
            }
        }
    }
}

/// Parses a whole number.
pub(super) fn whole(place: Place, word: &str, expected: &'static str) -> Parsed<u64> {
    word.parse().map_err(|_| (place, Problem::Expected { expected, found: word.into() }))
}

/// Parses a number, also in Fortran notation: `1.5D-3`.
pub(super) fn real(place: Place, word: &str, expected: &'static str) -> Parsed<f64> {
    let plain = word.replace(['d', 'D'], "e");
    // "infinity" and "nan" are not numbers of a deck.
    let number = plain.parse::<f64>().ok().filter(|_| plain.bytes().all(|b| b"0123456789+-.eE".contains(&b)));
    number.ok_or((place, Problem::Expected { expected, found: word.into() }))
}
