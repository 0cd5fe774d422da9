//! The reader: one pass over the lines, every complaint with its line number.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::Path;

use super::error::{MshError, MshProblem};
use super::lines::{Lines, Parsed};
use super::order::{Element, element, order};
use crate::{CellKind, Facet, Mesh, Point3};

/// Reads a Gmsh 2.2 ASCII file; `unit` is the length of the file's unit in metres (0.001 for millimetres).
///
/// The physical group of a solid element becomes its region, that of a surface element a facet group; groups without
/// a name are called "region-TAG" and "surface-TAG", solids without a group "body". Points, lines and sections of
/// other kinds are read over, and so are nodes that no solid uses. Nodes keep the order of the file.
pub fn read(file: &Path, unit: f64) -> Result<Mesh, MshError> {
    let text =
        std::fs::read_to_string(file).map_err(|source| MshError::Io { file: file.to_path_buf(), source })?;
    read_text(&text, file, unit)
}

/// As [`read`], from text in memory; `file` is the name used in errors.
pub fn read_text(text: &str, file: &Path, unit: f64) -> Result<Mesh, MshError> {
    if unit.is_nan() || unit <= 0.0 || unit.is_infinite() {
        return Err(MshError::Unit { file: file.to_path_buf(), unit });
    }
    let content = parse(text).map_err(|(line, problem)| MshError::Syntax {
        file: file.to_path_buf(),
        line,
        problem,
    })?;
    content.into_mesh(unit, file)
}

#[derive(Default)]
struct Content {
    points: Vec<Point3>,
    kinds: Vec<CellKind>,
    nodes: Vec<u32>,
    regions: Vec<u16>,
    region_names: Vec<String>,
    groups: Vec<(String, Vec<Facet>)>,
}

/// Physical names by dimension and tag.
type Names = HashMap<(u64, u64), String>;

fn parse(text: &str) -> Parsed<Content> {
    let mut lines = Lines::new(text);
    let mut content = Content::default();
    let mut names = Names::new();
    let mut nodes: Option<HashMap<u64, u32>> = None;
    let (mut formatted, mut elements) = (false, false);
    while let Some(line) = lines.next() {
        match line {
            "$MeshFormat" => {
                format(&mut lines)?;
                formatted = true;
            }
            _ if !formatted => {
                return lines.fail(MshProblem::Expected { expected: "$MeshFormat", found: line.into() });
            }
            "$PhysicalNames" => physical_names(&mut lines, &mut names)?,
            "$Nodes" if nodes.is_some() => return lines.fail(MshProblem::Repeated { section: "$Nodes" }),
            "$Nodes" => nodes = Some(read_nodes(&mut lines, &mut content.points)?),
            "$Elements" if elements => return lines.fail(MshProblem::Repeated { section: "$Elements" }),
            "$Elements" => {
                let Some(numbers) = &nodes else {
                    return lines.fail(MshProblem::Missing { section: "$Nodes" });
                };
                read_elements(&mut lines, numbers, &names, &mut content)?;
                elements = true;
            }
            _ if line.starts_with('$') && !line.starts_with("$End") => skip(&mut lines, line)?,
            _ => {
                return lines
                    .fail(MshProblem::Expected { expected: "the start of a section", found: line.into() });
            }
        }
    }
    if !formatted {
        return lines.fail(MshProblem::End { expected: "$MeshFormat" });
    }
    if !elements {
        let section = if nodes.is_some() { "$Elements" } else { "$Nodes" };
        return lines.fail(MshProblem::Missing { section });
    }
    Ok(content)
}

fn format(lines: &mut Lines) -> Parsed<()> {
    let line = lines.need("the format version")?;
    let mut tokens = line.split_whitespace();
    let known = tokens.next().is_some_and(|v| v.starts_with("2.")) && tokens.next() == Some("0");
    if !known {
        return lines.fail(MshProblem::Format { found: line.into() });
    }
    lines.exactly("$EndMeshFormat")
}

fn skip(lines: &mut Lines, start: &str) -> Parsed<()> {
    let name = start.trim_start_matches('$');
    loop {
        if lines.need("the end of a section")?.strip_prefix("$End") == Some(name) {
            return Ok(());
        }
    }
}

