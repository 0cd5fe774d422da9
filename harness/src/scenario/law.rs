//! From a scene's material to the law that the solvers take, and to its limit at small strain.

use cases::scene::{ErrorKind, Material};
use material::{
    Hencky, Law, LinearElastic, Material as _, MaterialError, MooneyRivlin, NeoHookean, NeoHookeanIsochoric,
    Ogden, SaintVenantKirchhoff,
};

use crate::Failure;
use crate::error::Key;

/// The law of the material at `key` of the scene, with another Poisson's ratio if one is given and the law takes one.
pub fn law(material: &Material, poisson: Option<f64>, key: &str) -> Result<Law, Failure> {
    build(material, poisson)
        .map_err(|bad| Failure::at(ErrorKind::Invalid, Key::Scene(key.into()), bad.to_string(), ""))
}

fn build(material: &Material, poisson: Option<f64>) -> Result<Law, MaterialError> {
    let nu = |own: f64| poisson.unwrap_or(own);
    Ok(match material {
        Material::Linear(e) => Law::Linear(LinearElastic::new(e.young, nu(e.poisson))?),
        Material::SaintVenantKirchhoff(e) => {
            Law::SaintVenantKirchhoff(SaintVenantKirchhoff::new(e.young, nu(e.poisson))?)
        }
        Material::NeoHookean(e) => Law::NeoHookean(NeoHookean::new(e.young, nu(e.poisson))?),
        Material::NeoHookeanIsochoric(e) => {
            Law::NeoHookeanIsochoric(NeoHookeanIsochoric::new(e.young, nu(e.poisson))?)
        }
        Material::Hencky(e) => Law::Hencky(Hencky::new(e.young, nu(e.poisson))?),
        Material::MooneyRivlin { c10, c01, bulk, .. } => {
            Law::MooneyRivlin(MooneyRivlin::new(*c10, *c01, *bulk)?)
        }
        Material::Ogden { terms, bulk, .. } => Law::Ogden(Ogden::new(terms, *bulk)?),
    })
}

/// What the law is at small strain: `E = mu (3 lambda + 2 mu) / (lambda + mu)`, `nu = lambda / (2 (lambda + mu))`.
pub fn small_strain(law: &Law, key: &str) -> Result<LinearElastic, Failure> {
    if let Law::Linear(linear) = law {
        return Ok(*linear);
    }
    let (lambda, mu) = (law.lambda(), law.mu());
    let (young, poisson) = (mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu), 0.5 * lambda / (lambda + mu));
    LinearElastic::new(young, poisson)
        .map_err(|bad| Failure::at(ErrorKind::Invalid, Key::Scene(key.into()), bad.to_string(), ""))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_and_moduli_of_mooney_rivlin_are_one_law() {
        // E = 20 kPa, nu = 0.45: mu = 2 (c10 + c01), kappa = E / (3 - 6 nu).
        let (mu, bulk) = (20e3 / 2.9, 20e3 / 0.3);
        let material = Material::MooneyRivlin { c10: 0.35 * mu, c01: 0.15 * mu, bulk, density: None };
        let law = law(&material, None, "material").unwrap();
        let linear = small_strain(&law, "material").unwrap();
        assert!((linear.young() / 20e3 - 1.0).abs() < 1e-12, "{}", linear.young());
        assert!((linear.poisson() - 0.45).abs() < 1e-12, "{}", linear.poisson());
    }
}
