//! St. Venant-Kirchhoff: Hooke's law between Green-Lagrange strain and second Piola-Kirchhoff stress.

use super::kinematics::{add_left, add_right, green_lagrange, tangent_of};
use super::{LinearElastic, Material, MaterialError, Tangent};
use crate::Matrix3;

/// `W = lambda/2 (tr E)^2 + mu E : E`, `E = (H + H^T + H^T H) / 2`; moduli in Pa.
///
/// For large rotation at small strain. It softens in compression: at `nu = 0` the nominal stress of a bar
/// shortened to `l` is `E l (1 - l^2) / 2`, at most `E / (3 sqrt 3) = 0.192 E` at `l = 1 / sqrt 3`, and nothing
/// keeps `J` from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SaintVenantKirchhoff {
    mu: f64,
    lambda: f64,
}

impl SaintVenantKirchhoff {
    /// From Young's modulus (Pa, positive) and Poisson's ratio (-1 < nu < 0.5).
    pub fn new(young: f64, poisson: f64) -> Result<SaintVenantKirchhoff, MaterialError> {
        let hooke = LinearElastic::new(young, poisson)?;
        Ok(SaintVenantKirchhoff { mu: hooke.mu(), lambda: hooke.lambda() })
    }

    /// Second Piola-Kirchhoff stress `S = lambda tr(E) I + 2 mu E`.
    fn second_piola(&self, H: &Matrix3) -> Matrix3 {
        let E = green_lagrange(H);
        E * (2.0 * self.mu) + Matrix3::identity() * (self.lambda * E.trace())
    }

    /// `d(F S)/dF` at the stress `S`: `delta_ik S_jl + lambda F_ij F_kl + mu (B_ik delta_jl + F_il F_kj)`, `B = F F^T`.
    fn tangent_at(&self, H: &Matrix3, S: &Matrix3) -> Tangent {
        let F = Matrix3::identity() + H;
        let B = F * F.transpose() * self.mu;
        let mut tangent =
            tangent_of(|i, j, k, l| self.lambda * F[(i, j)] * F[(k, l)] + self.mu * F[(i, l)] * F[(k, j)]);
        add_right(&mut tangent, S);
        add_left(&mut tangent, &B);
        tangent
    }
}

impl Material for SaintVenantKirchhoff {
    fn energy(&self, H: &Matrix3) -> f64 {
        let E = green_lagrange(H);
        0.5 * self.lambda * E.trace().powi(2) + self.mu * E.norm_squared()
    }

    fn stress(&self, H: &Matrix3) -> Matrix3 {
        let S = self.second_piola(H);
        S + H * S
    }

    fn tangent(&self, H: &Matrix3) -> Tangent {
        self.tangent_at(H, &self.second_piola(H))
    }

    fn stress_and_tangent(&self, H: &Matrix3) -> (Matrix3, Tangent) {
        let S = self.second_piola(H);
        (S + H * S, self.tangent_at(H, &S))
    }

    fn mu(&self) -> f64 {
        self.mu
    }

    fn lambda(&self) -> f64 {
        self.lambda
    }
}
