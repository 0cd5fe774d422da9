//! Ogden's law in isochoric principal stretches.

use std::slice::{from_mut, from_ref};

use catalogue::{Build, Dimension, Entry, Kind, Parameter, Problem, Values};
use lanes::{LANES, madd};
use shape::Matrix3;

use super::moduli::BULK;
use crate::error::MaterialError;
use crate::differences::exp_m1_less;
use crate::lane::series::{self, BOUNDS, Power, unrolled};
use crate::lane::stretch::{Stretch, pair_of, pairs, squared};
use crate::lane::{LaneStrain, Lanes};
use crate::material::{Material, Tangent, one_by_one};
use crate::principal::{Principal, Slopes, sinh_over};
use crate::separated::Separated;
use crate::volumetric::Volumetric;

/// Ogden's law `W = sum_p mu_p / alpha_p (l_1^alpha_p + l_2^alpha_p + l_3^alpha_p - 3) + (J - 1)^2 / D1` with
/// isochoric stretches `l_a = J^(-1/3) lambda_a` and `D1 = 2 / kappa`; moduli in Pa.
///
/// The initial shear modulus is `mu = sum_p mu_p alpha_p / 2`, in Ogden's own convention. Abaqus writes
/// `2 mu_p / alpha_p^2` for `mu_p / alpha_p` here: `mu_p(here) = 2 mu_p(Abaqus) / alpha_p`. A single term
/// with exponent 2 is the isochoric neo-Hookean law; exponents 2 and -2 with `mu_1 = 2 C10`, `mu_2 = -2 C01`
/// give Mooney-Rivlin. Source: Ogden, Proc. R. Soc. A 326 (1972) 565-584.
#[derive(Clone, Debug, PartialEq)]
pub struct Ogden {
    terms: Vec<(f64, f64)>,
    bulk: f64,
    series: Series,
}

pub(super) const ENTRY: Entry<Build<Ogden>> = Entry {
    name: "ogden",
    meaning: "sum_p mu_p/alpha_p (l_1^alpha_p + l_2^alpha_p + l_3^alpha_p - 3) + (J - 1)^2 / D1, l_a isochoric stretches",
    source: "Ogden, Proc. R. Soc. A 326 (1972) 565-584",
    parameters: &[
        Parameter::required("mu", Dimension::Pressure, "constant of each term").of(Kind::List),
        Parameter::required("alpha", Dimension::None, "exponent of each term, not 0").of(Kind::List),
        BULK,
    ],
    build,
};

fn build(values: &Values) -> Result<Ogden, Problem> {
    let [mu, alpha] = ["mu", "alpha"].map(|name| values.list(name).unwrap_or_default());
    if mu.len() != alpha.len() || mu.is_empty() {
        return Err(Problem::new("does not match mu").help("give one alpha for each mu").of("alpha"));
    }
    let terms: Vec<(f64, f64)> = mu.iter().copied().zip(alpha.iter().copied()).collect();
    Ogden::new(&terms, values.number("bulk")?).map_err(|bad| match bad {
        MaterialError::Shear { .. } => Problem::new("does not give a positive shear modulus")
            .help("the sum of mu times alpha, which is twice the shear modulus, must be positive")
            .of("mu"),
        MaterialError::OgdenTerm { .. } => {
            Problem::new("contains a zero").help("give exponents other than 0").of("alpha")
        }
        bad => bad.into(),
    })
}

/// Series `g` of `sum_p mu_p (exp(alpha_p e / 2) - 1) = e g(e)` in `e = dev ln C`, for lanes. There is a
/// series of the necessary length for each of [`BOUNDS`], or `None` if its terms would cancel.
type Series = [Option<Power>; BOUNDS.len()];

fn series_of(terms: &[(f64, f64)]) -> Series {
    let steepest = terms.iter().map(|(_, alpha)| 0.5 * alpha.abs()).fold(0.0, f64::max);
    BOUNDS.map(|bound| {
        // |e| is largest at the smallest eigenvalue of C.
        let exponent = steepest * -(-bound).ln_1p();
        // The size of a term z^n / (n + 1)! relative to the first. Terms as large as exp(4) cost at most one
        // digit.
        let mut term = 1.0;
        let enough = |n: &usize| {
            term *= exponent / (*n as f64 + 1.0);
            term < 2f64.powi(-55)
        };
        let length = if exponent <= 4.0 { (1..64).find(enough)? } else { return None };
        let mut powers: Vec<f64> = terms.iter().map(|(mu, _)| *mu).collect();
        let coefficient = |k: usize| {
            for (power, (_, alpha)) in powers.iter_mut().zip(terms) {
                *power *= 0.5 * alpha / (k as f64 + 1.0);
            }
            powers.iter().sum()
        };
        Power::new((0..length).map(coefficient).collect())
    })
}

