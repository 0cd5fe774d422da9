//! Displacements and forces of nodes that hold in a step: of its own cards, and of earlier steps unless
//! replaced. (CalculiX CrunchiX manual, 7; bounadd.f and forcadd.f.)

use std::collections::{BTreeSet, HashMap};

use super::deck::Deck;
use super::procedure::Procedure;
use super::sets::bare;
use crate::import::document::{Part, list, quoted};

const AXES: [&str; 3] = ["x", "y", "z"];

/// Value that a line prescribes along one axis.
pub(super) struct Entry {
    pub line: usize,
    pub step: usize,
    /// Set or node, as the line names it.
    pub name: String,
    /// Nodes of it that no later line has replaced.
    pub nodes: BTreeSet<u64>,
    pub axis: usize,
    pub value: f64,
    /// Name of the amplitude, in upper case.
    pub amplitude: Option<String>,
}

/// Displacements, or forces, in the order of the deck.
#[derive(Default)]
pub(super) struct Nodal {
    all: Vec<Entry>,
    /// Entries of each node and axis.
    owners: HashMap<(u64, usize), Vec<usize>>,
    /// Whether forces of one step on the same node add up.
    adds: bool,
}

/// Entries that differ in their axes or in single nodes only.
struct Group<'e> {
    first: &'e Entry,
    names: Vec<&'e str>,
    nodes: BTreeSet<u64>,
    axes: Vec<usize>,
}

impl Nodal {
    pub fn forces() -> Nodal {
        Nodal { adds: true, ..Nodal::default() }
    }

    /// Adds an entry, which replaces those of its nodes.
    pub fn add(&mut self, entry: Entry) {
        let index = self.all.len();
        for &node in &entry.nodes {
            let owners = self.owners.entry((node, entry.axis)).or_default();
            if !self.adds || owners.iter().any(|&owner| self.all[owner].step < entry.step) {
                for owner in owners.drain(..) {
                    self.all[owner].nodes.remove(&node);
                }
            }
            owners.push(index);
        }
        self.all.push(entry);
    }

    /// `OP=NEW`: removes the entries of earlier steps, if the step has none of its own yet.
    pub fn renew(&mut self, step: usize) -> bool {
        let first = self.all.iter().all(|entry| entry.step < step);
        if first {
            self.all.iter_mut().for_each(|entry| entry.nodes.clear());
            self.owners.clear();
        }
        first
    }

    /// Prescribed value of a node along an axis.
    pub fn value(&self, node: u64, axis: usize) -> Option<&Entry> {
        self.owners.get(&(node, axis))?.last().map(|&owner| &self.all[owner])
    }

    /// Whether all values are zero.
    pub fn are_zero(&self) -> bool {
        self.all.iter().all(|entry| entry.nodes.is_empty() || entry.value == 0.0)
    }

    /// Names of the amplitudes.
    pub fn amplitudes(&self) -> impl Iterator<Item = &String> {
        self.all.iter().filter(|entry| !entry.nodes.is_empty()).filter_map(|entry| entry.amplitude.as_ref())
    }

