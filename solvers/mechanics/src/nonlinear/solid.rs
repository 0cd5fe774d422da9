#![allow(non_snake_case)] // F, H, J, P as in the formulas
//! Internal energy, stresses and their derivatives of a body at finite (or small) strain, for any law and any
//! projection of the volume change.

use rayon::prelude::*;
use shape::{DilationGroups, Rows, VolumeRows};

use super::split::{Split, add_dilation_hessian, cofactor, dilation, dilation_at_pressure};
use super::{Inverted, StaticError};
use crate::material::{Law, Material, Tangent};
use crate::{Matrix3, Vector3};

/// How a body carries its volume change.
#[derive(Clone, Copy, Debug)]
pub enum Dilation<'a> {
    /// As the displacement gives it, point by point.
    Standard,
    /// One dilation per group: `J_a = sum_q share w J_q / V_a`, energy `sum over (a, q) of share w W(F_bar)`. Element
    /// mean and nodal mean alike.
    Groups(&'a DilationGroups),
    /// A pressure field of its own, its shape values at the volume points (mixed u-p). The energy is
    /// `sum_q w (psi(F, theta) + p (J - theta))`, with theta eliminated at each point.
    Mixed(&'a Rows),
}

/// A quadrature with laws: what has internal forces.
#[derive(Clone, Copy, Debug)]
pub struct Solid<'a> {
    /// Values and gradients at the points, with weights.
    pub volume: &'a VolumeRows,
    /// Laws by region.
    pub laws: &'a [Law],
    /// Region of each point; empty when all are of region 0.
    pub region: &'a [u16],
    /// Projection of the volume change.
    pub dilation: Dilation<'a>,
}

/// First derivatives of the energy.
pub(crate) struct Internal {
    /// `w P` per point (3, 3), J: nodal forces are `sum_q (w P) grad N`.
    pub stress: Vec<Matrix3>,
    /// `w (J - theta)` per point, m^3, where a pressure field is there; the pressure's residual is `sum_q M (...)`.
    pub misfit: Vec<f64>,
    /// Strain energy, J (with a pressure field: of the saddle functional).
    pub energy: f64,
    /// The point with the smallest J, and J.
    pub smallest: (usize, f64),
}

/// Second derivatives of the energy.
pub(crate) struct Hessian {
    /// Per point (9, 9), J: `w d2/dF2` with everything local to the point.
    pub point: Vec<Tangent>,
    /// Per group: rows `b` and `m` and the scalar `k` of `k b b^T + b m^T + m b^T`.
    pub groups: Vec<GroupHessian>,
    /// Per point with a pressure field: `w d2/(dF dp)` (3, 3), m^3, and `-w d2/dp2`, m^3/Pa.
    pub pressure: Vec<(Matrix3, f64)>,
}

/// The share of one dilation group in the second derivatives; rows by ascending node.
pub(crate) struct GroupHessian {
    /// `dJ_a / du`, 1/m.
    pub b: Vec<Vector3>,
    /// `d2 psi / dF d theta` carried to the nodes, N.
    pub m: Vec<Vector3>,
    /// `d2 psi / d theta2` over the group, J.
    pub k: f64,
}

/// For each point its (group, place in the flat pair list, share): the transpose of the groups.
pub(crate) struct Pairs {
    offsets: Vec<usize>,
    /// (group, share), point by point.
    of_point: Vec<(u32, f64)>,
    /// For each entry of the groups' own list its place in `of_point`.
    place: Vec<usize>,
    group_offsets: Vec<usize>,
}

impl Pairs {
    pub fn new(groups: &DilationGroups) -> Pairs {
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
        Pairs { offsets, of_point, place, group_offsets }
    }

    pub fn of(&self, q: usize) -> &[(u32, f64)] {
        &self.of_point[self.offsets[q]..self.offsets[q + 1]]
    }

    /// Places in the pair list of a group's entries.
    fn places(&self, group: usize) -> &[usize] {
        &self.place[self.group_offsets[group]..self.group_offsets[group + 1]]
    }
}

/// Displacement gradient and `J - 1` of each point.
pub(super) struct Kinematics {
    pub H: Vec<Matrix3>,
    pub J1: Vec<f64>,
    smallest: (usize, f64),
}

