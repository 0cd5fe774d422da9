//! A part of a deck, or a flat deck: nodes, elements, sets and surfaces with their own numbering.

use std::collections::HashMap;

use geometry::{CellKind, Point3};

use super::cards::{Card, real, split, unquoted, whole};
use super::kinds::{Type, element_type, known};
use super::model::load_group;
use super::ranges::Range;
use crate::content::{Content, NO_REGION};
use crate::error::{Parsed, Place, Problem};
use crate::rows::Row;

/// Nodes, elements, sets and surfaces. Names are compared without regard to case and kept as first written.
#[derive(Clone, Default)]
pub(super) struct Scope {
    pub(super) content: Content,
    kinds: Vec<CellKind>,
    elsets: Sets,
    nsets: Sets,
    /// Sets that determine the region of their elements.
    sections: Vec<(Place, String)>,
    /// Places and corners of the shells, by element number.
    shells: HashMap<u64, (Place, Vec<u64>)>,
    /// Number of members of all sets so far.
    members: u64,
    /// Whether the deck is a model with steps.
    pub(super) of_model: bool,
}

/// Names as written and members of sets, by upper-case name.
#[derive(Clone, Default)]
struct Sets {
    lists: HashMap<String, (String, Vec<u64>)>,
    order: Vec<String>,
}

impl Sets {
    fn of(&mut self, name: &str) -> &mut Vec<u64> {
        let key = name.to_ascii_uppercase();
        if !self.lists.contains_key(&key) {
            self.order.push(key.clone());
        }
        &mut self.lists.entry(key).or_insert_with(|| (name.into(), Vec::new())).1
    }

    fn get(&self, name: &str) -> Option<&(String, Vec<u64>)> {
        self.lists.get(&name.to_ascii_uppercase())
    }
}

impl Scope {
    pub(super) fn nodes(&mut self, card: &Card) -> Parsed<()> {
        let system = card.get("SYSTEM").unwrap_or("R").to_ascii_uppercase();
        if system != "R" && system != "C" {
            let help =
                "write the nodes in x, y, z (SYSTEM=R), or in radius, angle in degrees and z (SYSTEM=C)";
            return Err((card.place, Problem::Unread { what: format!("*NODE, SYSTEM={system}"), help }));
        }
        let mut numbers = Vec::new();
        for &(place, line) in &card.data {
            let words = split(line);
            let number = whole(place, &words[0], "a node number")?;
            let mut at = Point3::origin();
            for d in 0..3 {
                // Omitted coordinates are 0.
                match words.get(d + 1).map(String::as_str) {
                    None | Some("") => {}
                    Some(word) => at[d] = real(place, word, "a coordinate")?,
                }
            }
            if system == "C" {
                let (sin, cos) = at.y.to_radians().sin_cos();
                at = Point3::new(at.x * cos, at.x * sin, at.z);
            }
            self.content.node(place, number, at)?;
            numbers.push(number);
        }
        if let Some(set) = card.get("NSET") {
            self.nsets.of(set).extend(numbers);
        }
        Ok(())
    }

