//! Numbered lines of a text file, and errors with line numbers.

use std::str::FromStr;

use crate::error::{Parsed, Place, Problem};

/// Iterator over lines with line numbers.
pub(super) struct Lines<'a> {
    lines: std::str::Lines<'a>,
    number: usize,
}

impl<'a> Lines<'a> {
    pub(super) fn new(text: &'a str) -> Lines<'a> {
        Lines { lines: text.lines(), number: 0 }
    }

    /// Next line that is not blank. After the last line, the place is one past the end.
    pub(super) fn next(&mut self) -> Option<&'a str> {
        loop {
            self.number += 1;
            let line = self.lines.next()?.trim();
            if !line.is_empty() {
                return Some(line);
            }
        }
    }

    /// Place of the last line returned.
    pub(super) fn place(&self) -> Place {
        Place::Line(self.number)
    }

    pub(super) fn need(&mut self, expected: &'static str) -> Parsed<&'a str> {
        match self.next() {
            Some(line) => Ok(line),
            None => self.fail(Problem::End { expected }),
        }
    }

    pub(super) fn fail<T>(&self, problem: Problem) -> Parsed<T> {
        Err((self.place(), problem))
    }

    pub(super) fn number<T: FromStr>(&self, token: Option<&str>, expected: &'static str) -> Parsed<T> {
        let found = token.unwrap_or("the end of the line");
        match token.and_then(|t| t.parse().ok()) {
            Some(value) => Ok(value),
            None => self.fail(Problem::Expected { expected, found: found.into() }),
        }
    }

    pub(super) fn exactly(&mut self, expected: &'static str) -> Parsed<()> {
        let line = self.need(expected)?;
        if line == expected { Ok(()) } else { self.fail(Problem::Expected { expected, found: line.into() }) }
    }
}
