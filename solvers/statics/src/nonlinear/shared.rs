#![allow(non_snake_case)] // F, H, J, P as in the formulas
//! Stresses and tangents of points that share their volume change: the energy is
//! `sum over (a, q) of share w psi(F_q, J_a)`.
//!
//! Terms are computed by point if the law is separable into shape and volume ([`Separated`]), otherwise by
//! every pair of group and point.

use lanes::LanePath;
use material::split::{Split, add_dilation_hessian, cofactor};
use material::{Material, Separated, Tangent};
use rayon::prelude::*;
use shape::{DilationGroups, Matrix3, Vector3};

use super::error::Inverted;
use super::groups::Pairs;
use super::lanes::{GroupHessian, GroupRow, Lanes, PointTangent, add_row};
use super::solid::{Kinematics, Solid};

/// Groups per task.
const GROUPS: usize = 8;
/// Number of points that the groups of a task traverse together: for a cloud with 35 neighbours per group,
/// 140 KB of rows.
const POINTS: usize = 64;

/// A solid at a displacement, with the dilations that its points share.
pub(super) struct Shared<'a> {
    solid: &'a Solid<'a>,
    groups: &'a DilationGroups,
    pairs: &'a Pairs,
    kinematics: &'a Kinematics,
    /// `J_a - 1` of each group.
    theta: Vec<f64>,
    /// Separated volume terms of each group, if the body has a single, separable law.
    parts: Option<Vec<Separated>>,
}

/// Terms of a point's second derivatives that its groups need.
struct PairSecond {
    by_theta: f64,
    by_theta_theta: f64,
    by_F_theta: Matrix3,
}