impl Ogden {
    /// Builds the law from the terms `(mu_p, alpha_p)` (Pa, dimensionless; `alpha_p` not 0,
    /// `sum mu_p alpha_p` positive) and the bulk modulus (Pa, positive). Single terms with a negative
    /// `mu_p alpha_p` occur in fits and are accepted.
    pub fn new(terms: &[(f64, f64)], bulk: f64) -> Result<Ogden, MaterialError> {
        for (term, &(mu, alpha)) in terms.iter().enumerate() {
            if !(mu.is_finite() && alpha.is_finite() && alpha != 0.0) {
                return Err(MaterialError::OgdenTerm { term, mu, alpha });
            }
        }
        let shear = 0.5 * terms.iter().map(|(mu, alpha)| mu * alpha).sum::<f64>();
        if !(shear > 0.0 && shear.is_finite()) {
            return Err(MaterialError::Shear { mu: shear });
        }
        if !(bulk > 0.0 && bulk.is_finite()) {
            return Err(MaterialError::Bulk { bulk });
        }
        Ok(Ogden { terms: terms.to_vec(), bulk, series: series_of(terms) })
    }

    /// Returns the terms `(mu_p, alpha_p)`: `mu_p` in Pa, `alpha_p` dimensionless.
    pub fn terms(&self) -> &[(f64, f64)] {
        &self.terms
    }

    /// Returns `tau_a = sum_p mu_p (l_a^alpha_p - mean_b l_b^alpha_p) + kappa J (J - 1)`.
    fn kirchhoff(&self, principal: &Principal) -> [f64; 3] {
        let e = isochoric(&principal.log);
        let mut tau = [self.bulk * principal.j * (1.0 + principal.j); 3];
        for &(mu, alpha) in &self.terms {
            let grown = e.map(|e| (alpha * e).exp_m1());
            let mean = (grown[0] + grown[1] + grown[2]) / 3.0;
            for a in 0..3 {
                tau[a] += mu * (grown[a] - mean);
            }
        }
        tau
    }

    fn slopes(&self, principal: &Principal) -> Slopes {
        let e = isochoric(&principal.log);
        let J = 1.0 + principal.j;
        let mut slope = [[self.bulk * J * (J + principal.j); 3]; 3];
        let mut quotient = [0.0; 3];
        for &(mu, alpha) in &self.terms {
            let power = e.map(|e| (alpha * e).exp());
            let third = (power[0] + power[1] + power[2]) / 3.0;
            let scale = mu * alpha;
            for a in 0..3 {
                slope[a][a] += scale * power[a];
                for b in 0..3 {
                    slope[a][b] += scale * (third - power[a] - power[b]) / 3.0;
                }
                // (exp(alpha e_b) - exp(alpha e_c)) / (e_b - e_c), from the mean and half the difference.
                let (b, c) = ((a + 1) % 3, (a + 2) % 3);
                let mean = (0.5 * alpha * (e[b] + e[c])).exp();
                quotient[a] += scale * mean * sinh_over(0.5 * alpha * (e[b] - e[c]));
            }
        }
        Slopes { slope, quotient }
    }
}

impl Material for Ogden {
    fn energy(&self, H: &Matrix3) -> f64 {
        let principal = Principal::new(H);
        let e = isochoric(&principal.log);
        let mut energy = 0.5 * self.bulk * principal.j * principal.j;
        for &(mu, alpha) in &self.terms {
            // The three e sum to 0, so the first-order terms can be omitted.
            energy += mu / alpha * e.map(|e| exp_m1_less(alpha * e)).iter().sum::<f64>();
        }
        energy
    }

    fn stress(&self, H: &Matrix3) -> Matrix3 {
        let principal = Principal::new(H);
        principal.stress(H, &self.kirchhoff(&principal))
    }

    fn tangent(&self, H: &Matrix3) -> Tangent {
        let principal = Principal::new(H);
        principal.tangent(H, &self.kirchhoff(&principal), &self.slopes(&principal))
    }

    fn stress_and_tangent(&self, H: &Matrix3) -> (Matrix3, Tangent) {
        let principal = Principal::new(H);
        let tau = self.kirchhoff(&principal);
        (principal.stress(H, &tau), principal.tangent(H, &tau, &self.slopes(&principal)))
    }

    #[inline(always)]
    fn stress_lanes<const FMA: bool>(&self, strain: &LaneStrain, p: &mut [Lanes; 9]) {
        self.stress_batch::<FMA>(from_ref(strain), from_mut(p));
    }

