//! Sets and surfaces of an assembly, which refer to nodes and elements of its instances.

use std::collections::HashMap;

use geometry::CellKind;

use super::cards::{Card, split, unquoted};
use super::ranges::Range;
use super::scope::Scope;
use crate::content::Content;
use crate::error::{Parsed, Place, Problem};

/// Largest number of members of all sets, and of numbers in all ranges. Sets of sets can double with every
/// line.
const MOST: usize = 1 << 23;

/// An instance of an Abaqus assembly: a part placed in it.
pub(super) struct Placed<'a> {
    /// Name of the instance in the assembly.
    pub name: &'a str,
    pub part: &'a Scope,
    pub first_node: u32,
    pub first_cell: u32,
}

/// A card that is processed after all instances have been placed.
pub(super) struct Waiting {
    place: Place,
    keyword: String,
    name: String,
    instance: Option<String>,
    generate: bool,
    by_nodes: bool,
    data: Vec<(Place, Vec<String>)>,
}

impl Waiting {
    /// Stores a card, or returns `None` for a surface that consists of neither element faces nor nodes.
    pub(super) fn new(card: &Card) -> Parsed<Option<Waiting>> {
        let by_nodes = card.get("TYPE").is_some_and(|t| t.eq_ignore_ascii_case("NODE"));
        let known = card.get("TYPE").is_none_or(|t| t.eq_ignore_ascii_case("ELEMENT") || by_nodes);
        let surface = card.keyword == "SURFACE";
        if surface && (!known || card.get("COMBINE").is_some()) {
            return Ok(None);
        }
        let of_name = match card.keyword.as_str() {
            "NSET" => "NSET",
            "ELSET" => "ELSET",
            _ => "NAME",
        };
        Ok(Some(Waiting {
            place: card.place,
            keyword: card.keyword.clone(),
            name: card.need(of_name)?.into(),
            instance: card.get("INSTANCE").map(String::from),
            generate: card.get("GENERATE").is_some(),
            by_nodes,
            data: card.data.iter().map(|&(place, line)| (place, split(line))).collect(),
        }))
    }

    /// Name of the surface or node set, `None` for an element set.
    pub(super) fn surface(&self) -> Option<&str> {
        (self.keyword != "ELSET").then_some(&self.name)
    }

    fn unknown(&self, place: Place, of: &'static str, number: &str) -> (Place, Problem) {
        let what = match self.keyword.as_str() {
            "NSET" => "node set",
            "ELSET" => "element set",
            _ => "surface",
        };
        (place, Problem::UnknownMember { what, name: self.name.clone(), of, number: number.into() })
    }
}

/// Sets defined so far, as nodes and cells of the whole mesh, by upper-case name.
struct Sets<'a> {
    placed: &'a [Placed<'a>],
    nodes: HashMap<String, Vec<u32>>,
    cells: HashMap<String, Vec<u32>>,
}

/// Adds the sets and surfaces of an assembly to the whole mesh. Nodes and elements outside of instances are
/// referred to by the assembly's own numbers.
pub(super) fn add(whole: &mut Content, waiting: &[Waiting], placed: &[Placed]) -> Parsed<()> {
    let mut sets = Sets { placed, nodes: HashMap::new(), cells: HashMap::new() };
    let (mut names, mut members, mut ranges): (Vec<&str>, usize, usize) = (Vec::new(), 0, 0);
    for card in waiting {
        if card.keyword == "SURFACE" {
            sets.surface(whole, card)?;
            continue;
        }
        let of_nodes = card.keyword == "NSET";
        let found = sets.members(whole, card, of_nodes, &mut ranges)?;
        let lists = if of_nodes { &mut sets.nodes } else { &mut sets.cells };
        members += found.len();
        few_enough(card.place, members)?;
        let key = card.name.to_ascii_uppercase();
        if of_nodes && !lists.contains_key(&key) {
            names.push(&card.name);
        }
        // A part's region keeps its name, so an assembly set of the same name adds no group.
        if !of_nodes
            && !card.name.starts_with('_')
            && !whole.regions().any(|name| name.eq_ignore_ascii_case(&card.name))
        {
            whole.also(card.place, &card.name, &found)?;
        }
        lists.entry(key).or_default().extend(found);
    }
    for name in names {
        whole.node_set(name, sets.nodes.remove(&name.to_ascii_uppercase()).unwrap_or_default());
    }
    Ok(())
}

