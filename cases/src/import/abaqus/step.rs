//! Supports, loads and the procedure of a deck. (CalculiX CrunchiX manual, 7.)

use std::collections::{BTreeSet, HashMap};

use mesh_files::{DeckCard, load_group};

use super::sets::{Sets, bare, real, solid};
use crate::import::document::{Part, list, quoted};
use crate::import::finding::Findings;
use crate::import::units::Units;

const AXES: [&str; 3] = ["x", "y", "z"];

/// Procedure of a step.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Kind {
    Static { steps: usize, time: f64 },
    Modes { count: usize },
}

/// Lines of a `*BOUNDARY` that differ in their nodes only.
struct Group<'c> {
    line: usize,
    names: Vec<&'c str>,
    moved: Vec<&'static str>,
    value: f64,
}

/// Conditions of a deck, as parts of the scene.
pub(super) struct Step<'s> {
    pub sets: &'s Sets,
    pub findings: &'s Findings,
    pub units: Units,
    /// Names of surfaces, in upper case, as written.
    pub surfaces: HashMap<String, String>,
    /// Mass per volume, if all materials have the same.
    pub density: Option<f64>,
    pub amplitudes: HashMap<String, Vec<[f64; 2]>>,
    pub large: bool,
    pub kind: Option<Kind>,
    pub supports: Vec<Part>,
    pub loads: Vec<Part>,
    pub printed: BTreeSet<u64>,
}

