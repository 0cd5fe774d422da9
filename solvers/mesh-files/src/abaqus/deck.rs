//! A whole deck: parts, instances and included files.

use std::path::{Path, PathBuf};

use geometry::{Point3, Vector3};

use super::assembly::{self, Placed, Waiting};
use super::cards::{Card, cards, real, split};
use super::include::{DEEPEST, Includes};
use super::keywords;
use super::kinds::{Type, element_type};
use super::names::Shared;
use super::scope::Scope;
use crate::content::Content;
use crate::error::{Parsed, Place, Problem};
use crate::left_out::{Kind, LeftOut};
use crate::text::text;

/// Largest number of nodes, element nodes and set members that instances may place for a deck of any size.
const MOST_PLACED: usize = 1 << 23;

/// Keywords that add to the part of the enclosing instance.
const ADDED: [&str; 6] = ["NODE", "ELEMENT", "ELSET", "NSET", "SURFACE", "SOLID SECTION"];

pub(super) struct Deck {
    folder: PathBuf,
    includes: Includes,
    /// Content outside of parts.
    flat: Scope,
    /// Part being read.
    open: Option<(String, Scope)>,
    /// Whether the last instance is being read.
    placing: bool,
    /// Total extent of the parts copied because instances add to them.
    copied: usize,
    parts: Vec<(String, Scope)>,
    instances: Vec<Instance>,
    /// Sets and surfaces of the assembly.
    waiting: Vec<Waiting>,
    ended: bool,
    /// Parts of the deck that are not in the mesh.
    left_out: Vec<LeftOut>,
}

/// An instance of a part in the assembly: shifted, then rotated by an angle about a line.
struct Instance {
    place: Place,
    name: String,
    part: usize,
    moved: Vector3,
    turned: Option<(Point3, Vector3, f64)>,
}

impl Deck {
    pub(super) fn new(folder: &Path) -> Deck {
        Deck {
            folder: folder.into(),
            includes: Includes::default(),
            flat: Scope::default(),
            open: None,
            placing: false,
            copied: 0,
            parts: Vec::new(),
            instances: Vec::new(),
            waiting: Vec::new(),
            ended: false,
            left_out: Vec::new(),
        }
    }

    /// Reads the text of a deck; `depth` is the number of nested includes.
    pub(super) fn read(&mut self, text: &str, depth: usize) -> Parsed<()> {
        let cards = cards(text)?;
        self.flat.of_model |= cards.iter().any(|card| card.keyword == "STEP");
        for card in cards {
            self.left_out.extend(lost(&card, depth));
            if self.ended {
                if card.keyword == "DLOAD" && self.parts.is_empty() {
                    self.flat.loaded_faces(&card);
                }
                self.flat.read_over(&card);
            } else {
                self.card(&card, depth)?;
            }
        }
        Ok(())
    }

    fn card(&mut self, card: &Card, depth: usize) -> Parsed<()> {
        if self.placing && self.open.is_none() && ADDED.contains(&card.keyword.as_str()) {
            self.open = Some(self.own_part(card.place)?);
        }
        let placed = !self.instances.is_empty() && self.open.is_none();
        let scope = self.open.as_mut().map_or(&mut self.flat, |(_, scope)| scope);
        match card.keyword.as_str() {
            "NODE" | "ELEMENT" | "ELSET" | "NSET" | "SURFACE" if card.get("INPUT").is_some() => {
                let help = "copy the lines of that file below the keyword";
                Err((card.place, Problem::Unread { what: format!("INPUT of *{}", card.keyword), help }))
            }
            "NODE" => scope.nodes(card),
            "ELEMENT" => scope.elements(card),
            // Sets of the assembly refer to instances.
            "ELSET" | "NSET" | "SURFACE" if placed || card.get("INSTANCE").is_some() => {
                self.waiting.extend(Waiting::new(card)?);
                Ok(())
            }
            "ELSET" | "NSET" => scope.set(card),
            "SURFACE" => scope.surface(card),
            "SOLID SECTION" => scope.section(card),
            "INCLUDE" => self.include(card, depth),
            "PART" if self.placing => {
                let expected = "*END INSTANCE before the next *PART";
                Err((card.place, Problem::Expected { expected, found: "none".into() }))
            }
            "PART" => {
                self.open = Some((card.need("NAME")?.into(), Scope::default()));
                Ok(())
            }
            "END PART" => self.close_part(card.place),
            "INSTANCE" => self.instance(card),
            "END INSTANCE" => {
                self.close_instance();
                Ok(())
            }
            "STEP" => {
                self.ended = true;
                // Solvers pass over nodes without elements in a model.
                self.flat.content.leave_unused_out();
                Ok(())
            }
            "SYSTEM" | "NGEN" | "NFILL" | "NCOPY" | "NMAP" | "ELGEN" | "ELCOPY" | "SUBMODEL"
            | "TRANSFORM SHELL" => {
                let help = "write a deck that lists all nodes and elements, in one coordinate system";
                Err((card.place, Problem::Unread { what: format!("*{}", card.keyword), help }))
            }
            keyword if keywords::known(keyword).is_none() => {
                let found = keyword.chars().take(40).collect();
                Err((card.place, Problem::UnknownKeyword { found, nearest: keywords::nearest(keyword) }))
            }
            _ => {
                scope.read_over(card);
                Ok(())
            }
        }
    }