impl Solid<'_> {
    /// The law at a point.
    pub(crate) fn law(&self, q: usize) -> &Law {
        &self.laws[self.region.get(q).copied().unwrap_or(0) as usize]
    }

    /// Number of nodes.
    pub(crate) fn node_count(&self) -> usize {
        self.volume.rows().node_count()
    }

    /// Number of pressure parameters.
    pub(crate) fn pressure_count(&self) -> usize {
        match self.dilation {
            Dilation::Mixed(rows) => rows.node_count(),
            _ => 0,
        }
    }

    pub(crate) fn pairs(&self) -> Option<Pairs> {
        match self.dilation {
            Dilation::Groups(groups) => Some(Pairs::new(groups)),
            _ => None,
        }
    }

    pub(super) fn kinematics(&self, u: &[Vector3]) -> Result<Kinematics, Inverted> {
        let (H, J1): (Vec<Matrix3>, Vec<f64>) = (0..self.volume.weights().len())
            .into_par_iter()
            .with_min_len(256)
            .map(|q| {
                let (nodes, grads) = self.volume.row(q);
                let mut H = Matrix3::zeros();
                for (&node, g) in nodes.iter().zip(grads) {
                    H += u[node as usize] * g.transpose();
                }
                let J1 = dilation(self.law(q).is_small_strain(), &H);
                (H, J1)
            })
            .unzip();
        let mut smallest = (0, f64::INFINITY);
        for (q, &J1) in J1.iter().enumerate() {
            let J = 1.0 + J1;
            // A small-strain law knows no inversion; a NaN must not pass either way.
            if !(J > 0.0) && !self.law(q).is_small_strain() || J.is_nan() {
                return Err(Inverted { point: q, det: J });
            }
            if J < smallest.1 {
                smallest = (q, J);
            }
        }
        Ok(Kinematics { H, J1, smallest })
    }

    /// `J_a - 1` of each group.
    pub(super) fn group_dilations(&self, groups: &DilationGroups, J1: &[f64]) -> Result<Vec<f64>, Inverted> {
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
                    sum += dv * J1[q as usize];
                }
                let mean = sum / volume;
                let q = points[0] as usize;
                // Shares of quadratic or meshless bases may be negative: a mean of positive J's need not be positive.
                if mean > -1.0 || self.law(q).is_small_strain() {
                    Ok(mean)
                } else {
                    Err(Inverted { point: q, det: 1.0 + mean })
                }
            })
            .collect()
    }

    fn group_volume(&self, groups: &DilationGroups, a: usize) -> f64 {
        let (points, shares) = groups.group(a);
        points.iter().zip(shares).map(|(&q, s)| s * self.volume.weights()[q as usize]).sum()
    }

    /// `sum_q share w value / V_a`, with one value per pair.
    fn group_mean(&self, groups: &DilationGroups, pairs: &Pairs, value: &[f64]) -> Vec<f64> {
        let weights = self.volume.weights();
        (0..groups.len())
            .into_par_iter()
            .with_min_len(32)
            .map(|a| {
                let (points, shares) = groups.group(a);
                let sum: f64 = (points.iter().zip(shares).zip(pairs.places(a)))
                    .map(|((&q, s), &at)| s * weights[q as usize] * value[at])
                    .sum();
                sum / self.group_volume(groups, a)
            })
            .collect()
    }

    /// `theta - 1` at a point of the mixed method.
    pub(super) fn mixed_dilation(&self, q: usize, H: &Matrix3, J1: f64, p: f64) -> Result<f64, StaticError> {
        let law = self.law(q);
        dilation_at_pressure(law, H, J1, p, J1)
            // Far from J the guess p = kappa (theta - 1) may be the better one.
            .or_else(|| {
                let guess = (p / (law.lambda() + 2.0 / 3.0 * law.mu())).max(-0.9);
                dilation_at_pressure(law, H, J1, p, guess)
            })
            .ok_or(StaticError::NoDilation { point: q, pressure: p })
    }

    /// Pressure of the mixed method at each point, Pa.
    pub(super) fn pressures(&self, rows: &Rows, p: &[f64]) -> Vec<f64> {
        (0..rows.len())
            .map(|q| {
                let (nodes, values) = rows.row(q);
                nodes.iter().zip(values).map(|(&m, v)| v * p[m as usize]).sum()
            })
            .collect()
    }

    /// Energy and stresses at nodal parameters `u` (and pressures `p`).
    pub(crate) fn internal(
        &self,
        pairs: Option<&Pairs>,
        u: &[Vector3],
        p: &[f64],
    ) -> Result<Internal, StaticError> {
        let Kinematics { H, J1, smallest } = self.kinematics(u)?;
        let weights = self.volume.weights();
        let points = 0..weights.len();
        let mut misfit = Vec::new();
        let (stress, energy): (Vec<Matrix3>, Vec<f64>) = match self.dilation {
            Dilation::Standard => points
                .into_par_iter()
                .with_min_len(128)
                .map(|q| {
                    let law = self.law(q);
                    (law.stress(&H[q]) * weights[q], law.energy(&H[q]) * weights[q])
                })
                .unzip(),
            Dilation::Groups(groups) => {
                let pairs = pairs.expect("groups have pairs");
                let theta = self.group_dilations(groups, &J1)?;
                let each: Vec<(Matrix3, f64, Vec<f64>)> = points
                    .into_par_iter()
                    .with_min_len(64)
                    .map(|q| {
                        let law = self.law(q);
                        let (mut P, mut energy) = (Matrix3::zeros(), 0.0);
                        let mut mean_stress = Vec::with_capacity(pairs.of(q).len());
                        for &(a, share) in pairs.of(q) {
                            let split = Split::new(law, &H[q], J1[q], theta[a as usize]);
                            let first = split.first(law);
                            P += first.by_F * share;
                            energy += split.energy(law) * share;
                            mean_stress.push(first.by_theta);
                        }
                        (P, energy * weights[q], mean_stress)
                    })
                    .collect();
                let by_pair: Vec<f64> = each.iter().flat_map(|e| e.2.iter().copied()).collect();
                let pressure = self.group_mean(groups, pairs, &by_pair);
                each.into_par_iter()
                    .enumerate()
                    .map(|(q, (P, energy, _))| {
                        let p: f64 = pairs.of(q).iter().map(|&(a, s)| s * pressure[a as usize]).sum();
                        let cof = cofactor(self.law(q).is_small_strain(), &H[q]);
                        ((P + cof * p) * weights[q], energy)
                    })
                    .unzip()
            }
            Dilation::Mixed(rows) => {
                let p = self.pressures(rows, p);
                let each: Vec<(Matrix3, f64, f64)> = points
                    .into_par_iter()
                    .with_min_len(64)
                    .map(|q| {
                        let law = self.law(q);
                        let theta = self.mixed_dilation(q, &H[q], J1[q], p[q])?;
                        let split = Split::new(law, &H[q], J1[q], theta);
                        let cof = cofactor(law.is_small_strain(), &H[q]);
                        let P = split.first(law).by_F + cof * p[q];
                        let gap = J1[q] - theta;
                        Ok((P * weights[q], (split.energy(law) + p[q] * gap) * weights[q], gap * weights[q]))
                    })
                    .collect::<Result<_, StaticError>>()?;
                misfit = each.iter().map(|e| e.2).collect();
                each.into_iter().map(|e| (e.0, e.1)).unzip()
            }
        };
        Ok(Internal { stress, misfit, energy: energy.iter().sum(), smallest })
    }

    /// Second derivatives at nodal parameters `u` (and pressures `p`).
    pub(crate) fn hessian(
        &self,
        pairs: Option<&Pairs>,
        u: &[Vector3],
        p: &[f64],
    ) -> Result<Hessian, StaticError> {
        let Kinematics { H, J1, .. } = self.kinematics(u)?;
        let weights = self.volume.weights();
        let points = (0..weights.len()).into_par_iter().with_min_len(64);
        let none = (Vec::new(), Vec::new());
        let (point, groups, pressure) = match self.dilation {
            Dilation::Standard => {
                let point = points.map(|q| self.law(q).tangent(&H[q]) * weights[q]).collect();
                (point, none.0, none.1)
            }
            Dilation::Groups(groups) => {
                let pairs = pairs.expect("groups have pairs");
                let theta = self.group_dilations(groups, &J1)?;
                type Each = (Tangent, Vec<(f64, f64, Matrix3)>);
                let each: Vec<Each> = points
                    .map(|q| {
                        let law = self.law(q);
                        let mut D = Tangent::zeros();
                        let mut of_pair = Vec::with_capacity(pairs.of(q).len());
                        for &(a, share) in pairs.of(q) {
                            let (first, second) =
                                Split::new(law, &H[q], J1[q], theta[a as usize]).second(law);
                            D += second.by_FF * share;
                            of_pair.push((first.by_theta, second.by_theta_theta, second.by_F_theta));
                        }
                        (D, of_pair)
                    })
                    .collect();
                let of_pair: Vec<(f64, f64, Matrix3)> =
                    each.iter().flat_map(|e| e.1.iter().copied()).collect();
                let by_theta: Vec<f64> = of_pair.iter().map(|o| o.0).collect();
                let pressure = self.group_mean(groups, pairs, &by_theta);
                let point = (each.into_par_iter().enumerate())
                    .map(|(q, (mut D, _))| {
                        let p: f64 = pairs.of(q).iter().map(|&(a, s)| s * pressure[a as usize]).sum();
                        add_dilation_hessian(self.law(q).is_small_strain(), &H[q], p, &mut D);
                        D * weights[q]
                    })
                    .collect();
                (point, self.group_hessians(groups, pairs, &H, &of_pair), none.1)
            }
            Dilation::Mixed(rows) => {
                let p = self.pressures(rows, p);
                let each: Vec<(Tangent, (Matrix3, f64))> = points
                    .map(|q| {
                        let law = self.law(q);
                        let theta = self.mixed_dilation(q, &H[q], J1[q], p[q])?;
                        let (_, second) = Split::new(law, &H[q], J1[q], theta).second(law);
                        let by_p = second.by_F_theta / second.by_theta_theta;
                        // theta follows F at constant p: the Schur complement of the local elimination.
                        let v = super::split::flat(&second.by_F_theta);
                        let mut D = second.by_FF - v * v.transpose() / second.by_theta_theta;
                        let small = law.is_small_strain();
                        add_dilation_hessian(small, &H[q], p[q], &mut D);
                        let cof = cofactor(small, &H[q]);
                        Ok((D * weights[q], ((by_p + cof) * weights[q], weights[q] / second.by_theta_theta)))
                    })
                    .collect::<Result<_, StaticError>>()?;
                let (point, pressure) = each.into_iter().unzip();
                (point, none.0, pressure)
            }
        };
        Ok(Hessian { point, groups, pressure })
    }

    fn group_hessians(
        &self,
        groups: &DilationGroups,
        pairs: &Pairs,
        H: &[Matrix3],
        of_pair: &[(f64, f64, Matrix3)],
    ) -> Vec<GroupHessian> {
        let weights = self.volume.weights();
        // The same for all groups of a point, which are as many as its neighbours where the bases are meshless.
        let cof: Vec<Vec<Vector3>> = (0..weights.len())
            .into_par_iter()
            .with_min_len(64)
            .map(|q| {
                let cof = cofactor(self.law(q).is_small_strain(), &H[q]);
                self.volume.row(q).1.iter().map(|g| cof * g).collect()
            })
            .collect();
        (0..groups.len())
            .into_par_iter()
            .map_init(
                || (vec![[Vector3::zeros(); 2]; self.node_count()], vec![false; self.node_count()]),
                |(scratch, seen), a| {
                    let (points, shares) = groups.group(a);
                    let volume = self.group_volume(groups, a);
                    let (mut nodes, mut k) = (Vec::new(), 0.0);
                    for ((&q, share), &at) in points.iter().zip(shares).zip(pairs.places(a)) {
                        let q = q as usize;
                        let dv = share * weights[q];
                        let (_, stiffness, mixed) = &of_pair[at];
                        k += dv * stiffness;
                        let mixed = mixed * dv;
                        let (row, grads) = self.volume.row(q);
                        for ((&node, g), cof) in row.iter().zip(grads).zip(&cof[q]) {
                            if !std::mem::replace(&mut seen[node as usize], true) {
                                nodes.push(node);
                            }
                            let [b, m] = &mut scratch[node as usize];
                            *b += cof * (dv / volume);
                            *m += mixed * g;
                        }
                    }
                    nodes.sort_unstable();
                    nodes.iter().for_each(|&n| seen[n as usize] = false);
                    let (b, m) = nodes
                        .iter()
                        .map(|&n| std::mem::replace(&mut scratch[n as usize], [Vector3::zeros(); 2]).into())
                        .unzip();
                    GroupHessian { b, m, k }
                },
            )
            .collect()
    }
}
