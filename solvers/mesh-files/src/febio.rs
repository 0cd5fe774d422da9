//! Meshes of FEBio models, .feb of specification 4.0 and 3.0. Each `<Elements>` of solids becomes a region,
//! `<NodeSet>`, `<Surface>` and `<ElementSet>` become groups of their names. (FEBio User Manual 4, "Free
//! format input", 3.6.)
//!
//! The elements of rigid bodies are no cells: only their surface counts, and they do not deform. Their nodes
//! become a group under the name of the `<Elements>`, so that supports can move those that a solid shares.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};

use geometry::{CellKind, Point3};
use roxmltree::{Document, Node};

use crate::content::{Content, NO_REGION};
use crate::data_array::DataArray;
use crate::error::{Parsed, Place, Problem};
use crate::left_out::{Kind, LeftOut};
use crate::rows::Row;
use crate::text::text;
use crate::xml::{Lines, line_of_fault, refuse_long_tags};

/// Array of the directions of fibres, `<ElementData type="fiber">`.
const FIBRES: &str = "fiber";

/// Number of bytes in which the root element of a model begins.
const HEAD: usize = 4096;

/// Whether an XML file is an FEBio model, by its root element.
pub(super) fn is_model(bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(HEAD)];
    head.windows(b"<febio_spec".len()).any(|window| window == b"<febio_spec")
}

/// Name of the group of a node set; that of a surface with the same name is the name itself.
pub fn node_set_group(name: &str, surface_has_it: bool) -> String {
    if surface_has_it { format!("nodes:{name}") } else { name.into() }
}

/// Solid of an element type of FEBio.
pub fn solid_of(element: &str) -> Option<CellKind> {
    // FEBio names wedges after their five faces.
    let name = match element {
        "penta6" => "wedge6",
        "penta15" => "wedge15",
        other => other,
    };
    CellKind::ALL.into_iter().find(|kind| kind.name() == name)
}

/// Number of corners of a face type of FEBio.
fn face_corners(face: &str) -> Option<usize> {
    match face {
        "tri3" | "tri6" | "tri7" => Some(3),
        "quad4" | "quad8" | "quad9" => Some(4),
        _ => None,
    }
}

/// Text of a model, guarded for an XML parser.
///
/// # Errors
/// The line and the problem of bytes that are no text, or of a tag that is too long.
pub fn model_text(bytes: &[u8]) -> Result<Cow<'_, str>, (usize, String)> {
    let guarded = || {
        let text = text(bytes)?;
        refuse_long_tags(&text)?;
        Ok(text)
    };
    guarded().map_err(|(place, problem): (Place, Problem)| match place {
        Place::Line(line) => (line, problem.to_string()),
        _ => (0, problem.to_string()),
    })
}

struct Reader<'a> {
    lines: Lines,
    content: Content,
    /// Names of rigid `<Elements>`.
    rigid: HashSet<&'a str>,
    /// Nodes of elements that are not in the mesh.
    outside: HashSet<u64>,
    elements: HashMap<&'a str, Vec<u64>>,
    /// Elements of each `<ElementSet>` in the order of the file.
    sets: HashMap<&'a str, Vec<u64>>,
}

pub(super) fn parse(bytes: &[u8], wanted: Option<&str>) -> Parsed<Content> {
    let text = text(bytes)?;
    refuse_long_tags(&text)?;
    let document = Document::parse(&text).map_err(|bad| {
        (Place::Line(line_of_fault(&bad, &text)), Problem::Xml { problem: bad.to_string() })
    })?;
    let root = document.root_element();
    let lines = Lines::of(&text);
    let version = root.attribute("version").unwrap_or_default();
    if !["4.0", "3.0"].contains(&version) {
        let what = format!("febio_spec version '{version}'");
        let help = "save the model with FEBio Studio, which writes 4.0";
        return Err((Place::Line(lines.at(root)), Problem::Unread { what, help }));
    }
    let Some(mesh) = child(root, "Mesh") else {
        return Err((Place::Line(lines.at(root)), Problem::Missing { section: "Mesh" }));
    };
    let mut reader = Reader {
        lines,
        content: Content::default(),
        rigid: rigid_parts(root),
        outside: HashSet::new(),
        elements: HashMap::new(),
        sets: HashMap::new(),
    };
    // Unconnected nodes belong to rigid bodies, springs and shells.
    reader.content.leave_unused_out();
    let parts = |tag: &'static str| mesh.children().filter(move |node| node.has_tag_name(tag));
    parts("Nodes").try_for_each(|part| reader.nodes(part))?;
    parts("Elements").try_for_each(|part| reader.elements(part))?;
    let surfaces: HashSet<&str> = parts("Surface").filter_map(|part| part.attribute("name")).collect();
    parts("Surface").try_for_each(|part| reader.surface(part))?;
    parts("NodeSet").try_for_each(|part| reader.node_set(part, &surfaces))?;
    parts("ElementSet").try_for_each(|part| reader.element_set(part))?;
    let data = child(root, "MeshData").into_iter().flat_map(|section| section.children());
    data.filter(|node| node.has_tag_name("ElementData")).try_for_each(|part| reader.fibres(part, wanted))?;
    Ok(reader.content)
}

