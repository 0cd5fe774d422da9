//! Volume changes shared by points: the points' shares in the groups.

use algebra::Connectivity;
use shape::{DilationGroups, Rows};

/// Transpose of the groups: for each point its (group, share) pairs, in one flat list.
pub(crate) struct Pairs {
    offsets: Vec<usize>,
    /// Pairs (group, share), point by point.
    of_point: Vec<(u32, f64)>,
    /// Place in `of_point` of every entry of the groups' own list.
    place: Vec<usize>,
    group_offsets: Vec<usize>,
    /// Nodes of the points of each group, ascending.
    nodes: Vec<u32>,
    node_offsets: Vec<usize>,
}

impl Pairs {
    pub fn new(groups: &DilationGroups, rows: &Rows) -> Pairs {
        let points = groups.point_count();
        let mut offsets = vec![0usize; points + 1];
        let mut group_offsets = vec![0];
        for a in 0..groups.len() {
            groups.group(a).0.iter().for_each(|&q| offsets[q as usize + 1] += 1);
            group_offsets.push(group_offsets[a] + groups.group(a).0.len());
        }
        for q in 0..points {
            offsets[q + 1] += offsets[q];
        }
        let mut next = offsets.clone();
        let mut of_point = vec![(0, 0.0); offsets[points]];
        let mut place = Vec::with_capacity(of_point.len());
        for a in 0..groups.len() {
            let (members, shares) = groups.group(a);
            for (&q, &share) in members.iter().zip(shares) {
                let at = &mut next[q as usize];
                of_point[*at] = (a as u32, share);
                place.push(*at);
                *at += 1;
            }
        }
        let (mut nodes, mut node_offsets) = (Vec::new(), vec![0]);
        let mut mark = vec![u32::MAX; rows.node_count()];
        for a in 0..groups.len() {
            let start = nodes.len();
            for &q in groups.group(a).0 {
                for &node in rows.row(q as usize).0 {
                    if std::mem::replace(&mut mark[node as usize], a as u32) != a as u32 {
                        nodes.push(node);
                    }
                }
            }
            nodes[start..].sort_unstable();
            node_offsets.push(nodes.len());
        }
        Pairs { offsets, of_point, place, group_offsets, nodes, node_offsets }
    }

    pub fn of(&self, q: usize) -> &[(u32, f64)] {
        &self.of_point[self.offsets[q]..self.offsets[q + 1]]
    }

    /// Returns the indices of a group's entries in the flat list of (group, share) pairs, in the order of the
    /// group's points.
    pub fn places(&self, group: usize) -> &[usize] {
        &self.place[self.group_offsets[group]..self.group_offsets[group + 1]]
    }

    /// Returns the nodes of a group's points, ascending.
    pub fn nodes(&self, group: usize) -> &[u32] {
        &self.nodes[self.node_offsets[group]..self.node_offsets[group + 1]]
    }

    /// Returns the nodes of all groups, one row per group.
    pub fn connectivity(&self) -> Connectivity<'_> {
        Connectivity { offsets: &self.node_offsets, nodes: &self.nodes, seen_by: &[] }
    }
}
