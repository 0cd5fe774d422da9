//! Hencky's law: Hooke's law between logarithmic strain and Kirchhoff stress.

use super::{Entry, LawEntry, LinearElastic, MODULI, moduli};
use crate::lane::stretch::{Stretch, add_logarithmic};
use crate::lane::{LaneStrain, Lanes, one_by_one, series};
use crate::principal::{Principal, Slopes};
use crate::{Material, MaterialError, Separated, Tangent, Volumetric};
use shape::Matrix3;

/// `W = mu e : e + lambda/2 (tr e)^2`, `e = ln V` (`V^2 = F F^T`); `tau = 2 mu e + lambda tr(e) I`; moduli in Pa.
///
/// What a linear elastic material amounts to in codes that integrate the rate of deformation, as Abaqus does under
/// NLGEOM. In a bar under uniaxial stress `tau = E ln l` and the sides shrink by `l^(-nu)`, exactly. The energy loses
/// ellipticity at large stretch (the Kirchhoff stress has `dtau/de` constant, so the nominal stress of a bar falls
/// beyond `ln l = 1`).
/// Source: Hencky (1928); Xiao and Chen, Acta Mechanica 157 (2002).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hencky {
    mu: f64,
    lambda: f64,
}

pub(super) const ENTRY: LawEntry = Entry {
    name: "hencky",
    meaning: "mu e : e + lambda/2 (tr e)^2, e = ln V: logarithmic strain",
    source: "Hencky (1928); Xiao and Chen, Acta Mechanica 157 (2002)",
    parameters: MODULI,
    build: |values| {
        let (young, poisson) = moduli(values)?;
        Ok(Hencky::new(young, poisson)?.into())
    },
};

impl Hencky {
    /// From Young's modulus (Pa, positive) and Poisson's ratio (-1 < nu < 0.5).
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

    /// `tau = mu dev ln C + kappa ln(J) I`.
    #[inline(always)]
    fn stress_lanes<const FMA: bool>(&self, strain: &LaneStrain, p: &mut [Lanes; 9]) {
        let stretch = Stretch::new::<FMA>(strain);
        let Some(rung) = series::rung(&stretch.a) else { return one_by_one(self, strain, p) };
        let mut tau = stretch.logarithm::<FMA>(rung);
        tau.iter_mut().flatten().for_each(|tau| *tau *= self.mu);
        let bulk = self.bulk();
        if bulk != 0.0 {
            add_logarithmic::<FMA>(bulk, strain, &mut tau[0]);
        }
        stretch.stress::<FMA>(strain, &tau, p);
    }

    fn split(&self) -> Option<(Hencky, Volumetric)> {
        let volume = Volumetric { quadratic: 0.0, logarithmic: self.bulk() };
        Some((Hencky { lambda: -2.0 / 3.0 * self.mu, ..*self }, volume))
    }

    fn separated(&self, theta_minus_1: f64) -> Option<Separated> {
        Some(Separated::logarithmic(self.bulk(), theta_minus_1))
    }

    fn mu(&self) -> f64 {
        self.mu
    }

    fn lambda(&self) -> f64 {
        self.lambda
    }
}
