//! Quantities recovered from nodal parameters: stress, mean pressure and strain energy.

use material::LinearElastic;
use shape::{GradRows, Matrix3, Vector3};

use crate::body::{LinearBody, check_len, check_regions, region_of};
use crate::dilation::group_bulk;
use crate::error::SolveError;

/// Computes the stress (3, 3), Pa, at any points by the plain law, `sigma = lambda tr(eps) I + 2 mu eps`,
/// from nodal parameters `u` (m). `region` has one entry per point, or none if all points are in region 0.
pub fn stress(
    at: &GradRows,
    u: &[Vector3],
    materials: &[LinearElastic],
    region: &[u16],
) -> Result<Vec<Matrix3>, SolveError> {
    check_len("nodal parameters", u.len(), at.rows().node_count())?;
    check_regions(region, at.points().len(), materials)?;
    let gradients = at.displacement_gradients(u);
    Ok(gradients.iter().enumerate().map(|(q, h)| materials[region_of(region, q)].stress(h)).collect())
}

/// Computes the stress (3, 3), Pa, at the body's own quadrature points. With a volumetric projection the mean
/// stress follows from the projected dilation, `sigma = 2 mu dev(eps) + kappa theta_q I`,
/// `theta_q = sum_a share_aq theta_a`.
pub fn body_stress(body: &LinearBody, u: &[Vector3]) -> Result<Vec<Matrix3>, SolveError> {
    body.check()?;
    let plain = stress(body.volume.at(), u, body.materials, body.region)?;
    let Some(theta) = projected_dilation(body, u) else { return Ok(plain) };
    let mean = |q: usize| body.material(q).bulk() * theta[q];
    Ok(plain.iter().enumerate().map(|(q, s)| s + Matrix3::identity() * (mean(q) - s.trace() / 3.0)).collect())
}

/// Returns the mean pressure `p = -tr(sigma) / 3` of [`body_stress`], Pa, at the body's quadrature points.
pub fn mean_pressure(body: &LinearBody, u: &[Vector3]) -> Result<Vec<f64>, SolveError> {
    Ok(body_stress(body, u)?.iter().map(|s| -s.trace() / 3.0).collect())
}

/// Returns the strain energy, J: `sum_q w psi(H_q)`, or with a projection
/// `sum_q w mu |dev eps|^2 + sum_a V_a kappa theta_a^2 / 2`. It includes the energy of hourglass
/// control. Without weak supports the energy equals `u . K u / 2`.
pub fn strain_energy(body: &LinearBody, u: &[Vector3]) -> Result<f64, SolveError> {
    body.check()?;
    check_len("nodal parameters", u.len(), body.nodes.len())?;
    let gradients = body.volume.at().displacement_gradients(u);
    let weights = body.volume.weights();
    let mut energy = 0.0;
    for (q, (h, w)) in gradients.iter().zip(weights).enumerate() {
        let law = body.material(q);
        let volumetric = if body.dilation.is_some() { 0.5 * law.bulk() * h.trace().powi(2) } else { 0.0 };
        energy += w * (law.energy_density(h) - volumetric);
    }
    for (a, (volume, theta)) in group_dilations(body, &gradients).into_iter().enumerate() {
        energy += 0.5 * volume * group_bulk(body, a) * theta * theta;
    }
    let moduli = |q: usize| [body.material(q).lambda(), body.material(q).mu()];
    Ok(energy + body.volume.hourglass_energy(moduli, u))
}

/// Returns volume (m^3) and mean dilation of each group; empty without groups.
fn group_dilations(body: &LinearBody, gradients: &[Matrix3]) -> Vec<(f64, f64)> {
    let Some(groups) = body.dilation else { return Vec::new() };
    let mean = |a| {
        let (points, shares) = groups.group(a);
        let (mut volume, mut sum) = (0.0, 0.0);
        for (&q, share) in points.iter().zip(shares) {
            let dv = share * body.volume.weights()[q as usize];
            volume += dv;
            sum += dv * gradients[q as usize].trace();
        }
        (volume, sum / volume)
    };
    (0..groups.len()).map(mean).collect()
}

fn projected_dilation(body: &LinearBody, u: &[Vector3]) -> Option<Vec<f64>> {
    let groups = body.dilation?;
    let gradients = body.volume.at().displacement_gradients(u);
    let mut theta = vec![0.0; gradients.len()];
    for (a, (_, mean)) in group_dilations(body, &gradients).into_iter().enumerate() {
        let (points, shares) = groups.group(a);
        for (&q, share) in points.iter().zip(shares) {
            theta[q as usize] += share * mean;
        }
    }
    Some(theta)
}
