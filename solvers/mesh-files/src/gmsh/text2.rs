//! Reader of version 2 in text: one pass over the lines, with a line number in every error.

use geometry::Point3;

use super::groups::{Names, named};
use super::order::{Element, element, known};
use crate::content::Content;
use crate::error::{Parsed, Problem};
use crate::lines::Lines;
use crate::rows::Row;

pub(super) fn parse(text: &str) -> Parsed<Content> {
    let mut lines = Lines::new(text);
    let mut content = Content::default();
    content.repeat_cells();
    let mut names = Names::default();
    let (mut nodes, mut elements) = (false, false);
    begin(&mut lines, "$MeshFormat")?;
    lines.need("the format version")?;
    lines.exactly("$EndMeshFormat")?;
    while let Some(line) = lines.next() {
        match line {
            "$PhysicalNames" => physical_names(&mut lines, &mut names, &mut content)?,
            "$Nodes" if nodes => return lines.fail(Problem::Repeated { section: "$Nodes" }),
            "$Nodes" => {
                read_nodes(&mut lines, &mut content, "$EndNodes")?;
                nodes = true;
            }
            "$Elements" if elements => return lines.fail(Problem::Repeated { section: "$Elements" }),
            "$Elements" if !nodes => return lines.fail(Problem::Missing { section: "$Nodes" }),
            "$Elements" => {
                read_elements(&mut lines, &names, &mut content)?;
                elements = true;
            }
            _ if line.starts_with('$') && !line.starts_with("$End") => skip(&mut lines, line)?,
            _ => {
                return lines
                    .fail(Problem::Expected { expected: "the start of a section", found: line.into() });
            }
        }
    }
    if !elements {
        let section = if nodes { "$Elements" } else { "$Nodes" };
        return lines.fail(Problem::Missing { section });
    }
    Ok(content)
}

/// Moves past the line that begins the first required section, skipping sections such as `$Comments`.
pub(super) fn begin(lines: &mut Lines, first: &'static str) -> Parsed<()> {
    loop {
        match lines.need(first)? {
            line if line == first => return Ok(()),
            line if line.starts_with('$') && !line.starts_with("$End") => skip(lines, line)?,
            line => return lines.fail(Problem::Expected { expected: first, found: line.into() }),
        }
    }
}

fn skip(lines: &mut Lines, start: &str) -> Parsed<()> {
    let end = format!("$End{}", start.trim_start_matches('$'));
    while !lines.need("the end of a section")?.eq_ignore_ascii_case(&end) {}
    Ok(())
}

pub(super) fn count(lines: &mut Lines, expected: &'static str) -> Parsed<usize> {
    let line = lines.need(expected)?;
    lines.number(Some(line), expected)
}

fn physical_names(lines: &mut Lines, names: &mut Names, content: &mut Content) -> Parsed<()> {
    for _ in 0..count(lines, "the number of physical names")? {
        let line = lines.need("a physical name")?;
        let name = named(lines, line)?;
        names.add(content, lines.place(), name)?;
    }
    lines.exactly("$EndPhysicalNames")
}

pub(super) fn read_nodes(lines: &mut Lines, content: &mut Content, end: &'static str) -> Parsed<()> {
    for _ in 0..count(lines, "the number of nodes")? {
        let line = lines.need("a node")?;
        let mut tokens = line.split_whitespace();
        let number = lines.number(tokens.next(), "a node number")?;
        let mut at = Point3::origin();
        for d in 0..3 {
            at[d] = lines.number(tokens.next(), "a coordinate")?;
        }
        if let Some(extra) = tokens.next() {
            return lines.fail(Problem::Expected { expected: "the end of the line", found: extra.into() });
        }
        content.node(lines.place(), number, at)?;
    }
    lines.exactly(end)
}

fn read_elements(lines: &mut Lines, names: &Names, content: &mut Content) -> Parsed<()> {
    let mut list = Vec::new();
    for _ in 0..count(lines, "the number of elements")? {
        let line = lines.need("an element")?;
        let mut tokens = line.split_whitespace();
        let number: u64 = lines.number(tokens.next(), "an element number")?;
        let kind: u64 = lines.number(tokens.next(), "an element type")?;
        let tags: usize = lines.number(tokens.next(), "a number of tags")?;
        let Some(element) = element(kind) else {
            let kind = kind.to_string();
            return lines.fail(Problem::UnknownType { element: number, kind, known: known() });
        };
        let (found, expected) =
            (line.split_whitespace().count(), tags.saturating_add(3 + element.node_count()));
        if found != expected {
            let kind = kind.to_string();
            return lines.fail(Problem::Length { element: number, kind, found, expected });
        }
        let mut group = 0;
        for tag in 0..tags {
            let value: i64 = lines.number(tokens.next(), "a tag")?;
            if tag == 0 {
                // A negative tag marks a reversed surface in Gmsh.
                group = value.unsigned_abs();
            }
        }
        list.clear();
        for _ in 0..element.node_count() {
            list.push(lines.number(tokens.next(), "a node number")?);
        }
        add(content, names, Row { place: lines.place(), tag: number }, element, &[group], &list)?;
    }
    lines.exactly("$EndElements")?;
    if content.cell_count() == 0 { lines.fail(Problem::NoCells) } else { Ok(()) }
}

/// Adds an element with its physical groups, where 0 means none; the first group is a solid's region.
pub(super) fn add(
    content: &mut Content,
    names: &Names,
    row: Row,
    element: Element,
    groups: &[u64],
    list: &[u64],
) -> Parsed<()> {
    match element {
        Element::Cell(kind) => {
            let group = groups.first().copied().unwrap_or(0);
            let region = names.region(content, row.place, group)?;
            content.cell(row, kind, region, list, kind.entry().files.gmsh_order)?;
            let cell = content.cell_count() as u32 - 1;
            for &group in groups.iter().skip(1).filter(|&&group| group != 0) {
                let region = names.region(content, row.place, group)?;
                content.also_in(cell, region);
            }
            Ok(())
        }
        Element::Face { corners, .. } if groups.iter().any(|&group| group != 0) => {
            let named = groups.iter().filter(|&&group| group != 0);
            let groups: Vec<usize> = named.map(|&group| names.group(content, group)).collect();
            content.face(row, &groups, list, corners)
        }
        Element::Curve { .. } => {
            for &group in groups.iter().filter(|&&group| group != 0) {
                content.curve(row, &names.curve(element.dimension().unsigned_abs(), group), list)?;
            }
            content.element(row, list)
        }
        Element::Face { .. } => content.element(row, list),
    }
}