impl Step<'_> {
    fn refuse(&self, line: usize, what: impl Into<String>, help: &str) {
        self.findings.refuse(line, what, help);
    }

    /// Reads a card of the conditions; `false` for another card.
    pub fn card(&mut self, card: &DeckCard) -> bool {
        match card.keyword.as_str() {
            "BOUNDARY" => self.boundary(card),
            "CLOAD" => self.forces(card),
            "DLOAD" | "DSLOAD" => self.pressures(card),
            "STATIC" => self.statics(card),
            "FREQUENCY" => self.modes(card),
            "NODE PRINT" => self.print(card),
            _ => return false,
        }
        true
    }

    fn statics(&mut self, card: &DeckCard) {
        if card.get("SOLVER").is_none() && card.get("RIKS").is_some() {
            self.refuse(card.line, "*STATIC, RIKS can't be expressed", "");
        }
        let words = card.data.first().map(|(_, words)| words.as_slice()).unwrap_or_default();
        let value = |at: usize| words.get(at).and_then(|word| real(word)).filter(|value| *value > 0.0);
        let (first, time) = (value(0).unwrap_or(1.0), value(1).unwrap_or(1.0));
        let steps = (time / first).round().clamp(1.0, 1000.0) as usize;
        self.kind = Some(Kind::Static { steps, time });
    }

    fn modes(&mut self, card: &DeckCard) {
        let count = card.data.first().and_then(|(_, words)| words.first()?.parse().ok()).unwrap_or(1);
        self.kind = Some(Kind::Modes { count });
    }

    fn print(&mut self, card: &DeckCard) {
        let printed =
            card.data.iter().flat_map(|(_, words)| words).any(|word| word.eq_ignore_ascii_case("U"));
        let name = card.get("NSET").unwrap_or_default();
        match (printed, self.sets.members(true, name)) {
            (true, Some(nodes)) => self.printed.extend(nodes),
            _ => self.findings.leave_out(card.line, "*NODE PRINT of other values than U"),
        }
    }

    /// Factor at the end of the step of the amplitude that a card names.
    fn amplitude(&self, card: &DeckCard) -> Option<f64> {
        let Some(name) = card.get("AMPLITUDE") else { return Some(1.0) };
        let points = self.amplitudes.get(&name.to_ascii_uppercase());
        let Some((points, Some(Kind::Static { time, .. }))) = points.map(|points| (points, self.kind)) else {
            self.refuse(
                card.line,
                format!("amplitude '{name}' is not read"),
                "give a table, in a static step",
            );
            return None;
        };
        let after = points.partition_point(|point| point[0] < time);
        let next = points.get(after).copied();
        Some(match (after.checked_sub(1).map(|at| points[at]), next) {
            (Some([t0, f0]), Some([t1, f1])) => f0 + (f1 - f0) * ((time - t0) / (t1 - t0)),
            (Some([_, f]), None) | (None, Some([_, f])) => f,
            (None, None) => 0.0,
        })
    }

    /// Refuses parameters that change the meaning of a card.
    fn plain(&self, card: &DeckCard) -> bool {
        let known = ["AMPLITUDE"];
        let other = card.parameters.iter().find(|(key, _)| !known.contains(&key.as_str()));
        if let Some((key, value)) = other {
            self.refuse(card.line, format!("{key}={value} of *{} can't be expressed", card.keyword), "");
        }
        other.is_none()
    }

    fn boundary(&mut self, card: &DeckCard) {
        let (true, Some(factor)) = (self.plain(card), self.amplitude(card)) else { return };
        let mut groups: Vec<Group> = Vec::new();
        for (line, words) in &card.data {
            let name = bare(words.first().map_or("", String::as_str));
            let word = |at: usize| words.get(at).map(|word| bare(word)).filter(|word| !word.is_empty());
            let axes = match word(1).map(str::to_ascii_uppercase).as_deref() {
                Some("ENCASTRE" | "PINNED") => Some((1, 3)),
                Some("XSYMM") => Some((1, 1)),
                Some("YSYMM") => Some((2, 2)),
                Some("ZSYMM") => Some((3, 3)),
                Some(first) => first.parse::<u32>().ok().filter(|first| *first > 0).and_then(|first| {
                    let last = word(2).map_or(Some(first), |last| last.parse().ok())?;
                    Some((first, last.max(first)))
                }),
                None => None,
            };
            let value = words.get(3).map_or(Some(0.0), |word| real(word));
            let (Some((first, last)), Some(value)) = (axes, value) else {
                self.refuse(*line, "no degrees of freedom with their value", "");
                continue;
            };
            if first > 3 {
                self.findings
                    .leave_out(*line, format!("degrees of freedom {first} to {last}, which solids lack"));
                continue;
            }
            let moved: Vec<&str> = (first..=last.min(3)).map(|axis| AXES[axis as usize - 1]).collect();
            match groups.last_mut() {
                // Nodes one by one, in lines that differ in nothing else.
                Some(group)
                    if name.parse::<u64>().is_ok()
                        && group.moved == moved
                        && group.value == value
                        && group.names.iter().all(|name| name.parse::<u64>().is_ok()) =>
                {
                    group.names.push(name);
                }
                _ => groups.push(Group { line: *line, names: vec![name], moved, value }),
            }
        }
        for group in groups {
            self.supports.extend(self.support(&group, factor));
        }
    }

    fn support(&self, group: &Group, factor: f64) -> Option<Part> {
        let Group { line, names, moved, value } = group;
        let shown = match &names[..] {
            [one] => (*one).to_string(),
            [first, .., last] => format!("{first} to {last}"),
            [] => String::new(),
        };
        let part = Part::new("[[support]]").note(format!("*BOUNDARY {shown} (line {line})"));
        let part = self.nodes(part, names, *line)?;
        let value = value * factor;
        if value == 0.0 {
            return Some(part.key("fix", quoted(&moved.concat())));
        }
        let value = self.units.lengths(value);
        let moves: Vec<String> = moved.iter().map(|axis| format!("{axis} = {value}")).collect();
        Some(part.key("move", format!("{{ {} }}", moves.join(", "))))
    }

    /// Adds the nodes that a card names to a support: a set by its name, others by their places.
    fn nodes(&self, part: Part, names: &[&str], line: usize) -> Option<Part> {
        if let [name] = names
            && let Some(group) = self.sets.group(name)
            && !self.surfaces.contains_key(&name.to_ascii_uppercase())
        {
            return Some(part.key("on", quoted(group)));
        }
        let places: Option<Vec<String>> = names.iter().map(|name| self.places(name, line)).collect();
        Some(part.key("at", list(places?.into_iter().filter(|places| !places.is_empty()))))
    }

    /// Places of the nodes that a card names, without the brackets around them.
    fn places(&self, name: &str, line: usize) -> Option<String> {
        let Some(nodes) = self.sets.members(true, name) else {
            self.refuse(line, format!("node set '{name}' is not in the deck"), "");
            return None;
        };
        let mut places = Vec::new();
        for node in nodes {
            let Some(place) = self.sets.place(node) else {
                self.refuse(line, format!("node {node} is not in the deck"), "");
                return None;
            };
            places.push(list(place.map(|x| self.units.lengths(x))));
        }
        Some(places.join(", "))
    }

    fn forces(&mut self, card: &DeckCard) {
        let (true, Some(factor)) = (self.plain(card), self.amplitude(card)) else { return };
        for (line, words) in &card.data {
            let name = bare(words.first().map_or("", String::as_str));
            let axis =
                words.get(1).and_then(|word| word.parse::<usize>().ok()).filter(|a| (1..=3).contains(a));
            let value = words.get(2).map_or(Some(0.0), |word| real(word));
            let (Some(axis), Some(value)) = (axis, value) else {
                self.refuse(*line, "no force along 1, 2 or 3", "");
                continue;
            };
            let Some(at) = self.places(name, *line) else { continue };
            let force = [1, 2, 3].map(|other| if other == axis { value * factor } else { 0.0 });
            let part = Part::new("[[load]]").note(format!("*CLOAD {name} (line {line})"));
            let part = part.key("force", list(force.map(|f| self.units.forces(f)))).key("at", list([at]));
            self.loads.push(part);
        }
    }

    fn pressures(&mut self, card: &DeckCard) {
        let (true, Some(factor)) = (self.plain(card), self.amplitude(card)) else { return };
        for (line, words) in &card.data {
            let name = bare(words.first().map_or("", String::as_str));
            let label = words.get(1).map(|label| label.to_ascii_uppercase()).unwrap_or_default();
            let Some(values) = words.iter().skip(2).map(|word| real(word)).collect::<Option<Vec<f64>>>()
            else {
                self.refuse(*line, "a word that is no number", "");
                continue;
            };
            let origin = format!("*{} {name}, {label} (line {line})", card.keyword);
            let part = Part::new("[[load]]").note(origin);
            let value = values.first().copied().unwrap_or(0.0) * factor;
            let surface = self.surfaces.get(&name.to_ascii_uppercase());
            let part = match (card.keyword.as_str(), label.as_str(), surface) {
                ("DSLOAD", "P", Some(surface)) => {
                    part.key("on", quoted(surface)).key("pressure", self.units.pressures(value))
                }
                ("DLOAD", "GRAV", _) => match self.gravity(name, value, &values, *line) {
                    Some(body) => part.key("body", body),
                    None => continue,
                },
                ("DLOAD", _, _) if self.has_face(name, &label) => part
                    .key("on", quoted(&load_group(name, &label)))
                    .key("pressure", self.units.pressures(value)),
                _ => {
                    let help = "pressures on faces of solids (P1 to P6, P) and GRAV are read";
                    self.refuse(*line, format!("load {label} on '{name}' can't be expressed"), help);
                    continue;
                }
            };
            self.loads.push(part);
        }
    }

    /// Whether all elements of a set are solids with the face of this label.
    fn has_face(&self, name: &str, label: &str) -> bool {
        let face =
            label.strip_prefix('P').and_then(|face| face.parse::<usize>().ok()).filter(|face| *face > 0);
        let (Some(face), Some(cells)) = (face, self.sets.members(false, name)) else { return false };
        let has = |cell: &u64| {
            let kind = self.sets.elements.get(cell).and_then(|(kind, _)| solid(kind));
            kind.is_some_and(|kind| face <= kind.entry().cell.abaqus_faces.len())
        };
        !cells.is_empty() && cells.iter().all(has)
    }

    fn gravity(&self, name: &str, value: f64, values: &[f64], line: usize) -> Option<String> {
        let all = self
            .sets
            .members(false, name)
            .is_some_and(|cells| self.sets.elements.keys().all(|element| cells.contains(element)));
        let ([_, x, y, z], Some(density), true) = (values, self.density, all) else {
            let help = "a body force of a scene acts on all elements, which have one *DENSITY";
            self.refuse(line, format!("gravity on '{name}'"), help);
            return None;
        };
        Some(list([x, y, z].map(|n| self.units.body_forces(density * value * n))))
    }

    /// The procedure of the scene.
    pub fn procedure(&self, line: usize) -> Option<Part> {
        let part = Part::new("[procedure]").note(format!("*STEP (line {line})"));
        Some(match self.kind? {
            Kind::Modes { count } => part.key("kind", quoted("modes")).key("modes", count.to_string()),
            Kind::Static { .. } if !self.large => part.key("kind", quoted("linear")),
            Kind::Static { steps, .. } => part.key("kind", quoted("static")).key("steps", steps.to_string()),
        })
    }

    /// The displacements that the deck prints, as probes.
    pub fn output(&self) -> Option<Part> {
        let probes: Vec<String> = (self.printed.iter().filter_map(|node| self.sets.place(*node)))
            .map(|place| list(place.map(|x| self.units.lengths(x))))
            .collect();
        let nodes: Vec<String> = self.printed.iter().map(u64::to_string).collect();
        let part = Part::new("[output]").note(format!("*NODE PRINT: nodes {}", nodes.join(", ")));
        (!probes.is_empty()).then(|| part.key("probes", list(probes)))
    }
}

/// Points of an `*AMPLITUDE`, if it is a table of values.
pub(super) fn amplitude(card: &DeckCard, findings: &Findings) -> Option<(String, Vec<[f64; 2]>)> {
    let name = card.get("NAME").unwrap_or_default().to_ascii_uppercase();
    if let Some((key, value)) = card.parameters.iter().find(|(key, _)| key != "NAME") {
        findings.leave_out(card.line, format!("*AMPLITUDE '{name}' with {key}={value}"));
        return None;
    }
    let words = card.data.iter().flat_map(|(_, words)| words).filter(|word| !word.is_empty());
    let values: Option<Vec<f64>> = words.map(|word| real(word)).collect();
    let values = values.filter(|values| values.len() % 2 == 0 && !values.is_empty())?;
    let points: Vec<[f64; 2]> = values.chunks(2).map(|pair| [pair[0], pair[1]]).collect();
    points.windows(2).all(|pair| pair[0][0] < pair[1][0]).then_some((name, points))
}
