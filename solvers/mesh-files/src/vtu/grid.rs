//! Reader of the grid: points, cells and their names.

use geometry::Point3;
use roxmltree::{Document, Node};

use super::array::{Coding, Compressor, Numbers, Source, read};
use crate::content::Content;
use crate::data_array::DataArray;
use crate::error::{Parsed, Place, Problem};
use crate::left_out::LeftOut;
use crate::text::line_of;
use crate::vtk_cells::{Array, Cells, lost, regions};
use crate::xml::{line_of_fault, refuse_long_tags};

/// Prefix of the arrays that mark cells in groups across the regions; the number of the group follows.
pub(super) const GROUP: &str = "group-";

pub(super) struct File<'a> {
    bytes: &'a [u8],
    document: &'a Document<'a>,
    coding: Coding,
    /// Position after the `_` of appended data, and whether these are base64.
    appended: Option<(usize, bool)>,
    /// Name of the array whose values are kept.
    wanted: Option<&'a str>,
}

pub(crate) fn parse(bytes: &[u8], wanted: Option<&str>) -> Parsed<Content> {
    open(bytes, "UnstructuredGrid", wanted, |file| file.content())
}

/// Opens a file of this type and reads it.
pub(super) fn open<T>(
    bytes: &[u8],
    kind: &'static str,
    wanted: Option<&str>,
    read: impl FnOnce(File) -> Parsed<T>,
) -> Parsed<T> {
    // Raw data are not XML, so the text before them is parsed with a closing tag added.
    let tag = b"<AppendedData";
    let cut = bytes.windows(tag.len()).position(|w| w == tag);
    let text = std::str::from_utf8(&bytes[..cut.unwrap_or(bytes.len())]).map_err(|bad| {
        let place = Place::Line(line_of(bytes, bad.valid_up_to()));
        (place, Problem::Expected { expected: "text in UTF-8", found: "other bytes".into() })
    })?;
    refuse_long_tags(text)?;
    let closed = if cut.is_some() { format!("{text}</VTKFile>") } else { text.to_string() };
    let document = Document::parse(&closed)
        .map_err(|bad| (Place::Line(line_of_fault(&bad, text)), Problem::Xml { problem: bad.to_string() }))?;
    let root = document.root_element();
    let here = Place::Line(1);
    if !root.has_tag_name("VTKFile") {
        return Err((here, Problem::Format { found: format!("<{}>", root.tag_name().name()) }));
    }
    if root.attribute("type") != Some(kind) {
        let found = root.attribute("type").unwrap_or(root.tag_name().name()).to_string();
        let expected = "<VTKFile type=\"UnstructuredGrid\"> (a mesh) or \"PolyData\" (a surface)";
        return Err((here, Problem::Expected { expected, found }));
    }
    let compressor = match root.attribute("compressor") {
        None | Some("") => Compressor::None,
        Some("vtkZLibDataCompressor") => Compressor::Zlib,
        Some("vtkLZ4DataCompressor") => Compressor::Lz4,
        Some(other) => {
            let help = "write the file with zlib, lz4 or no compression";
            return Err((here, Problem::Unread { what: other.to_string(), help }));
        }
    };
    let head = if root.attribute("header_type") == Some("UInt64") { 8 } else { 4 };
    let coding = Coding { big_endian: root.attribute("byte_order") == Some("BigEndian"), head, compressor };
    let appended = cut.map(|cut| appended(bytes, cut)).transpose()?;
    read(File { bytes, document: &document, coding, appended, wanted })
}

/// Position after the `_` of the appended data, and whether these are base64.
fn appended(bytes: &[u8], cut: usize) -> Parsed<(usize, bool)> {
    let close = bytes[cut..].iter().position(|&b| b == b'>').map(|at| cut + at + 1);
    let start = close.and_then(|close| Some(close + bytes[close..].iter().position(|&b| b == b'_')? + 1));
    let (Some(close), Some(start)) = (close, start) else {
        return Err((Place::Byte(cut), Problem::End { expected: "_ and the appended data" }));
    };
    Ok((start, bytes[cut..close].windows(6).any(|w| w == b"base64")))
}

