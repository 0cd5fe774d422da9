//! Legacy VTK format (.vtk) of unstructured grids: versions 1 to 5.1, in text or big-endian binary.

use geometry::Point3;

use crate::content::Content;
use crate::data_array::DataArray;
use crate::error::{Parsed, Place, Problem};
use crate::vtk_cells::{Array, Cells, lost, regions};

/// Newest supported version.
const NEWEST: f64 = 5.1;

/// Scanner of words, and of numbers in text or binary.
struct Scanner<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Line of the position, from 1; meaningful in text only.
    line: usize,
    binary: bool,
}

/// Kind of items that a section describes, with their number.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Of {
    Grid,
    Cells(usize),
    Points(usize),
}

/// Content found so far.
#[derive(Default)]
struct Found {
    points: Option<Vec<f64>>,
    ends: Option<Vec<usize>>,
    list: Vec<i64>,
    types: Option<Vec<i64>>,
    /// Arrays with one number per cell.
    arrays: Vec<Array>,
    /// All other arrays, without their values, and whether they belong to cells.
    others: Vec<(Array, bool)>,
    /// Name of the array whose values are kept.
    wanted: Option<String>,
    /// All arrays, if one is wanted.
    data: Vec<DataArray>,
}

impl Found {
    /// Keeps an array with one number per cell, which may hold regions, or only the name of another array.
    /// `place` is the place of its description.
    fn keep(&mut self, of: Of, parts: usize, name: &str, place: Place, values: Vec<f64>) {
        // Blanks in names are written as %20.
        let name = name.replace("%20", " ");
        if self.wanted.is_some() && of != Of::Grid {
            let values = if self.wanted.as_ref() == Some(&name) { values.clone() } else { Vec::new() };
            let (of_cells, numbers) = (matches!(of, Of::Cells(_)), Vec::new());
            let (name, components) = (name.clone(), parts);
            self.data.push(DataArray { name, place, of_cells, components, numbers, values });
        }
        let array = Array { name, place, values };
        match (of, parts) {
            (Of::Grid, _) => {}
            (Of::Cells(_), 1) => self.arrays.push(array),
            _ => self.others.push((Array { values: Vec::new(), ..array }, matches!(of, Of::Cells(_)))),
        }
    }
}

pub(super) fn parse(bytes: &[u8], wanted: Option<&str>) -> Parsed<Content> {
    let mut scanner = Scanner { bytes, at: 0, line: 1, binary: false };
    let version = scanner.rest_of_line();
    if !version.starts_with("# vtk DataFile Version") {
        let expected = "# vtk DataFile Version";
        return Err((Place::Line(1), Problem::Expected { expected, found: version }));
    }
    let newest = version.rsplit(' ').next().and_then(|number| number.parse::<f64>().ok());
    if newest.is_none_or(|number| number > NEWEST) {
        return Err((Place::Line(1), Problem::Expected { expected: "a version up to 5.1", found: version }));
    }
    scanner.rest_of_line();
    let coding = scanner.word().unwrap_or_default();
    scanner.binary = coding.eq_ignore_ascii_case("BINARY");
    if !scanner.binary && !coding.eq_ignore_ascii_case("ASCII") {
        return scanner.fail("ASCII or BINARY", &coding);
    }
    scanner.exactly("DATASET")?;
    let dataset = scanner.word().unwrap_or_default();
    if !dataset.eq_ignore_ascii_case("UNSTRUCTURED_GRID") {
        return scanner.fail("UNSTRUCTURED_GRID (a mesh of cells)", &dataset);
    }
    let mut found = Found { wanted: wanted.map(str::to_string), ..Found::default() };
    let mut of = Of::Grid;
    while let Some(word) = scanner.word() {
        of = section(&mut scanner, &mut found, of, &word)?;
    }
    content(&scanner, found)
}

