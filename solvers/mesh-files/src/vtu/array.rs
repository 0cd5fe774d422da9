//! Data arrays: numbers in text, base64 or raw bytes.

use std::io::Read;

use crate::error::{Parsed, Place, Problem};

/// Encoding of all arrays of a file, stated in its head.
#[derive(Clone, Copy)]
pub(super) struct Coding {
    pub(super) big_endian: bool,
    /// Width of a length word in bytes: 4 or 8.
    pub(super) head: usize,
    pub(super) compressor: Compressor,
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Compressor {
    None,
    Zlib,
    Lz4,
}

/// Bytes of an array and their encoding.
pub(super) enum Source<'a> {
    Text(&'a str),
    Base64(&'a [u8]),
    Raw(&'a [u8]),
}

/// Numbers of an array; integers stay integers.
pub(super) enum Numbers {
    Whole(Vec<i64>),
    Real(Vec<f64>),
}

/// Largest ratio of unpacked to packed bytes; zlib compresses zeros about a thousandfold.
const MOST_SHRUNK: usize = 1100;
/// Size of an array, in bytes and in numbers, up to which any compression is accepted; the types of eight
/// million cells have this size. A larger array may have at most 32 numbers per packed byte. Otherwise a file
/// of one mebibyte could take ten gigabytes.
const SHRUNK_BYTES: usize = 1 << 26;
const SHRUNK_NUMBERS: usize = 1 << 23;
const LARGE_SHRUNK: usize = 32;

/// Reads `count` numbers of a VTK type.
pub(super) fn read(
    source: &Source,
    kind: &str,
    count: usize,
    coding: Coding,
    place: Place,
) -> Parsed<Numbers> {
    let size = match kind {
        "Int8" | "UInt8" => 1,
        "Int16" | "UInt16" => 2,
        "Int32" | "UInt32" | "Float32" => 4,
        "Int64" | "UInt64" | "Float64" => 8,
        _ => {
            let expected = "a type of numbers, such as Float64 or Int64";
            return Err((place, Problem::Expected { expected, found: kind.into() }));
        }
    };
    let whole = !kind.starts_with("Float");
    let wanted = |packed: usize| {
        let is_small = |wanted: usize| wanted <= SHRUNK_BYTES && count <= SHRUNK_NUMBERS;
        let fits = |wanted: &usize| is_small(*wanted) || count <= packed.saturating_mul(LARGE_SHRUNK);
        let wanted = count.checked_mul(size).filter(fits);
        wanted.ok_or((place, Problem::TooMany { what: "numbers", count }))
    };
    let bytes = match source {
        Source::Text(text) => {
            let mut words = text.split_ascii_whitespace();
            return if whole {
                of_text(&mut words, count, place).map(Numbers::Whole)
            } else {
                of_text(&mut words, count, place).map(Numbers::Real)
            };
        }
        Source::Raw(bytes) => unpacked(&mut Plain { bytes }, wanted(bytes.len())?, coding, place)?,
        Source::Base64(text) => {
            unpacked(&mut Quartets { text, left: Vec::new() }, wanted(text.len())?, coding, place)?
        }
    };
    let ordered = |chunk: &[u8]| {
        let mut eight = [0; 8];
        eight[..size].copy_from_slice(chunk);
        if coding.big_endian {
            eight[..size].reverse();
        }
        u64::from_le_bytes(eight)
    };
    let each = bytes.chunks_exact(size).map(ordered);
    let fill = 64 - 8 * size as u32;
    Ok(match kind {
        "Float32" => Numbers::Real(each.map(|bits| f32::from_bits(bits as u32).into()).collect()),
        "Float64" => Numbers::Real(each.map(f64::from_bits).collect()),
        _ if kind.starts_with('U') => {
            Numbers::Whole(each.map(|bits| i64::try_from(bits).unwrap_or(-1)).collect())
        }
        _ => Numbers::Whole(each.map(|bits| (bits << fill) as i64 >> fill).collect()),
    })
}

fn of_text<'a, T: std::str::FromStr>(
    words: &mut impl Iterator<Item = &'a str>,
    count: usize,
    place: Place,
) -> Parsed<Vec<T>> {
    let mut found = Vec::new();
    for word in words {
        let number = word.parse().map_err(|_| {
            (place, Problem::Expected { expected: "a number", found: word.chars().take(40).collect() })
        })?;
        found.push(number);
    }
    counted(found.len(), count, place)?;
    Ok(found)
}

/// Rejects an array of another length.
fn counted(found: usize, expected: usize, place: Place) -> Parsed<()> {
    if found == expected { Ok(()) } else { Err((place, Problem::ArrayLength { found, expected })) }
}

/// A stream of bytes.
trait Bytes {
    /// Returns the next `count` bytes, or `None` if fewer are left.
    fn next(&mut self, count: usize) -> Option<Vec<u8>>;

    /// Approximate number of bytes left.
    fn left(&self) -> usize;
}

struct Plain<'a> {
    bytes: &'a [u8],
}

impl Bytes for Plain<'_> {
    fn next(&mut self, count: usize) -> Option<Vec<u8>> {
        let (head, rest) = self.bytes.split_at_checked(count)?;
        self.bytes = rest;
        Some(head.to_vec())
    }