fn child<'a>(node: Node<'a, 'a>, name: &str) -> Option<Node<'a, 'a>> {
    node.children().find(|child| child.has_tag_name(name))
}

/// Names of the `<Elements>` whose material is a rigid body.
fn rigid_parts<'a>(root: Node<'a, 'a>) -> HashSet<&'a str> {
    let materials = child(root, "Material").into_iter().flat_map(|section| section.children());
    let rigid: HashSet<&str> = (materials
        .filter(|material| material.attribute("type") == Some("rigid body")))
    .filter_map(|material| material.attribute("name"))
    .collect();
    let domains = child(root, "MeshDomains").into_iter().flat_map(|section| section.children());
    (domains.filter(|domain| domain.attribute("mat").is_some_and(|name| rigid.contains(name))))
        .filter_map(|domain| domain.attribute("name"))
        .collect()
}

impl<'a> Reader<'a> {
    fn place(&self, node: Node) -> Place {
        Place::Line(self.lines.at(node))
    }

    fn nodes(&mut self, part: Node<'a, 'a>) -> Parsed<()> {
        for node in part.children().filter(|node| node.has_tag_name("node")) {
            let place = self.place(node);
            let number = self.id(node)?;
            let words: Vec<&str> = words(node).collect();
            let [x, y, z] = words[..] else {
                let found = words.join(", ");
                return Err((place, Problem::Expected { expected: "three coordinates", found }));
            };
            let read = |word: &str| {
                let bad = || (place, Problem::Expected { expected: "a number", found: word.into() });
                word.parse::<f64>().map_err(|_| bad())
            };
            self.content.node(place, number, Point3::new(read(x)?, read(y)?, read(z)?))?;
        }
        Ok(())
    }

    fn elements(&mut self, part: Node<'a, 'a>) -> Parsed<()> {
        let place = self.place(part);
        let (kind, name) = (self.attribute(part, "type")?, self.attribute(part, "name")?);
        let solid = solid_of(kind);
        let rigid = self.rigid.contains(name);
        let region = match solid {
            Some(_) if !rigid => self.content.region(place, name)?,
            _ => NO_REGION,
        };
        let (mut own, mut nodes) = (Vec::new(), Vec::new());
        for element in part.children().filter(|node| node.has_tag_name("elem")) {
            let row = Row { place: self.place(element), tag: self.id(element)? };
            let list = self.whole_numbers(element)?;
            match solid {
                Some(solid) if !rigid => {
                    if list.len() != solid.node_count() {
                        let expected = "as many nodes as the element type has";
                        let found = format!("{} of {kind}", list.len());
                        return Err((row.place, Problem::Expected { expected, found }));
                    }
                    self.content.cell(row, solid, region, &list, solid.entry().files.abaqus_order)?;
                    own.push(row.tag);
                }
                _ => {
                    self.content.element(row, &list)?;
                    nodes.extend(list.iter().filter_map(|&node| self.content.node_of(node)));
                    self.outside.extend(list);
                }
            }
        }
        match solid {
            Some(_) if rigid => {
                let part = LeftOut { place, what: format!("rigid body '{name}'"), kind: Kind::Model };
                self.content.leave_out([part]);
                nodes.sort_unstable();
                nodes.dedup();
                self.content.node_set(name, nodes);
            }
            Some(_) => {}
            None => {
                let what = format!("elements {kind} '{name}'");
                self.content.leave_out([LeftOut { place, what, kind: Kind::Joins }]);
            }
        }
        self.elements.insert(name, own);
        Ok(())
    }

    fn surface(&mut self, part: Node<'a, 'a>) -> Parsed<()> {
        let name = self.attribute(part, "name")?;
        let group = self.content.group(name);
        for (count, face) in (1..).zip(part.children().filter(Node::is_element)) {
            let row = Row { place: self.place(face), tag: count };
            let kind = face.tag_name().name();
            let Some(corners) = face_corners(kind) else {
                let expected = "a face: tri3, tri6, quad4 or quad8";
                return Err((row.place, Problem::Expected { expected, found: kind.into() }));
            };
            let list = self.whole_numbers(face)?;
            if list.len() < corners {
                let found = format!("{} nodes", list.len());
                return Err((row.place, Problem::Expected { expected: "all corners of the face", found }));
            }
            // A face of a rigid body or a shell belongs to no cell.
            let loose = list.iter().all(|node| self.outside.contains(node));
            self.content.cell_face(row, group, &list[..corners], loose)?;
        }
        Ok(())
    }

