//! Dilation groups: sets of quadrature points that share a volume change. The remedy for volumetric locking
//! is a second, small table, filled in the same way by finite elements (one group per element or per node)
//! and by meshless clouds.

use crate::Vector3;
use crate::rows::ShapeError;
use crate::tables::VolumeRows;

/// Number of nodes among which [`DilationGroups::near`] divides a point: in three dimensions the nodes of the
/// surrounding tetrahedron.
const NEAREST: usize = 4;

/// Ratio of a group's volume to the volume with absolute shares below which [`DilationGroups::by_part`] omits
/// a part of a divided group.
const POSITIVE: f64 = 0.5;

/// Groups of pairs (point, share): group `a` averages the dilation of its points with the weights
/// `share * w_q`, `V_a = sum_q share_aq w_q`. The shares of a point over all groups sum to one, so no volume
/// is lost or counted twice.
#[derive(Clone, Debug, PartialEq)]
pub struct DilationGroups {
    offsets: Vec<usize>,
    points: Vec<u32>,
    shares: Vec<f64>,
    point_count: usize,
    /// Part of each point, for groups that do not cross parts; empty if there is a single part.
    parts: Vec<u16>,
}

impl DilationGroups {
    /// Checks the arrays and builds groups over `point_count` quadrature points: `offsets` (groups + 1),
    /// `points` and `shares` (one per entry).
    ///
    /// # Errors
    /// Arrays of unequal length, broken offsets, an empty group, a point out of range, or a point whose
    /// shares do not sum to one.
    pub fn new(
        point_count: usize,
        offsets: Vec<usize>,
        points: Vec<u32>,
        shares: Vec<f64>,
    ) -> Result<DilationGroups, ShapeError> {
        let entries = points.len();
        if shares.len() != entries {
            return Err(ShapeError::Length { what: "shares", found: shares.len(), expected: entries });
        }
        if offsets.first() != Some(&0) || offsets.last() != Some(&entries) {
            return Err(ShapeError::BrokenOffsets { row: 0, offset: *offsets.last().unwrap_or(&0), entries });
        }
        let mut total = vec![0.0; point_count];
        for (row, pair) in offsets.windows(2).enumerate() {
            if pair[1] <= pair[0] {
                return Err(ShapeError::BrokenOffsets { row, offset: pair[1], entries });
            }
            for k in pair[0]..pair[1] {
                let point = points[k] as usize;
                if point >= point_count {
                    return Err(ShapeError::NodeOutOfRange { row, node: point, nodes: point_count });
                }
                total[point] += shares[k];
            }
        }
        // The negation also rejects NaN.
        #[allow(clippy::neg_cmp_op_on_partial_ord)]
        let lost = total.iter().position(|t| !((t - 1.0).abs() < 1e-12));
        match lost {
            Some(row) => Err(ShapeError::NotUnity { row, sum: total[row], tolerance: 1e-12 }),
            None => Ok(DilationGroups { offsets, points, shares, point_count, parts: Vec::new() }),
        }
    }

    /// Builds one group for each cell from the numbers of points per cell; points are in the order of cells.
    pub fn of_cells(points: impl IntoIterator<Item = usize>) -> Result<DilationGroups, ShapeError> {
        let mut offsets = vec![0];
        let mut count = 0;
        for of_cell in points {
            count += of_cell;
            offsets.push(count);
        }
        DilationGroups::new(count, offsets, (0..count as u32).collect(), vec![1.0; count])
    }

    /// Number of groups.
    pub fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Whether there are no groups.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of quadrature points divided among the groups.
    pub fn point_count(&self) -> usize {
        self.point_count
    }

    /// Part of each quadrature point, such as its material, as given to [`DilationGroups::by_part`]; empty if
    /// there is a single part.
    pub fn parts(&self) -> &[u16] {
        &self.parts
    }

    /// Returns the points and shares of a group.
    pub fn group(&self, group: usize) -> (&[u32], &[f64]) {
        let range = self.offsets[group]..self.offsets[group + 1];
        (&self.points[range.clone()], &self.shares[range])
    }

    /// Builds one group per node, with each point divided by its shape values, `share_aq = N_a(x_q)` (nodal
    /// averaging; Ortiz-Bernardin et al. 2015, volume-averaged nodal projection). Groups are ordered by node.
    /// A node that is in no row has no group, so the index of a group is not always that of its node.
    ///
    /// # Errors
    /// A point whose values do not sum to one.
    pub fn nodal(volume: &VolumeRows) -> Result<DilationGroups, ShapeError> {
        DilationGroups::of_nodes(volume, |values, shares| shares.extend(values.iter().map(|&v| Some(v))))
    }