impl<'a> File<'a> {
    fn content(&self) -> Parsed<Content> {
        let mut content = Content::default();
        let all = self.document.root_element();
        let region_names = self.names(all, "region-names")?;
        let surface_names = self.names(all, "surface-names")?;
        for name in &region_names {
            content.region(Place::Line(1), name)?;
        }
        let mut pieces = 0;
        for piece in self.pieces() {
            pieces += 1;
            self.piece(piece, &mut content, &region_names, &surface_names)?;
        }
        match (pieces, content.cell_count()) {
            (0, _) => Err((Place::Line(1), Problem::Missing { section: "<Piece>" })),
            (_, 0) => Err((Place::Line(1), Problem::NoCells)),
            _ => Ok(content),
        }
    }

    pub(super) fn pieces(&self) -> impl Iterator<Item = Node<'a, 'a>> + use<'a> {
        let document: &'a Document<'a> = self.document;
        document.root_element().descendants().filter(|node| node.has_tag_name("Piece"))
    }

    pub(super) fn place(&self, node: Node) -> Place {
        Place::Line(self.document.text_pos_at(node.range().start).row as usize)
    }

    pub(super) fn count(&self, piece: Node, name: &'static str) -> Parsed<usize> {
        let found = piece.attribute(name).unwrap_or_default();
        let count = found.trim().parse::<usize>();
        count.map_err(|_| (self.place(piece), Problem::Expected { expected: name, found: found.into() }))
    }

    /// Reads a piece, whose points follow those of the previous pieces.
    fn piece(
        &self,
        piece: Node<'a, 'a>,
        content: &mut Content,
        region_names: &[String],
        surface_names: &[String],
    ) -> Parsed<()> {
        let (points, cells) = (self.count(piece, "NumberOfPoints")?, self.count(piece, "NumberOfCells")?);
        let first = content.node_count() as u64;
        self.data(piece, [cells, points], [content.element_count() as u64, first], content)?;
        let (place, at) = self.points(piece, points)?;
        for (number, x) in at.chunks_exact(3).enumerate() {
            content.node(place, first + number as u64, Point3::new(x[0], x[1], x[2]))?;
        }
        let of_cells = self.section(piece, "Cells")?;
        let named = |name| self.named(of_cells, name);
        let types = whole(self.array(named("types")?, cells)?, self.place(of_cells))?;
        let (ends, _) = self.offsets(of_cells, cells)?;
        let length = ends.last().copied().unwrap_or(0);
        let list = whole(self.array(named("connectivity")?, length)?, self.place(of_cells))?;
        let regions = regions(|name| self.cell_array(piece, cells, name))?;
        content.leave_out(self.lost(piece, cells, regions.as_ref())?);
        let regions = regions.map(|array| array.whole()).transpose()?;
        let surfaces = self.cell_array(piece, cells, "surface")?.map(|array| array.whole()).transpose()?;
        let mut further = Vec::new();
        for (at, name) in self.names(self.document.root_element(), "group-names")?.into_iter().enumerate() {
            if let Some(array) = self.cell_array(piece, cells, &format!("{GROUP}{at}"))? {
                further.push((name, array.whole()?));
            }
        }
        let cells = Cells { first, types, ends, list, regions, surfaces, further };
        cells.add_to(content, region_names, surface_names)
    }

    pub(super) fn section(&self, piece: Node<'a, 'a>, name: &'static str) -> Parsed<Node<'a, 'a>> {
        let found = piece.children().find(|node| node.has_tag_name(name));
        found.ok_or((self.place(piece), Problem::Missing { section: name }))
    }

    /// The array of this name in a section.
    pub(super) fn named(&self, section: Node<'a, 'a>, name: &'static str) -> Parsed<Node<'a, 'a>> {
        let mut arrays = section.children().filter(|node| node.has_tag_name("DataArray"));
        let found = arrays.find(|node| node.attribute("Name") == Some(name));
        found.ok_or((self.place(section), Problem::Missing { section: name }))
    }

    /// Coordinates of the points of a piece, and their place.
    pub(super) fn points(&self, piece: Node<'a, 'a>, points: usize) -> Parsed<(Place, Vec<f64>)> {
        let section = self.section(piece, "Points")?;
        let coordinates = section.children().find(|node| node.has_tag_name("DataArray"));
        let coordinates = coordinates.ok_or((self.place(piece), Problem::Missing { section: "Points" }))?;
        let place = self.place(coordinates);
        let dimension = coordinates.attribute("NumberOfComponents").unwrap_or("3");
        if dimension.trim() != "3" {
            let (expected, found) = ("points of 3 coordinates", dimension.to_string());
            return Err((place, Problem::Expected { expected, found }));
        }
        let three = points
            .checked_mul(3)
            .ok_or((self.place(piece), Problem::TooMany { what: "nodes", count: points }))?;
        Ok((place, reals(self.array(coordinates, three)?)))
    }

    /// Ends of the cells or polygons of a section in its list of nodes, and the place of these ends.
    pub(super) fn offsets(&self, section: Node<'a, 'a>, count: usize) -> Parsed<(Vec<usize>, Place)> {
        let node = self.named(section, "offsets")?;
        let offsets = whole(self.array(node, count)?, self.place(section))?;
        let ends: Option<Vec<usize>> = offsets.iter().map(|&end| usize::try_from(end).ok()).collect();
        let ends = ends.filter(|ends| ends.is_sorted());
        let unsorted = Problem::Expected { expected: "ascending offsets", found: "others".into() };
        ends.map(|ends| (ends, self.place(node))).ok_or((self.place(node), unsorted))
    }

    /// Adds the arrays of cells and points, if one is wanted: with the number of items and the first number of each.
    fn data(&self, piece: Node, counts: [usize; 2], first: [u64; 2], content: &mut Content) -> Parsed<()> {
        let Some(wanted) = self.wanted else { return Ok(()) };
        for (k, section) in ["CellData", "PointData"].into_iter().enumerate() {
            let data =
                piece.children().filter(|node| node.has_tag_name(section)).flat_map(|data| data.children());
            for node in data.filter(|node| node.has_tag_name("DataArray")) {
                let name = node.attribute("Name").unwrap_or_default().to_string();
                let place = self.place(node);
                let given = node.attribute("NumberOfComponents").unwrap_or("1");
                let expected = "a number of components";
                let wrong = |_| (place, Problem::Expected { expected, found: given.to_string() });
                let components: usize = given.trim().parse().map_err(wrong)?;
                let mut values = Vec::new();
                if name == wanted {
                    let count = counts[k].checked_mul(components);
                    let count =
                        count.ok_or((place, Problem::TooMany { what: "numbers", count: counts[k] }))?;
                    values = reals(self.array(node, count)?);
                }
                let (of_cells, numbers) = (k == 0, Vec::new());
                let array = DataArray { name, place, of_cells, components, numbers, values };
                content.arrays.push(array.numbered_from(first[k]));
            }
        }
        Ok(())
    }

    /// Arrays of cells and points that are not used.
    fn lost(&self, piece: Node, cells: usize, taken: Option<&Array>) -> Parsed<Vec<LeftOut>> {
        let mut found = Vec::new();
        for (section, of_cells) in [("CellData", true), ("PointData", false)] {
            let data =
                piece.children().filter(|node| node.has_tag_name(section)).flat_map(|data| data.children());
            for node in data.filter(|node| node.has_tag_name("DataArray")) {
                let name = node.attribute("Name").unwrap_or_default();
                let place = self.place(node);
                let own = name.eq_ignore_ascii_case("surface") || name.starts_with(GROUP);
                if of_cells && (own || taken.is_some_and(|taken| taken.name == name)) {
                    continue;
                }
                let single =
                    of_cells && node.attribute("NumberOfComponents").is_none_or(|count| count.trim() == "1");
                // Unreadable values are ignored here.
                let read = |_| self.array(node, cells).map(reals).unwrap_or_default();
                let values = (taken.is_none() && single).then_some(()).map(read).unwrap_or_default();
                found.push(lost(&Array { name: name.into(), place, values }, of_cells, taken.is_some()));
            }
        }
        Ok(found)
    }

    /// Numbers per cell, by the name of the array without regard to case.
    fn cell_array(&self, piece: Node, cells: usize, name: &str) -> Parsed<Option<Array>> {
        let data = piece.children().filter(|node| node.has_tag_name("CellData"));
        let mut arrays = data.flat_map(|data| data.children());
        let is_it = |node: &Node| node.attribute("Name").is_some_and(|own| own.eq_ignore_ascii_case(name));
        let Some(found) = arrays.find(is_it) else { return Ok(None) };
        let name = found.attribute("Name").unwrap_or_default().into();
        let place = self.place(found);
        Ok(Some(Array { name, place, values: reals(self.array(found, cells)?) }))
    }

    /// Strings of field data: character codes, each string terminated by a zero.
    fn names(&self, root: Node, name: &str) -> Parsed<Vec<String>> {
        let of_field = root.descendants().filter(|node| node.has_tag_name("FieldData"));
        let mut arrays = of_field.flat_map(|field| field.children());
        let Some(found) = arrays.find(|node| node.attribute("Name") == Some(name)) else {
            return Ok(Vec::new());
        };
        let bad = || (self.place(found), Problem::Expected { expected: "names in text", found: name.into() });
        let codes = found.text().unwrap_or_default().split_ascii_whitespace().map(str::parse::<u8>);
        let codes: Vec<u8> = codes.collect::<Result<_, _>>().map_err(|_| bad())?;
        let mut names = codes.split(|&code| code == 0).map(|name| String::from_utf8_lossy(name).into_owned());
        let mut names: Vec<String> = names.by_ref().collect();
        names.pop();
        Ok(names)
    }

    pub(super) fn array(&self, node: Node, count: usize) -> Parsed<Numbers> {
        let kind = node.attribute("type").unwrap_or_default();
        let format = node.attribute("format").unwrap_or("ascii");
        let text = node.text().unwrap_or_default();
        let place = self.place(node);
        match (format, self.appended) {
            ("ascii", _) => read(&Source::Text(text), kind, count, self.coding, place),
            ("binary", _) => read(&Source::Base64(text.trim().as_bytes()), kind, count, self.coding, place),
            ("appended", Some((start, base64))) => {
                let offset = node.attribute("offset").and_then(|offset| offset.trim().parse::<usize>().ok());
                let bytes = offset.and_then(|offset| self.bytes.get(start.checked_add(offset)?..));
                let Some(bytes) = bytes else {
                    let found = node.attribute("offset").unwrap_or_default().into();
                    return Err((place, Problem::Expected { expected: "an offset inside the file", found }));
                };
                let source = if base64 { Source::Base64(bytes) } else { Source::Raw(bytes) };
                read(&source, kind, count, self.coding, place)
            }
            ("appended", None) => Err((place, Problem::Missing { section: "<AppendedData>" })),
            _ => Err((
                place,
                Problem::Expected { expected: "ascii, binary or appended", found: format.into() },
            )),
        }
    }
}

fn reals(numbers: Numbers) -> Vec<f64> {
    match numbers {
        Numbers::Real(values) => values,
        Numbers::Whole(values) => values.into_iter().map(|value| value as f64).collect(),
    }
}

pub(super) fn whole(numbers: Numbers, place: Place) -> Parsed<Vec<i64>> {
    match numbers {
        Numbers::Whole(values) => Ok(values),
        Numbers::Real(_) => {
            Err((place, Problem::Expected { expected: "whole numbers", found: "reals".into() }))
        }
    }
}
