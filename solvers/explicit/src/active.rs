//! Active stress along the fibre, beside the laws of a body.

#![allow(non_snake_case)]

use material::AtPoint;
use shape::{Matrix3, Vector3};

use crate::body::ExplicitBody;
use crate::error::InvertedPoint;
use crate::plain;

/// Active stress along the fibre over time: the second Piola-Kirchhoff stress `T f x f` of each region.
///
/// Its stiffness `T f . g_I f . g_J` grows with `T`: the critical step is estimated with the largest `T`.
pub struct Contraction<'a> {
    /// Stress of each region (Pa) at a time (s).
    pub stress: &'a (dyn Fn(f64) -> Vec<f64> + Sync),
    /// Largest stress of each region over all times, Pa; not negative.
    pub largest: Vec<f64>,
}

impl ExplicitBody<'_> {
    /// The law at a point with an active stress (Pa, by region).
    fn contracting(&self, q: usize, active: &[f64]) -> AtPoint<'_> {
        self.law(q).contracting(active.get(self.region(q) as usize).copied().unwrap_or(0.0))
    }

    /// Adds `factor` times the nodal forces of an active stress (Pa, by region) at the displacements `u` (m) to
    /// `f` (N). The stress is that of the strains with shared dilations, if points share them.
    pub(super) fn add_active_forces(
        &self,
        active: &[f64],
        factor: f64,
        u: &[Vector3],
        f: &mut [Vector3],
    ) -> Result<(), InvertedPoint> {
        let stress = |q: usize, H: &Matrix3| self.contracting(q, active).active_stress(H);
        let mut forces = vec![Vector3::zeros(); f.len()];
        match self.groups {
            None => plain::forces(self.volume, stress, u, &mut forces),
            Some(groups) => plain::dilated_forces(self.volume, groups, stress, u, &mut forces),
        }?;
        f.iter_mut().zip(&forces).for_each(|(f, active)| *f += active * factor);
        Ok(())
    }

    /// Returns the energy `T/2 (|F f|^2 - 1)` (J) of an active stress (Pa, by region) at the displacements `u` (m).
    pub(super) fn active_energy(&self, active: &[f64], u: &[Vector3]) -> Result<f64, InvertedPoint> {
        let density = |q: usize, H: &Matrix3| self.contracting(q, active).active_energy(H);
        match self.groups {
            None => plain::energy(self.volume, density, u),
            Some(groups) => plain::dilated_energy(self.volume, groups, density, u),
        }
    }
}