    fn close_part(&mut self, place: Place) -> Parsed<()> {
        let Some(part) = self.open.take().filter(|_| !self.placing) else {
            let expected = "*PART before *END PART";
            return Err((place, Problem::Expected { expected, found: "none".into() }));
        };
        self.parts.push(part);
        Ok(())
    }

    /// Copies the part of the last instance, because the instance adds to it.
    fn own_part(&mut self, place: Place) -> Parsed<(String, Scope)> {
        let part = &self.parts[self.instances.last().map_or(0, |instance| instance.part)];
        self.copied += part.1.content.extent();
        if self.copied > MOST_PLACED {
            let what = "nodes and elements placed by *INSTANCE";
            return Err((place, Problem::TooMany { what, count: self.copied }));
        }
        Ok(part.clone())
    }

    fn close_instance(&mut self) {
        self.placing = false;
        if let (Some(part), Some(instance)) = (self.open.take(), self.instances.last_mut()) {
            instance.part = self.parts.len();
            self.parts.push(part);
        }
    }

    /// Reads `*INSTANCE, NAME, PART` with a shift, and an axis of rotation with an angle in degrees.
    fn instance(&mut self, card: &Card) -> Parsed<()> {
        if self.placing {
            let expected = "*END INSTANCE before the next *INSTANCE";
            return Err((card.place, Problem::Expected { expected, found: "none".into() }));
        }
        let name = card.need("PART")?;
        let part = self.parts.iter().position(|(known, _)| known.eq_ignore_ascii_case(name));
        let part = part.ok_or_else(|| {
            let number = name.to_string();
            (card.place, Problem::UnknownMember { what: "*INSTANCE", name: name.into(), of: "part", number })
        })?;
        let numbers = |line: usize, count: usize| -> Parsed<Vec<f64>> {
            let Some(&(place, words)) = card.data.get(line) else { return Ok(Vec::new()) };
            let words: Vec<String> = split(words).into_iter().filter(|word| !word.is_empty()).collect();
            if words.len() != count {
                let expected =
                    if count == 3 { "a shift along x, y, z" } else { "two points of an axis and an angle" };
                return Err((place, Problem::Expected { expected, found: words.join(", ") }));
            }
            words.iter().map(|word| real(place, word, "a number")).collect()
        };
        let shift = numbers(0, 3)?;
        let turn = numbers(1, 7)?;
        let turned = (!turn.is_empty()).then(|| {
            let at = Point3::new(turn[0], turn[1], turn[2]);
            (at, Point3::new(turn[3], turn[4], turn[5]) - at, turn[6].to_radians())
        });
        let moved =
            if shift.is_empty() { Vector3::zeros() } else { Vector3::new(shift[0], shift[1], shift[2]) };
        if let Some((_, axis, _)) = turned
            && axis.norm() == 0.0
        {
            let expected = "two different points of an axis";
            return Err((card.place, Problem::Expected { expected, found: "the same point twice".into() }));
        }
        // An instance without a name has the name of its part.
        let name =
            card.get("NAME").filter(|name| !name.is_empty()).unwrap_or(&self.parts[part].0).to_string();
        if self.instances.iter().any(|other| other.name.eq_ignore_ascii_case(&name)) {
            return Err((card.place, Problem::SameInstance { name }));
        }
        self.instances.push(Instance { place: card.place, name, part, moved, turned });
        self.placing = true;
        Ok(())
    }

