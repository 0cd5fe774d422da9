//! A deck with its sets, surfaces and amplitudes, to which its conditions refer.

use std::collections::{BTreeSet, HashMap};

use super::amplitude::Amplitude;
use super::sets::Sets;
use crate::import::document::list;
use crate::import::finding::Findings;
use crate::import::units::Units;

/// The model of a deck.
pub(super) struct Deck<'s> {
    pub sets: &'s Sets,
    pub findings: &'s Findings,
    pub units: Units,
    /// Names of surfaces, in upper case, as written.
    pub surfaces: HashMap<String, String>,
    /// Amplitudes by their names in upper case.
    pub amplitudes: HashMap<String, Amplitude>,
    /// Nodes with the axes of a `*TRANSFORM`.
    pub turned: BTreeSet<u64>,
    /// Mass per volume, if all materials have the same.
    pub density: Option<f64>,
}

impl Deck<'_> {
    /// Nodes of a set, or a node, that the deck has.
    pub fn nodes(&self, name: &str, line: usize) -> Option<BTreeSet<u64>> {
        let Some(mut nodes) = self.sets.members(true, name) else {
            self.findings.refuse(line, format!("node set '{name}' is not in the deck"), "");
            return None;
        };
        nodes.retain(|node| self.sets.place(*node).is_some());
        if nodes.is_empty() {
            let what = if name.parse::<u64>().is_ok() { "node" } else { "node set" };
            self.findings.refuse(line, format!("{what} '{name}' is not in the deck"), "");
        }
        Some(nodes)
    }

    /// Name of the set of these nodes in the mesh.
    pub fn group(&self, name: &str, nodes: &BTreeSet<u64>) -> Option<&str> {
        let mut members = self.sets.members(true, name)?;
        members.retain(|node| self.sets.used(*node));
        let whole = members == *nodes && !self.surfaces.contains_key(&name.to_ascii_uppercase());
        whole.then(|| self.sets.group(name)).flatten()
    }

    /// Places of nodes, without the brackets around them.
    pub fn places(&self, nodes: &BTreeSet<u64>) -> String {
        let places = nodes.iter().filter_map(|node| self.sets.place(*node));
        let places: Vec<String> = places.map(|x| list(x.map(|x| self.units.lengths(x)))).collect();
        places.join(", ")
    }
}
