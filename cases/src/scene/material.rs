//! Materials of a scene.

use catalogue::{Problem, Value, Values};
use material::{Law, LawEntry, Material as _};

use crate::exact::{Elastic, ExactError, Hyperelastic, Medium};

/// A law with the constants that the scene gives, and what goes with any law.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    entry: &'static LawEntry,
    values: Values,
    law: Law,
    /// Density in kilograms per cubic metre, where one is given.
    pub density: Option<f64>,
    /// Its relaxation over time; nothing relaxes where empty.
    pub prony: Vec<Relaxation>,
}

impl Material {
    /// `law` is what `entry` makes of `values`.
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

    /// The law with another Poisson's ratio; as it is where the scene gives it none.
    pub fn at_poisson(&self, poisson: f64) -> Result<Law, Problem> {
        let mut values = self.values.clone();
        if values.has("poisson") {
            values.give("poisson", Value::Number(poisson))?;
        }
        (self.entry.build)(&values)
    }
}

/// A law as the exact solutions take it, of these moduli at small strain: their energies are written out apart from the
/// solvers', and share the constants alone. A law that is not among them has solutions at small strain only.
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
    /// The share, between 0 and 1.
    pub g: f64,
    /// Its time in seconds, positive.
    pub tau: f64,
}