    /// Builds groups as [`DilationGroups::nodal`] does, but divides each point only among the four nodes with
    /// the largest shape values, in proportion to these values. A node without a share in any point has no
    /// group. A nodal group couples all nodes of its points, which in a cloud may be up to four support radii
    /// apart. With this method a group couples only the nodes of the points around its node.
    ///
    /// # Errors
    /// A point whose four largest values sum to zero.
    pub fn near(volume: &VolumeRows) -> Result<DilationGroups, ShapeError> {
        let mut order = Vec::new();
        DilationGroups::of_nodes(volume, |values, shares| {
            order.clear();
            order.extend(0..values.len());
            // Equal values in the order of their nodes.
            order.sort_by(|&a, &b| values[b].total_cmp(&values[a]));
            order.truncate(NEAREST);
            let sum: f64 = order.iter().map(|&k| values[k]).sum();
            // A node with zero value at all of its points would have a group without volume.
            let share = |k: usize| (order.contains(&k) && values[k] != 0.0).then(|| values[k] / sum);
            shares.extend((0..values.len()).map(share));
        })
    }

    /// Builds one group per node. `share` appends the shares of a point, given its values; `None` marks a
    /// node without a share.
    fn of_nodes(
        volume: &VolumeRows,
        mut share: impl FnMut(&[f64], &mut Vec<Option<f64>>),
    ) -> Result<DilationGroups, ShapeError> {
        let rows = volume.rows();
        let mut all = Vec::with_capacity(rows.nodes().len());
        for q in 0..rows.len() {
            share(rows.row(q).1, &mut all);
        }
        let mut next = vec![0; rows.node_count()];
        for (&node, share) in rows.nodes().iter().zip(&all) {
            next[node as usize] += usize::from(share.is_some());
        }
        let mut offsets = vec![0];
        for next in &mut next {
            let first = offsets[offsets.len() - 1];
            let count = *next;
            // A node without a share in any point has no group.
            if count > 0 {
                offsets.push(first + count);
            }
            *next = first;
        }
        let entries = offsets[offsets.len() - 1];
        let (mut points, mut shares) = (vec![0; entries], vec![0.0; entries]);
        for q in 0..rows.len() {
            for k in rows.range(q) {
                let Some(share) = all[k] else { continue };
                let at = &mut next[rows.nodes()[k] as usize];
                (points[*at], shares[*at]) = (q as u32, share);
                *at += 1;
            }
        }
        DilationGroups::new(rows.len(), offsets, points, shares)
    }

    /// Divides every group into one group for each part among its points. A mean across the border of two
    /// materials would mix dilations that jump there. `parts` has one entry per point; `weights` (m^3) are
    /// those of the quadrature.
    ///
    /// The shares of a cloud can be negative. A piece of a divided group with almost no volume is omitted,
    /// and its points are divided among their other groups.
    ///
    /// # Errors
    /// A list whose length is not the number of points, or a point of which every piece is omitted.
    pub fn by_part(&self, parts: &[u16], weights: &[f64]) -> Result<DilationGroups, ShapeError> {
        for (what, found) in [("parts of points", parts.len()), ("weights", weights.len())] {
            if found != self.point_count {
                return Err(ShapeError::Length { what, found, expected: self.point_count });
            }
        }
        let (mut offsets, mut points, mut shares) = (vec![0], Vec::new(), Vec::new());
        let mut kept = vec![1.0; self.point_count];
        for a in 0..self.len() {
            let (of_group, by) = self.group(a);
            let mut entries: Vec<(u32, f64)> = of_group.iter().copied().zip(by.iter().copied()).collect();
            let part = |entry: &(u32, f64)| parts[entry.0 as usize];
            entries.sort_by_key(part);
            for piece in entries.chunk_by(|x, y| part(x) == part(y)) {
                let volume = |size: fn(f64) -> f64| -> f64 {
                    piece.iter().map(|&(q, share)| size(share) * weights[q as usize]).sum()
                };
                if piece.len() < entries.len() && volume(|share| share) <= POSITIVE * volume(f64::abs) {
                    piece.iter().for_each(|&(q, share)| kept[q as usize] -= share);
                    continue;
                }
                points.extend(piece.iter().map(|entry| entry.0));
                shares.extend(piece.iter().map(|entry| entry.1));
                offsets.push(points.len());
            }
        }
        shares.iter_mut().zip(&points).for_each(|(share, &q)| *share /= kept[q as usize]);
        let groups = DilationGroups::new(self.point_count, offsets, points, shares)?;
        Ok(DilationGroups { parts: parts.to_vec(), ..groups })
    }