impl Sets<'_> {
    fn instance(&self, name: &str) -> Option<&Placed<'_>> {
        self.placed.iter().find(|placed| placed.name.eq_ignore_ascii_case(name))
    }

    /// Nodes or cells listed by a set. `ranges` counts the numbers of all ranges.
    fn members(
        &self,
        whole: &Content,
        card: &Waiting,
        of_nodes: bool,
        ranges: &mut usize,
    ) -> Parsed<Vec<u32>> {
        let instance = match &card.instance {
            None => None,
            Some(name) => {
                Some(self.instance(name).ok_or_else(|| card.unknown(card.place, "instance", name))?)
            }
        };
        let mut found = Vec::new();
        for (place, words) in &card.data {
            if card.generate {
                let content = instance.map_or(whole, |placed| &placed.part.content);
                let range = Range::read(*place, words)?;
                *ranges += range.count();
                few_enough(*place, *ranges)?;
                let of = if of_nodes { "node" } else { "element" };
                let numbers = range.members(content, !of_nodes);
                let numbers = numbers.map_err(|number| card.unknown(*place, of, &number.to_string()))?;
                found.extend(placed(content, instance, of_nodes, &numbers));
                continue;
            }
            for word in words.iter().filter(|word| !word.is_empty()) {
                found.extend(self.one(whole, card, *place, instance, of_nodes, &unquoted(word))?);
                few_enough(*place, found.len())?;
            }
        }
        Ok(found)
    }

    /// Members denoted by a word: a number or a set, optionally prefixed by an instance and a dot.
    fn one(
        &self,
        whole: &Content,
        card: &Waiting,
        place: Place,
        instance: Option<&Placed>,
        of_nodes: bool,
        word: &str,
    ) -> Parsed<Vec<u32>> {
        if let (None, Some((name, member))) = (instance, word.split_once('.'))
            && let Some(other) = self.instance(name)
        {
            return self.one(whole, card, place, Some(other), of_nodes, member);
        }
        let numbers = match (word.parse::<u64>(), instance) {
            (Ok(number), _) => vec![number],
            (Err(_), None) => {
                let lists = if of_nodes { &self.nodes } else { &self.cells };
                let known = lists.get(&word.to_ascii_uppercase()).cloned();
                return known.ok_or_else(|| card.unknown(place, "set", word));
            }
            (Err(_), Some(placed)) => {
                let known = placed.part.set_of(of_nodes, word);
                known.ok_or_else(|| card.unknown(place, "set", word))?.to_vec()
            }
        };
        let content = instance.map_or(whole, |placed| &placed.part.content);
        for number in &numbers {
            let known =
                if of_nodes { content.node_of(*number).is_some() } else { content.knows_element(*number) };
            if !known {
                let of = if of_nodes { "node" } else { "element" };
                return Err(card.unknown(place, of, &number.to_string()));
            }
        }
        Ok(placed(content, instance, of_nodes, &numbers))
    }

    fn surface(&self, whole: &mut Content, card: &Waiting) -> Parsed<()> {
        let group = whole.group(&card.name);
        for (place, words) in &card.data {
            let first = unquoted(&words[0]);
            let found = self.one(whole, card, *place, None, card.by_nodes, &first)?;
            if card.by_nodes {
                whole.node_set(&card.name, found);
                continue;
            }
            let label = words.get(1).map(|word| word.to_ascii_uppercase()).unwrap_or_default();
            if label.is_empty() {
                whole.free_faces(*place, group, found);
                continue;
            }
            let face = label.strip_prefix('S').and_then(|face| face.parse::<usize>().ok());
            for cell in found {
                let kind: CellKind = whole.kind(cell);
                let corners = face.and_then(|face| kind.entry().cell.abaqus_faces.get(face.checked_sub(1)?));
                if !corners.is_some_and(|corners| whole.facet(group, cell, corners)) {
                    let expected = "a face that the elements have, such as S1";
                    return Err((*place, Problem::Expected { expected, found: label }));
                }
            }
        }
        Ok(())
    }
}

fn few_enough(place: Place, count: usize) -> Parsed<()> {
    if count <= MOST { Ok(()) } else { Err((place, Problem::TooMany { what: "members of sets", count })) }
}

/// Indices of nodes or cells in the whole mesh, from their numbers in an instance.
fn placed(content: &Content, instance: Option<&Placed>, of_nodes: bool, numbers: &[u64]) -> Vec<u32> {
    let (node, cell) = instance.map_or((0, 0), |placed| (placed.first_node, placed.first_cell));
    let one = |&number: &u64| {
        if of_nodes {
            content.node_of(number).map(|n| n + node)
        } else {
            content.cell_of(number).map(|c| c + cell)
        }
    };
    numbers.iter().filter_map(one).collect()
}
