//! Dilation groups: which quadrature points share one volume change. The cure of volumetric locking is a second,
//! small table, filled alike by finite elements (one group per element, or per node) and by meshless clouds.

use crate::{ShapeError, Vector3, VolumeRows};

/// Groups of (point, share): group `a` averages the dilation of its points with the weights
/// `share * w_q`, `V_a = sum_q share_aq w_q`. Shares of one point over all groups sum to one, so that no volume is
/// lost or counted twice.
#[derive(Clone, Debug, PartialEq)]
pub struct DilationGroups {
    offsets: Vec<usize>,
    points: Vec<u32>,
    shares: Vec<f64>,
    point_count: usize,
}

impl DilationGroups {
    /// Checks and wraps: `offsets` (groups + 1), `points` and `shares` (one per entry).
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
        // As a negation: a NaN must not pass.
        #[allow(clippy::neg_cmp_op_on_partial_ord)]
        let lost = total.iter().position(|t| !((t - 1.0).abs() < 1e-12));
        match lost {
            Some(row) => Err(ShapeError::NotUnity { row, sum: total[row], tolerance: 1e-12 }),
            None => Ok(DilationGroups { offsets, points, shares, point_count }),
        }
    }

    /// Number of groups.
    pub fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    /// True without groups.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of quadrature points the groups divide up.
    pub fn point_count(&self) -> usize {
        self.point_count
    }

    /// Points and shares of one group.
    pub fn group(&self, group: usize) -> (&[u32], &[f64]) {
        let range = self.offsets[group]..self.offsets[group + 1];
        (&self.points[range.clone()], &self.shares[range])
    }

    /// One group per node, each point shared out by its own shape values (nodal averaging; Ortiz-Bernardin et
    /// al. 2015, volume-averaged nodal projection): `share_aq = N_a(x_q)`. A point whose values do not sum to one
    /// is refused.
    pub fn nodal(volume: &VolumeRows) -> Result<DilationGroups, ShapeError> {
        let rows = volume.rows();
        let mut next = vec![0; rows.node_count()];
        rows.nodes().iter().for_each(|&node| next[node as usize] += 1);
        let mut offsets = vec![0];
        for next in &mut next {
            let (first, count) = (offsets[offsets.len() - 1], *next);
            // A node that no point sees has no group.
            if count > 0 {
                offsets.push(first + count);
            }
            *next = first;
        }
        let (mut points, mut shares) = (vec![0; rows.nodes().len()], vec![0.0; rows.nodes().len()]);
        for q in 0..rows.len() {
            let (nodes, values) = rows.row(q);
            for (&node, &value) in nodes.iter().zip(values) {
                let at = &mut next[node as usize];
                (points[*at], shares[*at]) = (q as u32, value);
                *at += 1;
            }
        }
        DilationGroups::new(rows.len(), offsets, points, shares)
    }

    /// Volume `V_a` (m^3) and averaged gradient row `b_a = sum_q share w_q grad N / V_a` (1/m) of one group, by
    /// ascending node. `scratch` holds one vector per node and is zero on entry and on return.
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
                // Again where a sum is zero by chance.
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
