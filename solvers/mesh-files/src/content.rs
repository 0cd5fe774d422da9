//! Content of a mesh file as collected by the readers, and its conversion to a mesh.

mod groups;
mod node_groups;

use std::collections::{BTreeMap, HashMap};
use std::path::Path;

use geometry::{CellKind, Facet, Mesh, Point3};

use self::node_groups::{faces_of, of_cell, with_further_nodes, within};
use crate::data_array::DataArray;
use crate::error::{FileError, Parsed, Place, Problem};
use crate::left_out::LeftOut;
use crate::middles::turn_if_inverted;
use crate::names::{Names, without_empty};
use crate::numbers::Numbers;
use crate::overlap::Cells;
use crate::rows::{Row, Rows};

/// Content of a file read so far. Nodes and elements are identified by the numbers of the file.
#[derive(Clone, Default)]
pub(super) struct Content {
    node_numbers: Numbers,
    points: Vec<Point3>,
    /// Row of each node, and whether something other than a cell uses the node.
    node_rows: Vec<(Row, bool)>,
    element_numbers: Numbers,
    /// Cell of each numbered element; `u32::MAX` for other elements.
    cell_of_element: Vec<u32>,
    kinds: Vec<CellKind>,
    nodes: Vec<u32>,
    regions: Vec<u16>,
    rows: Vec<Row>,
    region_names: Names,
    faces: Vec<Face>,
    group_names: Names,
    facets: Vec<(usize, Facet)>,
    free: Vec<Free>,
    node_sets: Vec<(String, Vec<u32>)>,
    /// Nodes of named points and curves.
    curves: BTreeMap<String, Vec<u32>>,
    /// Whether unused nodes are dropped, because elements of the file have interior nodes.
    leaves_unused_out: bool,
    /// Cells in additional regions, which become groups of cells.
    also: Vec<(u32, u16)>,
    /// Whether a cell may be listed once for each of its regions.
    repeats: bool,
    left_out: Vec<LeftOut>,
    /// Arrays of cells and nodes, if one is requested.
    pub(super) arrays: Vec<DataArray>,
}

/// Kind of item that a name belongs to.
#[derive(Clone, Copy)]
pub(super) enum Named {
    Region,
    Surface,
}

/// A group of the free faces of some cells, which are determined once all cells are known.
#[derive(Clone)]
struct Free {
    place: Place,
    group: usize,
    cells: Vec<u32>,
}

/// Treatment of nodes that no element or set uses.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Unused {
    Refused,
    LeftOut,
}

/// Region index of a cell without a region.
pub(super) const NO_REGION: u16 = u16::MAX;

/// A surface element whose cell is not yet known; corners sorted and padded with `u32::MAX`.
#[derive(Clone)]
struct Face {
    place: Place,
    element: u64,
    corners: [u32; 4],
    group: usize,
    /// Whether the face need not belong to a solid, as for a shell.
    loose: bool,
}

impl Content {
    /// Adds a node, with its position in the unit of the file.
    pub(super) fn node(&mut self, place: Place, number: u64, at: Point3) -> Parsed<()> {
        if !at.coords.iter().all(|c| c.is_finite()) {
            return Err((place, Problem::NotFinite { number }));
        }
        let index = index(place, "nodes", self.points.len())?;
        if !self.node_numbers.add(number, index) {
            return Err((place, Problem::Duplicate { what: "node", number }));
        }
        self.points.push(at);
        self.node_rows.push((Row { place, tag: number }, false));
        Ok(())
    }

    /// Number of nodes so far.
    pub(super) fn node_count(&self) -> usize {
        self.points.len()
    }

    /// Total size: the number of nodes, cell nodes, faces and set members.
    pub(super) fn extent(&self) -> usize {
        let sets: usize = self.node_sets.iter().map(|(_, nodes)| nodes.len()).sum();
        let free: usize = self.free.iter().map(|free| free.cells.len()).sum();
        self.points.len() + self.nodes.len() + self.facets.len() + self.faces.len() + free + sets
    }

    /// Number of elements so far, including elements that are not cells.
    pub(super) fn element_count(&self) -> usize {
        self.cell_of_element.len()
    }