    fn left(&self) -> usize {
        self.bytes.len()
    }
}

/// Base64 text in which each part may be padded with `=`, because lengths are encoded separately from their
/// data.
struct Quartets<'a> {
    text: &'a [u8],
    left: Vec<u8>,
}

impl Bytes for Quartets<'_> {
    fn next(&mut self, count: usize) -> Option<Vec<u8>> {
        if count > self.left() {
            return None;
        }
        let mut found = std::mem::take(&mut self.left);
        while found.len() < count {
            let (quartet, rest) = self.text.split_at_checked(4)?;
            self.text = rest;
            let mut bits = 0u32;
            for &c in quartet {
                bits = bits << 6 | u32::from(sextet(c)?);
            }
            let filled = quartet.iter().rev().take_while(|&&c| c == b'=').count();
            found.extend_from_slice(&bits.to_be_bytes()[1..4 - filled.min(2)]);
        }
        self.left = found.split_off(count);
        Some(found)
    }

    fn left(&self) -> usize {
        self.left.len() + self.text.len() / 4 * 3
    }
}

fn sextet(c: u8) -> Option<u8> {
    Some(match c {
        b'A'..=b'Z' => c - b'A',
        b'a'..=b'z' => c - b'a' + 26,
        b'0'..=b'9' => c - b'0' + 52,
        b'+' => 62,
        b'/' => 63,
        b'=' => 0,
        _ => return None,
    })
}

/// Unpacks the bytes of an array, which follow its length or the sizes of its compressed blocks.
fn unpacked(bytes: &mut impl Bytes, wanted: usize, coding: Coding, place: Place) -> Parsed<Vec<u8>> {
    let end = || (place, Problem::End { expected: "the rest of an array" });
    let length = |bytes: &mut dyn Bytes| -> Parsed<usize> {
        let mut word = bytes.next(coding.head).ok_or_else(end)?;
        if coding.big_endian {
            word.reverse();
        }
        word.resize(8, 0);
        let value = u64::from_le_bytes(word.try_into().expect("eight bytes"));
        usize::try_from(value).map_err(|_| end())
    };
    if coding.compressor == Compressor::None {
        let found = length(bytes)?;
        counted(found, wanted, place)?;
        return bytes.next(found).ok_or_else(end);
    }
    let (blocks, size, last) = (length(bytes)?, length(bytes)?, length(bytes)?);
    if blocks > bytes.left() / coding.head {
        return Err((place, Problem::TooMany { what: "blocks of an array", count: blocks }));
    }
    let sizes: Vec<usize> = (0..blocks).map(|_| length(bytes)).collect::<Parsed<_>>()?;
    let full = if last == 0 { blocks } else { blocks.saturating_sub(1) };
    let total = full.checked_mul(size).and_then(|bytes| bytes.checked_add(last));
    counted(total.unwrap_or(usize::MAX), wanted, place)?;
    if wanted > bytes.left().saturating_mul(MOST_SHRUNK) {
        return Err((place, Problem::TooMany { what: "bytes of an array", count: wanted }));
    }
    let mut all = Vec::with_capacity(wanted);
    for (block, packed) in sizes.into_iter().enumerate() {
        let packed = bytes.next(packed).ok_or_else(end)?;
        let room = if block < full { size } else { last };
        let unpacked = match coding.compressor {
            Compressor::Lz4 => lz4_flex::block::decompress(&packed, room).ok(),
            _ => {
                let mut unpacked = Vec::with_capacity(room);
                let mut reader = flate2::read::ZlibDecoder::new(&packed[..]).take(room as u64 + 1);
                reader.read_to_end(&mut unpacked).ok().map(|_| unpacked)
            }
        };
        match unpacked.filter(|found| found.len() == room) {
            Some(found) => all.extend(found),
            None => {
                let expected = "a block that unpacks to the stated length";
                return Err((place, Problem::Expected { expected, found: format!("block {block}") }));
            }
        }
    }
    Ok(all)
}