/// Reads the section that begins with this word, and returns the kind of items described by the next
/// sections.
fn section(scanner: &mut Scanner, found: &mut Found, of: Of, word: &str) -> Parsed<Of> {
    let values = match of {
        Of::Grid => 0,
        Of::Cells(count) | Of::Points(count) => count,
    };
    match word.to_ascii_uppercase().as_str() {
        "POINTS" => {
            let count = scanner.count()?;
            let kind = scanner.kind()?;
            found.points = Some(scanner.numbers(scanner.times(count, 3)?, &kind)?);
        }
        "CELLS" => cells(scanner, found)?,
        "CELL_TYPES" => {
            let count = scanner.count()?;
            found.types = Some(scanner.whole(count, "int")?);
        }
        "CELL_DATA" => return Ok(Of::Cells(scanner.count()?)),
        "POINT_DATA" => return Ok(Of::Points(scanner.count()?)),
        "METADATA" => scanner.skip_to_blank_line(),
        "FIELD" => field(scanner, found, of)?,
        "SCALARS" if of != Of::Grid => {
            let name = scanner.word().unwrap_or_default();
            let place = scanner.place();
            let kind = scanner.kind()?;
            let parts = match scanner.peek() {
                Some(word) if word.parse::<usize>().is_ok() => scanner.count()?,
                _ => 1,
            };
            if scanner.peek().as_deref() == Some("LOOKUP_TABLE") {
                scanner.word();
                scanner.word();
            }
            let values = scanner.numbers(scanner.times(values, parts)?, &kind)?;
            found.keep(of, parts, &name, place, values);
        }
        "VECTORS" | "NORMALS" | "TENSORS" | "TENSORS6" | "GLOBAL_IDS" | "PEDIGREE_IDS" if of != Of::Grid => {
            let name = scanner.word().unwrap_or_default();
            let place = scanner.place();
            let kind = scanner.kind()?;
            let parts = match word.to_ascii_uppercase().as_str() {
                "VECTORS" | "NORMALS" => 3,
                "TENSORS" => 9,
                "TENSORS6" => 6,
                _ => 1,
            };
            let values = scanner.numbers(scanner.times(values, parts)?, &kind)?;
            found.keep(of, parts, &name, place, values);
        }
        "TEXTURE_COORDINATES" if of != Of::Grid => {
            scanner.word();
            let parts = scanner.count()?;
            let kind = scanner.kind()?;
            scanner.numbers(scanner.times(values, parts)?, &kind)?;
        }
        "COLOR_SCALARS" if of != Of::Grid => {
            scanner.word();
            let parts = scanner.count()?;
            let kind = if scanner.binary { "unsigned_char" } else { "float" };
            scanner.numbers(scanner.times(values, parts)?, kind)?;
        }
        "LOOKUP_TABLE" => {
            scanner.word();
            let count = scanner.count()?;
            let kind = if scanner.binary { "unsigned_char" } else { "float" };
            scanner.numbers(scanner.times(count, 4)?, kind)?;
        }
        _ => return scanner.fail("a part of the format, such as POINTS or CELL_DATA", word),
    }
    Ok(of)
}

/// Reads the arrays of a field.
fn field(scanner: &mut Scanner, found: &mut Found, of: Of) -> Parsed<()> {
    scanner.word();
    for _ in 0..scanner.count()? {
        let Some(name) = scanner.word() else { return scanner.fail("the name of an array", "") };
        // A field without arrays may be followed by their description.
        let (parts, tuples) = (scanner.count()?, scanner.count()?);
        let place = scanner.place();
        let kind = scanner.kind()?;
        let values = scanner.numbers(scanner.times(parts, tuples)?, &kind)?;
        found.keep(of, parts, &name, place, values);
        if scanner.peek().as_deref() == Some("METADATA") {
            scanner.word();
            scanner.skip_to_blank_line();
        }
    }
    Ok(())
}

/// Reads `CELLS n size`, in which each length precedes its points; from version 5.1 on, offsets and points
/// are separate.
fn cells(scanner: &mut Scanner, found: &mut Found) -> Parsed<()> {
    let (count, size) = (scanner.count()?, scanner.count()?);
    if scanner.peek().is_some_and(|word| word.eq_ignore_ascii_case("OFFSETS")) {
        scanner.word();
        let kind = scanner.kind()?;
        let offsets = scanner.whole(count, &kind)?;
        scanner.exactly("CONNECTIVITY")?;
        let kind = scanner.kind()?;
        found.list = scanner.whole(size, &kind)?;
        let ends: Option<Vec<usize>> = offsets.iter().map(|&end| usize::try_from(end).ok()).collect();
        let ends =
            ends.filter(|ends| ends.is_sorted() && ends.first() == Some(&0) && ends.last() == Some(&size));
        return match ends {
            Some(ends) => {
                found.ends = Some(ends[1..].to_vec());
                Ok(())
            }
            None => scanner.fail("offsets that ascend from 0 to the length of CONNECTIVITY", "others"),
        };
    }
    let all = scanner.whole(size, "int")?;
    let (mut at, mut ends) = (0, Vec::new());
    for cell in 0..count {
        let length = all.get(at).and_then(|&length| usize::try_from(length).ok());
        let points = length.and_then(|length| all.get(at + 1..(at + 1).checked_add(length)?));
        let Some(points) = points else {
            let problem = Problem::End { expected: "the points of the cell, within the size given by CELLS" };
            return Err((Place::Cell(cell), problem));
        };
        found.list.extend(points);
        ends.push(found.list.len());
        at += 1 + points.len();
    }
    if at != size {
        let (found, expected) = (at, size);
        return Err((scanner.place(), Problem::ArrayLength { found, expected }));
    }
    found.ends = Some(ends);
    Ok(())
}

