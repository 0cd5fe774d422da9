//! The laws that a scene can name.

use super::lane::{LaneStrain, Lanes};
use super::{
    Hencky, LinearElastic, Material, MooneyRivlin, NeoHookean, NeoHookeanIsochoric, Ogden,
    SaintVenantKirchhoff, Tangent, Volumetric,
};
use shape::Matrix3;

/// A law chosen at run time.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum Law {
    Linear(LinearElastic),
    SaintVenantKirchhoff(SaintVenantKirchhoff),
    NeoHookean(NeoHookean),
    NeoHookeanIsochoric(NeoHookeanIsochoric),
    Hencky(Hencky),
    MooneyRivlin(MooneyRivlin),
    Ogden(Ogden),
}

impl Law {
    /// Its name in scene files and tables.
    pub fn name(&self) -> &'static str {
        match self {
            Law::Linear(_) => "linear",
            Law::SaintVenantKirchhoff(_) => "saint-venant-kirchhoff",
            Law::NeoHookean(_) => "neo-hookean",
            Law::NeoHookeanIsochoric(_) => "neo-hookean-isochoric",
            Law::Hencky(_) => "hencky",
            Law::MooneyRivlin(_) => "mooney-rivlin",
            Law::Ogden(_) => "ogden",
        }
    }

    /// Whether the law holds for small displacement gradients only, rotations included.
    pub fn is_small_strain(&self) -> bool {
        matches!(self, Law::Linear(_))
    }
}

/// `$value` of the law inside; `$law` names its variant.
macro_rules! of_each {
    ($law:expr, $m:ident => $value:expr) => {
        of_each!($law, _variant, $m => $value)
    };
    ($law:expr, $variant:ident, $m:ident => $value:expr) => {
        of_each!(@ $law, $variant, $m => $value;
            Linear SaintVenantKirchhoff NeoHookean NeoHookeanIsochoric Hencky MooneyRivlin Ogden)
    };
    (@ $law:expr, $variant:ident, $m:ident => $value:expr; $($name:ident)*) => {
        match $law {
            $(Law::$name($m) => {
                #[allow(unused_variables)]
                let $variant = Law::$name;
                $value
            })*
        }
    };
}

impl Material for Law {
    fn energy(&self, H: &Matrix3) -> f64 {
        of_each!(self, m => Material::energy(m, H))
    }

    fn stress(&self, H: &Matrix3) -> Matrix3 {
        of_each!(self, m => Material::stress(m, H))
    }

    fn tangent(&self, H: &Matrix3) -> Tangent {
        of_each!(self, m => Material::tangent(m, H))
    }

    fn stress_and_tangent(&self, H: &Matrix3) -> (Matrix3, Tangent) {
        of_each!(self, m => Material::stress_and_tangent(m, H))
    }

    #[inline(always)]
    fn stress_lanes<const FMA: bool>(&self, strain: &LaneStrain, p: &mut [Lanes; 9]) {
        of_each!(self, m => Material::stress_lanes::<FMA>(m, strain, p))
    }

    #[inline(always)]
    fn stress_batch<const FMA: bool>(&self, strains: &[LaneStrain], p: &mut [[Lanes; 9]]) {
        of_each!(self, m => Material::stress_batch::<FMA>(m, strains, p))
    }

    fn split(&self) -> Option<(Law, Volumetric)> {
        of_each!(self, variant, m => Material::split(m).map(|(shape, volume)| (variant(shape), volume)))
    }

    fn mu(&self) -> f64 {
        of_each!(self, m => Material::mu(m))
    }

    fn lambda(&self) -> f64 {
        of_each!(self, m => Material::lambda(m))
    }
}