    pub(super) fn elements(&mut self, card: &Card) -> Parsed<()> {
        let name = card.need("TYPE")?;
        let set = card.get("ELSET").map(String::from);
        let mut numbers = Vec::new();
        let mut lines = card.data.iter();
        while let Some(&(place, line)) = lines.next() {
            let mut words = split(line);
            let number = whole(place, &words[0], "an element number")?;
            let Some(of_type) = element_type(name) else {
                let kind = name.to_string();
                return Err((place, Problem::UnknownType { element: number, kind, known: known() }));
            };
            let wanted = match of_type {
                Type::Cell(kind) => Some(kind.node_count()),
                Type::Face(_, nodes) => Some(nodes),
                Type::Other => None,
            };
            // A node list continues on the next line if it is too short or ends with a comma.
            let short = |words: &Vec<String>| {
                let open = words.last().is_some_and(String::is_empty);
                wanted.map_or(open, |nodes| words.iter().filter(|word| !word.is_empty()).count() <= nodes)
            };
            while short(&words) {
                let Some(&(_, more)) = lines.next() else { break };
                words.extend(split(more));
            }
            words.retain(|word| !word.is_empty());
            numbers.push(number);
            let Some(nodes) = wanted else {
                // Numbers of such elements are nodes, and possibly properties or other elements.
                self.content.element(Row { place, tag: number }, &[])?;
                self.touch(&words[1..]);
                continue;
            };
            // CalculiX takes the first eight nodes of a C3D8, which some models list as for a C3D20.
            let longer = self.of_model && name.eq_ignore_ascii_case("C3D8") && words.len() > nodes + 1;
            if longer || has_inner_nodes(name, nodes, words.len() - 1) {
                self.touch(&words.split_off(nodes + 1));
                self.content.leave_unused_out();
            }
            if words.len() != nodes + 1 {
                let found = words.len();
                let expected = nodes + 1;
                let kind = name.to_string();
                return Err((place, Problem::Length { element: number, kind, found, expected }));
            }
            let list: Vec<u64> =
                words[1..].iter().map(|word| whole(place, word, "a node number")).collect::<Parsed<_>>()?;
            let Type::Cell(kind) = of_type else {
                self.content.element(Row { place, tag: number }, &list)?;
                let corners = if let Type::Face(corners, _) = of_type { corners } else { 0 };
                self.shells.insert(number, (place, list[..corners].to_vec()));
                continue;
            };
            let row = Row { place, tag: number };
            self.content.cell(row, kind, NO_REGION, &list, kind.entry().files.abaqus_order)?;
            self.kinds.push(kind);
        }
        if let Some(set) = set {
            self.elsets.of(&set).extend(numbers);
        }
        Ok(())
    }

    /// Marks nodes as used if their numbers are among these words.
    fn touch(&mut self, words: &[String]) {
        for number in words.iter().filter_map(|word| word.parse().ok()) {
            self.content.touch(number);
        }
    }

    /// Marks the nodes of a skipped card as used: some, such as reference points of rigid bodies, occur
    /// nowhere else.
    pub(super) fn read_over(&mut self, card: &Card) {
        self.touch(&card.values());
        card.data.iter().for_each(|(_, line)| self.touch(&split(line)));
    }

    /// Reads `*ELSET` and `*NSET`.
    pub(super) fn set(&mut self, card: &Card) -> Parsed<()> {
        let of_elements = card.keyword == "ELSET";
        let name = card.need(if of_elements { "ELSET" } else { "NSET" })?;
        let what = if of_elements { "element set" } else { "node set" };
        let (mut found, mut ranges) = (Vec::new(), 0);
        for &(place, line) in &card.data {
            let words = split(line);
            if card.get("GENERATE").is_some() {
                let range = Range::read(place, &words)?;
                // The time for a range depends on its length, even if few of its numbers exist.
                ranges += range.count();
                self.few_enough(place, found.len() + ranges)?;
                let unknown = |number: u64| {
                    let of = if of_elements { "element" } else { "node" };
                    let number = number.to_string();
                    (place, Problem::UnknownMember { what, name: name.into(), of, number })
                };
                found.extend(range.members(&self.content, of_elements).map_err(unknown)?);
                continue;
            }
            for word in words.iter().filter(|word| !word.is_empty()) {
                let sets = if of_elements { &self.elsets } else { &self.nsets };
                let unknown = || {
                    let of = if word.parse::<u64>().is_err() {
                        "set"
                    } else if of_elements {
                        "element"
                    } else {
                        "node"
                    };
                    (place, Problem::UnknownMember { what, name: name.into(), of, number: word.clone() })
                };
                match word.parse::<u64>() {
                    Ok(number) => {
                        let known = if of_elements {
                            self.content.knows_element(number)
                        } else {
                            self.content.node_of(number).is_some()
                        };
                        if !known {
                            return Err(unknown());
                        }
                        found.push(number);
                    }
                    Err(_) => found.extend(&sets.get(&unquoted(word)).ok_or_else(unknown)?.1),
                }
                self.few_enough(place, found.len() + ranges)?;
            }
        }
        self.members += (found.len() + ranges) as u64;
        let sets = if of_elements { &mut self.elsets } else { &mut self.nsets };
        sets.of(name).extend(found);
        Ok(())
    }