fn count(lines: &mut Lines, expected: &'static str) -> Parsed<usize> {
    let line = lines.need(expected)?;
    lines.number(Some(line), expected)
}

fn physical_names(lines: &mut Lines, names: &mut Names) -> Parsed<()> {
    for _ in 0..count(lines, "the number of physical names")? {
        let line = lines.need("a physical name")?;
        let mut tokens = line.splitn(3, char::is_whitespace);
        let dimension = lines.number(tokens.next(), "the dimension of a physical name")?;
        let tag = lines.number(tokens.next(), "the tag of a physical name")?;
        let rest = tokens.next().unwrap_or("").trim();
        let Some(name) = rest.strip_prefix('"').and_then(|r| r.strip_suffix('"')).filter(|n| !n.is_empty())
        else {
            return lines.fail(MshProblem::Expected { expected: "a name in quotes", found: rest.into() });
        };
        if names.insert((dimension, tag), name.into()).is_some() {
            return lines.fail(MshProblem::Duplicate { what: "physical tag", number: tag });
        }
    }
    lines.exactly("$EndPhysicalNames")
}

fn read_nodes(lines: &mut Lines, points: &mut Vec<Point3>) -> Parsed<HashMap<u64, u32>> {
    let mut numbers = HashMap::new();
    for _ in 0..count(lines, "the number of nodes")? {
        let line = lines.need("a node")?;
        let mut tokens = line.split_whitespace();
        let number = lines.number(tokens.next(), "a node number")?;
        let mut at = Point3::origin();
        for d in 0..3 {
            at[d] = lines.number(tokens.next(), "a coordinate")?;
        }
        if let Some(extra) = tokens.next() {
            return lines.fail(MshProblem::Expected { expected: "the end of the line", found: extra.into() });
        }
        if !at.coords.iter().all(|c: &f64| c.is_finite()) {
            return lines.fail(MshProblem::NotFinite { number });
        }
        let Ok(index) = u32::try_from(points.len()) else {
            return lines.fail(MshProblem::TooMany { what: "nodes", count: points.len() });
        };
        if numbers.insert(number, index).is_some() {
            return lines.fail(MshProblem::Duplicate { what: "node", number });
        }
        points.push(at);
    }
    lines.exactly("$EndNodes")?;
    Ok(numbers)
}

/// A surface element waiting for its cell: line and element number, sorted corners, group.
struct Face {
    line: usize,
    element: u64,
    corners: Vec<u32>,
    group: usize,
}

fn read_elements(
    lines: &mut Lines,
    numbers: &HashMap<u64, u32>,
    names: &Names,
    content: &mut Content,
) -> Parsed<()> {
    let mut region_tags = Tags::default();
    let mut group_tags = Tags::default();
    let mut faces: Vec<Face> = Vec::new();
    let mut seen = HashSet::new();
    for _ in 0..count(lines, "the number of elements")? {
        let line = lines.need("an element")?;
        let mut tokens = line.split_whitespace();
        let number: u64 = lines.number(tokens.next(), "an element number")?;
        let kind: u64 = lines.number(tokens.next(), "an element type")?;
        let tags: usize = lines.number(tokens.next(), "a number of tags")?;
        if !seen.insert(number) {
            return lines.fail(MshProblem::Duplicate { what: "element", number });
        }
        let Some(element) = element(kind) else {
            return lines.fail(MshProblem::UnknownType { element: number, kind });
        };
        let (found, expected) =
            (line.split_whitespace().count(), tags.saturating_add(3 + element.node_count()));
        if found != expected {
            return lines.fail(MshProblem::Length { element: number, kind, found, expected });
        }
        let mut group = 0;
        for tag in 0..tags {
            let value: i64 = lines.number(tokens.next(), "a tag")?;
            if tag == 0 {
                // Gmsh marks a reversed surface by a negative tag.
                group = value.unsigned_abs();
            }
        }
        let mut list = [0u32; 20];
        for place in 0..element.node_count() {
            let node = lines.number(tokens.next(), "a node number")?;
            match numbers.get(&node) {
                Some(index) if list[..place].contains(index) => {
                    return lines.fail(MshProblem::RepeatedNode { element: number, node });
                }
                Some(&index) => list[place] = index,
                None => return lines.fail(MshProblem::UnknownNode { element: number, node }),
            }
        }
        match element {
            Element::Cell(kind) => {
                let mut ours = list;
                for (place, &local) in order(kind).iter().enumerate() {
                    ours[local] = list[place];
                }
                let Ok(region) = u16::try_from(region_tags.index_of(group)) else {
                    return lines
                        .fail(MshProblem::TooMany { what: "regions", count: region_tags.list.len() });
                };
                content.kinds.push(kind);
                content.nodes.extend_from_slice(&ours[..kind.node_count()]);
                content.regions.push(region);
            }
            Element::Face { corners, .. } if group != 0 => {
                let mut corners = list[..corners].to_vec();
                corners.sort_unstable();
                let group = group_tags.index_of(group);
                faces.push(Face { line: lines.number, element: number, corners, group });
            }
            Element::Face { .. } | Element::Ignored { .. } => {}
        }
    }
    lines.exactly("$EndElements")?;
    if content.kinds.is_empty() {
        return lines.fail(MshProblem::NoCells);
    }
    let name = |dimension, tag: u64, plain: &str| match names.get(&(dimension, tag)) {
        Some(name) => name.clone(),
        None => format!("{plain}-{tag}"),
    };
    content.region_names =
        region_tags.list.iter().map(|&t| if t == 0 { "body".into() } else { name(3, t, "region") }).collect();
    content.groups = group_tags.list.iter().map(|&t| (name(2, t, "surface"), Vec::new())).collect();
    attach(faces, content)
}

