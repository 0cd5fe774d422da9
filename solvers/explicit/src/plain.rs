//! Plain loop over quadrature points on one thread, for any law, table and dilation groups. It is the
//! reference for tests of the lane kernels, and the fallback for laws and tables without a lane kernel.

#![allow(non_snake_case)]

use material::volume_change;
use shape::{DilationGroups, Matrix3, Vector3, VolumeRows};

use crate::error::InvertedPoint;

/// Returns the displacement gradient at one point, and `J - 1`; an error unless `J > 0`.
fn strain(volume: &VolumeRows, q: usize, u: &[Vector3]) -> Result<(Matrix3, f64), InvertedPoint> {
    let (nodes, grads) = volume.row(q);
    let mut H = Matrix3::zeros();
    for (&node, g) in nodes.iter().zip(grads) {
        H += u[node as usize] * g.transpose();
    }
    let j = volume_change(&H);
    if 1.0 + j > 0.0 { Ok((H, j)) } else { Err(InvertedPoint { point: q, det_f: 1.0 + j }) }
}

/// Checks that no point is inverted; the error names the first inverted point.
pub(super) fn check(volume: &VolumeRows, u: &[Vector3]) -> Result<(), InvertedPoint> {
    (0..volume.weights().len()).try_for_each(|q| strain(volume, q, u).map(|_| ()))
}

/// Computes `f_I = sum_q w P(H_q) grad N_I`, N; `stress(q, H)` is the first Piola-Kirchhoff stress at point
/// `q`.
pub(super) fn forces(
    volume: &VolumeRows,
    stress: impl Fn(usize, &Matrix3) -> Matrix3,
    u: &[Vector3],
    f: &mut [Vector3],
) -> Result<(), InvertedPoint> {
    f.fill(Vector3::zeros());
    for (q, &w) in volume.weights().iter().enumerate() {
        let (H, _) = strain(volume, q, u)?;
        add(volume, q, &(stress(q, &H) * w), f);
    }
    Ok(())
}

fn add(volume: &VolumeRows, q: usize, wP: &Matrix3, f: &mut [Vector3]) {
    let (nodes, grads) = volume.row(q);
    for (&node, g) in nodes.iter().zip(grads) {
        f[node as usize] += wP * g;
    }
}

/// Computes `sum_q w W(H_q)`, J.
pub(super) fn energy(
    volume: &VolumeRows,
    density: impl Fn(usize, &Matrix3) -> f64,
    u: &[Vector3],
) -> Result<f64, InvertedPoint> {
    let mut sum = 0.0;
    for (q, &w) in volume.weights().iter().enumerate() {
        sum += w * density(q, &strain(volume, q, u)?.0);
    }
    Ok(sum)
}

/// Values `J_a - 1 = sum_q share w (J_q - 1) / V_a` and `V_a` of every group, and `H` and `J - 1` of every
/// point.
type Dilated = (Vec<(f64, f64)>, Vec<(Matrix3, f64)>);

fn dilated(volume: &VolumeRows, groups: &DilationGroups, u: &[Vector3]) -> Result<Dilated, InvertedPoint> {
    let strains: Vec<_> =
        (0..volume.weights().len()).map(|q| strain(volume, q, u)).collect::<Result<_, _>>()?;
    let mean = |a: usize| {
        let (points, shares) = groups.group(a);
        let (mut measure, mut sum) = (0.0, 0.0);
        for (&q, share) in points.iter().zip(shares) {
            let dv = share * volume.weights()[q as usize];
            measure += dv;
            sum += dv * strains[q as usize].1;
        }
        (sum / measure, measure)
    };
    Ok(((0..groups.len()).map(mean).collect(), strains))
}

/// Returns `H_bar = (J_a / J_q)^(1/3) (I + H) - I` and the factor.
fn bar(H: &Matrix3, j: f64, j_a: f64) -> (Matrix3, f64) {
    let less = ((j_a.ln_1p() - j.ln_1p()) / 3.0).exp_m1();
    (H * (1.0 + less) + Matrix3::identity() * less, 1.0 + less)
}

/// Computes the energy as [`energy`], with `W(F_bar)` over all pairs (group a, point q) of weight `share w`,
/// `F_bar = (J_a / J_q)^(1/3) F`.
pub(super) fn dilated_energy(
    volume: &VolumeRows,
    groups: &DilationGroups,
    density: impl Fn(usize, &Matrix3) -> f64,
    u: &[Vector3],
) -> Result<f64, InvertedPoint> {
    let (means, strains) = dilated(volume, groups, u)?;
    let mut sum = 0.0;
    for (a, &(j_a, _)) in means.iter().enumerate() {
        let (points, shares) = groups.group(a);
        for (&q, share) in points.iter().zip(shares) {
            let (H, j) = &strains[q as usize];
            sum += share * volume.weights()[q as usize] * density(q as usize, &bar(H, *j, j_a).0);
        }
    }
    Ok(sum)
}

/// Computes the derivative of [`dilated_energy`]. With `r = (J_a / J_q)^(1/3)` and
/// `dF_bar = r dF + F_bar (dJ_a / (3 J_a) - dJ_q / (3 J_q))`:
/// `w P_q = sum_a share w (r P(F_bar) - P(F_bar) : F_bar / 3 F^-T) + w sum_a share p_a cof F`,
/// `p_a = sum_q share w P(F_bar) : F_bar / (3 J_a V_a)`.
pub(super) fn dilated_forces(
    volume: &VolumeRows,
    groups: &DilationGroups,
    stress: impl Fn(usize, &Matrix3) -> Matrix3,
    u: &[Vector3],
    f: &mut [Vector3],
) -> Result<(), InvertedPoint> {
    let (means, strains) = dilated(volume, groups, u)?;
    let mut wP = vec![Matrix3::zeros(); strains.len()];
    let mut cofactors = Vec::with_capacity(strains.len());
    for (H, j) in &strains {
        let inverse = (Matrix3::identity() + H).try_inverse().expect("J > 0 was checked");
        cofactors.push(inverse.transpose() * (1.0 + j));
    }
    for (a, &(j_a, measure)) in means.iter().enumerate() {
        let (points, shares) = groups.group(a);
        let mut mean = 0.0;
        for (&q, share) in points.iter().zip(shares) {
            let q = q as usize;
            let (H, j) = &strains[q];
            let dv = share * volume.weights()[q];
            let (H_bar, r) = bar(H, *j, j_a);
            let P = stress(q, &H_bar);
            let spherical = (P.dot(&H_bar) + P.trace()) / 3.0;
            wP[q] += (P * r - cofactors[q] * (spherical / (1.0 + j))) * dv;
            mean += dv * spherical;
        }
        let p_a = mean / ((1.0 + j_a) * measure);
        for (&q, share) in points.iter().zip(shares) {
            let q = q as usize;
            wP[q] += cofactors[q] * (share * volume.weights()[q] * p_a);
        }
    }
    f.fill(Vector3::zeros());
    wP.iter().enumerate().for_each(|(q, wP)| add(volume, q, wP, f));
    Ok(())
}
