//! Cells in several groups, groups of nodes, and the parts of a file that are not in the mesh.

use std::collections::{BTreeMap, HashMap, HashSet};

use super::Content;
use crate::error::{Parsed, Place, Problem};
use crate::left_out::{Kind, LeftOut};
use crate::middles;
use crate::overlap::Cells;
use crate::rows::Row;

impl Content {
    /// Allows a cell to be listed once for each of its regions.
    pub(crate) fn repeat_cells(&mut self) {
        self.repeats = true;
    }

    /// Adds a cell to an additional region.
    pub(crate) fn also_in(&mut self, cell: u32, region: u16) {
        self.also.push((cell, region));
    }

    /// Adds cells to an additional region of this name.
    pub(crate) fn also(&mut self, place: Place, name: &str, cells: &[u32]) -> Parsed<()> {
        if !cells.is_empty() {
            let region = self.region(place, name)?;
            self.also.extend(cells.iter().map(|&cell| (cell, region)));
        }
        Ok(())
    }

    /// Adds the nodes of a point or a line to a named group of nodes.
    pub(crate) fn curve(&mut self, row: Row, name: &str, list: &[u64]) -> Parsed<()> {
        for &number in list {
            let Some(node) = self.node_of(number) else {
                return Err((row.place, Problem::UnknownNode { element: row.tag, node: number }));
            };
            self.curves.entry(name.into()).or_default().push(node);
        }
        Ok(())
    }

    /// Records parts of the file that are not in the mesh.
    pub(crate) fn leave_out(&mut self, parts: impl IntoIterator<Item = LeftOut>) {
        self.left_out.extend(parts);
    }

    /// Parts of the file that are not in the mesh.
    /// Numbers of the nodes that cells use, in their order in the file: the nodes of the mesh.
    pub(crate) fn used_nodes(&self) -> Vec<u64> {
        let mut used = vec![false; self.points.len()];
        self.nodes.iter().for_each(|&node| used[node as usize] = true);
        let rows = self.node_rows.iter().zip(used);
        rows.filter(|(_, used)| *used).map(|((row, _), _)| row.tag).collect()
    }

    pub(crate) fn into_left_out(mut self) -> Vec<LeftOut> {
        self.put_middles_in_order();
        self.left_out
    }

    /// Reorders mid-edge nodes that the file lists in another order than its format.
    pub(super) fn put_middles_in_order(&mut self) {
        let orders = middles::put_in_order(&self.kinds, &mut self.nodes, &self.points);
        self.left_out.extend(orders.into_iter().map(|(kind, cells)| LeftOut {
            place: Place::Cell(0),
            what: format!(
                "the mid-edge nodes of {cells} {} are not in the order of the format; each node was assigned to the edge that it halves",
                kind.name()
            ),
            kind: Kind::Changed,
        }));
    }

    /// Groups of cells across the regions. A group whose cells all have it as their region is omitted.
    pub(super) fn further(&self) -> BTreeMap<String, Vec<u32>> {
        let mut cells: BTreeMap<u16, Vec<u32>> = BTreeMap::new();
        for &(cell, region) in &self.also {
            cells.entry(region).or_default().push(cell);
        }
        cells.retain(|region, cells| cells.iter().any(|&cell| self.regions[cell as usize] != *region));
        cells
            .into_iter()
            .map(|(region, cells)| (self.region_names.list[region as usize].clone(), cells))
            .collect()
    }

    /// Merges cells that are listed once for each of their regions; the first cell is in all these regions.
    pub(super) fn join_repeated(&mut self) {
        let cells = Cells { kinds: &self.kinds, nodes: &self.nodes, points: &self.points };
        if !self.repeats || cells.twins().is_none() {
            return;
        }
        let (kinds, nodes) = (std::mem::take(&mut self.kinds), std::mem::take(&mut self.nodes));
        let (regions, rows) = (std::mem::take(&mut self.regions), std::mem::take(&mut self.rows));
        let (mut first, mut known) = (HashMap::new(), HashSet::new());
        let mut start = 0;
        for (cell, kind) in kinds.into_iter().enumerate() {
            let list = &nodes[start..start + kind.node_count()];
            start += list.len();
            let next = self.kinds.len() as u32;
            let of = *first.entry(list).or_insert(next);
            // A cell listed twice in one region is an error of the file, which is found later.
            if known.insert((of, regions[cell])) && of != next {
                self.also.push((of, regions[cell]));
                continue;
            }
            self.kinds.push(kind);
            self.nodes.extend_from_slice(list);
            self.regions.push(regions[cell]);
            self.rows.push(rows[cell]);
        }
    }
}
