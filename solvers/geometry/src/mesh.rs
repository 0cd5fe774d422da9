//! A mixed mesh in flat arrays, with named regions, further named groups of cells, and named groups of
//! boundary facets and of nodes.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use crate::Point3;
use crate::cell::FaceKind;
use crate::element::CellKind;

/// One face of one cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Facet {
    /// Cell index.
    pub cell: u32,
    /// Index into [`CellKind::faces`].
    pub face: u8,
}

/// Errors of mesh construction.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// A mesh with no cells or no points.
    #[error("the mesh has {points} points and {cells} cells; at least one cell is needed")]
    Empty {
        /// Number of points given.
        points: usize,
        /// Number of cells given.
        cells: usize,
    },
    /// A connectivity entry beyond the points.
    #[error("cell {cell} names node {node}, but there are only {points} points (0 to {})", points - 1)]
    NodeOutOfRange {
        /// Cell index.
        cell: usize,
        /// The bad node index.
        node: usize,
        /// Number of points.
        points: usize,
    },
    /// A coordinate that is not a finite number.
    #[error("point {point} has a coordinate that is not finite")]
    NotFinite {
        /// Point index.
        point: usize,
    },
    /// A cell that names one node twice.
    #[error("cell {cell} names node {node} twice")]
    RepeatedNode {
        /// Cell index.
        cell: usize,
        /// The repeated node.
        node: usize,
    },
    /// A facet group naming a face that does not exist.
    #[error("facet group '{group}' names face {face} of cell {cell}, which does not exist")]
    NoSuchFacet {
        /// Group name.
        group: String,
        /// Cell index.
        cell: u32,
        /// Face index.
        face: u8,
    },
}

/// A mesh of cells of any kinds; positions in metres.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    points: Vec<Point3>,
    kinds: Vec<CellKind>,
    offsets: Vec<usize>,
    nodes: Vec<u32>,
    regions: Vec<u16>,
    region_names: Vec<String>,
    cell_groups: BTreeMap<String, Vec<u32>>,
    groups: BTreeMap<String, Vec<Facet>>,
    node_groups: BTreeMap<String, Vec<u32>>,
    boundary: Boundary,
}

/// Cached boundary facets, computed on first use. Every load and every essential condition needs them, and
/// for 6190 tetrahedra they take a fifth of the time to prepare a cloud of 83 nodes.
#[derive(Clone, Debug, Default)]
struct Boundary(OnceLock<Vec<Facet>>);

/// The cells determine the boundary, so two meshes are equal whether or not it has been computed.
impl PartialEq for Boundary {
    fn eq(&self, _: &Boundary) -> bool {
        true
    }
}

impl Mesh {
    /// Creates a mesh of one region named "body", without facet groups. `cells` are (kind, node indices)
    /// pairs.
    ///
    /// # Errors
    /// No cells or points, a coordinate that is not finite, or a node that is out of range or repeated within
    /// a cell.
    ///
    /// # Panics
    /// A cell whose number of indices is not that of its kind.
    pub fn new(points: Vec<Point3>, cells: &[(CellKind, Vec<u32>)]) -> Result<Mesh, MeshError> {
        let kinds = cells.iter().map(|(kind, _)| *kind).collect();
        let nodes = cells.iter().flat_map(|(_, nodes)| nodes.iter().copied()).collect();
        Mesh::from_flat(points, kinds, nodes)
    }

    /// Creates a mesh as [`Mesh::new`] does, from flat arrays: the kind of each cell, and the concatenated
    /// node indices.
    ///
    /// # Errors
    /// As for [`Mesh::new`].
    ///
    /// # Panics
    /// As for [`Mesh::new`].
    pub fn from_flat(points: Vec<Point3>, kinds: Vec<CellKind>, nodes: Vec<u32>) -> Result<Mesh, MeshError> {
        if points.is_empty() || kinds.is_empty() {
            return Err(MeshError::Empty { points: points.len(), cells: kinds.len() });
        }
        if let Some(point) = points.iter().position(|p| !p.coords.iter().all(|c| c.is_finite())) {
            return Err(MeshError::NotFinite { point });
        }
        let mut offsets = Vec::with_capacity(kinds.len() + 1);
        offsets.push(0);
        for kind in &kinds {
            offsets.push(offsets.last().unwrap() + kind.node_count());
        }
        assert_eq!(
            *offsets.last().unwrap(),
            nodes.len(),
            "connectivity length does not match the cell kinds"
        );
        for cell in 0..kinds.len() {
            let list = &nodes[offsets[cell]..offsets[cell + 1]];
            for (a, &node) in list.iter().enumerate() {
                if node as usize >= points.len() {
                    return Err(MeshError::NodeOutOfRange {
                        cell,
                        node: node as usize,
                        points: points.len(),
                    });
                }
                if list[..a].contains(&node) {
                    return Err(MeshError::RepeatedNode { cell, node: node as usize });
                }
            }
        }
        let regions = vec![0; kinds.len()];
        Ok(Mesh {
            points,
            kinds,
            offsets,
            nodes,
            regions,
            region_names: vec!["body".into()],
            cell_groups: BTreeMap::new(),
            groups: BTreeMap::new(),
            node_groups: BTreeMap::new(),
            boundary: Boundary::default(),
        })
    }