    /// Returns the volume `V_a` (m^3) and averaged gradient row `b_a = sum_q share w_q grad N / V_a` (1/m) of
    /// a group, by ascending node. `scratch` has one vector per node and is zero on entry and on return.
    pub fn averaged_gradient(
        &self,
        group: usize,
        volume: &VolumeRows,
        scratch: &mut [Vector3],
    ) -> (f64, Vec<(u32, Vector3)>) {
        let (points, shares) = self.group(group);
        let mut touched = Vec::new();
        let mut measure = 0.0;
        for (&q, &share) in points.iter().zip(shares) {
            let dv = share * volume.weights()[q as usize];
            measure += dv;
            let (nodes, grads) = volume.row(q as usize);
            for (&node, g) in nodes.iter().zip(grads) {
                let sum = &mut scratch[node as usize];
                // A node may be appended again if its sum is zero by chance.
                if *sum == Vector3::zeros() {
                    touched.push(node);
                }
                *sum += dv * g;
            }
        }
        touched.sort_unstable();
        touched.dedup();
        let row = touched
            .iter()
            .map(|&node| (node, std::mem::replace(&mut scratch[node as usize], Vector3::zeros()) / measure))
            .collect();
        (measure, row)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{GradRows, Point3, Rows, Unity};

    /// Three points over six nodes; the third has two nodes, of which one has a zero value.
    fn volume() -> VolumeRows {
        let values = vec![0.3, 0.05, 0.2, 0.2, -0.05, 0.3, 0.5, 0.25, 0.125, 0.0625, 0.0625, 0.0, 1.0, 0.0];
        let nodes = (0..6).chain(0..6).chain([0, 4]).collect();
        let rows = Rows::new(6, vec![0, 6, 12, 14], nodes, values, Unity::Within(1e-12)).unwrap();
        let grads = GradRows::new(vec![Point3::origin(); 3], rows, vec![Vector3::zeros(); 14]).unwrap();
        VolumeRows::new(grads, vec![2.0, 1.0, 1.0]).unwrap()
    }

    #[test]
    fn the_four_largest_values_share_a_point_in_their_proportion() {
        let groups = DilationGroups::near(&volume()).unwrap();
        let of = |point: u32| {
            let share = |a: usize| {
                let (points, shares) = groups.group(a);
                points.iter().position(|&p| p == point).map(|k| shares[k])
            };
            (0..groups.len()).map(share).collect::<Vec<_>>()
        };
        // Node 4 has a share in no point, hence no group: among equal values the first node is selected.
        assert_eq!(groups.len(), 5);
        let close = |found: &[Option<f64>], wanted: [f64; 5]| {
            found.iter().zip(wanted).all(|(f, w)| (f.unwrap_or(0.0) - w).abs() < 1e-15)
        };
        assert!(close(&of(0), [0.3, 0.0, 0.2, 0.2, 0.3]), "{:?}", of(0));
        let sum = 0.9375;
        assert!(close(&of(1), [0.5 / sum, 0.25 / sum, 0.125 / sum, 0.0625 / sum, 0.0]), "{:?}", of(1));
    }

    #[test]
    fn a_group_does_not_cross_the_border_of_two_parts() {
        let volume = volume();
        let whole = DilationGroups::nodal(&volume).unwrap();
        let cut = whole.by_part(&[0, 1, 0], volume.weights()).unwrap();
        let part = |q: &u32| [0, 1, 0][*q as usize];
        assert!((0..cut.len()).all(|a| cut.group(a).0.iter().all(|q| part(q) == part(&cut.group(a).0[0]))));
        let sum = |groups: &DilationGroups, point: u32| -> f64 {
            let entries = |a: usize| groups.group(a).0.iter().zip(groups.group(a).1);
            (0..groups.len()).flat_map(entries).filter(|(q, _)| **q == point).map(|(_, share)| share).sum()
        };
        assert!((0..3).all(|q| (sum(&cut, q) - 1.0).abs() < 1e-15));
        // Node 4 has the share -0.05 in the first point. Such a piece has no volume, and the other groups
        // take over its point.
        assert_eq!((0..cut.len()).filter(|&a| cut.group(a).1.iter().any(|share| *share < 0.0)).count(), 0);
        // Points with a single part keep their groups.
        let uncut = whole.by_part(&[1; 3], volume.weights()).unwrap();
        assert!((0..whole.len()).all(|a| whole.group(a) == uncut.group(a)) && uncut.len() == whole.len());
        assert!(whole.by_part(&[0, 1], volume.weights()).is_err());
    }

    #[test]
    fn cells_of_several_kinds_have_groups_of_their_own_points() {
        let groups = DilationGroups::of_cells([4, 1, 8]).unwrap();
        assert_eq!((groups.len(), groups.point_count()), (3, 13));
        let points: Vec<Vec<u32>> = (0..3).map(|cell| groups.group(cell).0.to_vec()).collect();
        assert_eq!(points, [(0..4).collect(), vec![4], (5..13).collect::<Vec<u32>>()]);
        assert!((0..3).all(|cell| groups.group(cell).1.iter().all(|&share| share == 1.0)));
    }
}
