//! Hencky's law: Hooke's law between logarithmic strain and Kirchhoff stress.

use std::slice::{from_mut, from_ref};

use catalogue::{Build, Entry};
use lanes::{LANES, madd};
use shape::Matrix3;

use super::linear::LinearElastic;
use super::moduli::{MODULI, moduli};
use crate::error::MaterialError;
use crate::lane::math::ln_1p;
use crate::lane::series::{self, unrolled};
use crate::lane::stretch::{Stretch, pair_of, pairs};
use crate::lane::{LaneStrain, Lanes, of_lane};
use crate::material::{Material, Tangent, one_by_one};
use crate::principal::{Principal, Slopes};
use crate::separated::Separated;
use crate::volumetric::Volumetric;

/// Hencky's law `W = mu e : e + lambda/2 (tr e)^2` with `e = ln V` (`V^2 = F F^T`) and
/// `tau = 2 mu e + lambda tr(e) I`; moduli in Pa.
///
/// It corresponds to linear elasticity in codes that integrate the rate of deformation, such as Abaqus with
/// NLGEOM. For a bar under uniaxial stress, `tau = E ln l` and the sides shrink by `l^(-nu)`, exactly. The
/// energy loses ellipticity at large stretch: `dtau/de` is constant, so the nominal stress of a bar decreases
/// beyond `ln l = 1`. Source: Hencky (1928); Xiao and Chen, Acta Mechanica 157 (2002).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hencky {
    mu: f64,
    lambda: f64,
}

pub(super) const ENTRY: Entry<Build<Hencky>> = Entry {
    name: "hencky",
    meaning: "mu e : e + lambda/2 (tr e)^2, e = ln V: logarithmic strain",
    source: "Hencky (1928); Xiao and Chen, Acta Mechanica 157 (2002)",
    parameters: MODULI,
    build: |values| {
        let (young, poisson) = moduli(values)?;
        Ok(Hencky::new(young, poisson)?)
    },
};

impl Hencky {
    /// Builds the law from Young's modulus (Pa, positive) and Poisson's ratio (-1 < nu < 0.5).
    pub fn new(young: f64, poisson: f64) -> Result<Hencky, MaterialError> {
        let hooke = LinearElastic::new(young, poisson)?;
        Ok(Hencky { mu: hooke.mu(), lambda: hooke.lambda() })
    }

    fn kirchhoff(&self, e: &[f64; 3]) -> [f64; 3] {
        let volume = self.lambda * (e[0] + e[1] + e[2]);
        e.map(|e| 2.0 * self.mu * e + volume)
    }

    fn slopes(&self) -> Slopes {
        let mut slope = [[self.lambda; 3]; 3];
        for a in 0..3 {
            slope[a][a] += 2.0 * self.mu;
        }
        Slopes { slope, quotient: [2.0 * self.mu; 3] }
    }
}

impl Material for Hencky {
    fn energy(&self, H: &Matrix3) -> f64 {
        let e = Principal::new(H).log;
        let trace = e[0] + e[1] + e[2];
        self.mu * (e[0] * e[0] + e[1] * e[1] + e[2] * e[2]) + 0.5 * self.lambda * trace * trace
    }

    fn stress(&self, H: &Matrix3) -> Matrix3 {
        let principal = Principal::new(H);
        principal.stress(H, &self.kirchhoff(&principal.log))
    }

    fn tangent(&self, H: &Matrix3) -> Tangent {
        let principal = Principal::new(H);
        principal.tangent(H, &self.kirchhoff(&principal.log), &self.slopes())
    }

    fn stress_and_tangent(&self, H: &Matrix3) -> (Matrix3, Tangent) {
        let principal = Principal::new(H);
        let tau = self.kirchhoff(&principal.log);
        (principal.stress(H, &tau), principal.tangent(H, &tau, &self.slopes()))
    }

    #[inline(always)]
    fn stress_lanes<const FMA: bool>(&self, strain: &LaneStrain, p: &mut [Lanes; 9]) {
        self.stress_batch::<FMA>(from_ref(strain), from_mut(p));
    }

    #[inline(always)]
    fn stress_batch<const FMA: bool>(&self, strains: &[LaneStrain], p: &mut [[Lanes; 9]]) {
        let bulk = self.bulk();
        for pair in pairs(strains.len()) {
            let stretch = pair_of::<FMA>(strains, pair);
            for (&k, stretch) in pair.iter().zip(&stretch) {
                let strain = &strains[k];
                let p = &mut p[k];
                match series::rung(&stretch.a).and_then(series::of_logarithm) {
                    Some(series) => {
                        let log_j = if bulk == 0.0 { [0.0; LANES] } else { logarithm::<FMA>(strain) };
                        unrolled!(series, stress::<FMA>([self.mu, bulk], &log_j, stretch, &strain.h, p));
                    }
                    None => one_by_one(self, strain, p),
                }
            }
        }
    }

    fn split(&self) -> Option<(Hencky, Volumetric)> {
        let volume = Volumetric::logarithmic(self.bulk());
        Some((Hencky { lambda: -2.0 / 3.0 * self.mu, ..*self }, volume))
    }

    fn separated(&self, theta_minus_1: f64) -> Option<Separated> {
        Some(Separated::of_volume(Volumetric::logarithmic(self.bulk()), theta_minus_1))
    }

    fn mu(&self) -> f64 {
        self.mu
    }

    fn lambda(&self) -> f64 {
        self.lambda
    }
}

/// Returns `ln J`.
#[inline(always)]
fn logarithm<const FMA: bool>(strain: &LaneStrain) -> Lanes {
    let mut out = [0.0; LANES];
    for l in 0..LANES {
        out[l] = ln_1p::<FMA>(strain.invariants[0][l] + strain.invariants[1][l]);
    }
    out
}

/// Computes the stress for `tau = mu dev ln C + kappa ln(J) I`.
#[inline(always)]
fn stress<const FMA: bool, const N: usize>(
    g: &[f64; N],
    [mu, bulk]: [f64; 2],
    log_j: &Lanes,
    stretch: &Stretch,
    h: &[Lanes; 9],
    p: &mut [Lanes; 9],
) {
    for l in 0..LANES {
        let e = stretch.logarithm::<FMA, N>(g, l);
        let tau = [madd::<FMA>(bulk, log_j[l], mu * e[0]), mu * e[1], mu * e[2]];
        let at = stretch.stress::<FMA>(&of_lane(h, l), &tau, l);
        for k in 0..9 {
            p[k][l] = at[k];
        }
    }
}
