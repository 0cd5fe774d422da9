//! Elastic laws whose deviatoric stress relaxes.

use shape::Matrix3;

use super::kinematics::{Kinematics, add_right, tangent_of};
use crate::material::{Material, Tangent};
use crate::prony::PronyStep;

/// Returns the deviatoric part of the second Piola-Kirchhoff stress, `S_dev = S - (S : C)/3 C^-1`, (3, 3),
/// Pa, from `P = F S`. It is the pull-back of the deviator of the Kirchhoff stress, on which [`PronyStep`]
/// acts.
pub fn deviator(P: &Matrix3, H: &Matrix3) -> Matrix3 {
    let k = Kinematics::new(H);
    let pressure = P.dot(&k.F) / 3.0;
    k.G.transpose() * (P - k.G * pressure)
}

/// Returns `P` and `dP/dF` at the end of a step for a `law` whose deviatoric part relaxes; `carried` is
/// [`PronyStep::carried`] of the point:
///
/// ```text
/// P = P0 + (m - 1) (P0 - p F^-T) + F carried,   p = P0 : F / 3,   m = PronyStep::modulus
/// ```
///
/// with the elastic stress `P0` of the law. The tangent is symmetric for laws in which `p` depends on `J`
/// alone and unsymmetric for the others: Saint Venant-Kirchhoff, compressible neo-Hookean, Blatz-Ko,
/// hyperfoam, corotational and stable neo-Hookean.
pub fn relaxed_stress_and_tangent(
    law: &impl Material,
    H: &Matrix3,
    step: &PronyStep,
    carried: &Matrix3,
) -> (Matrix3, Tangent) {
    let k = Kinematics::new(H);
    let (F, G) = (&k.F, &k.G);
    let (P, tangent) = law.stress_and_tangent(H);
    let p = P.dot(F) / 3.0;
    let less = step.modulus() - 1.0;
    let stress = P + (P - G * p) * less + F * carried;

    // dp/dF_kl = (P_kl + F_ij dP_ij/dF_kl) / 3.
    let F_tangent = tangent.tr_mul(&nalgebra::SVector::<f64, 9>::from_column_slice(F.as_slice()));
    let slope = (P + Matrix3::from_column_slice(F_tangent.as_slice())) * (less / 3.0);
    let mut relaxed = tangent * (1.0 + less)
        + tangent_of(|i, j, k, l| less * p * G[(i, l)] * G[(k, j)] - G[(i, j)] * slope[(k, l)]);
    add_right(&mut relaxed, carried);
    (stress, relaxed)
}
