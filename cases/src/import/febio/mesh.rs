//! Names of a model's mesh: parts, sets, surfaces and the places of nodes.

use std::collections::{BTreeSet, HashMap, HashSet};

use geometry::CellKind;
use mesh_files::{node_set_group, solid_of};
use roxmltree::Node;

use super::fields::{Source, numbers};
use crate::import::document::{list, quoted};
use crate::import::edges::lacks_a_middle;
use crate::import::units::Units;

/// Largest difference of two unit vectors that are the same.
const ROUNDING: f64 = 1e-9;

/// One `<Elements>` of the mesh.
pub(super) struct Elements<'a> {
    pub name: &'a str,
    pub node: Node<'a, 'a>,
    /// Type in the file.
    pub kind: &'a str,
    pub solid: Option<CellKind>,
    /// Nodes of each element.
    lists: Vec<Vec<u64>>,
}

/// Names of the mesh.
pub(super) struct Mesh<'a> {
    pub parts: Vec<Elements<'a>>,
    sets: HashMap<&'a str, Node<'a, 'a>>,
    surfaces: HashMap<&'a str, Node<'a, 'a>>,
    /// Primary and secondary surface.
    pairs: HashMap<&'a str, [&'a str; 2]>,
    places: HashMap<u64, Node<'a, 'a>>,
    /// Whether `<MeshData>` has directions of fibres for elements.
    pub has_fibres: bool,
}