    /// Replaces the regions: one index per cell into `names`.
    ///
    /// # Panics
    /// A number of indices that is not that of the cells, or an index beyond `names`.
    pub fn with_regions(mut self, regions: Vec<u16>, names: Vec<String>) -> Mesh {
        assert_eq!(regions.len(), self.kinds.len(), "one region per cell");
        assert!(regions.iter().all(|&r| (r as usize) < names.len()), "every region has a name");
        self.regions = regions;
        self.region_names = names;
        self
    }

    /// Adds (or replaces) a named group of cells. The regions of the cells are unaffected.
    pub fn with_cell_group(mut self, name: &str, mut cells: Vec<u32>) -> Mesh {
        assert!(cells.iter().all(|&cell| (cell as usize) < self.kinds.len()), "cells of the mesh");
        cells.sort_unstable();
        cells.dedup();
        self.cell_groups.insert(name.into(), cells);
        self
    }

    /// Adds (or replaces) a named group of facets.
    ///
    /// # Errors
    /// A facet of a cell or face that does not exist.
    pub fn with_group(mut self, name: &str, facets: Vec<Facet>) -> Result<Mesh, MeshError> {
        for f in &facets {
            let known = self.kinds.get(f.cell as usize).is_some_and(|k| (f.face as usize) < k.faces().len());
            if !known {
                return Err(MeshError::NoSuchFacet { group: name.into(), cell: f.cell, face: f.face });
            }
        }
        self.groups.insert(name.into(), facets);
        Ok(self)
    }

    /// Adds (or replaces) a named group of nodes, such as those of a curve.
    ///
    /// # Panics
    /// A node that does not exist.
    pub fn with_node_group(mut self, name: &str, mut nodes: Vec<u32>) -> Mesh {
        assert!(nodes.iter().all(|&node| (node as usize) < self.points.len()), "nodes of the mesh");
        nodes.sort_unstable();
        nodes.dedup();
        self.node_groups.insert(name.into(), nodes);
        self
    }

    /// Node positions, in metres.
    pub fn points(&self) -> &[Point3] {
        &self.points
    }

    /// Number of cells.
    pub fn cell_count(&self) -> usize {
        self.kinds.len()
    }

    /// Kind of one cell.
    pub fn kind(&self, cell: usize) -> CellKind {
        self.kinds[cell]
    }

    /// The common kind of all cells, or `None` in a mixed mesh.
    pub fn uniform_kind(&self) -> Option<CellKind> {
        self.kinds.iter().all(|k| *k == self.kinds[0]).then_some(self.kinds[0])
    }

    /// Node indices of one cell.
    pub fn cell(&self, cell: usize) -> &[u32] {
        &self.nodes[self.offsets[cell]..self.offsets[cell + 1]]
    }

    /// Positions of one cell's nodes.
    pub fn cell_points(&self, cell: usize) -> impl ExactSizeIterator<Item = &Point3> {
        self.cell(cell).iter().map(|&n| &self.points[n as usize])
    }

    /// Region index of one cell.
    pub fn region(&self, cell: usize) -> u16 {
        self.regions[cell]
    }

    /// Names of the regions.
    pub fn region_names(&self) -> &[String] {
        &self.region_names
    }

    /// Groups of cells, which may cross regions, sorted by name, each with its cells in ascending order.
    pub fn cell_groups(&self) -> impl Iterator<Item = (&str, &[u32])> {
        self.cell_groups.iter().map(|(name, cells)| (name.as_str(), cells.as_slice()))
    }

    /// Whether a cell is in the region or the cell group with this name.
    pub fn is_in(&self, cell: usize, name: &str) -> bool {
        let group =
            || self.cell_groups.get(name).is_some_and(|cells| cells.binary_search(&(cell as u32)).is_ok());
        self.region_names[self.regions[cell] as usize] == name || group()
    }

    /// A named facet group.
    pub fn group(&self, name: &str) -> Option<&[Facet]> {
        self.groups.get(name).map(Vec::as_slice)
    }

    /// A named group of nodes, sorted.
    pub fn node_group(&self, name: &str) -> Option<&[u32]> {
        self.node_groups.get(name).map(Vec::as_slice)
    }

    /// All groups of nodes, sorted by name.
    pub fn node_groups(&self) -> impl Iterator<Item = (&str, &[u32])> {
        self.node_groups.iter().map(|(name, nodes)| (name.as_str(), nodes.as_slice()))
    }