/// Tags in the order in which they come.
#[derive(Default)]
struct Tags {
    list: Vec<u64>,
    places: HashMap<u64, usize>,
}

impl Tags {
    /// The place of `tag` in the list, added at the end if it is new.
    fn index_of(&mut self, tag: u64) -> usize {
        let list = &mut self.list;
        *self.places.entry(tag).or_insert_with(|| {
            list.push(tag);
            list.len() - 1
        })
    }
}

/// Finds the cell face of every surface element; between two cells, that of the first.
fn attach(faces: Vec<Face>, content: &mut Content) -> Parsed<()> {
    if faces.is_empty() {
        return Ok(());
    }
    let mut owner: HashMap<Vec<u32>, Facet> = HashMap::new();
    let mut start = 0;
    for (cell, kind) in content.kinds.iter().enumerate() {
        for (face, local) in kind.faces().iter().enumerate() {
            let corners = &local[..kind.face_kind().corner_count()];
            let mut key: Vec<u32> = corners.iter().map(|&l| content.nodes[start + l]).collect();
            key.sort_unstable();
            owner.entry(key).or_insert(Facet { cell: cell as u32, face: face as u8 });
        }
        start += kind.node_count();
    }
    for Face { line, element, corners, group } in faces {
        match owner.get(&corners) {
            Some(&facet) => content.groups[group].1.push(facet),
            None => return Err((line, MshProblem::LooseFace { element })),
        }
    }
    Ok(())
}

impl Content {
    fn into_mesh(self, unit: f64, file: &Path) -> Result<Mesh, MshError> {
        let wrong = |source| MshError::Mesh { file: file.to_path_buf(), source };
        let mut used = vec![u32::MAX; self.points.len()];
        for &node in &self.nodes {
            used[node as usize] = 0;
        }
        let mut points = Vec::new();
        for (slot, p) in used.iter_mut().zip(&self.points).filter(|(slot, _)| **slot == 0) {
            *slot = points.len() as u32;
            points.push(Point3::from(p.coords * unit));
        }
        let nodes = self.nodes.iter().map(|&n| used[n as usize]).collect();
        let mut mesh = Mesh::from_flat(points, self.kinds, nodes)
            .map_err(wrong)?
            .with_regions(self.regions, self.region_names);
        let mut groups: BTreeMap<String, Vec<Facet>> = BTreeMap::new();
        for (name, facets) in self.groups {
            groups.entry(name).or_default().extend(facets);
        }
        for (name, mut facets) in groups {
            facets.sort_unstable();
            facets.dedup();
            mesh = mesh.with_group(&name, facets).map_err(wrong)?;
        }
        Ok(mesh)
    }
}