fn content(scanner: &Scanner, found: Found) -> Parsed<Content> {
    let missing = |section| (scanner.place(), Problem::Missing { section });
    let points = found.points.ok_or_else(|| missing("POINTS"))?;
    let ends = found.ends.ok_or_else(|| missing("CELLS"))?;
    let types = found.types.ok_or_else(|| missing("CELL_TYPES"))?;
    let counted = |found: usize, expected: usize| {
        let wrong = Problem::ArrayLength { found, expected };
        if found == expected { Ok(()) } else { Err((scanner.place(), wrong)) }
    };
    counted(types.len(), ends.len())?;
    let mut content = Content::default();
    for (number, x) in points.chunks_exact(3).enumerate() {
        content.node(Place::Node(number), number as u64, Point3::new(x[0], x[1], x[2]))?;
    }
    for array in found.data.iter().filter(|array| !array.values.is_empty()) {
        let items = if array.of_cells { types.len() } else { points.len() / 3 };
        let lengths = Problem::ArrayLength { found: array.values.len(), expected: array.components * items };
        if array.values.len() != array.components * items {
            return Err((array.place, lengths));
        }
    }
    found.data.into_iter().for_each(|array| content.arrays.push(array.numbered_from(0)));
    let array = |name: &str| -> Parsed<Option<Array>> {
        let found = found.arrays.iter().find(|array| array.name.eq_ignore_ascii_case(name));
        found.map_or(Ok(()), |array| counted(array.values.len(), types.len()))?;
        Ok(found.cloned())
    };
    let regions = regions(array)?;
    let surfaces = array("surface")?.map(|array| array.whole()).transpose()?;
    let name = regions.as_ref().map(|array| array.name.clone());
    let is_taken =
        |array: &Array| name.as_ref() == Some(&array.name) || array.name.eq_ignore_ascii_case("surface");
    let single =
        found.arrays.iter().filter(|array| !is_taken(array)).map(|array| lost(array, true, name.is_some()));
    content
        .leave_out(single.chain(found.others.iter().map(|(array, of_cells)| lost(array, *of_cells, true))));
    let regions = regions.map(|array| array.whole()).transpose()?;
    let further = Vec::new();
    let cells = Cells { first: 0, types, ends, list: found.list, regions, surfaces, further };
    cells.add_to(&mut content, &[], &[])?;
    if content.cell_count() == 0 { Err((scanner.place(), Problem::NoCells)) } else { Ok(content) }
}

