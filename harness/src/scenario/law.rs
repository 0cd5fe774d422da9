//! Laws of a scene's materials, with a study's Poisson's ratio, and their small-strain limits.

use cases::scene::{ErrorKind, Material};
use material::{Law, LinearElastic, Material as _};

use crate::error::{Failure, Key};

/// Returns the law of the material at `key` of the scene. A given Poisson's ratio replaces that of the law,
/// if the law has one.
///
/// # Errors
/// Returns an error if the law does not allow this Poisson's ratio.
pub fn law(material: &Material, poisson: Option<f64>, key: &str) -> Result<Law, Failure> {
    let Some(poisson) = poisson else { return Ok(material.law().clone()) };
    material.at_poisson(poisson).map_err(|bad| {
        let key = bad.parameter.map_or(key.to_string(), |parameter| format!("{key}.{parameter}"));
        Failure::at(ErrorKind::Invalid, Key::Scene(key), bad.problem, &bad.help.unwrap_or_default())
    })
}

/// Returns the small-strain limit of the law: `E = mu (3 lambda + 2 mu) / (lambda + mu)`, `nu = lambda / (2
/// (lambda + mu))`.
///
/// # Errors
/// Returns an error if the limit is not a valid linear law.
pub fn small_strain(law: &Law, key: &str) -> Result<LinearElastic, Failure> {
    if let Law::LinearElastic(linear) = law {
        return Ok(*linear);
    }
    let (lambda, mu) = (law.lambda(), law.mu());
    let young = mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu);
    let poisson = 0.5 * lambda / (lambda + mu);
    LinearElastic::new(young, poisson)
        .map_err(|bad| Failure::at(ErrorKind::Invalid, Key::Scene(key.into()), bad.to_string(), ""))
}

#[cfg(test)]
mod tests {
    use material::MooneyRivlin;

    use super::*;

    #[test]
    fn the_limit_of_mooney_rivlin_is_that_of_its_constants() {
        // E = 20 kPa, nu = 0.45: mu = 2 (c10 + c01), kappa = E / (3 - 6 nu).
        let (mu, bulk) = (20e3 / 2.9, 20e3 / 0.3);
        let law = MooneyRivlin::new(0.35 * mu, 0.15 * mu, bulk).unwrap().into();
        let linear = small_strain(&law, "material").unwrap();
        assert!((linear.young() / 20e3 - 1.0).abs() < 1e-12, "{}", linear.young());
        assert!((linear.poisson() - 0.45).abs() < 1e-12, "{}", linear.poisson());
    }
}
