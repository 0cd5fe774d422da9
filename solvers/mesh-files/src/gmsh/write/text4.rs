//! Writer of version 4.1: a volume entity for each set of groups of a cell, and a surface entity for each set
//! of groups of a facet.
//!
//! An element belongs to one entity, and an entity to any number of physical groups. Facets with the same
//! groups therefore form one entity.

use std::collections::BTreeMap;
use std::fmt::{self, Write};

use geometry::{Facet, Mesh, Point3};

use super::groups::{cell_tags, group_tag, physical_names};
use super::nodes::{cell_nodes, face_nodes};

/// Surface entities: the physical tags of each, and its facets by element type.
type Surfaces = BTreeMap<Vec<usize>, BTreeMap<u64, Vec<Facet>>>;

/// Elements of one entity and type.
struct Block<T> {
    dimension: u8,
    entity: usize,
    kind: u64,
    elements: Vec<T>,
}

pub(super) fn text(mesh: &Mesh, unit: f64) -> String {
    let mut out = String::from("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
    let surfaces = surfaces(mesh);
    let volumes = Volumes::new(mesh);
    physical_names(&mut out, mesh);
    entities(&mut out, mesh, unit, &surfaces, &volumes);
    nodes(&mut out, mesh, unit, volumes.of_cell[0]);
    elements(&mut out, mesh, &surfaces, &volumes);
    out
}

/// Volume entities: the physical tags of each, and the entity of each cell, from 1.
struct Volumes {
    tags: Vec<Vec<usize>>,
    of_cell: Vec<usize>,
}

impl Volumes {
    fn new(mesh: &Mesh) -> Volumes {
        let of_cells = cell_tags(mesh);
        // Entities of a single region come first, in the order of the regions. A mesh without further groups
        // has an entity for each region.
        let mut tags = of_cells.clone();
        tags.sort_unstable_by_key(|tags| (tags.len(), tags.clone()));
        tags.dedup();
        let place: BTreeMap<&Vec<usize>, usize> = tags.iter().zip(1..).collect();
        let of_cell = of_cells.iter().map(|tags| place[tags]).collect();
        Volumes { of_cell, tags }
    }
}

fn surfaces(mesh: &Mesh) -> Surfaces {
    let mut of_facet: BTreeMap<Facet, Vec<usize>> = BTreeMap::new();
    for (group, name) in mesh.group_names().enumerate() {
        for &facet in mesh.group(name).unwrap_or_default() {
            let tags = of_facet.entry(facet).or_default();
            if tags.last() != Some(&group_tag(mesh, group)) {
                tags.push(group_tag(mesh, group));
            }
        }
    }
    let mut surfaces = Surfaces::new();
    for (facet, tags) in of_facet {
        let kind = mesh.facet_kind(facet).gmsh();
        surfaces.entry(tags).or_default().entry(kind).or_default().push(facet);
    }
    surfaces
}

fn entities(out: &mut String, mesh: &Mesh, unit: f64, surfaces: &Surfaces, volumes: &Volumes) {
    let mut of_volume = vec![None; volumes.tags.len()];
    for (cell, volume) in volumes.of_cell.iter().enumerate() {
        grow(&mut of_volume[volume - 1], mesh.cell(cell).iter().map(|&node| mesh.points()[node as usize]));
    }
    // Writing to a string cannot fail.
    let _ = writeln!(out, "$Entities\n0 0 {} {}", surfaces.len(), volumes.tags.len());
    for (at, (tags, by_kind)) in surfaces.iter().enumerate() {
        let nodes = by_kind.values().flatten().flat_map(|&facet| mesh.facet_nodes(facet));
        let mut bounds = None;
        grow(&mut bounds, nodes.map(|node| mesh.points()[node as usize]));
        entity(out, at + 1, bounds.unwrap_or_default(), unit, tags);
    }
    for (at, (tags, bounds)) in volumes.tags.iter().zip(of_volume).enumerate() {
        entity(out, at + 1, bounds.unwrap_or_default(), unit, tags);
    }
    out.push_str("$EndEntities\n");
}

/// Lowest and highest corner of a box.
type Bounds = (Point3, Point3);

fn grow(bounds: &mut Option<Bounds>, points: impl Iterator<Item = Point3>) {
    for p in points {
        let (low, high) = bounds.unwrap_or((p, p));
        *bounds = Some((low.inf(&p), high.sup(&p)));
    }
}

/// A number in the fewest digits that preserve its bits; meshio cannot read numbers of hundreds of digits.
struct Number(f64);

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        let plain = size == 0.0 || (1e-5..1e16).contains(&size);
        if plain { write!(f, "{}", self.0) } else { write!(f, "{:e}", self.0) }
    }
}

