//! Stress (Pa) as the method itself has it: of the law at its own dilation, with the mean pressure of its projection.

use material::Law;
use shape::Matrix3;

use super::mean_pressure::{self, cauchy, dilated, dilation, mean};
use crate::prepare::Prepared;

/// Cauchy stresses of a method at its displacement.
pub(super) struct OwnStress<'a> {
    laws: &'a [Law],
    prepared: &'a Prepared,
    /// Displacement gradients at the quadrature points.
    gradients: &'a [Matrix3],
    /// Mean pressure at the quadrature points, Pa; none without a projection.
    pressure: Option<Vec<f64>>,
}

impl<'a> OwnStress<'a> {
    /// Of displacement gradients at the quadrature points and the parameters (Pa) of a pressure field, where there is one.
    pub(super) fn new(
        laws: &'a [Law],
        prepared: &'a Prepared,
        gradients: &'a [Matrix3],
        parameters: &[f64],
    ) -> OwnStress<'a> {
        let volume = &prepared.volume;
        let projected = volume.groups.is_some() || volume.pressure.is_some();
        let pressure = projected.then(|| mean_pressure::at_points(laws, volume, gradients, parameters));
        OwnStress { laws, prepared, gradients, pressure }
    }

    /// The law of quadrature point `q`.
    pub(super) fn law(&self, q: usize) -> &'a Law {
        &self.laws[self.prepared.volume.region.get(q).map_or(0, |&r| usize::from(r))]
    }

    /// At a displacement gradient, with the law and the dilation of quadrature point `q`.
    pub(super) fn at(&self, q: usize, h: &Matrix3) -> Matrix3 {
        let Some(pressure) = &self.pressure else { return cauchy(self.law(q), h) };
        let shape = match &self.prepared.volume.groups {
            None => cauchy(self.law(q), h),
            Some(groups) => (0..groups.len())
                .filter_map(|a| {
                    let (points, shares) = groups.group(a);
                    let own = points.iter().position(|&p| p as usize == q)?;
                    Some(self.with_dilation(q, h, self.dilation(points, shares)) * shares[own])
                })
                .sum(),
        };
        with_pressure(shape, pressure[q])
    }

    /// At every quadrature point.
    pub(super) fn everywhere(&self) -> Vec<Matrix3> {
        let plain = || self.gradients.iter().enumerate().map(|(q, h)| cauchy(self.law(q), h));
        let Some(pressure) = &self.pressure else { return plain().collect() };
        let shapes = match &self.prepared.volume.groups {
            None => plain().collect(),
            Some(groups) => {
                let mut shapes = vec![Matrix3::zeros(); self.gradients.len()];
                for a in 0..groups.len() {
                    let (points, shares) = groups.group(a);
                    let theta = self.dilation(points, shares);
                    for (&q, &share) in points.iter().zip(shares) {
                        let q = q as usize;
                        shapes[q] += self.with_dilation(q, &self.gradients[q], theta) * share;
                    }
                }
                shapes
            }
        };
        shapes.into_iter().zip(pressure).map(|(shape, &p)| with_pressure(shape, p)).collect()
    }

    fn with_dilation(&self, q: usize, h: &Matrix3, theta: f64) -> Matrix3 {
        let law = self.law(q);
        cauchy(law, &dilated(law, h, theta))
    }

    /// Mean of `J - 1` over a group.
    fn dilation(&self, points: &[u32], shares: &[f64]) -> f64 {
        let weights = self.prepared.volume.rows.weights();
        mean(points, shares, weights, &|q| dilation(self.law(q), &self.gradients[q]))
    }
}

/// The deviator of `stress` with a mean pressure, positive in compression.
fn with_pressure(stress: Matrix3, pressure: f64) -> Matrix3 {
    stress - Matrix3::identity() * (stress.trace() / 3.0 + pressure)
}
