#![allow(non_snake_case)] // J as in the formulas
//! Volume changes shared by points: the points' shares in the groups, and means over groups.

use algebra::Connectivity;
use material::Material as _;
use rayon::prelude::*;
use shape::{DilationGroups, Rows};

use super::{Inverted, Solid};

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

impl Solid<'_> {
    /// Returns `J_a - 1` of each group.
    pub(super) fn group_dilations(
        &self,
        groups: &DilationGroups,
        j_minus_1: &[f64],
    ) -> Result<Vec<f64>, Inverted> {
        let weights = self.volume.weights();
        (0..groups.len())
            .into_par_iter()
            .with_min_len(32)
            .map(|a| {
                let (points, shares) = groups.group(a);
                let (mut volume, mut sum) = (0.0, 0.0);
                for (&q, share) in points.iter().zip(shares) {
                    let dv = share * weights[q as usize];
                    volume += dv;
                    sum += dv * j_minus_1[q as usize];
                }
                let mean = sum / volume;
                let q = points[0] as usize;
                // Shares of quadratic or meshless bases may be negative, so a mean of positive J's need not
                // be positive.
                if mean > -1.0 || self.law(q).is_small_strain() {
                    Ok(mean)
                } else {
                    Err(Inverted { point: q, det: 1.0 + mean })
                }
            })
            .collect()
    }

    pub(super) fn group_volume(&self, groups: &DilationGroups, a: usize) -> f64 {
        let (points, shares) = groups.group(a);
        points.iter().zip(shares).map(|(&q, s)| s * self.volume.weights()[q as usize]).sum()
    }

    /// Returns the group means `sum_q share w value / V_a`; `value` takes the point and the place in the pair
    /// list.
    pub(super) fn group_mean(
        &self,
        groups: &DilationGroups,
        pairs: &Pairs,
        value: impl Fn(usize, usize) -> f64 + Sync + Send,
    ) -> Vec<f64> {
        let weights = self.volume.weights();
        (0..groups.len())
            .into_par_iter()
            .with_min_len(32)
            .map(|a| {
                let (points, shares) = groups.group(a);
                let sum: f64 = (points.iter().zip(shares).zip(pairs.places(a)))
                    .map(|((&q, s), &at)| s * weights[q as usize] * value(q as usize, at))
                    .sum();
                sum / self.group_volume(groups, a)
            })
            .collect()
    }
}