    fn node_set(&mut self, part: Node<'a, 'a>, surfaces: &HashSet<&str>) -> Parsed<()> {
        let name = self.attribute(part, "name")?;
        let place = self.place(part);
        let mut nodes = Vec::new();
        for number in self.members(part)? {
            let Some(node) = self.content.node_of(number) else {
                let (of, number) = ("node", number.to_string());
                let problem = Problem::UnknownMember { what: "node set", name: name.into(), of, number };
                return Err((place, problem));
            };
            self.content.touch(number);
            nodes.push(node);
        }
        self.content.node_set(&node_set_group(name, surfaces.contains(name)), nodes);
        Ok(())
    }

    fn element_set(&mut self, part: Node<'a, 'a>) -> Parsed<()> {
        let name = self.attribute(part, "name")?;
        self.sets.insert(name, self.members(part)?);
        // The elements of a domain have its name already.
        if self.elements.contains_key(name) {
            return Ok(());
        }
        let cells: Vec<u32> =
            self.members(part)?.into_iter().filter_map(|number| self.content.cell_of(number)).collect();
        self.content.also(self.place(part), name, &cells)
    }

    /// Reads the directions of fibres by the places of their elements in a set, as an array of their type.
    fn fibres(&mut self, part: Node<'a, 'a>, wanted: Option<&str>) -> Parsed<()> {
        let kind = part.attribute("type").or(part.attribute("var")).unwrap_or_default();
        if kind != FIBRES {
            return Ok(());
        }
        let place = self.place(part);
        let (of_cells, name) = (true, kind.to_string());
        let mut array =
            DataArray { name, place, of_cells, components: 3, numbers: Vec::new(), values: Vec::new() };
        if wanted == Some(kind) {
            let set = part.attribute("elem_set").unwrap_or_default();
            let Some(members) = self.sets.get(set).or_else(|| self.elements.get(set)) else {
                let expected = "an elem_set of the mesh";
                return Err((place, Problem::Expected { expected, found: format!("'{set}'") }));
            };
            for node in part.children().filter(Node::is_element) {
                let at = self.place(node);
                let word = node.attribute("lid").unwrap_or_default();
                let local = word.parse::<usize>().ok().and_then(|local| members.get(local.checked_sub(1)?));
                let Some(number) = local else {
                    let expected = "the place of an element in the set, from 1, as attribute 'lid'";
                    return Err((at, Problem::Expected { expected, found: format!("'{word}'") }));
                };
                let values: Vec<f64> = words(node).filter_map(|word| word.parse().ok()).collect();
                if values.len() != 3 || words(node).count() != 3 {
                    let found = words(node).collect::<Vec<_>>().join(", ");
                    return Err((at, Problem::Expected { expected: "three components", found }));
                }
                array.numbers.push(*number);
                array.values.extend(values);
            }
        }
        self.content.arrays.push(array);
        Ok(())
    }

    /// Members of a set, as text or each in its own element.
    fn members(&self, part: Node<'a, 'a>) -> Parsed<Vec<u64>> {
        let children: Vec<Node> = part.children().filter(Node::is_element).collect();
        if children.is_empty() {
            return self.whole_numbers(part);
        }
        children.into_iter().map(|child| self.id(child)).collect()
    }

    fn id(&self, node: Node<'a, 'a>) -> Parsed<u64> {
        self.whole(node, self.attribute(node, "id")?)
    }

    fn whole_numbers(&self, node: Node<'a, 'a>) -> Parsed<Vec<u64>> {
        words(node).map(|word| self.whole(node, word)).collect()
    }

    fn whole(&self, node: Node, word: &str) -> Parsed<u64> {
        let bad = || Problem::Expected { expected: "a positive whole number", found: word.into() };
        word.trim().parse().map_err(|_| (self.place(node), bad()))
    }

    fn attribute(&self, node: Node<'a, 'a>, name: &'static str) -> Parsed<&'a str> {
        let found = || format!("<{}>", node.tag_name().name());
        let missing = || {
            let expected = match name {
                "id" => "an attribute 'id'",
                "type" => "an attribute 'type'",
                _ => "an attribute 'name'",
            };
            (self.place(node), Problem::Expected { expected, found: found() })
        };
        node.attribute(name).ok_or_else(missing)
    }
}

/// Words of an element's text, separated by commas or blanks.
fn words<'a>(node: Node<'a, 'a>) -> impl Iterator<Item = &'a str> {
    let text = node.text().unwrap_or_default();
    text.split(|c: char| c == ',' || c.is_whitespace()).filter(|word| !word.is_empty())
}
