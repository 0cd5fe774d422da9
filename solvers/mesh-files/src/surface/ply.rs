//! PLY: a header of elements with their properties, followed by their values in text or binary.

use geometry::surface::Soup;

use crate::error::{Parsed, Place, Problem};
use crate::text::text;

/// A scalar type with its size in bytes.
#[derive(Clone, Copy)]
enum Scalar {
    Signed(usize),
    Unsigned(usize),
    Real(usize),
}

struct Property {
    name: String,
    /// Type of the count, if the property is a list.
    list: Option<Scalar>,
    of: Scalar,
}

struct Element {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

/// Stream of values.
enum Values<'a> {
    Text { words: Box<dyn Iterator<Item = (usize, &'a str)> + 'a>, line: usize },
    Binary { bytes: &'a [u8], at: usize, big: bool },
}

pub(super) fn parse(bytes: &[u8]) -> Parsed<Soup> {
    let (elements, mut values) = header(bytes)?;
    let mut soup = Soup::default();
    let mut corners = Vec::new();
    for element in &elements {
        for row in 0..element.count {
            let place = values.place();
            let mut at = [f64::NAN; 3];
            for property in &element.properties {
                let count = match property.list {
                    None => 1,
                    Some(of) => {
                        let found = values.next(of)?;
                        let known = (0.0..=1e6).contains(&found) && found.fract() == 0.0;
                        let wrong = || Problem::Expected {
                            expected: "the length of a list",
                            found: found.to_string(),
                        };
                        if known { found as usize } else { return Err((values.place(), wrong())) }
                    }
                };
                let is_face = element.name == "face" && property.name.starts_with("vertex_ind");
                corners.clear();
                for _ in 0..count {
                    let value = values.next(property.of)?;
                    match (property.name.as_str(), element.name.as_str()) {
                        ("x", "vertex") => at[0] = value,
                        ("y", "vertex") => at[1] = value,
                        ("z", "vertex") => at[2] = value,
                        _ if is_face => corners.push(corner(value, row, &soup, place)?),
                        _ => {}
                    }
                }
                if is_face {
                    if corners.len() < 3 {
                        let (expected, found) =
                            ("a face of three corners or more", corners.len().to_string());
                        return Err((place, Problem::Expected { expected, found }));
                    }
                    let added = soup.face(row + 1, &corners);
                    added.map_err(|fault| (place, Problem::of_face(row + 1, fault)))?;
                }
            }
            if element.name == "vertex" {
                if !at.iter().all(|x| x.is_finite()) {
                    return Err((place, Problem::NotFinite { number: row as u64 }));
                }
                soup.points.push(at.into());
            }
        }
    }
    values.end()?;
    Ok(soup)
}

fn corner(value: f64, row: usize, soup: &Soup, place: Place) -> Parsed<u32> {
    if value.fract() == 0.0 && (0.0..soup.points.len() as f64).contains(&value) {
        return Ok(value as u32);
    }
    Err((place, Problem::UnknownCorner { face: row as u64 + 1, node: value as i64 }))
}

/// Reads the header; returns the elements and the values after the header.
fn header(bytes: &[u8]) -> Parsed<(Vec<Element>, Values<'_>)> {
    let mut elements: Vec<Element> = Vec::new();
    let (mut at, mut number, mut format) = (0, 0, None);
    loop {
        number += 1;
        let place = Place::Line(number);
        let Some(end) = bytes[at..].iter().position(|&b| b == b'\n') else {
            return Err((place, Problem::End { expected: "end_header" }));
        };
        let line = text(&bytes[at..at + end]).map_err(|(_, problem)| (place, problem))?;
        let line = line.trim();
        at += end + 1;
        let wrong = |expected: &'static str| (place, Problem::Expected { expected, found: line.into() });
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        match &words[..] {
            ["ply"] | ["comment" | "obj_info", ..] => {}
            ["format", name, "1.0"] => format = Some(name.to_string()),
            ["element", name, count] => {
                let count = count.parse().map_err(|_| wrong("a number of elements"))?;
                // Each element takes at least one byte, so memory is allocated for no more.
                if count > bytes.len() {
                    return Err((
                        place,
                        Problem::TooMany { what: "elements for the size of the file", count },
                    ));
                }
                elements.push(Element { name: (*name).into(), count, properties: Vec::new() });
            }
            ["property", kind @ .., name] => {
                let (list, of) = match kind {
                    ["list", count, of] => (Some(scalar(count)), scalar(of)),
                    [of] => (None, scalar(of)),
                    _ => return Err(wrong("property TYPE NAME")),
                };
                let of = of.ok_or_else(|| wrong("a type such as float or int"))?;
                let list = match list {
                    None => None,
                    Some(count) => Some(count.ok_or_else(|| wrong("a type such as uchar or int"))?),
                };
                let last = elements.last_mut().ok_or_else(|| wrong("an element before its properties"))?;
                last.properties.push(Property { name: (*name).into(), list, of });
            }
            ["end_header"] => break,
            _ => return Err(wrong("a line of a PLY header (format 1.0, element, property)")),
        }
    }
    let place = Place::Line(number);
    complete(&elements, place)?;
    let values = match format.as_deref() {
        Some("ascii") => {
            let found = || "other bytes".into();
            let text = std::str::from_utf8(&bytes[at..])
                .map_err(|_| (place, Problem::Expected { expected: "numbers in text", found: found() }))?;
            let lines = text.lines().enumerate();
            let words = lines.flat_map(move |(line, words)| {
                words.split_ascii_whitespace().map(move |word| (number + 1 + line, word))
            });
            Values::Text { words: Box::new(words), line: number }
        }
        Some("binary_little_endian") => Values::Binary { bytes, at, big: false },
        Some("binary_big_endian") => Values::Binary { bytes, at, big: true },
        Some(other) => {
            let expected = "format ascii, binary_little_endian or binary_big_endian";
            return Err((place, Problem::Expected { expected, found: other.into() }));
        }
        None => return Err((place, Problem::Missing { section: "format" })),
    };
    Ok((elements, values))
}

/// Checks that a header has vertices with coordinates, then faces with corners.
fn complete(elements: &[Element], place: Place) -> Parsed<()> {
    let needed = |name: &str, property: &str| {
        let element = elements.iter().find(|element| element.name == name);
        element.is_some_and(|element| element.properties.iter().any(|p| p.name.starts_with(property)))
    };
    if !["x", "y", "z"].iter().all(|axis| needed("vertex", axis)) {
        return Err((place, Problem::Missing { section: "vertex with x, y and z" }));
    }
    if !needed("face", "vertex_ind") {
        return Err((place, Problem::Missing { section: "face with a list vertex_indices" }));
    }
    if let Some(empty) = elements.iter().find(|element| element.properties.is_empty() && element.count > 0) {
        let found = format!("{} without one", empty.name);
        return Err((place, Problem::Expected { expected: "properties of each element", found }));
    }
    let order = |name: &str| elements.iter().position(|element| element.name == name);
    if order("face") < order("vertex") {
        let found = "face first".into();
        return Err((place, Problem::Expected { expected: "element vertex before element face", found }));
    }
    Ok(())
}

fn scalar(name: &str) -> Option<Scalar> {
    Some(match name {
        "char" | "int8" => Scalar::Signed(1),
        "uchar" | "uint8" => Scalar::Unsigned(1),
        "short" | "int16" => Scalar::Signed(2),
        "ushort" | "uint16" => Scalar::Unsigned(2),
        "int" | "int32" => Scalar::Signed(4),
        "uint" | "uint32" => Scalar::Unsigned(4),
        "float" | "float32" => Scalar::Real(4),
        "double" | "float64" => Scalar::Real(8),
        _ => return None,
    })
}

impl Values<'_> {
    fn place(&self) -> Place {
        match self {
            Values::Text { line, .. } => Place::Line(*line),
            Values::Binary { at, .. } => Place::Byte(*at),
        }
    }

    fn next(&mut self, of: Scalar) -> Parsed<f64> {
        match self {
            Values::Text { words, line } => {
                let end = (Place::Line(*line + 1), Problem::End { expected: "a value of an element" });
                let (at, word) = words.next().ok_or(end)?;
                *line = at;
                let found =
                    || (Place::Line(at), Problem::Expected { expected: "a number", found: word.into() });
                word.parse().map_err(|_| found())
            }
            Values::Binary { bytes, at, big } => {
                let (Scalar::Signed(size) | Scalar::Unsigned(size) | Scalar::Real(size)) = of;
                let end = (Place::Byte(bytes.len()), Problem::End { expected: "a value of an element" });
                let found = bytes.get(*at..*at + size).ok_or(end)?;
                *at += size;
                // Copies the bytes to the end of an eight-byte number, the most significant first.
                let mut wide = [0; 8];
                for (slot, byte) in (8 - size..8).zip(0..size) {
                    wide[slot] = if *big { found[byte] } else { found[size - 1 - byte] };
                }
                let bits = u64::from_be_bytes(wide);
                Ok(match of {
                    Scalar::Unsigned(_) => bits as f64,
                    // The sign is the most significant bit.
                    Scalar::Signed(size) => {
                        let shift = 64 - 8 * size as u32;
                        ((bits << shift) as i64 >> shift) as f64
                    }
                    Scalar::Real(4) => f64::from(f32::from_bits(bits as u32)),
                    Scalar::Real(_) => f64::from_bits(bits),
                })
            }
        }
    }

    /// Rejects content after the last element.
    fn end(mut self) -> Parsed<()> {
        let more = match &mut self {
            Values::Text { words, .. } => {
                words.next().map(|(line, word)| (Place::Line(line), word.to_string()))
            }
            Values::Binary { bytes, at, .. } => {
                let blank = bytes[*at..].iter().all(u8::is_ascii_whitespace);
                (!blank).then(|| (Place::Byte(*at), format!("{} bytes more", bytes.len() - *at)))
            }
        };
        match more {
            None => Ok(()),
            Some((place, found)) => {
                Err((place, Problem::Expected { expected: "the end of the file", found }))
            }
        }
    }
}
