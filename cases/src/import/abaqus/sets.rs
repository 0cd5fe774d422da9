//! Nodes, elements and sets of a deck.

use std::collections::{BTreeSet, HashMap, HashSet};

use geometry::CellKind;
use mesh_files::DeckCard;

use crate::import::edges::lacks_a_middle;
use crate::import::finding::Findings;

/// Largest number of members of all sets.
const MOST: usize = 1 << 23;

/// The mesh of a flat deck, by the numbers and names of the deck.
#[derive(Default)]
pub(super) struct Sets {
    places: HashMap<u64, [f64; 3]>,
    /// Type of each element, in upper case, with its nodes.
    pub elements: HashMap<u64, (String, Vec<u64>)>,
    /// Line of the first `*NODE`.
    first_line: Option<usize>,
    /// Line of the first card of each element type.
    pub kinds: HashMap<String, usize>,
    /// Nodes of elements.
    used: HashSet<u64>,
    /// Names of the node sets as the deck first writes them.
    names: HashMap<String, String>,
    /// Members of the sets, by upper-case name.
    nodes: HashMap<String, BTreeSet<u64>>,
    cells: HashMap<String, BTreeSet<u64>>,
    members: usize,
}

impl Sets {
    /// Reads a card of the mesh; `false` for another card.
    pub fn card(&mut self, card: &DeckCard, findings: &Findings) -> bool {
        let set = |key: &str| card.get(key).filter(|name| !name.is_empty()).map(str::to_ascii_uppercase);
        match card.keyword.as_str() {
            "NODE" => {
                let mut numbers = Vec::new();
                self.first_line.get_or_insert(card.line);
                for (line, words) in &card.data {
                    let number = words.first().and_then(|word| word.parse().ok());
                    let x = [1, 2, 3].map(|at| words.get(at).map_or(Some(0.0), |word| real(word)));
                    let (Some(number), [Some(x), Some(y), Some(z)]) = (number, x) else {
                        findings.refuse(*line, "no node with its coordinates", "");
                        return true;
                    };
                    self.places.insert(number, [x, y, z]);
                    numbers.push(number);
                }
                if let Some(name) = card.get("NSET").filter(|name| !name.is_empty()) {
                    self.names.entry(name.to_ascii_uppercase()).or_insert_with(|| name.into());
                    self.nodes.entry(name.to_ascii_uppercase()).or_default().extend(numbers);
                }
            }
            "ELEMENT" => {
                let kind = card.get("TYPE").unwrap_or_default().to_ascii_uppercase();
                let count = node_count(&kind);
                let all = element_lines(card, count, findings);
                if let Some(name) = set("ELSET") {
                    self.cells.entry(name).or_default().extend(all.iter().map(|(number, _)| *number));
                }
                self.kinds.entry(kind.clone()).or_insert(card.line);
                self.used.extend(all.iter().flat_map(|(_, nodes)| nodes));
                self.elements.extend(all.into_iter().map(|(number, nodes)| (number, (kind.clone(), nodes))));
            }
            "NSET" | "ELSET" => self.set(card, findings),
            _ => return false,
        }
        true
    }

    fn set(&mut self, card: &DeckCard, findings: &Findings) {
        let of_nodes = card.keyword == "NSET";
        let name = card.get(&card.keyword).unwrap_or_default().to_ascii_uppercase();
        let mut found = BTreeSet::new();
        for (line, words) in &card.data {
            let words: Vec<&str> =
                words.iter().map(|word| bare(word)).filter(|word| !word.is_empty()).collect();
            if card.get("GENERATE").is_some() {
                let numbers: Vec<u64> = words.iter().filter_map(|word| word.parse().ok()).collect();
                let [first, last, step] = match numbers[..] {
                    [first, last] => [first, last, 1],
                    [first, last, step] if step > 0 => [first, last, step],
                    _ => {
                        findings.refuse(*line, "no first, last and step of GENERATE", "");
                        continue;
                    }
                };
                if last.saturating_sub(first) / step + self.members as u64 + found.len() as u64 > MOST as u64
                {
                    findings.refuse(*line, "GENERATE has too many members", "");
                    continue;
                }
                found.extend((first..=last).step_by(step as usize));
                continue;
            }
            for word in words {
                match word.parse::<u64>() {
                    Ok(number) => drop(found.insert(number)),
                    Err(_) => match self.of(of_nodes).get(&word.to_ascii_uppercase()) {
                        Some(others) => found.extend(others.iter().copied()),
                        None => findings.refuse(*line, format!("set '{word}' is not in the deck"), ""),
                    },
                }
            }
        }
        self.members += found.len();
        if self.members > MOST {
            findings.refuse(card.line, "the sets have too many members", "");
            return;
        }
        if of_nodes {
            let written = card.get(&card.keyword).unwrap_or_default();
            self.names.entry(name.clone()).or_insert_with(|| written.into());
        }
        let sets = if of_nodes { &mut self.nodes } else { &mut self.cells };
        sets.entry(name).or_default().extend(found);
    }

