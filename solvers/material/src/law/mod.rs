//! The laws that a scene can name.
//!
//! Each law is a file with its energy, its derivatives and its [`Entry`], and a line in the list below.
//! Optional capabilities (lanes, a split into shape and volume) have defaults in [`Material`] that are
//! correct for any law but slower.

mod isochoric;
mod moduli;
mod of_strain;
mod reinforced;
mod straightening;
mod with_volumetric;

use catalogue::{Build, Entry, Problem, Value, Values};
use shape::Matrix3;

use crate::lane::{LaneStrain, Lanes};
use crate::material::{Material, Tangent};
use crate::separated::Separated;
use crate::volumetric::{Volumetric, VolumetricForm};

pub use with_volumetric::WithVolumetric;

/// A law that scene files can name.
pub type LawEntry = Entry<Build<Law>>;

/// Declares the files of the laws, the enum that dispatches to them without a call through a pointer, and the
/// slice of their entries.
macro_rules! laws {
    ($($file:ident::$law:ident,)*) => {
        $(
            mod $file;
            pub use $file::$law;
            impl From<$law> for Law {
                fn from(law: $law) -> Law {
                    Law::$law(law)
                }
            }
        )*

        /// A law chosen at run time.
        #[derive(Clone, Debug, PartialEq)]
        #[allow(missing_docs)] // each is its type
        pub enum Law {
            $($law($law),)*
            WithVolumetric(WithVolumetric<Law>),
        }

        /// Entries of all laws, in the order of tables.
        pub static LAWS: &[LawEntry] =
            &[$($file::ENTRY.built_by(|values| Ok(($file::ENTRY.build)(values)?.into()))),*];

        impl Law {
            /// Returns the name in scene files and tables, whatever the form of the volumetric energy.
            pub fn name(&self) -> &'static str {
                match self {
                    $(Law::$law(_) => $file::ENTRY.name,)*
                    Law::WithVolumetric(law) => law.rest().name(),
                }
            }
        }

        impl Material for Law {
            fn is_small_strain(&self) -> bool {
                match self {
                    $(Law::$law(law) => law.is_small_strain(),)*
                    Law::WithVolumetric(law) => law.is_small_strain(),
                }
            }

            fn energy(&self, H: &Matrix3) -> f64 {
                match self {
                    $(Law::$law(law) => law.energy(H),)*
                    Law::WithVolumetric(law) => law.energy(H),
                }
            }

            fn stress(&self, H: &Matrix3) -> Matrix3 {
                match self {
                    $(Law::$law(law) => law.stress(H),)*
                    Law::WithVolumetric(law) => law.stress(H),
                }
            }

            fn tangent(&self, H: &Matrix3) -> Tangent {
                match self {
                    $(Law::$law(law) => law.tangent(H),)*
                    Law::WithVolumetric(law) => law.tangent(H),
                }
            }

            fn stress_and_tangent(&self, H: &Matrix3) -> (Matrix3, Tangent) {
                match self {
                    $(Law::$law(law) => law.stress_and_tangent(H),)*
                    Law::WithVolumetric(law) => law.stress_and_tangent(H),
                }
            }

            #[inline(always)]
            fn stress_lanes<const FMA: bool>(&self, strain: &LaneStrain, p: &mut [Lanes; 9]) {
                match self {
                    $(Law::$law(law) => law.stress_lanes::<FMA>(strain, p),)*
                    Law::WithVolumetric(law) => law.stress_lanes::<FMA>(strain, p),
                }
            }

            #[inline(always)]
            fn stress_batch<const FMA: bool>(&self, strains: &[LaneStrain], p: &mut [[Lanes; 9]]) {
                match self {
                    $(Law::$law(law) => law.stress_batch::<FMA>(strains, p),)*
                    Law::WithVolumetric(law) => law.stress_batch::<FMA>(strains, p),
                }
            }

            fn split(&self) -> Option<(Law, Volumetric)> {
                match self {
                    $(Law::$law(law) => law.split().map(|(shape, volume)| (shape.into(), volume)),)*
                    Law::WithVolumetric(law) => {
                        law.rest().split().map(|(shape, _)| (shape, law.volume()))
                    }
                }
            }

            fn without_volume(&self) -> Option<(Law, Volumetric)> {
                match self {
                    $(Law::$law(law) => law.without_volume().map(|(rest, volume)| (rest.into(), volume)),)*
                    Law::WithVolumetric(law) => Some((law.rest().clone(), law.volume())),
                }
            }

            fn separated(&self, theta_minus_1: f64) -> Option<Separated> {
                match self {
                    $(Law::$law(law) => law.separated(theta_minus_1),)*
                    Law::WithVolumetric(law) => law.separated(theta_minus_1),
                }
            }

            fn has_axes(&self) -> bool {
                match self {
                    $(Law::$law(law) => law.has_axes(),)*
                    Law::WithVolumetric(law) => law.has_axes(),
                }
            }

            fn has_sheets(&self) -> bool {
                match self {
                    $(Law::$law(law) => law.has_sheets(),)*
                    Law::WithVolumetric(law) => law.has_sheets(),
                }
            }

            fn mu(&self) -> f64 {
                match self {
                    $(Law::$law(law) => Material::mu(law),)*
                    Law::WithVolumetric(law) => Material::mu(law),
                }
            }

            fn lambda(&self) -> f64 {
                match self {
                    $(Law::$law(law) => Material::lambda(law),)*
                    Law::WithVolumetric(law) => Material::lambda(law),
                }
            }
        }
    };
}