    /// Reads an included file in place of the line. The file has to lie in the folder of the deck.
    fn include(&mut self, card: &Card, depth: usize) -> Parsed<()> {
        let name = card.need("INPUT")?.to_string();
        let unread = |help| Err((card.place, Problem::Unread { what: format!("*INCLUDE of {name}"), help }));
        if depth == DEEPEST {
            return unread("included files are nested more than eight deep");
        }
        let bytes = match self.includes.read(&self.folder, &name) {
            Ok((_, bytes)) => bytes,
            Err(help) => return unread(help),
        };
        let read = text(&bytes).and_then(|text| self.read(&text, depth + 1));
        read.map_err(|(place, problem)| {
            (card.place, Problem::Included { file: name.clone(), place, problem: Box::new(problem) })
        })
    }

    /// Rejects instances that turn a small deck into a mesh of more than eight million numbers.
    fn few_enough(&self) -> Parsed<()> {
        let written: usize = self.parts.iter().map(|(_, part)| part.content.extent()).sum();
        let most = MOST_PLACED.max(8 * written.saturating_sub(self.copied));
        let mut placed = 0;
        for instance in &self.instances {
            placed += self.parts[instance.part].1.content.extent();
            if placed > most {
                let what = "nodes and elements placed by *INSTANCE";
                return Err((instance.place, Problem::TooMany { what, count: placed }));
            }
        }
        Ok(())
    }

    /// Returns the whole mesh: the instances, or the flat deck.
    pub(super) fn finish(mut self) -> Parsed<Content> {
        let end = Place::Line(1);
        if let Some(instance) = self.instances.last().filter(|_| self.placing) {
            let found = format!("instance {} is still open", instance.name);
            return Err((instance.place, Problem::Expected { expected: "*END INSTANCE", found }));
        }
        if let Some((name, _)) = &self.open {
            let found = format!("part {name} is still open");
            return Err((end, Problem::Expected { expected: "*END PART", found }));
        }
        self.flat.close()?;
        self.parts.iter_mut().try_for_each(|(_, part)| part.close())?;
        let mut whole = std::mem::take(&mut self.flat.content);
        if self.instances.is_empty() && self.parts.len() == 1 {
            // A single part without an instance is used as it is.
            let (name, part) = &self.parts[0];
            let shared = Shared::new([&whole, &part.content].into_iter(), std::iter::empty());
            whole.append(end, &part.content, |x| *x, |of, own| shared.full(name, of, own))?;
        }
        self.few_enough()?;
        let mut placed = Vec::with_capacity(self.instances.len());
        let parts = self.instances.iter().map(|instance| &self.parts[instance.part].1.content);
        let of_assembly = self.waiting.iter().filter_map(Waiting::surface);
        let shared = Shared::new([&whole].into_iter().chain(parts), of_assembly);
        for Instance { place, name, part, moved, turned } in &self.instances {
            let turn = turned.map(|(at, axis, angle)| {
                (at, nalgebra::Rotation3::from_axis_angle(&nalgebra::Unit::new_normalize(axis), angle))
            });
            let put = |x: &Point3| {
                let x = x + moved;
                turn.map_or(x, |(at, turn)| at + turn * (x - at))
            };
            let part = &self.parts[*part].1;
            let named = |of, own: &str| shared.full(name, of, own);
            let (first_node, first_cell) = whole.append(*place, &part.content, put, named)?;
            placed.push(Placed { name, part, first_node, first_cell });
        }
        assembly::add(&mut whole, &self.waiting, &placed)?;
        whole.fill_regions("body")?;
        whole.leave_out(self.left_out);
        match (whole.node_count(), whole.cell_count()) {
            (0, _) => Err((end, Problem::Missing { section: "*NODE" })),
            (_, 0) => Err((end, Problem::NoCells)),
            _ => Ok(whole),
        }
    }
}

/// Describes a card that is not read and whose loss matters.
fn lost(card: &Card, depth: usize) -> Option<LeftOut> {
    let of_type = card.get("TYPE").filter(|name| matches!(element_type(name), Some(Type::Other)));
    let (kind, which) = match (card.keyword.as_str(), of_type) {
        ("ELEMENT", Some(of_type)) => (Kind::Joins, format!(", TYPE={of_type}")),
        (keyword, _) => {
            let name = card.get("NAME").filter(|name| !name.is_empty());
            (keywords::lost(keyword)?, name.map_or(String::new(), |name| format!(", NAME={name}")))
        }
    };
    let within = if depth > 0 { " of an included file" } else { "" };
    Some(LeftOut { place: card.place, what: format!("*{}{which}{within}", card.keyword), kind })
}