/// Writes an entity: its tag, bounding box and physical tags, without bounding entities.
fn entity(out: &mut String, tag: usize, (low, high): Bounds, unit: f64, physical: &[usize]) {
    let _ = write!(out, "{tag}");
    for x in low.iter().chain(high.iter()) {
        let _ = write!(out, " {}", Number(x / unit));
    }
    let _ = write!(out, " {}", physical.len());
    for tag in physical {
        let _ = write!(out, " {tag}");
    }
    out.push_str(" 0\n");
}

/// Writes all nodes in one block of the first cell's volume, so that they keep their order.
fn nodes(out: &mut String, mesh: &Mesh, unit: f64, volume: usize) {
    let count = mesh.points().len();
    let _ = writeln!(out, "$Nodes\n1 {count} 1 {count}\n3 {volume} 0 {count}");
    for node in 1..=count {
        let _ = writeln!(out, "{node}");
    }
    for p in mesh.points() {
        let [x, y, z] = [p.x, p.y, p.z].map(|x| Number(x / unit));
        let _ = writeln!(out, "{x} {y} {z}");
    }
    out.push_str("$EndNodes\n");
}

fn elements(out: &mut String, mesh: &Mesh, surfaces: &Surfaces, volumes: &Volumes) {
    let faces: Vec<Block<Facet>> = (surfaces.values().enumerate())
        .flat_map(|(at, by_kind)| {
            let block = move |(&kind, facets): (&u64, &Vec<Facet>)| Block {
                dimension: 2,
                entity: at + 1,
                kind,
                elements: facets.clone(),
            };
            by_kind.iter().map(block)
        })
        .collect();
    // Cells keep their order: a block ends at a change of entity or type.
    let mut cells: Vec<Block<usize>> = Vec::new();
    for cell in 0..mesh.cell_count() {
        let entity = volumes.of_cell[cell];
        let kind = mesh.kind(cell).entry().files.gmsh;
        match cells.last_mut().filter(|block| (block.entity, block.kind) == (entity, kind)) {
            Some(block) => block.elements.push(cell),
            None => cells.push(Block { dimension: 3, entity, kind, elements: vec![cell] }),
        }
    }
    let count = mesh.cell_count() + faces.iter().map(|block| block.elements.len()).sum::<usize>();
    let _ = writeln!(out, "$Elements\n{} {count} 1 {count}", faces.len() + cells.len());
    let mut number = 0;
    blocks(out, &mut number, &faces, |out, &facet| face_nodes(out, mesh, facet));
    blocks(out, &mut number, &cells, |out, &cell| cell_nodes(out, mesh, cell));
    out.push_str("$EndElements\n");
}

/// Writes blocks of elements, numbered consecutively after `number`.
fn blocks<T>(out: &mut String, number: &mut usize, blocks: &[Block<T>], nodes: impl Fn(&mut String, &T)) {
    for Block { dimension, entity, kind, elements } in blocks {
        let _ = writeln!(out, "{dimension} {entity} {kind} {}", elements.len());
        for element in elements {
            *number += 1;
            let _ = write!(out, "{number}");
            nodes(out, element);
        }
    }
}
