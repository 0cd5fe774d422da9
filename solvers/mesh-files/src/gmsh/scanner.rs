//! Scanner of a file in text or binary: numbers, and the lines between them.

use crate::error::{Parsed, Place, Problem};

/// Position in the file and encoding of its numbers.
pub(super) struct Scanner<'a> {
    bytes: &'a [u8],
    at: usize,
    line: usize,
    binary: bool,
    /// Whether the file has the opposite byte order.
    swapped: bool,
}

impl<'a> Scanner<'a> {
    pub(super) fn new(bytes: &'a [u8], binary: bool) -> Scanner<'a> {
        Scanner { bytes, at: 0, line: 1, binary, swapped: false }
    }

    /// Current place: the line in text, the byte in binary.
    pub(super) fn place(&self) -> Place {
        if self.binary { Place::Byte(self.at) } else { Place::Line(self.line) }
    }

    pub(super) fn fail<T>(&self, problem: Problem) -> Parsed<T> {
        Err((self.place(), problem))
    }

    fn skip_blanks(&mut self) {
        while let Some(byte) = self.bytes.get(self.at).filter(|b| b.is_ascii_whitespace()) {
            self.line += usize::from(*byte == b'\n');
            self.at += 1;
        }
    }

    /// Next line that is not blank, or `None` at the end.
    pub(super) fn line(&mut self) -> Option<String> {
        self.skip_blanks();
        let rest = &self.bytes[self.at..];
        let length = rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
        self.at += length;
        (length > 0).then(|| String::from_utf8_lossy(&rest[..length]).trim_end().to_string())
    }

    pub(super) fn exactly(&mut self, expected: &'static str) -> Parsed<()> {
        match self.line() {
            Some(line) if line == expected => Ok(()),
            Some(mut found) => {
                found.truncate(found.char_indices().nth(40).map_or(found.len(), |(at, _)| at));
                self.fail(Problem::Expected { expected, found })
            }
            None => self.fail(Problem::End { expected }),
        }
    }

    /// Skips to the end of the section of this name.
    pub(super) fn skip(&mut self, name: &str) -> Parsed<()> {
        let end = format!("$End{name}");
        let rest = &self.bytes[self.at..];
        let Some(found) = rest.windows(end.len()).position(|w| w == end.as_bytes()) else {
            return self.fail(Problem::End { expected: "the end of a section" });
        };
        self.line += rest[..found].iter().filter(|&&b| b == b'\n').count();
        self.at += found + end.len();
        Ok(())
    }

    /// Moves past the next line that begins one of these sections, and returns the index of its name; `None` if the
    /// rest of the file has none.
    pub(super) fn find(&mut self, names: &[&str]) -> Option<usize> {
        while let Some(found) = self.bytes[self.at..].iter().position(|&b| b == b'$') {
            let skipped = &self.bytes[self.at..self.at + found];
            self.line += skipped.iter().filter(|&&b| b == b'\n').count();
            self.at += found;
            let rest = &self.bytes[self.at..];
            let is_it = |name: &str| {
                rest.starts_with(name.as_bytes()) && rest.get(name.len()).is_none_or(u8::is_ascii_whitespace)
            };
            if let Some(index) = names.iter().position(|name| is_it(name)) {
                self.at += names[index].len();
                return Some(index);
            }
            self.at += 1;
        }
        None
    }

    /// Detects the byte order by the number 1 after the version.
    pub(super) fn byte_order(&mut self) -> Parsed<()> {
        // Skips the line break after the version.
        self.at += 1;
        match self.take::<4>("the number 1 of the byte order")? {
            [1, 0, 0, 0] => self.swapped = false,
            [0, 0, 0, 1] => self.swapped = true,
            found => {
                let expected = "the number 1 of the byte order";
                return self.fail(Problem::Expected { expected, found: format!("{found:?}") });
            }
        }
        Ok(())
    }

    /// Skips the line break after a count or section name, before binary numbers.
    pub(super) fn behind_line(&mut self) {
        if self.binary && self.bytes.get(self.at) == Some(&b'\n') {
            self.at += 1;
        }
    }

    fn take<const N: usize>(&mut self, expected: &'static str) -> Parsed<[u8; N]> {
        let Some(found) = self.bytes.get(self.at..self.at + N) else {
            return self.fail(Problem::End { expected });
        };
        self.at += N;
        let mut found: [u8; N] = found.try_into().expect("as long");
        if self.swapped {
            found.reverse();
        }
        Ok(found)
    }

    fn token<T: std::str::FromStr>(&mut self, expected: &'static str) -> Parsed<T> {
        self.skip_blanks();
        let rest = &self.bytes[self.at..];
        let length = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        if length == 0 {
            return self.fail(Problem::End { expected });
        }
        let parsed = std::str::from_utf8(&rest[..length]).ok().and_then(|word| word.parse().ok());
        let Some(value) = parsed else {
            let found = String::from_utf8_lossy(&rest[..length.min(40)]).into();
            return self.fail(Problem::Expected { expected, found });
        };
        self.at += length;
        Ok(value)
    }

    /// Reads an integer, 32 bits wide in binary.
    pub(super) fn int(&mut self, expected: &'static str) -> Parsed<i64> {
        if !self.binary {
            return self.token(expected);
        }
        Ok(i32::from_le_bytes(self.take(expected)?).into())
    }

    /// Reads an unsigned integer, 64 bits wide in binary.
    pub(super) fn size(&mut self, expected: &'static str) -> Parsed<u64> {
        if self.binary { Ok(u64::from_le_bytes(self.take(expected)?)) } else { self.token(expected) }
    }

    pub(super) fn real(&mut self, expected: &'static str) -> Parsed<f64> {
        if self.binary { Ok(f64::from_le_bytes(self.take(expected)?)) } else { self.token(expected) }
    }

    /// Reads a non-negative integer, 64 bits wide in binary if `wide`, else 32.
    pub(super) fn tag(&mut self, wide: bool, expected: &'static str) -> Parsed<u64> {
        if wide {
            return self.size(expected);
        }
        let found = self.int(expected)?;
        u64::try_from(found).or_else(|_| self.fail(Problem::Expected { expected, found: found.to_string() }))
    }

    /// Checks a count against the rest of the file: each item takes at least `least` bytes in binary, or two
    /// in text.
    pub(super) fn counted(&self, count: u64, least: usize, what: &'static str) -> Parsed<usize> {
        let least = if self.binary { least } else { 2 };
        let room = (self.bytes.len() - self.at) / least + 1;
        match usize::try_from(count) {
            Ok(count) if count <= room => Ok(count),
            _ => self.fail(Problem::TooMany { what, count: usize::try_from(count).unwrap_or(usize::MAX) }),
        }
    }
}