impl<'a> Mesh<'a> {
    /// Reads the names of `<Mesh>`; the mesh reader checks the content.
    pub fn read(mesh: Node<'a, 'a>, source: &Source) -> Mesh<'a> {
        let mut read = Mesh {
            parts: Vec::new(),
            sets: HashMap::new(),
            surfaces: HashMap::new(),
            pairs: HashMap::new(),
            places: HashMap::new(),
            has_fibres: false,
        };
        for node in mesh.children().filter(Node::is_element) {
            let name = node.attribute("name").unwrap_or_default();
            match node.tag_name().name() {
                "Nodes" => {
                    let nodes = node.children().filter(Node::is_element);
                    let of = |node: Node<'a, 'a>| Some((node.attribute("id")?.trim().parse().ok()?, node));
                    read.places.extend(nodes.filter_map(of));
                }
                "Elements" => {
                    let kind = node.attribute("type").unwrap_or_default();
                    let lists = node.children().filter(Node::is_element).map(whole_numbers).collect();
                    read.parts.push(Elements { name, node, kind, solid: solid_of(kind), lists });
                }
                "NodeSet" => drop(read.sets.insert(name, node)),
                "Surface" => drop(read.surfaces.insert(name, node)),
                "SurfacePair" => {
                    let side = |tag: &str| {
                        let side = node.children().find(|child| child.has_tag_name(tag));
                        side.and_then(|side| side.text()).unwrap_or_default().trim()
                    };
                    read.pairs.insert(name, [side("primary"), side("secondary")]);
                }
                "ElementSet" | "PartList" | "Edge" => {}
                other => source.refuse(node, format!("<{other}> of <Mesh> can't be expressed"), ""),
            }
        }
        read
    }

    /// Reads `<MeshData>`: the mesh reader takes the directions of fibres, other parts are refused.
    pub fn data(&mut self, section: Node, source: &Source) {
        for node in section.children().filter(Node::is_element) {
            let (tag, kind) = (node.tag_name().name(), node.attribute("type").or(node.attribute("var")));
            match (tag, kind) {
                ("ElementData", Some("fiber")) => self.has_fibres = true,
                _ => {
                    let kind = kind.map_or(String::new(), |kind| format!(" '{kind}'"));
                    source.refuse(node, format!("<{tag}>{kind} of <MeshData> can't be expressed"), "");
                }
            }
        }
    }

    /// Name of the group of the mesh that a condition on nodes names.
    pub fn nodes_of(&self, condition: Node, source: &Source) -> Option<String> {
        let name = condition.attribute("node_set").unwrap_or_default();
        if let Some(surface) = name.strip_prefix("@surface:") {
            return self.surfaces.contains_key(surface).then(|| surface.to_string()).or_else(|| {
                source.refuse(condition, format!("surface '{surface}' is not in the mesh"), "");
                None
            });
        }
        if !self.sets.contains_key(name) {
            source.refuse(condition, format!("node set '{name}' is not in the mesh"), "name a <NodeSet>");
            return None;
        }
        Some(node_set_group(name, self.surfaces.contains_key(name)))
    }

    /// Part of the mesh that a condition on nodes names, as a key of the scene with its value: a group by its
    /// name, or the places of the nodes if the faces of the group have further nodes.
    pub fn place_of(&self, condition: Node, units: Units, source: &Source) -> Option<(&'static str, String)> {
        let group = self.nodes_of(condition, source)?;
        let name = condition.attribute("node_set").unwrap_or_default();
        let lacks = self.sets.get(name).is_some_and(|set| {
            let nodes: HashSet<u64> = members(*set).into_iter().collect();
            let mut solids = self.parts.iter().filter_map(|part| Some((part.solid?, &part.lists)));
            solids.any(|(kind, lists)| {
                lists.iter().any(|list| lacks_a_middle(kind, list, |node| nodes.contains(&node)))
            })
        });
        if !lacks {
            return Some(("on", quoted(&group)));
        }
        let places = self.places_of(condition, source)?;
        Some(("at", list(places.into_iter().map(|place| list(place.map(|x| units.lengths(x)))))))
    }

    /// Direction from one local node, from 1, to another, if all elements of some parts have the same.
    pub fn local_direction(&self, parts: &[&str], ends: [usize; 2], source: &Source) -> Option<[f64; 3]> {
        let mut found: Option<[f64; 3]> = None;
        let own = self.parts.iter().filter(|part| parts.contains(&part.name));
        for nodes in own.flat_map(|part| &part.lists) {
            let place = |end: usize| -> Option<[f64; 3]> {
                let number = nodes.get(end.checked_sub(1)?)?;
                self.place(*number, source)
            };
            let (a, b) = (place(ends[0])?, place(ends[1])?);
            let d = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
            let length = d.iter().map(|x| x * x).sum::<f64>().sqrt();
            let d = d.map(|x| x / length);
            let first = *found.get_or_insert(d);
            if !first.iter().zip(&d).all(|(x, y)| (x - y).abs() <= ROUNDING) {
                return None;
            }
        }
        found
    }

    /// Name of the surface of the mesh that a condition names.
    pub fn surface_of(&self, condition: Node<'a, 'a>, source: &Source) -> Option<&'a str> {
        let name = condition.attribute("surface").unwrap_or_default();
        let known = self.surfaces.contains_key(name);
        if !known {
            source.refuse(condition, format!("surface '{name}' is not in the mesh"), "name a <Surface>");
        }
        known.then_some(name)
    }

    /// Surfaces of the pair that a contact names.
    pub fn pair_of(&self, contact: Node<'a, 'a>, source: &Source) -> Option<[&'a str; 2]> {
        let name = contact.attribute("surface_pair").unwrap_or_default();
        let pair =
            self.pairs.get(name).filter(|pair| pair.iter().all(|side| self.surfaces.contains_key(side)));
        if pair.is_none() {
            let help = "name a <SurfacePair> of two surfaces";
            source.refuse(contact, format!("surface pair '{name}' is not in the mesh"), help);
        }
        pair.copied()
    }

    /// Corners of the facets of a surface.
    pub fn facets(&self, surface: &str) -> Vec<Vec<u64>> {
        let facets = self.surfaces[surface].children().filter(Node::is_element);
        let corners = |facet: Node| {
            let mut nodes = whole_numbers(facet);
            nodes.truncate(if facet.tag_name().name().starts_with("tri") { 3 } else { 4 });
            nodes
        };
        facets.map(corners).collect()
    }

    /// Whether all these nodes belong to a part.
    pub fn has_nodes(&self, part: &str, nodes: &HashSet<u64>) -> bool {
        let Some(part) = self.parts.iter().find(|other| other.name == part) else { return false };
        let own: HashSet<u64> = part.lists.iter().flatten().copied().collect();
        !nodes.is_empty() && nodes.is_subset(&own)
    }

    /// Coordinates of a node.
    pub fn place(&self, number: u64, source: &Source) -> Option<[f64; 3]> {
        numbers(*self.places.get(&number)?, source, 3)?.try_into().ok()
    }

    /// Nodes that a condition names, with their coordinates.
    pub fn places_of(&self, condition: Node, source: &Source) -> Option<Vec<[f64; 3]>> {
        self.nodes_of(condition, source)?;
        let name = condition.attribute("node_set").unwrap_or_default();
        let nodes: BTreeSet<u64> = match name.strip_prefix("@surface:") {
            Some(surface) => {
                self.surfaces[surface].children().filter(Node::is_element).flat_map(whole_numbers).collect()
            }
            None => members(self.sets[name]).into_iter().collect(),
        };
        let mut places = Vec::new();
        for number in nodes {
            let Some(node) = self.places.get(&number) else {
                source.refuse(condition, format!("node {number} of '{name}' is not in the mesh"), "");
                return None;
            };
            places.push(numbers(*node, source, 3)?.try_into().ok()?);
        }
        Some(places)
    }

    /// Whether a solid that is not among these parts shares nodes with the part.
    pub fn shares_nodes(&self, part: &str, rigid: &HashSet<&str>) -> bool {
        let Some(own) = self.parts.iter().find(|other| other.name == part) else { return false };
        let solid = |other: &&Elements| other.solid.is_some() && !rigid.contains(other.name);
        let own: HashSet<u64> = own.lists.iter().flatten().copied().collect();
        self.parts
            .iter()
            .filter(solid)
            .any(|other| other.lists.iter().flatten().any(|node| own.contains(node)))
    }
}

/// Members of a set, as text or each in its own element.
fn members(set: Node) -> Vec<u64> {
    let children: Vec<u64> =
        set.children().filter_map(|node| node.attribute("id")?.trim().parse().ok()).collect();
    if children.is_empty() { whole_numbers(set) } else { children }
}

fn whole_numbers(node: Node) -> Vec<u64> {
    let text = node.text().unwrap_or_default();
    text.split(|c: char| c == ',' || c.is_whitespace()).filter_map(|word| word.parse().ok()).collect()
}