    /// Limits the number of set members, because sets of sets can double with every line.
    fn few_enough(&self, place: Place, more: usize) -> Parsed<()> {
        let count = self.members + more as u64;
        let problem = Problem::TooMany { what: "members of sets", count: count as usize };
        if count <= MOST { Ok(()) } else { Err((place, problem)) }
    }

    /// Members of a set of nodes or of elements.
    pub(super) fn set_of(&self, of_nodes: bool, name: &str) -> Option<&[u64]> {
        let sets = if of_nodes { &self.nsets } else { &self.elsets };
        sets.get(name).map(|(_, members)| &members[..])
    }

    pub(super) fn section(&mut self, card: &Card) -> Parsed<()> {
        self.sections.push((card.place, card.need("ELSET")?.into()));
        Ok(())
    }

    /// Reads `*SURFACE` by faces of elements, or by nodes.
    pub(super) fn surface(&mut self, card: &Card) -> Parsed<()> {
        let name = card.need("NAME")?;
        let by_nodes = card.get("TYPE").is_some_and(|t| t.eq_ignore_ascii_case("NODE"));
        for &(place, line) in &card.data {
            let words = split(line);
            let first = unquoted(&words[0]);
            let unknown = |of, number: String| {
                (place, Problem::UnknownMember { what: "surface", name: name.into(), of, number })
            };
            let sets = if by_nodes { &self.nsets } else { &self.elsets };
            let numbers = match first.parse::<u64>() {
                Ok(number) => vec![number],
                Err(_) => sets.get(&first).ok_or_else(|| unknown("set", first.clone()))?.1.clone(),
            };
            if by_nodes {
                let nodes = numbers.iter().filter_map(|&number| self.content.node_of(number)).collect();
                self.content.node_set(name, nodes);
                continue;
            }
            if let Some(&number) = numbers.iter().find(|&&number| !self.content.knows_element(number)) {
                return Err(unknown("element", number.to_string()));
            }
            match words.get(1).filter(|label| !label.is_empty()) {
                Some(label) => self.faces(place, name, &numbers, label)?,
                None => self.free_faces(place, name, &numbers)?,
            }
        }
        Ok(())
    }

    /// Adds a group for the element faces that each line of a `*DLOAD` loads, if the mesh has them.
    pub(super) fn loaded_faces(&mut self, card: &Card) {
        for &(place, line) in &card.data {
            let words = split(line);
            let (of, Some(label)) =
                (unquoted(&words[0]), words.get(1).map(|label| label.to_ascii_uppercase()))
            else {
                continue;
            };
            // `P2NP` is the pressure of a node on the face that `P2` loads.
            let label = label.strip_suffix("NP").unwrap_or(&label);
            let Some(face) = label.strip_prefix('P').filter(|face| face.parse::<u8>().is_ok()) else {
                continue;
            };
            let numbers = match of.parse::<u64>() {
                Ok(number) => vec![number],
                Err(_) => self.elsets.get(&of).map(|(_, members)| members.clone()).unwrap_or_default(),
            };
            let known = !numbers.is_empty() && numbers.iter().all(|&n| self.content.cell_of(n).is_some());
            if known {
                // Elements without this face are reported where the load is read.
                let _ = self.faces(place, &load_group(&of, label), &numbers, &format!("S{face}"));
            }
        }
    }