impl Scanner<'_> {
    fn place(&self) -> Place {
        if self.binary { Place::Byte(self.at) } else { Place::Line(self.line) }
    }

    fn fail<T>(&self, expected: &'static str, found: &str) -> Parsed<T> {
        let found = found.chars().take(40).collect();
        Err((self.place(), Problem::Expected { expected, found }))
    }

    fn step(&mut self) {
        self.line += usize::from(self.bytes[self.at] == b'\n');
        self.at += 1;
    }

    /// Rest of the line; moves to the next line.
    fn rest_of_line(&mut self) -> String {
        let start = self.at;
        while self.at < self.bytes.len() && self.bytes[self.at] != b'\n' {
            self.at += 1;
        }
        let line = String::from_utf8_lossy(&self.bytes[start..self.at]).trim().to_string();
        if self.at < self.bytes.len() {
            self.step();
        }
        line
    }

    fn slice(&mut self) -> Option<(usize, usize)> {
        while self.bytes.get(self.at).is_some_and(u8::is_ascii_whitespace) {
            self.step();
        }
        let start = self.at;
        while self.bytes.get(self.at).is_some_and(|b| !b.is_ascii_whitespace()) {
            self.at += 1;
        }
        (self.at > start).then_some((start, self.at))
    }

    fn word(&mut self) -> Option<String> {
        let (start, end) = self.slice()?;
        Some(String::from_utf8_lossy(&self.bytes[start..end]).into_owned())
    }

    /// Next word, which is not consumed.
    fn peek(&mut self) -> Option<String> {
        let (at, line) = (self.at, self.line);
        let word = self.word();
        (self.at, self.line) = (at, line);
        word
    }

    fn exactly(&mut self, expected: &'static str) -> Parsed<()> {
        let found = self.word().unwrap_or_default();
        if found.eq_ignore_ascii_case(expected) { Ok(()) } else { self.fail(expected, &found) }
    }

    fn count(&mut self) -> Parsed<usize> {
        let found = self.word().unwrap_or_default();
        found.parse().or_else(|_| self.fail("a number of values", &found))
    }

    fn kind(&mut self) -> Parsed<String> {
        Ok(self.word().unwrap_or_default().to_ascii_lowercase())
    }

    fn times(&self, count: usize, parts: usize) -> Parsed<usize> {
        count.checked_mul(parts).ok_or((self.place(), Problem::TooMany { what: "numbers", count }))
    }

    fn whole(&mut self, count: usize, kind: &str) -> Parsed<Vec<i64>> {
        let numbers = self.numbers(count, kind)?;
        match numbers.iter().find(|number| number.fract() != 0.0) {
            Some(found) => self.fail("a whole number", &found.to_string()),
            None => Ok(numbers.into_iter().map(|number| number as i64).collect()),
        }
    }

    /// Reads numbers of a type; integers up to 2^53 are exact.
    fn numbers(&mut self, count: usize, kind: &str) -> Parsed<Vec<f64>> {
        let size = match kind {
            "char" | "unsigned_char" | "vtktypeint8" | "vtktypeuint8" => 1,
            "short" | "unsigned_short" | "vtktypeint16" | "vtktypeuint16" => 2,
            "int" | "unsigned_int" | "float" | "vtkidtype" | "vtktypeint32" | "vtktypeuint32" => 4,
            "long" | "unsigned_long" | "double" | "vtktypeint64" | "vtktypeuint64" => 8,
            _ => return self.fail("a type of numbers, such as double or int (no bits, no text)", kind),
        };
        // Each number takes at least one byte in text, or its size in binary.
        let room = (self.bytes.len() - self.at) / if self.binary { size } else { 1 };
        if count > room {
            return Err((self.place(), Problem::TooMany { what: "numbers for the size of the file", count }));
        }
        if !self.binary {
            return (0..count).map(|_| self.number()).collect();
        }
        // The binary data begin after the line break.
        self.rest_of_line();
        let Some(bytes) = self.bytes.get(self.at..self.at + count * size) else {
            return Err((self.place(), Problem::End { expected: "the rest of an array" }));
        };
        self.at += count * size;
        let unsigned = kind.starts_with("unsigned") || kind.starts_with("vtktypeu");
        Ok(bytes
            .chunks_exact(size)
            .map(|chunk| {
                let bits = chunk.iter().fold(0u64, |bits, &byte| bits << 8 | u64::from(byte));
                let fill = 64 - 8 * size as u32;
                match kind {
                    "float" => f64::from(f32::from_bits(bits as u32)),
                    "double" => f64::from_bits(bits),
                    _ if unsigned => bits as f64,
                    _ => ((bits << fill) as i64 >> fill) as f64,
                }
            })
            .collect())
    }

    fn number(&mut self) -> Parsed<f64> {
        let Some((start, end)) = self.slice() else {
            return Err((self.place(), Problem::End { expected: "the rest of an array" }));
        };
        let word = std::str::from_utf8(&self.bytes[start..end]).unwrap_or_default();
        word.parse().or_else(|_| self.fail("a number", word))
    }

    /// Skips past a blank line, which ends descriptions of arrays.
    fn skip_to_blank_line(&mut self) {
        self.rest_of_line();
        while self.at < self.bytes.len() && !self.rest_of_line().is_empty() {}
    }
}