    /// Number of cells so far.
    pub(super) fn cell_count(&self) -> usize {
        self.kinds.len()
    }

    /// Adds an element that does not become a cell.
    pub(super) fn element(&mut self, row: Row, list: &[u64]) -> Parsed<()> {
        self.numbered(row.place, row.tag, u32::MAX)?;
        for &node in list {
            if !self.touch(node) {
                return Err((row.place, Problem::UnknownNode { element: row.tag, node }));
            }
        }
        Ok(())
    }

    /// Drops unused nodes, because elements of the file have interior nodes.
    pub(super) fn leave_unused_out(&mut self) {
        self.leaves_unused_out = true;
    }

    /// Marks a node as used, and returns whether a node with this number exists.
    pub(super) fn touch(&mut self, number: u64) -> bool {
        let node = self.node_numbers.get(number);
        if let Some(node) = node {
            self.node_rows[node as usize].1 = true;
        }
        node.is_some()
    }

    fn numbered(&mut self, place: Place, number: u64, cell: u32) -> Parsed<()> {
        let index = index(place, "elements", self.cell_of_element.len())?;
        if !self.element_numbers.add(number, index) {
            return Err((place, Problem::Duplicate { what: "element", number }));
        }
        self.cell_of_element.push(cell);
        Ok(())
    }

    /// Adds a cell of a region. `list` has the node numbers in the order of the file; entry g becomes node
    /// `order[g]` of the cell.
    pub(super) fn cell(
        &mut self,
        row: Row,
        kind: CellKind,
        region: u16,
        list: &[u64],
        order: &[usize],
    ) -> Parsed<()> {
        self.numbered(row.place, row.tag, self.kinds.len() as u32)?;
        let start = self.nodes.len();
        self.nodes.resize(start + kind.node_count(), u32::MAX);
        for (place, &number) in list.iter().enumerate() {
            let Some(node) = self.node_numbers.get(number) else {
                return Err((row.place, Problem::UnknownNode { element: row.tag, node: number }));
            };
            if list[..place].contains(&number) {
                return Err((row.place, Problem::RepeatedNode { element: row.tag, node: number }));
            }
            self.nodes[start + order[place]] = node;
        }
        self.kinds.push(kind);
        self.regions.push(region);
        self.rows.push(row);
        Ok(())
    }

    /// Puts the nodes of the last cell, of this kind, in mirrored order if its volume is negative.
    pub(super) fn turn_if_inverted(&mut self, kind: CellKind) {
        let start = self.nodes.len() - kind.node_count();
        turn_if_inverted(kind, &mut self.nodes[start..], &self.points);
    }

    /// Cell with this element number.
    pub(super) fn cell_of(&self, number: u64) -> Option<u32> {
        let element = self.element_numbers.get(number)? as usize;
        Some(self.cell_of_element[element]).filter(|&cell| cell != u32::MAX)
    }

    /// Assigns all cells without a region to the region of this name.
    pub(super) fn fill_regions(&mut self, name: &str) -> Parsed<()> {
        if let Some(first) = self.regions.iter().position(|&region| region == NO_REGION) {
            let region = self.region(self.rows[first].place, name)?;
            self.regions.iter_mut().filter(|known| **known == NO_REGION).for_each(|known| *known = region);
        }
        Ok(())
    }

    /// Assigns a cell to another region.
    pub(super) fn set_region(&mut self, cell: u32, region: u16) {
        self.regions[cell as usize] = region;
    }

    /// Index of the region of this name, which is added if it is new.
    pub(super) fn region(&mut self, place: Place, name: &str) -> Parsed<u16> {
        let at = self.region_names.place(name);
        let region = u16::try_from(at).ok().filter(|&region| region != NO_REGION);
        region.ok_or((place, Problem::TooMany { what: "regions", count: at }))
    }

    /// Index of the facet group of this name, which is added if it is new.
    pub(super) fn group(&mut self, name: &str) -> usize {
        self.group_names.place(name)
    }

    /// Adds a surface element to some groups by its node numbers, the corners first; its cell may follow.
    pub(super) fn face(&mut self, row: Row, groups: &[usize], list: &[u64], corners: usize) -> Parsed<()> {
        self.element(row, list)?;
        groups.iter().try_for_each(|&group| self.cell_face(row, group, &list[..corners], false))
    }