    /// Adds a face of each element, `S1` and so on, to a surface.
    fn faces(&mut self, place: Place, name: &str, numbers: &[u64], label: &str) -> Parsed<()> {
        let face = label.to_ascii_uppercase().strip_prefix('S').and_then(|face| face.parse::<usize>().ok());
        let Some(face) = face.filter(|face| *face > 0) else {
            let expected = "the face of an element, such as S1";
            return Err((place, Problem::Expected { expected, found: label.into() }));
        };
        let group = self.content.group(name);
        for &number in numbers {
            let Some(cell) = self.content.cell_of(number) else { continue };
            let corners = self.kinds[cell as usize].entry().cell.abaqus_faces.get(face - 1);
            if !corners.is_some_and(|corners| self.content.facet(group, cell, corners)) {
                let (expected, found) =
                    ("a face that the element has", format!("S{face} of element {number}"));
                return Err((place, Problem::Expected { expected, found }));
            }
        }
        Ok(())
    }

    /// Adds to a surface the element faces that belong to no other element, and shells on faces.
    fn free_faces(&mut self, place: Place, name: &str, numbers: &[u64]) -> Parsed<()> {
        let group = self.content.group(name);
        let cells = numbers.iter().filter_map(|&number| self.content.cell_of(number)).collect();
        for (number, (line, corners)) in numbers.iter().filter_map(|n| Some((n, self.shells.get(n)?))) {
            self.content.shell(Row { place: *line, tag: *number }, group, corners)?;
        }
        self.content.free_faces(place, group, cells);
        Ok(())
    }

    /// Assigns the regions of the elements, and adds the node sets to the content.
    pub(super) fn close(&mut self) -> Parsed<()> {
        let mut deciding = self.sections.clone();
        if deciding.is_empty() {
            // Later sets overwrite earlier sets, so the smallest set comes last.
            let cells = |key: &String| {
                let members = &self.elsets.lists[key].1;
                members.iter().filter(|&&number| self.content.cell_of(number).is_some()).count()
            };
            let mut by_size: Vec<(usize, &String)> =
                self.elsets.order.iter().map(|key| (cells(key), key)).collect();
            by_size.sort_by_key(|(count, _)| std::cmp::Reverse(*count));
            deciding = by_size.into_iter().map(|(_, key)| (Place::Line(1), key.clone())).collect();
        }
        for (place, set) in &deciding {
            let Some((name, members)) = self.elsets.get(set) else {
                let what = "*SOLID SECTION";
                let name = set.clone();
                return Err((*place, Problem::UnknownMember { what, name, of: "set", number: set.clone() }));
            };
            let cells: Vec<u32> = members.iter().filter_map(|&number| self.content.cell_of(number)).collect();
            if !cells.is_empty() {
                let region = self.content.region(*place, name)?;
                cells.into_iter().for_each(|cell| self.content.set_region(cell, region));
            }
        }
        for key in &self.elsets.order {
            let (name, members) = &self.elsets.lists[key];
            // Names of this form are internal sets of Abaqus/CAE.
            if !name.starts_with('_') {
                let cells: Vec<u32> =
                    members.iter().filter_map(|&number| self.content.cell_of(number)).collect();
                self.content.also(Place::Line(1), name, &cells)?;
            }
            for (number, (place, corners)) in members.iter().filter_map(|n| Some((n, self.shells.get(n)?))) {
                let group = self.content.group(name);
                self.content.shell(Row { place: *place, tag: *number }, group, corners)?;
            }
        }
        for key in &self.nsets.order {
            let (name, members) = &self.nsets.lists[key];
            let nodes = members.iter().filter_map(|&number| self.content.node_of(number)).collect();
            self.content.node_set(name, nodes);
        }
        Ok(())
    }
}

/// Whether an element with incompatible modes lists nodes for them after its eight corners.
fn has_inner_nodes(name: &str, corners: usize, nodes: usize) -> bool {
    name.eq_ignore_ascii_case("C3D8I") && (corners + 1..=corners + 3).contains(&nodes)
}

/// Largest number of members of all sets, and of numbers in all ranges.
const MOST: u64 = 20_000_000;
