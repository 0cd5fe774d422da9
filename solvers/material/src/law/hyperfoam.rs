//! Storakers' law of compressible foams in principal stretches.

use catalogue::{Build, Dimension, Entry, Kind, Parameter, Problem, Range, Values};
use shape::Matrix3;

use crate::error::MaterialError;
use crate::differences::exp_m1_less;
use crate::material::{Material, Tangent};
use crate::principal::{Principal, Slopes, sinh_over};

/// Hyperfoam law `W = sum_p 2 mu_p / alpha_p^2 (l_1^alpha_p + l_2^alpha_p + l_3^alpha_p - 3 +
/// (J^(-alpha_p beta_p) - 1) / beta_p) + kappa/2 (J - 1)^2` with `beta_p = nu_p / (1 - 2 nu_p)`; moduli in
/// Pa.
///
/// The shear modulus at small strain is `sum mu_p`. With `nu_p = 0` and `kappa` it is the unconstrained law
/// of Ogden in FEBio. Source: Storakers, J. Mech. Phys. Solids 34 (1986) 125-145; form as in the Abaqus
/// Theory Guide, Hyperelastic behavior in elastomeric foams.
#[derive(Clone, Debug, PartialEq)]
pub struct Hyperfoam {
    /// `mu_p` (Pa), `alpha_p` and `beta_p` of each term.
    terms: Vec<[f64; 3]>,
    /// Modulus of the further volumetric term, Pa.
    kappa: f64,
}

pub(super) const ENTRY: Entry<Build<Hyperfoam>> = Entry {
    name: "hyperfoam",
    meaning: "sum_p 2 mu_p/alpha_p^2 (l_1^alpha_p + l_2^alpha_p + l_3^alpha_p - 3 + (J^(-alpha_p beta_p) - 1)/beta_p) + kappa/2 (J - 1)^2, beta_p = nu_p / (1 - 2 nu_p)",
    source: "Storakers (1986); Abaqus Theory Guide, Hyperelastic behavior in elastomeric foams",
    parameters: &[
        Parameter::required("mu", Dimension::Pressure, "constant of each term").of(Kind::List),
        Parameter::required("alpha", Dimension::None, "exponent of each term, not 0").of(Kind::List),
        Parameter::required("nu", Dimension::None, "Poisson's ratio of each term")
            .of(Kind::List)
            .within(Range::Between(-1.0, 0.5)),
        Parameter::default(
            "kappa",
            Dimension::Pressure,
            0.0,
            "modulus of a further volumetric term; 0 unless given",
        )
        .within(Range::NotNegative),
    ],
    build,
};

fn build(values: &Values) -> Result<Hyperfoam, Problem> {
    let [mu, alpha, nu] = ["mu", "alpha", "nu"].map(|name| values.list(name).unwrap_or_default());
    for (name, list) in [("alpha", alpha), ("nu", nu)] {
        if list.len() != mu.len() || mu.is_empty() {
            let problem = Problem::new("does not match mu");
            return Err(problem.help(format!("give one {name} for each mu")).of(name));
        }
    }
    let terms: Vec<[f64; 3]> = (0..mu.len()).map(|p| [mu[p], alpha[p], nu[p]]).collect();
    let law = Hyperfoam::new(&terms).and_then(|law| law.with_volume(values.number("kappa").unwrap_or_default()));
    law.map_err(|bad| match bad {
        MaterialError::Shear { .. } => Problem::new("does not give a positive shear modulus")
            .help("the sum of mu, which is the shear modulus, must be positive")
            .of("mu"),
        MaterialError::OgdenTerm { .. } => {
            Problem::new("contains a zero").help("give exponents other than 0").of("alpha")
        }
        bad => bad.into(),
    })
}

impl Hyperfoam {
    /// Builds the law from the terms `[mu_p, alpha_p, nu_p]` (Pa, dimensionless; `alpha_p` not 0, `nu_p`
    /// between -1 and 0.5, `sum mu_p` positive).
    pub fn new(terms: &[[f64; 3]]) -> Result<Hyperfoam, MaterialError> {
        for (term, &[mu, alpha, poisson]) in terms.iter().enumerate() {
            if !(mu.is_finite() && alpha.is_finite() && alpha != 0.0) {
                return Err(MaterialError::OgdenTerm { term, mu, alpha });
            }
            if !(poisson > -1.0 && poisson < 0.5) {
                return Err(MaterialError::Poisson { poisson });
            }
        }
        let mu = terms.iter().map(|term| term[0]).sum::<f64>();
        if !(mu > 0.0) {
            return Err(MaterialError::Shear { mu });
        }
        let terms = terms.iter().map(|&[mu, alpha, nu]| [mu, alpha, nu / (1.0 - 2.0 * nu)]).collect();
        Ok(Hyperfoam { terms, kappa: 0.0 })
    }

