//! The projected dilation at quadrature points: `theta_q = sum_a share_aq b_a . u`.

use material::LinearElastic;
use rayon::prelude::*;
use shape::{DilationGroups, Vector3};

use crate::body::LinearBody;
use crate::error::SolveError;

/// Rows of the projected dilation at selected points.
pub(crate) struct Projected {
    /// For every point of the body's quadrature: pairs (node, 1/m) in ascending order; empty at points that
    /// are not selected.
    rows: Vec<Vec<(u32, Vector3)>>,
}

impl Projected {
    /// Computes the rows at the given points (in any order); `None` without a projection.
    pub fn new(body: &LinearBody, points: impl Iterator<Item = u32>) -> Option<Projected> {
        let groups = body.dilation?;
        let mut wanted = vec![false; groups.point_count()];
        points.for_each(|p| wanted[p as usize] = true);
        let mut lists: Vec<Vec<(u32, Vector3)>> = vec![Vec::new(); groups.point_count()];
        let mut scratch = vec![Vector3::zeros(); body.nodes.len()];
        for a in 0..groups.len() {
            let (members, shares) = groups.group(a);
            if !members.iter().any(|&p| wanted[p as usize]) {
                continue;
            }
            let (_, row) = groups.averaged_gradient(a, body.volume, &mut scratch);
            for (&p, &share) in members.iter().zip(shares).filter(|(p, _)| wanted[**p as usize]) {
                lists[p as usize].extend(row.iter().map(|&(node, b)| (node, b * share)));
            }
        }
        // Many groups share nodes. Summing repeated nodes shortens a row to a tenth.
        for list in &mut lists {
            list.sort_by_key(|e| e.0);
            list.dedup_by(|next, kept| {
                let same = next.0 == kept.0;
                if same {
                    kept.1 += next.1;
                }
                same
            });
            list.shrink_to_fit();
        }
        Some(Projected { rows: lists })
    }

    /// Returns the nodes of a point with the gradient of its dilation with respect to their displacements.
    pub fn row(&self, point: usize) -> &[(u32, Vector3)] {
        &self.rows[point]
    }
}

/// Volume (m^3) and averaged gradient row (1/m) of a group.
pub(crate) type Averaged = (f64, Vec<(u32, Vector3)>);

/// Returns volume and averaged gradient of every group, or an error for a group without volume.
pub(crate) fn averaged(body: &LinearBody, groups: &DilationGroups) -> Result<Vec<Averaged>, SolveError> {
    let scratch = || vec![Vector3::zeros(); body.nodes.len()];
    let averaged: Vec<Averaged> = (0..groups.len())
        .into_par_iter()
        .map_init(scratch, |scratch, a| groups.averaged_gradient(a, body.volume, scratch))
        .collect();
    // `!(V > 0)` also rejects NaN.
    match averaged.iter().enumerate().find(|(_, of)| !(of.0 > 0.0)) {
        Some((group, &(volume, _))) => Err(SolveError::GroupVolume { group, volume }),
        None => Ok(averaged),
    }
}

/// Returns the bulk modulus of a dilation group, Pa: the volume average over its points.
pub(crate) fn group_bulk(body: &LinearBody, group: usize) -> f64 {
    group_mean(body, group, LinearElastic::bulk)
}

/// Returns the volume average of a modulus over the points of a dilation group, Pa.
pub(crate) fn group_mean(body: &LinearBody, group: usize, modulus: impl Fn(&LinearElastic) -> f64) -> f64 {
    let (points, shares) = body.dilation.expect("a body with groups").group(group);
    let (mut volume, mut sum) = (0.0, 0.0);
    for (&q, share) in points.iter().zip(shares) {
        let dv = share * body.volume.weights()[q as usize];
        volume += dv;
        sum += dv * modulus(body.material(q as usize));
    }
    sum / volume
}