    /// Names of all facet groups, sorted.
    pub fn group_names(&self) -> impl Iterator<Item = &str> {
        self.groups.keys().map(String::as_str)
    }

    /// Global node indices of a facet, corners first, counter-clockwise from outside.
    pub fn facet_nodes(&self, facet: Facet) -> impl ExactSizeIterator<Item = u32> + '_ {
        let cell = self.cell(facet.cell as usize);
        self.kind(facet.cell as usize).faces()[facet.face as usize].iter().map(|&local| cell[local])
    }

    /// Shape of a facet.
    pub fn facet_kind(&self, facet: Facet) -> FaceKind {
        self.kind(facet.cell as usize).face_kind(facet.face as usize)
    }

    /// Global node indices of a facet's corners, counter-clockwise from outside.
    pub fn facet_corners(&self, facet: Facet) -> impl ExactSizeIterator<Item = u32> + '_ {
        self.facet_nodes(facet).take(self.facet_kind(facet).corner_count())
    }

    /// Facets that belong to only one cell, in cell order.
    pub fn boundary(&self) -> Vec<Facet> {
        self.boundary.0.get_or_init(|| self.find_boundary()).clone()
    }

    fn find_boundary(&self) -> Vec<Facet> {
        let facets = || {
            let of_cell = |(cell, kind): (usize, &CellKind)| {
                (0..kind.faces().len() as u8).map(move |face| Facet { cell: cell as u32, face })
            };
            self.kinds.iter().enumerate().flat_map(of_cell)
        };
        let lowest = |facet: Facet| self.facet_corners(facet).fold(u32::MAX, u32::min) as usize;
        // Bucket sort by smallest node: sorting all faces at once takes three times as long. The buckets hold
        // no corners: they would take three times the memory.
        let mut starts = vec![0u32; self.points.len() + 1];
        facets().for_each(|facet| starts[lowest(facet) + 1] += 1);
        for node in 0..self.points.len() {
            starts[node + 1] += starts[node];
        }
        let mut next = starts.clone();
        let mut order = vec![Facet { cell: 0, face: 0 }; starts[self.points.len()] as usize];
        for facet in facets() {
            let slot = &mut next[lowest(facet)];
            order[*slot as usize] = facet;
            *slot += 1;
        }
        let mut around = Vec::new();
        let mut outer = Vec::new();
        for range in starts.windows(2) {
            around.clear();
            around.extend(order[range[0] as usize..range[1] as usize].iter().map(|&facet| {
                // `u32::MAX` pads triangles, so that one type represents both face shapes.
                let mut nodes = [u32::MAX; 4];
                nodes.iter_mut().zip(self.facet_corners(facet)).for_each(|(slot, node)| *slot = node);
                nodes.sort_unstable();
                (nodes, facet)
            }));
            around.sort_unstable();
            outer.extend(
                around.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() == 1).map(|same| same[0].1),
            );
        }
        outer.sort_unstable();
        outer
    }

    /// Sorted indices of the nodes of the given facets.
    pub fn facet_group_nodes(&self, facets: &[Facet]) -> Vec<u32> {
        let mut nodes: Vec<u32> = facets.iter().flat_map(|&f| self.facet_nodes(f)).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// The same cells, regions and groups over other nodes; `number` maps an old node index to the new index.
    pub(crate) fn renumbered(&self, points: Vec<Point3>, number: impl Fn(u32) -> u32) -> Mesh {
        let nodes = self.nodes.iter().map(|&node| number(node)).collect();
        let moved = |group: &Vec<u32>| -> Vec<u32> {
            let mut group: Vec<u32> = group.iter().map(|&node| number(node)).collect();
            group.sort_unstable();
            group.dedup();
            group
        };
        let node_groups = self.node_groups.iter().map(|(name, group)| (name.clone(), moved(group))).collect();
        Mesh { points, nodes, node_groups, boundary: Default::default(), ..self.clone() }
    }

    /// The same topology with other positions, m.
    pub(crate) fn at(&self, points: Vec<Point3>) -> Mesh {
        debug_assert_eq!(points.len(), self.points.len());
        Mesh { points, ..self.clone() }
    }

    /// The same topology with every position mapped by `map`.
    ///
    /// # Errors
    /// A mapped coordinate that is not finite.
    pub fn moved(&self, map: impl Fn(&Point3) -> Point3) -> Result<Mesh, MeshError> {
        let points: Vec<Point3> = self.points.iter().map(map).collect();
        match points.iter().position(|p| !p.coords.iter().all(|c| c.is_finite())) {
            Some(point) => Err(MeshError::NotFinite { point }),
            None => Ok(Mesh { points, ..self.clone() }),
        }
    }
}