    #[inline(always)]
    fn stress_batch<const FMA: bool>(&self, strains: &[LaneStrain], p: &mut [[Lanes; 9]]) {
        let mut log = [Logarithm::ZERO; 2];
        for pair in pairs(strains.len()) {
            let stretch = pair_of::<FMA>(strains, pair);
            let mut of_stress = [None; 2];
            for m in 0..2 {
                let rung = series::rung(&stretch[m].a);
                if let Some(series) = rung.and_then(series::of_logarithm) {
                    unrolled!(series, logarithm::<FMA>(&stretch[m], &mut log[m]));
                    of_stress[m] = rung.and_then(|rung| self.series[rung].as_ref());
                }
            }
            for m in 0..2 {
                let strain = &strains[pair[m]];
                let p = &mut p[pair[m]];
                match of_stress[m] {
                    Some(series) => {
                        unrolled!(series, stress::<FMA>(self.bulk, strain, &stretch[m], &log[m], p))
                    }
                    None => one_by_one(self, strain, p),
                }
            }
        }
    }

    fn split(&self) -> Option<(Ogden, Volumetric)> {
        let volume = Volumetric::quadratic(self.bulk);
        Some((Ogden { bulk: 0.0, ..self.clone() }, volume))
    }

    fn separated(&self, theta_minus_1: f64) -> Option<Separated> {
        Some(Separated::of_volume(Volumetric::quadratic(Material::bulk(self)), theta_minus_1))
    }

    fn mu(&self) -> f64 {
        0.5 * self.terms.iter().map(|(mu, alpha)| mu * alpha).sum::<f64>()
    }

    fn lambda(&self) -> f64 {
        self.bulk - 2.0 / 3.0 * Material::mu(self)
    }
}

/// `e = dev ln C`, its square, and the `a`, `b` of `e^3 = a e + b I`.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct Logarithm {
    e: [Lanes; 3],
    square: [Lanes; 3],
    ab: [Lanes; 2],
}

impl Logarithm {
    const ZERO: Logarithm =
        Logarithm { e: [[0.0; LANES]; 3], square: [[0.0; LANES]; 3], ab: [[0.0; LANES]; 2] };
}

#[inline(always)]
fn logarithm<const FMA: bool, const N: usize>(g: &[f64; N], stretch: &Stretch, out: &mut Logarithm) {
    for l in 0..LANES {
        let e = stretch.logarithm::<FMA, N>(g, l);
        let (square, [a, b]) = squared::<FMA>(stretch.a[l], stretch.b[l], e);
        (out.e[0][l], out.e[1][l], out.e[2][l]) = (e[0], e[1], e[2]);
        (out.square[0][l], out.square[1][l], out.square[2][l]) = (square[0], square[1], square[2]);
        (out.ab[0][l], out.ab[1][l]) = (a, b);
    }
}

/// Computes the stress for `tau = dev f(dev ln C) + kappa J (J - 1) I`.
#[inline(always)]
fn stress<const FMA: bool, const N: usize>(
    g: &[f64; N],
    bulk: f64,
    strain: &LaneStrain,
    stretch: &Stretch,
    Logarithm { e, square, ab }: &Logarithm,
    p: &mut [Lanes; 9],
) {
    for l in 0..LANES {
        let e = [e[0][l], e[1][l], e[2][l]];
        let square = [square[0][l], square[1][l], square[2][l]];
        let mut tau = stretch.series::<FMA, N>(g, &e, &square, [ab[0][l], ab[1][l]]);
        let j = strain.invariants[0][l] + strain.invariants[1][l];
        tau[0] = madd::<FMA>(bulk * j, 1.0 + j, tau[0]);
        let at = stretch.stress::<FMA>(&strain.lane(l), &tau, l);
        for k in 0..9 {
            p[k][l] = at[k];
        }
    }
}

/// Returns the logarithms of the isochoric stretches.
fn isochoric(log: &[f64; 3]) -> [f64; 3] {
    let mean = (log[0] + log[1] + log[2]) / 3.0;
    log.map(|e| e - mean)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_constants_are_refused() {
        let refused = |terms: &[(f64, f64)], bulk| Ogden::new(terms, bulk).unwrap_err();
        assert_eq!(
            refused(&[(1.0, 2.0), (3.0, 0.0)], 1.0),
            MaterialError::OgdenTerm { term: 1, mu: 3.0, alpha: 0.0 }
        );
        assert!(matches!(refused(&[(f64::NAN, 2.0)], 1.0), MaterialError::OgdenTerm { term: 0, .. }));
        assert_eq!(refused(&[], 1.0), MaterialError::Shear { mu: 0.0 });
        assert_eq!(refused(&[(1.0, 2.0), (1.0, -3.0)], 1.0), MaterialError::Shear { mu: -0.5 });
        assert_eq!(refused(&[(1.0, 2.0)], -4.0), MaterialError::Bulk { bulk: -4.0 });
        let text = refused(&[(5.0, 0.0)], 1.0).to_string();
        assert!(text.contains("term 1") && text.contains("5 Pa"), "{text}");
    }
}
