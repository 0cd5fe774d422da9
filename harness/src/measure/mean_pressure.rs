//! Mean pressure `p = -tr(sigma) / 3` (Pa) of the method itself: from the law, from the projected dilation,
//! or from the method's own pressure field. A plain displacement gradient would give a pressure that
//! projected methods never use.

use material::split::dilation;
use material::{AtPoint, Law, Material};
use shape::{DilationGroups, Matrix3};

use crate::discretise::Volume;

/// Cauchy stress `P F^T / J` (Pa) at a displacement gradient; `P` itself at small strain.
pub fn cauchy(law: &impl Material, h: &Matrix3) -> Matrix3 {
    let p = law.stress(h);
    if law.is_small_strain() {
        return p;
    }
    let f = Matrix3::identity() + h;
    p * f.transpose() / f.determinant()
}

/// Mean pressure at every quadrature point of a volume, Pa, positive in compression. `gradients` are the
/// displacement gradients (3, 3) at the points. `parameters` (Pa, tension positive) are those of the method's
/// pressure field, if it has one; `active` is the active stress by region, Pa.
pub fn at_points(
    (laws, active): (&[Law], &[f64]),
    volume: &Volume,
    gradients: &[Matrix3],
    parameters: &[f64],
) -> Vec<f64> {
    let law = |q: usize| volume.law(laws, active, q);
    if let Some(rows) = &volume.pressure {
        let at = |q| {
            let (nodes, values) = rows.row(q);
            -nodes.iter().zip(values).map(|(&m, v)| v * parameters[m as usize]).sum::<f64>()
        };
        return (0..gradients.len()).map(at).collect();
    }
    match &volume.groups {
        None => gradients.iter().enumerate().map(|(q, h)| -cauchy(&law(q), h).trace() / 3.0).collect(),
        Some(groups) => projected(groups, law, volume.rows.weights(), gradients),
    }
}

/// Projected pressure `p_q = sum_a share_aq p_a`. `p_a` is the mean over group a of the law's pressure at the
/// group's dilation.
fn projected<'l>(
    groups: &DilationGroups,
    law: impl Fn(usize) -> AtPoint<'l>,
    weights: &[f64],
    gradients: &[Matrix3],
) -> Vec<f64> {
    let mut pressure = vec![0.0; gradients.len()];
    for a in 0..groups.len() {
        let (points, shares) = groups.group(a);
        let mean = |value: &dyn Fn(usize) -> f64| mean(points, shares, weights, value);
        let theta = mean(&|q| dilation(law(q).is_small_strain(), &gradients[q]));
        let of_group = mean(&|q| -cauchy(&law(q), &dilated(&law(q), &gradients[q], theta)).trace() / 3.0);
        for (&q, share) in points.iter().zip(shares) {
            pressure[q as usize] += share * of_group;
        }
    }
    pressure
}

/// Mean over a group of points, weighted by volume and share.
pub(super) fn mean(points: &[u32], shares: &[f64], weights: &[f64], value: &dyn Fn(usize) -> f64) -> f64 {
    let each = points.iter().zip(shares).map(|(&q, s)| (q as usize, s * weights[q as usize]));
    let (sum, measure) = each.fold((0.0, 0.0), |(s, m), (q, dv)| (s + dv * value(q), m + dv));
    sum / measure
}

/// Displacement gradient of `F_bar = ((1 + theta) / J)^(1/3) F`; at small strain, of the strain with the
/// trace `theta`.
pub(super) fn dilated(law: &impl Material, h: &Matrix3, theta: f64) -> Matrix3 {
    let j = dilation(law.is_small_strain(), h);
    if law.is_small_strain() {
        return h + Matrix3::identity() * ((theta - j) / 3.0);
    }
    let grown = ((theta.ln_1p() - j.ln_1p()) / 3.0).exp_m1();
    h + (Matrix3::identity() + h) * grown
}
