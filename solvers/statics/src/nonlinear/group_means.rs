//! Means over groups of points that share their volume change.

use material::Material as _;
use rayon::prelude::*;
use shape::DilationGroups;

use super::error::Inverted;
use super::groups::Pairs;
use super::solid::Solid;

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
