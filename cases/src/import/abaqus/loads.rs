//! Pressures and body forces that hold in a step. (CalculiX CrunchiX manual, 7; loadadd.f and bodyadd.f.)

use std::collections::BTreeSet;

use mesh_files::load_group;

use super::deck::Deck;
use super::nodal::Nodal;
use super::procedure::Procedure;
use super::sets::solid;
use crate::import::document::{Part, list, quoted};

/// Faces, elements or surface that a line loads.
#[derive(PartialEq)]
pub(super) enum Target {
    /// A face, such as `P2`, of each element.
    Faces { label: String, cells: BTreeSet<u64> },
    /// A `*SURFACE`, by its name as written.
    Surface(String),
    /// Acceleration along a unit vector.
    Gravity([f64; 3]),
    /// Square of the speed of rotation about the axis through a point along a unit vector.
    Rotation { point: [f64; 3], axis: [f64; 3] },
}

/// A line of `*DLOAD` or `*DSLOAD`.
pub(super) struct Load {
    pub line: usize,
    pub step: usize,
    pub keyword: String,
    /// Set or element, as the line names it.
    pub name: String,
    pub label: String,
    pub target: Target,
    pub value: f64,
    /// Node whose second prescribed value is the pressure.
    pub node: Option<u64>,
    /// Name of the amplitude, in upper case.
    pub amplitude: Option<String>,
}

/// Loads in the order of the deck.
#[derive(Default)]
pub(super) struct Loads {
    all: Vec<Load>,
}

impl Loads {
    /// Adds a load, which replaces one of an earlier step on the same faces or elements.
    pub fn add(&mut self, load: Load, deck: &Deck) {
        self.all.retain(|old| match old.step == load.step {
            // Loads of one step add up.
            true => true,
            false => match load.replaces(old) {
                Some(replaces) => !replaces,
                None => {
                    let what =
                        format!("{} on '{}' may change the load of line {}", load.label, load.name, old.line);
                    deck.findings.refuse(
                        load.line,
                        what,
                        "name the same elements or the same surface, or give OP=NEW",
                    );
                    true
                }
            },
        });
        self.all.push(load);
    }

    /// `OP=NEW`: removes the loads of earlier steps, if the step has none of its own yet.
    pub fn renew(&mut self, step: usize) -> bool {
        let first = self.all.iter().all(|load| load.step < step);
        if first {
            self.all.clear();
        }
        first
    }

    pub fn are_zero(&self) -> bool {
        self.all.iter().all(|load| load.value == 0.0)
    }

    /// Names of the amplitudes.
    pub fn amplitudes(&self) -> impl Iterator<Item = &String> {
        self.all.iter().filter_map(|load| load.amplitude.as_ref())
    }

    /// The loads of the scene.
    pub fn parts(&self, deck: &Deck, procedure: &Procedure, large: bool, supports: &Nodal) -> Vec<Part> {
        self.all.iter().filter_map(|load| load.part(deck, procedure, large, supports)).collect()
    }
}

impl Load {
    /// Whether this load takes the place of an earlier one; `None` if of a part of it.
    fn replaces(&self, old: &Load) -> Option<bool> {
        match (&old.target, &self.target) {
            (Target::Faces { label: a, cells: old }, Target::Faces { label: b, cells: new }) => {
                if a != b || old.is_disjoint(new) { Some(false) } else { old.is_subset(new).then_some(true) }
            }
            (Target::Surface(old), Target::Surface(new)) => (old == new).then_some(true),
            (Target::Faces { .. }, Target::Surface(_)) | (Target::Surface(_), Target::Faces { .. }) => None,
            _ => Some(self.name.eq_ignore_ascii_case(&old.name) && self.target == old.target),
        }
    }

    fn part(&self, deck: &Deck, procedure: &Procedure, large: bool, supports: &Nodal) -> Option<Part> {
        let (mut value, mut amplitude) = (self.value, self.amplitude.as_ref());
        if let Some(node) = self.node {
            let Some(entry) = supports.value(node, 1) else {
                let what = format!("the pressure of node {node} is not prescribed");
                deck.findings.refuse(self.line, what, "give it in *BOUNDARY as degree of freedom 2");
                return None;
            };
            (value, amplitude) = (entry.value, entry.amplitude.as_ref());
        }
        let (value, curve) = procedure.value(value, amplitude, self.line, deck)?;
        let Load { line, keyword, name, label, .. } = self;
        let part = Part::new("[[load]]").note(format!("*{keyword} {name}, {label} (line {line})"));
        let pressure =
            |part: Part, on: &str| part.key("on", quoted(on)).key("pressure", deck.units.pressures(value));
        let part = match &self.target {
            Target::Faces { label, .. } => pressure(part, &load_group(name, label)),
            Target::Surface(surface) => pressure(part, surface),
            Target::Gravity(along) => {
                let density = self.density(deck)?;
                part.key("body", list(along.map(|n| deck.units.body_forces(density * value * n))))
            }
            Target::Rotation { point, axis } => {
                let density = self.density(deck)?;
                if large {
                    let help = "a body force of a scene is that of the undeformed body";
                    deck.findings.refuse(*line, "CENTRIF with NLGEOM can't be expressed", help);
                }
                part.key("body", rotation(density * value, *point, *axis, deck))
            }
        };
        Some(part.maybe("curve", curve))
    }

    /// The density, if all elements have it and this load.
    fn density(&self, deck: &Deck) -> Option<f64> {
        let cells = deck.sets.members(false, &self.name);
        let all = cells.is_some_and(|cells| deck.sets.elements.keys().all(|element| cells.contains(element)));
        let density = deck.density.filter(|_| all);
        if density.is_none() {
            let help = "a body force of a scene acts on all elements, which have one *DENSITY";
            deck.findings.refuse(self.line, format!("{} on '{}'", self.label, self.name), help);
        }
        density
    }
}

/// Whether all elements are solids with the face of this label.
pub(super) fn has_face(deck: &Deck, cells: &BTreeSet<u64>, label: &str) -> bool {
    let face = label.strip_prefix('P').and_then(|face| face.parse::<usize>().ok()).filter(|face| *face > 0);
    let has = |cell: &u64| {
        let kind = deck.sets.elements.get(cell).and_then(|(kind, _)| solid(kind));
        kind.zip(face).is_some_and(|(kind, face)| face <= kind.entry().cell.abaqus_faces.len())
    };
    !cells.is_empty() && cells.iter().all(has)
}

/// Force per volume `rho omega^2 (x - p)` across the axis of a rotation, as expressions in the coordinates.
/// `factor` is the density times the square of the speed.
fn rotation(factor: f64, point: [f64; 3], axis: [f64; 3], deck: &Deck) -> String {
    let of = [0, 1, 2].map(|i| {
        let terms: Vec<String> = (0..3)
            .map(|j| (j, f64::from(u8::from(i == j)) - axis[i] * axis[j]))
            .filter(|(_, share)| *share != 0.0)
            .map(|(j, share)| {
                let from = deck.units.metres(point[j]);
                format!(
                    "({}) * ({} - {from})",
                    deck.units.body_force_rates(factor * share),
                    ["x", "y", "z"][j]
                )
            })
            .collect();
        quoted(&if terms.is_empty() { "0".into() } else { terms.join(" + ") })
    });
    format!("{{ unit = \"N/m^3\", of = {} }}", list(of))
}