    /// Adds a shell whose number is known to a group if it lies on the face of a cell.
    pub(super) fn shell(&mut self, row: Row, group: usize, corners: &[u64]) -> Parsed<()> {
        self.cell_face(row, group, corners, true)
    }

    /// Adds a face of a present or later cell to a group. A face that is `loose` may belong to no cell.
    pub(super) fn cell_face(&mut self, row: Row, group: usize, corners: &[u64], loose: bool) -> Parsed<()> {
        let corners = self.corners(row, corners)?;
        self.faces.push(Face { place: row.place, element: row.tag, corners, group, loose });
        Ok(())
    }

    /// Indices of nodes by number, sorted and padded with `u32::MAX`.
    fn corners(&self, row: Row, numbers: &[u64]) -> Parsed<[u32; 4]> {
        let mut sorted = [u32::MAX; 4];
        for (place, &number) in numbers.iter().enumerate() {
            let Some(node) = self.node_numbers.get(number) else {
                return Err((row.place, Problem::UnknownNode { element: row.tag, node: number }));
            };
            if numbers[..place].contains(&number) {
                return Err((row.place, Problem::RepeatedNode { element: row.tag, node: number }));
            }
            sorted[place] = node;
        }
        sorted.sort_unstable();
        Ok(sorted)
    }

    /// Adds the cell face with these local corners to a group; returns `false` if the cell has no such face.
    pub(super) fn facet(&mut self, group: usize, cell: u32, corners: &[usize]) -> bool {
        let kind = self.kinds[cell as usize];
        let is = |&face: &usize| {
            let own = kind.face_corners(face);
            own.len() == corners.len() && own.iter().all(|local| corners.contains(local))
        };
        let found = (0..kind.faces().len()).find(is);
        if let Some(face) = found {
            self.facets.push((group, Facet { cell, face: face as u8 }));
        }
        found.is_some()
    }

    /// Adds to a group those faces of some cells that belong to no other cell.
    pub(super) fn free_faces(&mut self, place: Place, group: usize, cells: Vec<u32>) {
        self.free.push(Free { place, group, cells });
    }

    /// Kind of a cell.
    pub(super) fn kind(&self, cell: u32) -> CellKind {
        self.kinds[cell as usize]
    }

    /// Whether an element with this number exists, as a cell or otherwise.
    pub(super) fn knows_element(&self, number: u64) -> bool {
        self.element_numbers.get(number).is_some()
    }

    /// Index of the node with this number in the file, `None` if there is none.
    pub(super) fn node_of(&self, number: u64) -> Option<u32> {
        self.node_numbers.get(number)
    }

    /// Adds a node set, which names the boundary faces that have all their corners in it, and its nodes if these
    /// faces do not have all of them.
    pub(super) fn node_set(&mut self, name: &str, nodes: Vec<u32>) {
        self.node_sets.push((name.into(), nodes));
    }

    /// Names of the regions.
    pub(super) fn regions(&self) -> impl Iterator<Item = &str> {
        self.region_names.list.iter().map(String::as_str)
    }

    /// Names of all facet groups so far: those of faces, and the node sets, which become facet groups.
    pub(super) fn surfaces(&self) -> impl Iterator<Item = &str> {
        let sets = self.node_sets.iter().map(|(name, _)| name.as_str());
        self.group_names.list.iter().map(String::as_str).chain(sets)
    }