impl<'a> Shared<'a> {
    pub fn new(
        solid: &'a Solid<'a>,
        groups: &'a DilationGroups,
        pairs: &'a Pairs,
        kinematics: &'a Kinematics,
    ) -> Result<Shared<'a>, Inverted> {
        let theta = solid.group_dilations(groups, &kinematics.j_minus_1)?;
        let parts = match solid.laws {
            // The law at a point has the active stress, with which it is not separable.
            [_] => theta.iter().map(|&theta| solid.law(0).separated(theta)).collect(),
            _ => None,
        };
        Ok(Shared { solid, groups, pairs, kinematics, theta, parts })
    }

    /// Selects the loop over pairs, against which the loop over points is tested.
    #[cfg(test)]
    pub fn plain(mut self) -> Shared<'a> {
        self.parts = None;
        self
    }

    /// Returns `w P` and the energy of every point, J.
    pub fn stress(&self) -> (Vec<Matrix3>, Vec<f64>) {
        match &self.parts {
            Some(parts) => self.stress_by_point(parts),
            None => self.stress_by_pair(),
        }
    }

    /// Returns `w d2/dF2` of every point, J, and the contribution of every group.
    pub fn hessian(&self) -> (Vec<PointTangent>, Vec<GroupHessian>) {
        match &self.parts {
            Some(parts) => self.hessian_by_point(parts),
            None => self.hessian_by_pair(),
        }
    }

    /// Returns the split of `F_q` for the dilation `theta`.
    fn split(&self, q: usize, theta_minus_1: f64) -> Split {
        Split::new(&self.solid.law(q), &self.kinematics.H[q], self.kinematics.j_minus_1[q], theta_minus_1)
    }

    fn cofactor(&self, q: usize) -> Matrix3 {
        cofactor(self.solid.law(q).is_small_strain(), &self.kinematics.H[q])
    }

    /// Returns `sum_a share value_a` of a point.
    fn at_point(&self, q: usize, of_group: impl Fn(usize) -> f64) -> f64 {
        self.pairs.of(q).iter().map(|&(a, share)| share * of_group(a as usize)).sum()
    }

    /// Returns `value` of every point.
    fn points<T: Send>(&self, value: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
        (0..self.kinematics.H.len()).into_par_iter().with_min_len(64).map(value).collect()
    }

    fn stress_by_point(&self, parts: &[Separated]) -> (Vec<Matrix3>, Vec<f64>) {
        let weights = self.solid.volume.weights();
        let shape: Vec<(Matrix3, f64)> = self.points(|q| {
            let law = &self.solid.law(q);
            let split = self.split(q, 0.0);
            (split.first(law).by_F, split.energy(law))
        });
        let energy = self.solid.group_mean(self.groups, self.pairs, |q, _| shape[q].1);
        let pressure: Vec<f64> = (parts.iter().zip(&energy)).map(|(v, e)| v.A[1] * e + v.U[1]).collect();
        self.points(|q| {
            let (P, energy) = &shape[q];
            let scale = self.at_point(q, |a| parts[a].A[0]);
            let stress = P * scale + self.cofactor(q) * self.at_point(q, |a| pressure[a]);
            (stress * weights[q], (energy * scale + self.at_point(q, |a| parts[a].U[0])) * weights[q])
        })
        .into_iter()
        .unzip()
    }

    fn stress_by_pair(&self) -> (Vec<Matrix3>, Vec<f64>) {
        let weights = self.solid.volume.weights();
        let each: Vec<(Matrix3, f64, Vec<f64>)> = self.points(|q| {
            let law = &self.solid.law(q);
            let (mut P, mut energy) = (Matrix3::zeros(), 0.0);
            let mut mean_stress = Vec::with_capacity(self.pairs.of(q).len());
            for &(a, share) in self.pairs.of(q) {
                let split = self.split(q, self.theta[a as usize]);
                let first = split.first(law);
                P += first.by_F * share;
                energy += split.energy(law) * share;
                mean_stress.push(first.by_theta);
            }
            (P, energy, mean_stress)
        });
        let by_pair: Vec<f64> = each.iter().flat_map(|e| e.2.iter().copied()).collect();
        let pressure = self.solid.group_mean(self.groups, self.pairs, |_, at| by_pair[at]);
        self.points(|q| {
            let (P, energy, _) = &each[q];
            let stress = P + self.cofactor(q) * self.at_point(q, |a| pressure[a]);
            (stress * weights[q], energy * weights[q])
        })
        .into_iter()
        .unzip()
    }

    fn hessian_by_point(&self, parts: &[Separated]) -> (Vec<PointTangent>, Vec<GroupHessian>) {
        let (shape, point): (Vec<(f64, Matrix3)>, Vec<PointTangent>) = (0..self.kinematics.H.len())
            .into_par_iter()
            .with_min_len(64)
            .map(|q| {
                let law = &self.solid.law(q);
                let split = self.split(q, 0.0);
                let (first, second) = split.second(law);
                let scale = self.at_point(q, |a| parts[a].A[0]);
                ((split.energy(law), first.by_F), PointTangent::new(&(second.by_FF * scale)))
            })
            .unzip();
        let energy = self.solid.group_mean(self.groups, self.pairs, |q, _| shape[q].0);
        let pressure: Vec<f64> = (parts.iter().zip(&energy)).map(|(v, e)| v.A[1] * e + v.U[1]).collect();
        let point = self.point_tangents(&pressure, point);
        // These rows are the same for all groups of a point. A meshless point has as many groups as
        // neighbours; a point of an element may have one, which needs no table.
        let rows = self.solid.volume.rows();
        let single = (0..shape.len()).all(|q| self.pairs.of(q).len() == 1);
        let tiles = if single { 0 } else { shape.len().div_ceil(POINTS) };
        let mixed: Vec<Vec<Lanes>> = (0..tiles)
            .into_par_iter()
            .map(|tile| {
                let points = tile * POINTS..((tile + 1) * POINTS).min(shape.len());
                points.flat_map(|q| self.mixed_rows(q, shape[q].1)).collect()
            })
            .collect();
        let of_point = |q: usize| {
            let tile = q / POINTS;
            let range = rows.range(q);
            let first = rows.offsets()[tile * POINTS];
            &mixed[tile][range.start - first..range.end - first]
        };
        let path = LanePath::best();
        let groups = self.group_hessians(
            |a| {
                let volume = self.solid.group_volume(self.groups, a);
                (volume * (parts[a].A[2] * energy[a] + parts[a].U[2]), parts[a].A[1])
            },
            |q, _, share, slot, sums| {
                let own: Vec<Lanes>;
                let row = if single {
                    own = self.mixed_rows(q, shape[q].1).collect();
                    &own
                } else {
                    of_point(q)
                };
                add_row(path, rows.row(q).0, row, share, slot, sums);
            },
        );
        (point, groups)
    }

    fn hessian_by_pair(&self) -> (Vec<PointTangent>, Vec<GroupHessian>) {
        let weights = self.solid.volume.weights();
        let (point, each): (Vec<PointTangent>, Vec<Vec<PairSecond>>) = self
            .points(|q| {
                let law = &self.solid.law(q);
                let mut D = Tangent::zeros();
                let mut of_pair = Vec::with_capacity(self.pairs.of(q).len());
                for &(a, share) in self.pairs.of(q) {
                    let (first, second) = self.split(q, self.theta[a as usize]).second(law);
                    D += second.by_FF * share;
                    let by_theta = first.by_theta;
                    let (by_theta_theta, by_F_theta) = (second.by_theta_theta, second.by_F_theta);
                    of_pair.push(PairSecond { by_theta, by_theta_theta, by_F_theta });
                }
                (PointTangent::new(&D), of_pair)
            })
            .into_iter()
            .unzip();
        let of_pair: Vec<&PairSecond> = each.iter().flatten().collect();
        let pressure = self.solid.group_mean(self.groups, self.pairs, |_, at| of_pair[at].by_theta);
        let point = self.point_tangents(&pressure, point);
        let stiffness = |a: usize| {
            let (points, shares) = self.groups.group(a);
            let k = (points.iter().zip(shares).zip(self.pairs.places(a)))
                .map(|((&q, s), &at)| s * weights[q as usize] * of_pair[at].by_theta_theta)
                .sum();
            (k, 1.0)
        };
        let rows = self.solid.volume.rows();
        let path = LanePath::best();
        let groups = self.group_hessians(stiffness, |q, at, share, slot, sums| {
            let mixed: Vec<Lanes> = self.mixed_rows(q, of_pair[at].by_F_theta).collect();
            add_row(path, rows.row(q).0, &mixed, share, slot, sums);
        });
        (point, groups)
    }

    /// Returns `w D` including the second derivative of J.
    fn point_tangents(&self, pressure: &[f64], mut point: Vec<PointTangent>) -> Vec<PointTangent> {
        point.par_iter_mut().with_min_len(64).enumerate().for_each(|(q, point)| {
            let mut D = point.matrix();
            let p = self.at_point(q, |a| pressure[a]);
            add_dilation_hessian(self.solid.law(q).is_small_strain(), &self.kinematics.H[q], p, &mut D);
            D *= self.solid.volume.weights()[q];
            *point = PointTangent::new(&D);
        });
        point
    }

    /// Returns the contributions of a point's neighbours to `b` and, with `by_F_theta`, to `m`.
    fn mixed_rows(&self, q: usize, by_F_theta: Matrix3) -> impl Iterator<Item = Lanes> + '_ {
        let cofactor = self.cofactor(q);
        let weight = self.solid.volume.weights()[q];
        let of_node = move |g: &Vector3| Lanes::pair(&(cofactor * g * weight), &(by_F_theta * g * weight));
        self.solid.volume.row(q).1.iter().map(of_node)
    }

    /// Computes the Hessians of all groups. `stiffness` gives k of a group and a factor of its m. `add` adds
    /// a point's contributions to b and m to the sums of the group, at the slot of each node; its arguments
    /// are the point, the place in the pair list and the share.
    fn group_hessians(
        &self,
        stiffness: impl Fn(usize) -> (f64, f64) + Sync + Send,
        add: impl Fn(usize, usize, f64, &[u32], &mut [Lanes]) + Sync + Send,
    ) -> Vec<GroupHessian> {
        let scratch = || vec![(vec![0; self.solid.node_count()], Vec::new()); GROUPS];
        let count = self.groups.len();
        let tasks: Vec<Vec<GroupHessian>> = (0..count.div_ceil(GROUPS))
            .into_par_iter()
            .map_init(scratch, |scratch, task| {
                let groups = task * GROUPS..((task + 1) * GROUPS).min(count);
                for (a, (slot, sums)) in groups.clone().zip(&mut *scratch) {
                    let nodes = self.pairs.nodes(a);
                    nodes.iter().enumerate().for_each(|(at, &node)| slot[node as usize] = at as u32);
                    sums.clear();
                    sums.resize(nodes.len(), Lanes::ZERO);
                }
                // All groups process a tile of points before the next tile, so the rows of the tile stay in
                // the cache.
                let mut done = [0; GROUPS];
                let next = |done: &[usize]| {
                    groups
                        .clone()
                        .zip(done)
                        .filter_map(|(a, &k)| self.groups.group(a).0.get(k))
                        .min()
                        .copied()
                };
                while let Some(first) = next(&done) {
                    let end = first + POINTS as u32;
                    for ((a, k), (slot, sums)) in groups.clone().zip(&mut done).zip(&mut *scratch) {
                        let (points, shares) = self.groups.group(a);
                        let places = self.pairs.places(a);
                        while *k < points.len() && points[*k] < end {
                            add(points[*k] as usize, places[*k], shares[*k], slot, sums);
                            *k += 1;
                        }
                    }
                }
                let row = |a: usize, sums: &[Lanes]| {
                    let volume = self.solid.group_volume(self.groups, a);
                    let (k, factor) = stiffness(a);
                    let of_node = |sum: &Lanes| {
                        let (b, m) = sum.of_pair();
                        let b = b / volume;
                        GroupRow::new(&b, &(m * factor + b * (0.5 * k)))
                    };
                    GroupHessian { bulk: k, rows: sums.iter().map(of_node).collect() }
                };
                groups.zip(&*scratch).map(|(a, (_, sums))| row(a, sums)).collect()
            })
            .collect();
        tasks.into_iter().flatten().collect()
    }
}