    /// Returns the law with the further term `kappa/2 (J - 1)^2` (Pa, zero or more).
    ///
    /// # Errors
    /// A `kappa` that is negative or not finite.
    pub fn with_volume(self, kappa: f64) -> Result<Hyperfoam, MaterialError> {
        MaterialError::check_not_negative("kappa", kappa)?;
        Ok(Hyperfoam { kappa, ..self })
    }

    /// Modulus of the further volumetric term, Pa.
    pub fn kappa(&self) -> f64 {
        self.kappa
    }

    /// Returns the terms `[mu_p, alpha_p, beta_p]`: `mu_p` in Pa.
    pub fn terms(&self) -> &[[f64; 3]] {
        &self.terms
    }

    /// Returns `tau_a = sum_p 2 mu_p / alpha_p (l_a^alpha_p - J^(-alpha_p beta_p)) + kappa J (J - 1)`.
    fn kirchhoff(&self, principal: &Principal) -> [f64; 3] {
        let log = principal.j.ln_1p();
        let mut tau = [self.kappa * (1.0 + principal.j) * principal.j; 3];
        for &[mu, alpha, beta] in &self.terms {
            let volume = (-alpha * beta * log).exp_m1();
            for (tau, e) in tau.iter_mut().zip(principal.log) {
                *tau += 2.0 * mu / alpha * ((alpha * e).exp_m1() - volume);
            }
        }
        tau
    }

    fn slopes(&self, principal: &Principal) -> Slopes {
        let (e, log) = (principal.log, principal.j.ln_1p());
        let J = 1.0 + principal.j;
        let (mut slope, mut quotient) = ([[self.kappa * J * (J + principal.j); 3]; 3], [0.0; 3]);
        for &[mu, alpha, beta] in &self.terms {
            let volume = 2.0 * mu * beta * (-alpha * beta * log).exp();
            for a in 0..3 {
                slope[a].iter_mut().for_each(|slope| *slope += volume);
                slope[a][a] += 2.0 * mu * (alpha * e[a]).exp();
                let (b, c) = ((a + 1) % 3, (a + 2) % 3);
                let mean = (0.5 * alpha * (e[b] + e[c])).exp();
                quotient[a] += 2.0 * mu * mean * sinh_over(0.5 * alpha * (e[b] - e[c]));
            }
        }
        Slopes { slope, quotient }
    }
}

impl Material for Hyperfoam {
    /// The first-order terms `alpha (e_1 + e_2 + e_3)` and `alpha ln J` cancel and are left out.
    fn energy(&self, H: &Matrix3) -> f64 {
        let principal = Principal::new(H);
        let log = principal.j.ln_1p();
        let of_term = |&[mu, alpha, beta]: &[f64; 3]| {
            let shape: f64 = principal.log.iter().map(|e| exp_m1_less(alpha * e)).sum();
            let volume = if beta == 0.0 { 0.0 } else { exp_m1_less(-alpha * beta * log) / beta };
            2.0 * mu / (alpha * alpha) * (shape + volume)
        };
        self.terms.iter().map(of_term).sum::<f64>() + 0.5 * self.kappa * principal.j * principal.j
    }

    fn stress(&self, H: &Matrix3) -> Matrix3 {
        let principal = Principal::new(H);
        principal.stress(H, &self.kirchhoff(&principal))
    }

    fn tangent(&self, H: &Matrix3) -> Tangent {
        let principal = Principal::new(H);
        principal.tangent(H, &self.kirchhoff(&principal), &self.slopes(&principal))
    }

    fn mu(&self) -> f64 {
        self.terms.iter().map(|term| term[0]).sum()
    }

    fn lambda(&self) -> f64 {
        self.terms.iter().map(|[mu, _, beta]| 2.0 * mu * beta).sum::<f64>() + self.kappa
    }
}