    /// Appends another content with its points mapped by `moved` and its names by `named`. Returns the
    /// indices of its first node and its first cell. The node and element numbers of `other` are not taken
    /// over.
    pub(super) fn append(
        &mut self,
        place: Place,
        other: &Content,
        moved: impl Fn(&Point3) -> Point3,
        named: impl Fn(Named, &str) -> String,
    ) -> Parsed<(u32, u32)> {
        self.leaves_unused_out |= other.leaves_unused_out;
        let first_node =
            index(place, "nodes", self.points.len() + other.points.len())? - other.points.len() as u32;
        let first_cell =
            index(place, "elements", self.kinds.len() + other.kinds.len())? - other.kinds.len() as u32;
        self.points.extend(other.points.iter().map(moved));
        self.node_rows.extend_from_slice(&other.node_rows);
        self.kinds.extend_from_slice(&other.kinds);
        self.nodes.extend(other.nodes.iter().map(|node| node + first_node));
        self.rows.extend_from_slice(&other.rows);
        let region = |name| self.region(place, &named(Named::Region, name));
        let regions: Vec<u16> = other.regions().map(region).collect::<Parsed<_>>()?;
        let region = |region: &u16| regions.get(*region as usize).copied().unwrap_or(NO_REGION);
        self.regions.extend(other.regions.iter().map(region));
        self.also.extend(other.also.iter().map(|(cell, of)| (cell + first_cell, region(of))));
        let surface = |name: &String| named(Named::Surface, name);
        let groups: Vec<usize> =
            other.group_names.list.iter().map(|name| self.group(&surface(name))).collect();
        let facet = |f: &Facet| Facet { cell: f.cell + first_cell, ..*f };
        self.facets.extend(other.facets.iter().map(|(group, f)| (groups[*group], facet(f))));
        let corner = |c: u32| if c == u32::MAX { c } else { c + first_node };
        self.faces.extend(other.faces.iter().map(|face| Face {
            corners: face.corners.map(corner),
            group: groups[face.group],
            ..*face
        }));
        self.free.extend(other.free.iter().map(|free| Free {
            group: groups[free.group],
            cells: free.cells.iter().map(|cell| cell + first_cell).collect(),
            ..*free
        }));
        let sets = other.node_sets.iter();
        self.node_sets.extend(
            sets.map(|(name, nodes)| (surface(name), nodes.iter().map(|node| node + first_node).collect())),
        );
        Ok((first_node, first_cell))
    }

    /// Returns the mesh, with lengths multiplied by `unit`, and the row of each cell.
    ///
    /// # Errors
    /// A file without a valid mesh, or unused nodes unless `unused` drops them.
    pub(super) fn into_mesh(
        mut self,
        unit: f64,
        file: &Path,
        unused: Unused,
    ) -> Result<(Mesh, Rows), FileError> {
        let at = |(place, problem)| FileError::At { file: file.to_path_buf(), place, problem };
        self.put_middles_in_order();
        self.join_repeated();
        self.refuse_overlaps().map_err(at)?;
        self.attach().map_err(at)?;
        let wrong = |source| FileError::Mesh { file: file.to_path_buf(), source };
        let mut used = vec![u32::MAX; self.points.len()];
        self.nodes.iter().for_each(|&node| used[node as usize] = 0);
        if unused == Unused::Refused && !self.leaves_unused_out {
            self.refuse_unused(&used).map_err(at)?;
        }
        let (mut points, mut rows) = (Vec::new(), Vec::new());
        let all = used.iter_mut().zip(&self.points).zip(&self.node_rows);
        for ((slot, p), (row, _)) in all.filter(|((slot, _), _)| **slot == 0) {
            *slot = points.len() as u32;
            points.push(Point3::from(p.coords * unit));
            rows.push(*row);
        }
        let nodes = self.nodes.iter().map(|&n| used[n as usize]).collect();
        let further = self.further();
        let (regions, names) = without_empty(self.regions, self.region_names.list);
        let mut mesh =
            Mesh::from_flat(points, self.kinds, nodes).map_err(wrong)?.with_regions(regions, names);
        for (name, cells) in further {
            mesh = mesh.with_cell_group(&name, cells);
        }
        let mut groups: BTreeMap<String, Vec<Facet>> = BTreeMap::new();
        for (group, facet) in self.facets {
            groups.entry(self.group_names.list[group].clone()).or_default().push(facet);
        }
        for (name, nodes) in &self.node_sets {
            let nodes = within(&used, nodes);
            let facets = faces_of(&mesh, &nodes);
            mesh = with_further_nodes(mesh, name, nodes, &facets);
            // A set of a few nodes has no face and is not a surface.
            if !facets.is_empty() {
                groups.entry(name.clone()).or_default().extend(facets);
            }
        }
        for (name, nodes) in self.curves.iter().filter(|(name, _)| !groups.contains_key(*name)) {
            mesh = with_further_nodes(mesh, name, within(&used, nodes), &[]);
        }
        let boundary = if self.free.is_empty() { Vec::new() } else { mesh.boundary() };
        for Free { place, group, cells } in self.free {
            let name = &self.group_names.list[group];
            let facets = groups.entry(name.clone()).or_default();
            facets.extend(cells.iter().flat_map(|&cell| of_cell(&boundary, cell)));
            if facets.is_empty() {
                return Err(at((place, Problem::NoFreeFace { name: name.clone() })));
            }
        }
        for (name, mut facets) in groups {
            facets.sort_unstable();
            facets.dedup();
            mesh = mesh.with_group(&name, facets).map_err(wrong)?;
        }
        Ok((mesh, Rows { nodes: rows, cells: self.rows }))
    }

