//! The laws that a scene can name.
//!
//! Each law is a file with its energy, its derivatives and its [`LawEntry`], and a line in the list below.
//! Optional capabilities (lanes, a split into shape and volume) have defaults in [`Material`] that are
//! correct for any law but slower.

use catalogue::{Dimension, Entry, Kind, Parameter, Problem, Range, Value, Values};
use shape::Matrix3;

use crate::lane::{LaneStrain, Lanes};
use crate::{Material, Separated, Tangent, Volumetric};

/// A law that scene files can name.
pub type LawEntry = Entry<fn(&Values) -> Result<Law, Problem>>;

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
        }

        /// Entries of all laws, in the order of tables.
        pub static LAWS: &[LawEntry] = &[$($file::ENTRY),*];

        impl Law {
            /// Returns the name in scene files and tables.
            pub fn name(&self) -> &'static str {
                match self {
                    $(Law::$law(_) => $file::ENTRY.name,)*
                }
            }
        }

        impl Material for Law {
            fn is_small_strain(&self) -> bool {
                match self {
                    $(Law::$law(law) => law.is_small_strain(),)*
                }
            }

            fn energy(&self, H: &Matrix3) -> f64 {
                match self {
                    $(Law::$law(law) => law.energy(H),)*
                }
            }

            fn stress(&self, H: &Matrix3) -> Matrix3 {
                match self {
                    $(Law::$law(law) => law.stress(H),)*
                }
            }

            fn tangent(&self, H: &Matrix3) -> Tangent {
                match self {
                    $(Law::$law(law) => law.tangent(H),)*
                }
            }

            fn stress_and_tangent(&self, H: &Matrix3) -> (Matrix3, Tangent) {
                match self {
                    $(Law::$law(law) => law.stress_and_tangent(H),)*
                }
            }

            #[inline(always)]
            fn stress_lanes<const FMA: bool>(&self, strain: &LaneStrain, p: &mut [Lanes; 9]) {
                match self {
                    $(Law::$law(law) => law.stress_lanes::<FMA>(strain, p),)*
                }
            }

            #[inline(always)]
            fn stress_batch<const FMA: bool>(&self, strains: &[LaneStrain], p: &mut [[Lanes; 9]]) {
                match self {
                    $(Law::$law(law) => law.stress_batch::<FMA>(strains, p),)*
                }
            }

            fn split(&self) -> Option<(Law, Volumetric)> {
                match self {
                    $(Law::$law(law) => law.split().map(|(shape, volume)| (shape.into(), volume)),)*
                }
            }

            fn separated(&self, theta_minus_1: f64) -> Option<Separated> {
                match self {
                    $(Law::$law(law) => law.separated(theta_minus_1),)*
                }
            }

            fn mu(&self) -> f64 {
                match self {
                    $(Law::$law(law) => Material::mu(law),)*
                }
            }

            fn lambda(&self) -> f64 {
                match self {
                    $(Law::$law(law) => Material::lambda(law),)*
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
}

const YOUNG: Parameter =
    Parameter::required("young", Dimension::Pressure, "Young's modulus; soft tissue has 1 to 100 kPa")
        .within(Range::Positive);
const POISSON: Parameter = Parameter::required(
    "poisson",
    Dimension::None,
    "Poisson's ratio; nearly incompressible tissue has 0.49 to 0.4999",
)
.within(Range::Between(-1.0, 0.5));
const BULK: Parameter =
    Parameter::required("bulk", Dimension::Pressure, "bulk modulus").within(Range::Positive);

/// Parameters of a law that is defined by its moduli at small strain.
const MODULI: &[Parameter] = &[YOUNG, POISSON];

/// Returns Young's modulus (Pa) and Poisson's ratio.
fn moduli(values: &Values) -> Result<(f64, f64), Problem> {
    Ok((values.number("young")?, values.number("poisson")?))
}

/// Shares of the shear modulus and exponents of a rubber in Ogden's law, for [`Law::all`].
pub(crate) const OGDEN: [(f64, f64); 3] = [(0.7, 1.3), (0.1, 5.0), (0.2, -2.0)];
/// Share of the second Mooney-Rivlin constant, for [`Law::all`].
pub(crate) const SECOND: f64 = 0.3;

impl Law {
    /// Returns every law with the same moduli at small strain, in the order of tables, for tests of common
    /// properties. Parameters other than Young's modulus (Pa) and Poisson's ratio have their defaults, or
    /// values of a rubber.
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
            } else {
                let mu = OGDEN.map(|(share, alpha)| 2.0 * share * hooke.mu() / alpha);
                give("mu", Value::List(mu.into()))?;
                give("alpha", Value::List(OGDEN.map(|(_, alpha)| alpha).into()))?;
                give("bulk", Value::Number(hooke.bulk()))?;
            }
            (entry.build)(&values)
        };
        LAWS.iter().map(sample).collect()
    }
}
