#![allow(non_snake_case)] // F, H, J, P as in the formulas
//! A body at finite (or small) strain, for any law and any projection of the volume change.

use material::split::dilation;
use material::{AtPoint, Law, Material};
use rayon::prelude::*;
use shape::{DilationGroups, Matrix3, Rows, Vector3, VolumeRows};

use super::curves::Timing;
use super::error::{Inverted, StaticError};
use super::groups::Pairs;
use super::split::dilation_at_pressure;

/// Treatment of the volume change.
#[derive(Clone, Copy, Debug)]
pub enum SolidDilation<'a> {
    /// Dilation of the displacement, point by point.
    Standard,
    /// One dilation per group: `J_a = sum_q share w J_q / V_a`, energy `sum over (a, q) of share w W(F_bar)`.
    /// Element means and nodal means both have this form.
    Groups(&'a DilationGroups),
    /// A separate pressure field, given by its shape values at the volume points (mixed u-p). The energy is
    /// `sum_q w (psi(F, theta) + p (J - theta))`, with theta eliminated at each point.
    Mixed(&'a Rows),
}

/// Active stress along the fibre by region.
#[derive(Clone, Copy, Debug, Default)]
pub struct Active<'a> {
    /// Full stress, Pa; empty if no region contracts.
    pub full: &'a [f64],
    /// Curves by region and the time at which they are read; `None` for the full stress.
    pub(crate) at: Option<(&'a Timing<'a>, f64)>,
}

impl<'a> Active<'a> {
    /// Uses the stresses `full`, Pa, by region.
    pub fn new(full: &'a [f64]) -> Active<'a> {
        Active { full, at: None }
    }

    fn of(&self, region: usize) -> Option<f64> {
        let full = self.full.get(region)?;
        Some(self.at.map_or(*full, |(timing, time)| full * timing.of(region).value(time)))
    }
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
    /// Axes of the material at each point, as columns: fibre, sheet and normal directions. Empty if no law
    /// depends on directions and nothing contracts.
    pub axes: &'a [Matrix3],
    /// Active stress along the fibre.
    pub active: Active<'a>,
    /// Projection of the volume change.
    pub dilation: SolidDilation<'a>,
}

/// Displacement gradient and `J - 1` of each point.
pub(super) struct Kinematics {
    pub H: Vec<Matrix3>,
    pub j_minus_1: Vec<f64>,
    pub smallest: (usize, f64),
}

impl Solid<'_> {
    /// Returns the law at a point.
    pub(crate) fn law(&self, q: usize) -> AtPoint<'_> {
        let region = self.region.get(q).copied().unwrap_or(0) as usize;
        let law = AtPoint::new(&self.laws[region], self.axes.get(q));
        match self.active.of(region) {
            Some(active) => law.contracting(active),
            None => law,
        }
    }

    /// Number of nodes.
    pub(crate) fn node_count(&self) -> usize {
        self.volume.rows().node_count()
    }

    /// Number of pressure parameters.
    pub(crate) fn pressure_count(&self) -> usize {
        match self.dilation {
            SolidDilation::Mixed(rows) => rows.node_count(),
            _ => 0,
        }
    }

    pub(crate) fn pairs(&self) -> Option<Pairs> {
        match self.dilation {
            SolidDilation::Groups(groups) => Some(Pairs::new(groups, self.volume.rows())),
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
        let law = &self.law(q);
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
}
