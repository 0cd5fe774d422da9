//! Materials of a scene.

use catalogue::{Problem, Value, Values};
use material::{Law, LawEntry, Material as _};

use crate::exact::{Elastic, ExactError, Hyperelastic, Medium};

/// A law with the constants given by the scene, and its density and relaxation.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    entry: &'static LawEntry,
    values: Values,
    law: Law,
    /// Density in kilograms per cubic metre, if given.
    pub density: Option<f64>,
    /// Prony series of the relaxation; empty for a material that does not relax.
    pub prony: Vec<Relaxation>,
}

impl Material {
    /// A material; `law` is the result of `entry` for `values`.
    pub(crate) fn new(
        entry: &'static LawEntry,
        values: Values,
        law: Law,
        density: Option<f64>,
        prony: Vec<Relaxation>,
    ) -> Material {
        Material { entry, values, law, density, prony }
    }

    /// The law.
    pub fn law(&self) -> &Law {
        &self.law
    }

    /// The name of the law in files and tables.
    pub fn name(&self) -> &'static str {
        self.entry.name
    }

    /// A constant that the scene gives as one number, such as `young` (SI).
    pub fn constant(&self, name: &str) -> Option<f64> {
        self.values.get(name)
    }

    /// The law with another Poisson's ratio; unchanged if the law has no such constant.
    pub fn at_poisson(&self, poisson: f64) -> Result<Law, Problem> {
        let mut values = self.values.clone();
        if values.has("poisson") {
            values.give("poisson", Value::Number(poisson))?;
        }
        (self.entry.build)(&values)
    }
}

/// The medium of the exact solutions for a law, with its moduli at small strain. The energies of
/// [`Hyperelastic`] are written separately from the solvers' laws and share only the constants. Other laws
/// have solutions at small strain only.
pub fn medium(law: &Law, young: f64, poisson: f64) -> Result<Medium, ExactError> {
    let elastic = Elastic::new(young, poisson)?;
    let law = match law {
        Law::SaintVenantKirchhoff(_) => Some(Hyperelastic::SaintVenantKirchhoff(elastic)),
        Law::NeoHookean(_) => Some(Hyperelastic::NeoHookean(elastic)),
        Law::Hencky(_) => Some(Hyperelastic::Hencky(elastic)),
        Law::NeoHookeanIsochoric(law) => {
            Some(Hyperelastic::MooneyRivlin { c10: law.c10(), c01: 0.0, bulk: law.bulk() })
        }
        Law::MooneyRivlin(law) => {
            Some(Hyperelastic::MooneyRivlin { c10: law.c10(), c01: law.c01(), bulk: law.bulk() })
        }
        Law::Ogden(law) => Some(Hyperelastic::Ogden { terms: law.terms().to_vec(), bulk: law.bulk() }),
        _ => None,
    };
    Ok(Medium { elastic, law })
}

/// A term of a Prony series: a share of the shear response that relaxes exponentially.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relaxation {
    /// Share `g` of the shear response, between 0 and 1.
    pub g: f64,
    /// Relaxation time in seconds, positive.
    pub tau: f64,
}
