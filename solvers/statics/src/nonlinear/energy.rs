#![allow(non_snake_case)] // F, H, J, P as in the formulas
//! Internal energy of a body, with its first and second derivatives.

use material::Material;
use material::split::{Split, add_dilation_hessian, cofactor, flat};
use rayon::prelude::*;
use shape::{Matrix3, Vector3};

use super::error::StaticError;
use super::groups::Pairs;
use super::lanes::{GroupHessian, PointTangent};
use super::shared::Shared;
use super::solid::{Kinematics, Solid, SolidDilation};

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

/// First derivatives and energy (J) of every point; see [`Internal`].
struct ByPoint {
    stress: Vec<Matrix3>,
    misfit: Vec<f64>,
    energy: Vec<f64>,
}

/// Second derivatives of the energy.
pub(crate) struct Hessian {
    /// Per point (9, 9), J: `w d2/dF2` including all terms local to the point.
    pub point: Vec<PointTangent>,
    /// Per group: the rows of `b n^T + n b^T`.
    pub groups: Vec<GroupHessian>,
    /// Per point with a pressure field: `w d2/(dF dp)` (3, 3), m^3, and `-w d2/dp2`, m^3/Pa.
    pub pressure: Vec<(Matrix3, f64)>,
}

impl Solid<'_> {
    /// Returns the strain energy at each quadrature point, J, at nodal parameters `u` (m) and pressures `p` (Pa);
    /// with a pressure field, the part of the saddle-point functional. That of hourglass control is contained.
    ///
    /// # Errors
    /// A point is inverted, or its dilation has no solution.
    pub fn energies(&self, u: &[Vector3], p: &[f64]) -> Result<Vec<f64>, StaticError> {
        let mut energies = self.by_point(self.pairs().as_ref(), p, &self.kinematics(u)?)?.energy;
        let moduli = |q: usize| [self.law(q).lambda(), self.law(q).mu()];
        for (energy, control) in energies.iter_mut().zip(self.volume.hourglass_energies(moduli, u)) {
            *energy += control;
        }
        Ok(energies)
    }

    /// Returns the internal forces on the nodes, N, at nodal parameters `u` (m), without a pressure field and
    /// hourglass control.
    ///
    /// # Errors
    /// A point is inverted.
    pub fn nodal_forces(&self, u: &[Vector3]) -> Result<Vec<Vector3>, StaticError> {
        let internal = self.internal(self.pairs().as_ref(), u, &[])?;
        let mut forces = vec![Vector3::zeros(); self.node_count()];
        for (q, stress) in internal.stress.iter().enumerate() {
            let (nodes, grads) = self.volume.row(q);
            nodes.iter().zip(grads).for_each(|(&node, grad)| forces[node as usize] += stress * grad);
        }
        Ok(forces)
    }

    /// Computes energy and stresses at nodal parameters `u` (m) and pressures `p` (Pa).
    pub(crate) fn internal(
        &self,
        pairs: Option<&Pairs>,
        u: &[Vector3],
        p: &[f64],
    ) -> Result<Internal, StaticError> {
        let kinematics = self.kinematics(u)?;
        let ByPoint { stress, misfit, energy } = self.by_point(pairs, p, &kinematics)?;
        Ok(Internal { stress, misfit, energy: energy.iter().sum(), smallest: kinematics.smallest })
    }

    /// Computes energy and stresses of every point.
    fn by_point(
        &self,
        pairs: Option<&Pairs>,
        p: &[f64],
        kinematics: &Kinematics,
    ) -> Result<ByPoint, StaticError> {
        let Kinematics { H, j_minus_1, .. } = kinematics;
        let weights = self.volume.weights();
        let points = 0..weights.len();
        let mut misfit = Vec::new();
        let (stress, energy): (Vec<Matrix3>, Vec<f64>) = match self.dilation {
            SolidDilation::Standard => points
                .into_par_iter()
                .with_min_len(128)
                .map(|q| {
                    let law = &self.law(q);
                    (law.stress(&H[q]) * weights[q], law.energy(&H[q]) * weights[q])
                })
                .unzip(),
            SolidDilation::Groups(groups) => {
                Shared::new(self, groups, pairs.expect("groups have pairs"), kinematics)?.stress()
            }
            SolidDilation::Mixed(rows) => {
                let p = self.pressures(rows, p);
                let each: Vec<(Matrix3, f64, f64)> = points
                    .into_par_iter()
                    .with_min_len(64)
                    .map(|q| {
                        let law = &self.law(q);
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
        Ok(ByPoint { stress, misfit, energy })
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
            SolidDilation::Standard => {
                let point = points.map(|q| self.law(q).tangent(&H[q]) * weights[q]);
                let point = point.map(|D| PointTangent::new(&D)).collect();
                (point, none.0, none.1)
            }
            SolidDilation::Groups(groups) => {
                let pairs = pairs.expect("groups have pairs");
                let (point, groups) = Shared::new(self, groups, pairs, &kinematics)?.hessian();
                (point, groups, none.1)
            }
            SolidDilation::Mixed(rows) => {
                let p = self.pressures(rows, p);
                let each: Vec<(PointTangent, (Matrix3, f64))> = points
                    .map(|q| {
                        let law = &self.law(q);
                        let theta = self.mixed_dilation(q, &H[q], j_minus_1[q], p[q])?;
                        let (_, second) = Split::new(law, &H[q], j_minus_1[q], theta).second(law);
                        let by_p = second.by_F_theta / second.by_theta_theta;
                        // theta follows F at constant p: this is the Schur complement of the local
                        // elimination.
                        let v = flat(&second.by_F_theta);
                        let mut D = second.by_FF - v * v.transpose() / second.by_theta_theta;
                        let small = law.is_small_strain();
                        add_dilation_hessian(small, &H[q], p[q], &mut D);
                        let cof = cofactor(small, &H[q]);
                        let D = PointTangent::new(&(D * weights[q]));
                        Ok((D, ((by_p + cof) * weights[q], weights[q] / second.by_theta_theta)))
                    })
                    .collect::<Result<_, StaticError>>()?;
                let (point, pressure) = each.into_iter().unzip();
                (point, none.0, pressure)
            }
        };
        Ok(Hessian { point, groups, pressure })
    }
}