    fn of(&self, of_nodes: bool) -> &HashMap<String, BTreeSet<u64>> {
        if of_nodes { &self.nodes } else { &self.cells }
    }

    /// Members of a set, or a single number.
    pub fn members(&self, of_nodes: bool, name: &str) -> Option<BTreeSet<u64>> {
        match name.parse::<u64>() {
            Ok(number) => Some(BTreeSet::from([number])),
            Err(_) => self.of(of_nodes).get(&name.to_ascii_uppercase()).cloned(),
        }
    }

    /// Name of a node set as the mesh has it; `None` for a set whose faces have further nodes.
    pub fn group(&self, name: &str) -> Option<&str> {
        let key = name.to_ascii_uppercase();
        let nodes = self.nodes.get(&key)?;
        let lacks = |(kind, list): &(String, Vec<u64>)| {
            solid(kind).is_some_and(|kind| lacks_a_middle(kind, list, |node| nodes.contains(&node)))
        };
        if self.elements.values().any(lacks) { None } else { self.names.get(&key).map(String::as_str) }
    }

    /// Lists the nodes without elements.
    pub fn leave_out_unused(&self, findings: &Findings) {
        let mut unused: Vec<&u64> = self.places.keys().filter(|node| !self.used.contains(node)).collect();
        unused.sort();
        if let (Some(first), Some(line)) = (unused.first(), self.first_line) {
            let what = format!("nodes without elements: {} from {first} on", unused.len());
            findings.leave_out(line, what);
        }
    }

    /// Whether a node belongs to an element.
    pub fn used(&self, node: u64) -> bool {
        self.used.contains(&node)
    }

    /// Coordinates of a node.
    pub fn place(&self, node: u64) -> Option<[f64; 3]> {
        self.places.get(&node).copied()
    }
}

/// Elements of a card with their nodes, each of which may take several lines.
fn element_lines(card: &DeckCard, count: usize, findings: &Findings) -> Vec<(u64, Vec<u64>)> {
    let mut all: Vec<(u64, Vec<u64>)> = Vec::new();
    let mut longer = None;
    for (line, words) in &card.data {
        let mut numbers = words.iter().filter_map(|word| word.parse::<u64>().ok());
        let open = all.last().is_some_and(|(_, nodes)| nodes.len() < count);
        if !open && let Some(number) = numbers.next() {
            all.push((number, Vec::new()));
        }
        if let Some((_, nodes)) = all.last_mut() {
            nodes.extend(numbers);
            if nodes.len() > count && count > 1 {
                // CalculiX takes the first eight of a C3D8.
                if count == 8 {
                    longer = longer.or(Some(*line));
                } else {
                    findings.refuse(*line, format!("an element of {count} nodes has {}", nodes.len()), "");
                }
                nodes.truncate(count);
            }
        }
    }
    if let Some(line) = longer {
        findings.leave_out(line, "nodes after the eight of an element");
    }
    all
}

/// Solid of an element type, without the letters of its variants.
pub(super) fn solid(kind: &str) -> Option<CellKind> {
    let plain = kind.trim_end_matches(|c: char| !c.is_ascii_digit());
    CellKind::ALL.into_iter().find(|known| known.entry().files.abaqus == plain)
}

/// Number of nodes of an element type, from the digits at its end.
fn node_count(kind: &str) -> usize {
    let digits = kind.strip_prefix("C3D").map(|rest| rest.trim_end_matches(|c: char| !c.is_ascii_digit()));
    digits.and_then(|digits| digits.parse().ok()).unwrap_or(1)
}

/// A name without quotes.
pub(super) fn bare(word: &str) -> &str {
    word.trim().trim_matches('"')
}

/// A number, also in Fortran notation.
pub(super) fn real(word: &str) -> Option<f64> {
    let word = bare(word);
    if word.is_empty() {
        return Some(0.0);
    }
    let plain = word.replace(['d', 'D'], "e");
    let number = plain.parse::<f64>().ok().filter(|_| plain.bytes().all(|b| b"0123456789+-.eE".contains(&b)));
    number.filter(|number| number.is_finite())
}