    /// Rejects unused nodes, which indicate that elements of the file have been lost.
    fn refuse_unused(&self, used: &[u32]) -> Parsed<()> {
        let mut named: Vec<bool> = self.node_rows.iter().map(|(_, touched)| *touched).collect();
        self.node_sets.iter().flat_map(|(_, nodes)| nodes).for_each(|&node| named[node as usize] = true);
        let unused = |node: &usize| used[*node] == u32::MAX && !named[*node];
        let mut all = (0..used.len()).filter(unused);
        let Some(first) = all.next() else { return Ok(()) };
        let Row { place, tag: number } = self.node_rows[first].0;
        Err((place, Problem::UnusedNode { number, others: all.count() }))
    }

    /// Rejects overlapping cells, whose volume would count twice.
    fn refuse_overlaps(&self) -> Parsed<()> {
        let cells = Cells { kinds: &self.kinds, nodes: &self.nodes, points: &self.points };
        if let Some([first, second]) = cells.twins().map(|pair| pair.map(|cell| self.rows[cell])) {
            let problem = Problem::SameNodes { element: second.tag, first: first.tag, place: first.place };
            return Err((second.place, problem));
        }
        match cells.same_side().map(|pair| pair.map(|cell| self.rows[cell])) {
            None => Ok(()),
            Some([first, second]) => {
                let problem = Problem::SameSide { element: second.tag, first: first.tag, place: first.place };
                Err((second.place, problem))
            }
        }
    }

    /// Finds the cell face of every surface element; of two cells, the face of the first.
    fn attach(&mut self) -> Parsed<()> {
        if self.faces.is_empty() {
            return Ok(());
        }
        // Most faces of a large mesh touch no surface: the flags skip the table look-up for these.
        let mut near = vec![false; self.points.len()];
        let mut owners: HashMap<[u32; 4], Option<Facet>> = HashMap::with_capacity(self.faces.len());
        for face in &self.faces {
            face.corners.iter().filter(|&&c| c != u32::MAX).for_each(|&c| near[c as usize] = true);
            owners.insert(face.corners, None);
        }
        let mut start = 0;
        for (cell, kind) in self.kinds.iter().enumerate() {
            for face in 0..kind.faces().len() {
                let (mut key, corners) = ([u32::MAX; 4], kind.face_corners(face));
                for (slot, &local) in key.iter_mut().zip(corners) {
                    *slot = self.nodes[start + local];
                }
                if !key[..corners.len()].iter().all(|&c| near[c as usize]) {
                    continue;
                }
                key.sort_unstable();
                if let Some(owner @ None) = owners.get_mut(&key) {
                    *owner = Some(Facet { cell: cell as u32, face: face as u8 });
                }
            }
            start += kind.node_count();
        }
        for Face { place, element, corners, group, loose } in &self.faces {
            match owners[corners] {
                Some(facet) => self.facets.push((*group, facet)),
                None if *loose => {}
                None => return Err((*place, Problem::LooseFace { element: *element })),
            }
        }
        Ok(())
    }
}

fn index(place: Place, what: &'static str, count: usize) -> Parsed<u32> {
    // The last value is reserved for "none".
    let index = u32::try_from(count).ok().filter(|&index| index != u32::MAX);
    index.ok_or((place, Problem::TooMany { what, count }))
}
