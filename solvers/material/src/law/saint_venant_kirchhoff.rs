//! St. Venant-Kirchhoff law: Hooke's law between Green-Lagrange strain and second Piola-Kirchhoff stress.

use catalogue::{Build, Entry};
use lanes::{LANES, madd};
use shape::Matrix3;

use super::linear::LinearElastic;
use super::moduli::{MODULI, moduli};
use crate::error::MaterialError;
use crate::kinematics::{add_left, add_right, green_lagrange, tangent_of};
use crate::lane::{LaneStrain, Lanes};
use crate::material::{Material, Tangent};

/// St. Venant-Kirchhoff law `W = lambda/2 (tr E)^2 + mu E : E` with `E = (H + H^T + H^T H) / 2`; moduli in
/// Pa.
///
/// The law suits large rotation at small strain. It softens in compression: for `nu = 0` the nominal stress
/// of a bar shortened to `l` is `E l (1 - l^2) / 2`, at most `E / (3 sqrt 3) = 0.192 E` at `l = 1 / sqrt 3`,
/// and nothing prevents `J` from reaching 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SaintVenantKirchhoff {
    mu: f64,
    lambda: f64,
}

pub(super) const ENTRY: Entry<Build<SaintVenantKirchhoff>> = Entry {
    name: "saint-venant-kirchhoff",
    meaning: "lambda/2 (tr E)^2 + mu E : E, E Green-Lagrange strain: for large rotation at small strain",
    source: "Saint-Venant (1844), Kirchhoff (1852)",
    parameters: MODULI,
    build: |values| {
        let (young, poisson) = moduli(values)?;
        Ok(SaintVenantKirchhoff::new(young, poisson)?)
    },
};

impl SaintVenantKirchhoff {
    /// Builds the law from Young's modulus (Pa, positive) and Poisson's ratio (-1 < nu < 0.5).
    pub fn new(young: f64, poisson: f64) -> Result<SaintVenantKirchhoff, MaterialError> {
        let hooke = LinearElastic::new(young, poisson)?;
        Ok(SaintVenantKirchhoff { mu: hooke.mu(), lambda: hooke.lambda() })
    }

    /// Returns the second Piola-Kirchhoff stress `S = lambda tr(E) I + 2 mu E`.
    fn second_piola(&self, H: &Matrix3) -> Matrix3 {
        let E = green_lagrange(H);
        E * (2.0 * self.mu) + Matrix3::identity() * (self.lambda * E.trace())
    }

    /// Returns `d(F S)/dF` at the stress `S`:
    /// `delta_ik S_jl + lambda F_ij F_kl + mu (B_ik delta_jl + F_il F_kj)` with `B = F F^T`.
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

    #[inline(always)]
    fn stress_lanes<const FMA: bool>(&self, strain: &LaneStrain, p: &mut [Lanes; 9]) {
        let m = madd::<FMA>;
        for l in 0..LANES {
            let h = strain.lane(l);
            // 2 E = H + H^T + H^T H.
            let twice = |i: usize, j: usize| {
                let sum = h[3 * i + j] + h[3 * j + i];
                m(h[i], h[j], m(h[3 + i], h[3 + j], m(h[6 + i], h[6 + j], sum)))
            };
            let (xx, yy, zz) = (twice(0, 0), twice(1, 1), twice(2, 2));
            let volume = 0.5 * self.lambda * (xx + yy + zz);
            let (xx, yy, zz) = (m(self.mu, xx, volume), m(self.mu, yy, volume), m(self.mu, zz, volume));
            let (xy, xz, yz) = (self.mu * twice(0, 1), self.mu * twice(0, 2), self.mu * twice(1, 2));
            let s = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
            for i in 0..3 {
                for j in 0..3 {
                    let row =
                        m(h[3 * i], s[0][j], m(h[3 * i + 1], s[1][j], m(h[3 * i + 2], s[2][j], s[i][j])));
                    p[3 * i + j][l] = row;
                }
            }
        }
    }

    fn mu(&self) -> f64 {
        self.mu
    }

    fn lambda(&self) -> f64 {
        self.lambda
    }
}
