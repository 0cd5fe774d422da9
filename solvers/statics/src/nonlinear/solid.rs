#![allow(non_snake_case)] // F, H, J, P as in the formulas
//! Internal energy, stresses and their derivatives of a body at finite (or small) strain, for any law and any
//! projection of the volume change.

use material::{Law, Material, Tangent};
use rayon::prelude::*;
use shape::{DilationGroups, Rows, VolumeRows};
use shape::{Matrix3, Vector3};

use super::groups::Pairs;
use super::shared::{GroupHessian, Shared};
use super::split::{Split, add_dilation_hessian, cofactor, dilation, dilation_at_pressure};
use super::{Inverted, StaticError};

/// Treatment of the volume change.
#[derive(Clone, Copy, Debug)]
pub enum Dilation<'a> {
    /// Dilation of the displacement, point by point.
    Standard,
    /// One dilation per group: `J_a = sum_q share w J_q / V_a`, energy `sum over (a, q) of share w W(F_bar)`.
    /// Element means and nodal means both have this form.
    Groups(&'a DilationGroups),
    /// A separate pressure field, given by its shape values at the volume points (mixed u-p). The energy is
    /// `sum_q w (psi(F, theta) + p (J - theta))`, with theta eliminated at each point.
    Mixed(&'a Rows),
}

/// A quadrature with laws, from which internal forces follow.
#[derive(Clone, Copy, Debug)]
pub struct Solid<'a> {
    /// Values and gradients at the points, with weights.
    pub volume: &'a VolumeRows,
    /// Laws by region.
    pub laws: &'a [Law],
    /// Region of each point; empty if all points are in region 0.
    pub region: &'a [u16],
    /// Projection of the volume change.
    pub dilation: Dilation<'a>,
}

/// First derivatives of the energy.
pub(crate) struct Internal {
    /// `w P` per point (3, 3), J; nodal forces are `sum_q (w P) grad N`.
    pub stress: Vec<Matrix3>,
    /// `w (J - theta)` per point, m^3, if there is a pressure field. The residual of a pressure parameter is
    /// the sum of this misfit over the points, times the parameter's shape function.
    pub misfit: Vec<f64>,
    /// Strain energy, J; with a pressure field, the value of the saddle-point functional.
    pub energy: f64,
    /// Index of the quadrature point with the smallest `J`, and this `J`.
    pub smallest: (usize, f64),
}

/// Second derivatives of the energy.
pub(crate) struct Hessian {
    /// Per point (9, 9), J: `w d2/dF2` including all terms local to the point.
    pub point: Vec<Tangent>,
    /// Per group: the rows of `b n^T + n b^T`.
    pub groups: Vec<GroupHessian>,
    /// Per point with a pressure field: `w d2/(dF dp)` (3, 3), m^3, and `-w d2/dp2`, m^3/Pa.
    pub pressure: Vec<(Matrix3, f64)>,
}

/// Displacement gradient and `J - 1` of each point.
pub(super) struct Kinematics {
    pub H: Vec<Matrix3>,
    pub j_minus_1: Vec<f64>,
    smallest: (usize, f64),
}

