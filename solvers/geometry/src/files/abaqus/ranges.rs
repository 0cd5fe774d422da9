//! `GENERATE`: the nodes or elements of a set from one number to another.

use super::super::content::Content;
use super::super::error::{Parsed, Place, Problem};
use super::cards::whole;

/// Numbers that one line may generate: more than decks have, and made in a moment.
const MOST: u64 = 10_000_000;

/// Numbers in equal steps.
pub(super) struct Range {
    first: u64,
    step: u64,
    count: u64,
}

impl Range {
    /// `first, last, step`, the step 1 unless given; the last number is one of the range.
    pub(super) fn read(place: Place, words: &[String]) -> Parsed<Range> {
        let word = |k: usize| words.get(k).map(String::as_str).filter(|word| !word.is_empty());
        let first = whole(place, word(0).unwrap_or(""), "the first number")?;
        let last = whole(place, word(1).unwrap_or(""), "the last number")?;
        let step = word(2).map_or(Ok(1), |word| whole(place, word, "the step between numbers"))?;
        let wrong = |expected| Err((place, Problem::Expected { expected, found: words.join(", ") }));
        let Some(span) = last.checked_sub(first).filter(|_| step > 0) else {
            return wrong("a first number, a last one not below it, and a step of 1 or more");
        };
        if !span.is_multiple_of(step) {
            return wrong("a last number that the steps from the first one reach");
        }
        let steps = span / step;
        if steps >= MOST {
            return Err((place, Problem::TooMany { what: "numbers to generate", count: steps as usize }));
        }
        Ok(Range { first, step, count: steps + 1 })
    }

    /// How many numbers it has.
    pub(super) fn count(&self) -> usize {
        self.count as usize
    }

    /// The numbers that nodes or elements have; those between that none has are left out, as Abaqus does. The first or the last number
    /// if none has that.
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