laws! {
    linear::LinearElastic,
    saint_venant_kirchhoff::SaintVenantKirchhoff,
    neo_hookean::NeoHookean,
    neo_hookean_isochoric::NeoHookeanIsochoric,
    hencky::Hencky,
    mooney_rivlin::MooneyRivlin,
    ogden::Ogden,
    fung_demiray::FungDemiray,
    gent::Gent,
    yeoh::Yeoh,
    polynomial::Polynomial,
    blatz_ko::BlatzKo,
    hyperfoam::Hyperfoam,
    corotational::Corotational,
    stable_neo_hookean::StableNeoHookean,
    guccione::Guccione,
    holzapfel_ogden::HolzapfelOgden,
    holzapfel_gasser_ogden::HolzapfelGasserOgden,
    trans_iso_mooney_rivlin::TransIsoMooneyRivlin,
    trans_iso_neo_hookean::TransIsoNeoHookean,
    porous_neo_hookean::PorousNeoHookean,
}

/// Shares of the shear modulus and exponents of a rubber in Ogden's law, for [`Law::all`].
pub(crate) const OGDEN: [(f64, f64); 3] = [(0.7, 1.3), (0.1, 5.0), (0.2, -2.0)];
/// Share of the second Mooney-Rivlin constant, for [`Law::all`].
pub(crate) const SECOND: f64 = 0.3;
/// Exponent of Demiray's law and limit of Gent's law, for [`Law::all`].
const STIFFENING: f64 = 0.2;
const LONGEST: f64 = 60.0;
/// Laws that [`Law::all`] leaves out: those of foams and porous solids, whose volumetric terms have the
/// power `nu / (1 - 2 nu)` of `J` and explode as the material becomes incompressible, and those that depend
/// on directions.
const OTHER_MODULI: [&str; 8] = [
    "blatz-ko",
    "hyperfoam",
    "guccione",
    "holzapfel-ogden",
    "holzapfel-gasser-ogden",
    "trans-iso-mooney-rivlin",
    "trans-iso-neo-hookean",
    "porous-neo-hookean",
];

impl Law {
    /// Returns the law with a volumetric energy of this form and its own bulk modulus. `None` if no term of
    /// its energy is a function of `J` alone.
    pub fn with_volumetric(self, form: VolumetricForm) -> Option<Law> {
        let (rest, Volumetric { form: own, bulk }) = self.without_volume()?;
        if own == form {
            return Some(self);
        }
        Some(Law::WithVolumetric(WithVolumetric::new(rest, Volumetric { form, bulk })))
    }

    /// Returns the isotropic laws, without those of foams, with the same moduli at small strain, in the order
    /// of tables, for tests of common properties. Parameters other than Young's modulus (Pa) and Poisson's
    /// ratio have their defaults, or values of a rubber.
    pub fn all(young: f64, poisson: f64) -> Result<Vec<Law>, Problem> {
        let hooke = LinearElastic::new(young, poisson)?;
        let sample = |entry: &LawEntry| {
            let mut values = Values::new(entry.parameters);
            let mut give =
                |name, value| if entry.parameter(name).is_some() { values.give(name, value) } else { Ok(()) };
            if entry.parameter("young").is_some() {
                give("young", Value::Number(young))?;
                give("poisson", Value::Number(poisson))?;
                give("share", Value::Number(SECOND))?;
                give("b", Value::Number(STIFFENING))?;
                give("jm", Value::Number(LONGEST))?;
            } else if entry.parameter("alpha").is_none() {
                let half = 0.5 * hooke.mu();
                give("poisson", Value::Number(poisson))?;
                give("c", Value::List(vec![half, 0.1 * half, 0.02 * half]))?;
                for (name, part) in [("c10", 0.8), ("c01", 0.2), ("c20", 0.1), ("c11", 0.05), ("c03", 0.01)] {
                    give(name, Value::Number(part * half))?;
                }
            } else {
                let mu = OGDEN.map(|(share, alpha)| 2.0 * share * hooke.mu() / alpha);
                give("mu", Value::List(mu.into()))?;
                give("alpha", Value::List(OGDEN.map(|(_, alpha)| alpha).into()))?;
                give("bulk", Value::Number(hooke.bulk()))?;
            }
            (entry.build)(&values)
        };
        LAWS.iter().filter(|entry| !OTHER_MODULI.contains(&entry.name)).map(sample).collect()
    }
}
