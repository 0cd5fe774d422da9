//! Stress (Pa) of the method itself at its quadrature points: from the law at the method's own dilation, with
//! the mean pressure of its projection.

use material::Material as _;
use material::split::dilation;
use shape::{Matrix3, Vector3};

use super::super::mean_pressure::{self, cauchy, dilated, mean};
use crate::measure::solved::Solved;

/// Cauchy stress (Pa) at every quadrature point, active stress included, from nodal parameters `u` (m) and, if there
/// is a pressure field, its parameters (Pa), at a time of [`Prepared::active`](crate::prepare::Prepared::active).
pub(crate) fn own_stress(run: &Solved, u: &[Vector3], parameters: &[f64], time: f64) -> Vec<Matrix3> {
    let (laws, volume) = (&run.setup.laws, &run.prepared.volume);
    let active = run.prepared.active(run.setup, time);
    let law = |q: usize| volume.law(laws, &active, q);
    let at = volume.rows.at();
    if volume.groups.is_none() && volume.pressure.is_none() {
        return (0..at.rows().len()).map(|q| cauchy(&law(q), &at.displacement_gradient(q, u))).collect();
    }
    let gradients = at.displacement_gradients(u);
    let mut stress: Vec<Matrix3> = match &volume.groups {
        None => gradients.iter().enumerate().map(|(q, h)| cauchy(&law(q), h)).collect(),
        Some(groups) => {
            let mut stress = vec![Matrix3::zeros(); gradients.len()];
            for a in 0..groups.len() {
                let (points, shares) = groups.group(a);
                let theta = mean(points, shares, volume.rows.weights(), &|q| {
                    dilation(law(q).is_small_strain(), &gradients[q])
                });
                for (&q, &share) in points.iter().zip(shares) {
                    let q = q as usize;
                    stress[q] += cauchy(&law(q), &dilated(&law(q), &gradients[q], theta)) * share;
                }
            }
            stress
        }
    };
    let pressure = mean_pressure::at_points((laws, &active), volume, &gradients, parameters);
    for (stress, pressure) in stress.iter_mut().zip(pressure) {
        *stress -= Matrix3::identity() * (stress.trace() / 3.0 + pressure);
    }
    stress
}