impl Solid<'_> {
    /// Returns the law at a point.
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
            Dilation::Groups(groups) => Some(Pairs::new(groups, self.volume.rows())),
            _ => None,
        }
    }

    pub(super) fn kinematics(&self, u: &[Vector3]) -> Result<Kinematics, Inverted> {
        let (H, j_minus_1): (Vec<Matrix3>, Vec<f64>) = (0..self.volume.weights().len())
            .into_par_iter()
            .with_min_len(256)
            .map(|q| {
                let (nodes, grads) = self.volume.row(q);
                let mut H = Matrix3::zeros();
                for (&node, g) in nodes.iter().zip(grads) {
                    H += u[node as usize] * g.transpose();
                }
                let j_minus_1 = dilation(self.law(q).is_small_strain(), &H);
                (H, j_minus_1)
            })
            .unzip();
        let mut smallest = (0, f64::INFINITY);
        for (q, &j_minus_1) in j_minus_1.iter().enumerate() {
            let J = 1.0 + j_minus_1;
            // A small-strain law has no inversion. NaN is refused in both cases.
            if !(J > 0.0) && !self.law(q).is_small_strain() || J.is_nan() {
                return Err(Inverted { point: q, det: J });
            }
            if J < smallest.1 {
                smallest = (q, J);
            }
        }
        Ok(Kinematics { H, j_minus_1, smallest })
    }

    /// Returns `theta - 1` at a point of the mixed method.
    pub(super) fn mixed_dilation(
        &self,
        q: usize,
        H: &Matrix3,
        j_minus_1: f64,
        p: f64,
    ) -> Result<f64, StaticError> {
        let law = self.law(q);
        dilation_at_pressure(law, H, j_minus_1, p, j_minus_1)
            // Far from J the guess p = kappa (theta - 1) may be better.
            .or_else(|| {
                let guess = (p / (law.lambda() + 2.0 / 3.0 * law.mu())).max(-0.9);
                dilation_at_pressure(law, H, j_minus_1, p, guess)
            })
            .ok_or(StaticError::NoDilation { point: q, pressure: p })
    }

    /// Returns the pressure of the mixed method at each point, Pa.
    pub(super) fn pressures(&self, rows: &Rows, p: &[f64]) -> Vec<f64> {
        (0..rows.len())
            .map(|q| {
                let (nodes, values) = rows.row(q);
                nodes.iter().zip(values).map(|(&m, v)| v * p[m as usize]).sum()
            })
            .collect()
    }

    /// Computes energy and stresses at nodal parameters `u` (m) and pressures `p` (Pa).
    pub(crate) fn internal(
        &self,
        pairs: Option<&Pairs>,
        u: &[Vector3],
        p: &[f64],
    ) -> Result<Internal, StaticError> {
        let kinematics = self.kinematics(u)?;
        let Kinematics { H, j_minus_1, smallest } = &kinematics;
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
                Shared::new(self, groups, pairs.expect("groups have pairs"), &kinematics)?.stress()
            }
            Dilation::Mixed(rows) => {
                let p = self.pressures(rows, p);
                let each: Vec<(Matrix3, f64, f64)> = points
                    .into_par_iter()
                    .with_min_len(64)
                    .map(|q| {
                        let law = self.law(q);
                        let theta = self.mixed_dilation(q, &H[q], j_minus_1[q], p[q])?;
                        let split = Split::new(law, &H[q], j_minus_1[q], theta);
                        let cof = cofactor(law.is_small_strain(), &H[q]);
                        let P = split.first(law).by_F + cof * p[q];
                        let gap = j_minus_1[q] - theta;
                        Ok((P * weights[q], (split.energy(law) + p[q] * gap) * weights[q], gap * weights[q]))
                    })
                    .collect::<Result<_, StaticError>>()?;
                misfit = each.iter().map(|e| e.2).collect();
                each.into_iter().map(|e| (e.0, e.1)).unzip()
            }
        };
        Ok(Internal { stress, misfit, energy: energy.iter().sum(), smallest: *smallest })
    }

    /// Computes second derivatives at nodal parameters `u` (m) and pressures `p` (Pa).
    pub(crate) fn hessian(
        &self,
        pairs: Option<&Pairs>,
        u: &[Vector3],
        p: &[f64],
    ) -> Result<Hessian, StaticError> {
        let kinematics = self.kinematics(u)?;
        let Kinematics { H, j_minus_1, .. } = &kinematics;
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
                let (point, groups) = Shared::new(self, groups, pairs, &kinematics)?.hessian();
                (point, groups, none.1)
            }
            Dilation::Mixed(rows) => {
                let p = self.pressures(rows, p);
                let each: Vec<(Tangent, (Matrix3, f64))> = points
                    .map(|q| {
                        let law = self.law(q);
                        let theta = self.mixed_dilation(q, &H[q], j_minus_1[q], p[q])?;
                        let (_, second) = Split::new(law, &H[q], j_minus_1[q], theta).second(law);
                        let by_p = second.by_F_theta / second.by_theta_theta;
                        // theta follows F at constant p: this is the Schur complement of the local
                        // elimination.
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
}
