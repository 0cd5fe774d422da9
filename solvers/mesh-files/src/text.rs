//! Text in files: decoding, byte order marks and line numbers.

use std::borrow::Cow;

use crate::error::{Parsed, Place, Problem};

/// Decodes a text in UTF-8, or else in Latin-1, in which every byte is a character.
pub(crate) fn text(bytes: &[u8]) -> Parsed<Cow<'_, str>> {
    let Err(bad) = std::str::from_utf8(bytes) else { return Ok(String::from_utf8_lossy(bytes)) };
    if bytes.contains(&0) {
        let place = Place::Line(line_of(bytes, bad.valid_up_to()));
        return Err((place, Problem::Expected { expected: "text", found: "other bytes".into() }));
    }
    Ok(bytes.iter().map(|&byte| char::from(byte)).collect())
}

/// Removes the byte order mark at the beginning and the zero bytes that some programs append to a text.
pub(crate) fn unmarked(bytes: &[u8]) -> &[u8] {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let end = bytes.iter().position(|&b| b == 0).unwrap_or(bytes.len());
    let behind_text = bytes[end..].iter().all(|&b| b == 0 || b.is_ascii_whitespace());
    if behind_text { &bytes[..end] } else { bytes }
}

/// Line number, from 1, of a byte.
pub(crate) fn line_of(bytes: &[u8], at: usize) -> usize {
    1 + bytes[..at.min(bytes.len())].iter().filter(|&&b| b == b'\n').count()
}

/// Returns the error for a file in none of the formats, with its first line.
pub(crate) fn unknown<T>(bytes: &[u8]) -> Parsed<T> {
    let start = bytes.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(bytes.len());
    let line = bytes[start..].split(|&b| b == b'\n').next().unwrap_or_default();
    let found = String::from_utf8_lossy(&line[..line.len().min(40)]).trim().to_string();
    Err((Place::Line(line_of(bytes, start)), Problem::Format { found }))
}