    /// Entries with the same nodes, and single nodes with the same values, together.
    fn groups(&self, deck: &Deck) -> Vec<Group<'_>> {
        let single = |name: &str| name.parse::<u64>().is_ok();
        let mut groups: Vec<Group> = Vec::new();
        for entry in self.all.iter().filter(|entry| !entry.nodes.is_empty()) {
            let nodes: BTreeSet<u64> = entry.nodes.iter().copied().filter(|n| deck.sets.used(*n)).collect();
            if nodes.is_empty() {
                let what = format!("'{}' along {}, of no element", entry.name, AXES[entry.axis]);
                deck.findings.leave_out(entry.line, what);
                continue;
            }
            let alike = |group: &Group| {
                group.first.value.to_bits() == entry.value.to_bits()
                    && group.first.amplitude == entry.amplitude
            };
            match groups.last_mut() {
                Some(group) if alike(group) && group.first.line == entry.line && group.nodes == nodes => {
                    group.axes.push(entry.axis);
                }
                _ => groups.push(Group {
                    first: entry,
                    names: vec![&entry.name],
                    nodes,
                    axes: vec![entry.axis],
                }),
            }
        }
        // Nodes one by one, in lines that differ in nothing else.
        let mut joined: Vec<Group> = Vec::new();
        for group in groups {
            match joined.last_mut() {
                Some(last)
                    if single(&group.first.name)
                        && last.names.iter().all(|name| single(name))
                        && last.axes == group.axes
                        && last.first.value.to_bits() == group.first.value.to_bits()
                        && last.first.amplitude == group.first.amplitude
                        && last.nodes.is_disjoint(&group.nodes) =>
                {
                    last.names.extend(group.names);
                    last.nodes.extend(group.nodes);
                }
                _ => joined.push(group),
            }
        }
        joined
    }

    /// The displacements as supports.
    pub fn supports(&self, deck: &Deck, procedure: &Procedure) -> Vec<Part> {
        self.turned(deck, "*BOUNDARY");
        let mut parts = Vec::new();
        for group in self.groups(deck) {
            let Group { first, axes, .. } = &group;
            let part = Part::new("[[support]]").note(group.note("*BOUNDARY"));
            let part = group.place(part, deck);
            let axes: Vec<&str> = axes.iter().map(|axis| AXES[*axis]).collect();
            let Some((value, curve)) =
                procedure.value(first.value, first.amplitude.as_ref(), first.line, deck)
            else {
                continue;
            };
            if value == 0.0 || procedure.vibrates() {
                parts.push(part.key("fix", quoted(&axes.concat())));
                continue;
            }
            if procedure.in_time() {
                let help = "a scene moves a body with mass along a smooth curve only";
                deck.findings.refuse(first.line, "a displacement other than zero in a dynamic step", help);
            }
            let value = deck.units.lengths(value);
            let moves: Vec<String> = axes.iter().map(|axis| format!("{axis} = {value}")).collect();
            parts.push(part.key("move", format!("{{ {} }}", moves.join(", "))).maybe("curve", curve));
        }
        parts
    }

    /// The forces as loads.
    pub fn loads(&self, deck: &Deck, procedure: &Procedure) -> Vec<Part> {
        self.turned(deck, "*CLOAD");
        let mut parts = Vec::new();
        for group in self.groups(deck) {
            let Group { first, axes, nodes, .. } = &group;
            let Some((value, curve)) =
                procedure.value(first.value, first.amplitude.as_ref(), first.line, deck)
            else {
                continue;
            };
            if value == 0.0 {
                deck.findings.leave_out(first.line, "a force of zero");
                continue;
            }
            let force = [0, 1, 2].map(|axis| if axes.contains(&axis) { value } else { 0.0 });
            let part = Part::new("[[load]]").note(group.note("*CLOAD"));
            let part = part.key("force", list(force.map(|f| deck.units.forces(f))));
            parts.push(part.key("at", list([deck.places(nodes)])).maybe("curve", curve));
        }
        parts
    }

    /// Refuses what acts along the axes of a `*TRANSFORM`. Three zeros are the same along any axes.
    fn turned(&self, deck: &Deck, keyword: &str) {
        let zero = |node: u64, axis| self.value(node, axis).is_some_and(|entry| entry.value == 0.0);
        for entry in &self.all {
            let mut nodes = entry.nodes.intersection(&deck.turned);
            if let Some(node) = nodes.find(|node| (0..3).any(|axis| !zero(**node, axis))) {
                let help = "supports and forces of a scene are along x, y and z";
                deck.findings.refuse(
                    entry.line,
                    format!("{keyword} of node {node} along axes of *TRANSFORM"),
                    help,
                );
            }
        }
    }
}

impl Group<'_> {
    fn note(&self, keyword: &str) -> String {
        let shown = match &self.names[..] {
            [first, .., last] => format!("{first} to {last}"),
            names => names.concat(),
        };
        format!("{keyword} {shown} (line {})", self.first.line)
    }

    /// Adds the nodes: a whole set by its name, others by their places.
    fn place(&self, part: Part, deck: &Deck) -> Part {
        let group = match &self.names[..] {
            [name] => deck.group(name, &self.nodes),
            _ => None,
        };
        match group {
            Some(group) => part.key("on", quoted(group)),
            None => part.key("at", list([deck.places(&self.nodes)])),
        }
    }
}

/// Axes, counted from 0, of a line of `*BOUNDARY`; `None` for a line that has none.
pub(super) fn axes(words: &[String]) -> Option<(u32, u32)> {
    let word = |at: usize| words.get(at).map(|word| bare(word)).filter(|word| !word.is_empty());
    match word(1).map(str::to_ascii_uppercase).as_deref() {
        Some("ENCASTRE" | "PINNED") => Some((1, 3)),
        Some("XSYMM") => Some((1, 1)),
        Some("YSYMM") => Some((2, 2)),
        Some("ZSYMM") => Some((3, 3)),
        Some(first) => first.parse::<u32>().ok().filter(|first| *first > 0).and_then(|first| {
            let last = word(2).map_or(Some(first), |last| last.parse().ok())?;
            Some((first, last.max(first)))
        }),
        None => None,
    }
}
