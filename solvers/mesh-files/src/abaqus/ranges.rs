//! `GENERATE`: ranges of node or element numbers in a set.

use super::cards::whole;
use crate::content::Content;
use crate::error::{Parsed, Place, Problem};

/// Largest count of numbers that one line may generate, more than real decks have.
const MOST: u64 = 10_000_000;

/// A range of equally spaced numbers.
pub(super) struct Range {
    first: u64,
    step: u64,
    count: u64,
}

impl Range {
    /// Reads `first, last, step`, with a default step of 1. The steps from the first number have to reach the
    /// last.
    pub(super) fn read(place: Place, words: &[String]) -> Parsed<Range> {
        let word = |k: usize| words.get(k).map(String::as_str).filter(|word| !word.is_empty());
        let first = whole(place, word(0).unwrap_or(""), "the first number")?;
        let last = whole(place, word(1).unwrap_or(""), "the last number")?;
        let step = word(2).map_or(Ok(1), |word| whole(place, word, "the step between numbers"))?;
        let wrong = |expected| Err((place, Problem::Expected { expected, found: words.join(", ") }));
        let Some(span) = last.checked_sub(first).filter(|_| step > 0) else {
            return wrong("a first number, a last number not below the first, and a step of 1 or more");
        };
        if !span.is_multiple_of(step) {
            return wrong("a last number that is a whole number of steps from the first");
        }
        let steps = span / step;
        if steps >= MOST {
            return Err((place, Problem::TooMany { what: "numbers to generate", count: steps as usize }));
        }
        Ok(Range { first, step, count: steps + 1 })
    }

    /// Count of numbers in the range.
    pub(super) fn count(&self) -> usize {
        self.count as usize
    }

    /// Numbers of existing nodes or elements in the range; the others are left out, as in Abaqus.
    ///
    /// # Errors
    /// The first or the last number, if no node or element has this number.
    pub(super) fn members(&self, content: &Content, of_elements: bool) -> Result<Vec<u64>, u64> {
        let known = |number: u64| {
            if of_elements { content.knows_element(number) } else { content.node_of(number).is_some() }
        };
        let number = |k: u64| self.first + k * self.step;
        match [self.first, number(self.count - 1)].into_iter().find(|&end| !known(end)) {
            Some(missing) => Err(missing),
            None => Ok((0..self.count).map(number).filter(|&number| known(number)).collect()),
        }
    }
}
