//! Pointwise constitutive laws. A law takes a displacement gradient `H = grad u` and has no access to a mesh.
//!
//! Every law takes `H` instead of `F = I + H`: with `F`, a strain of 1e-10 keeps 6 digits; with `H` it keeps
//! all digits (here `E = (H + H^T + H^T H) / 2`, `J - 1 = tr H + II(H) + det H`, `ln J = log1p(J - 1)`).
//!
//! ```
//! use tissuebench_material::{Law, LinearElastic, Material, NeoHookean};
//! use shape::Matrix3;
//! # fn main() -> Result<(), tissuebench_material::MaterialError> {
//! // Young's modulus 20 kPa, Poisson's ratio 0.45.
//! let soft = Law::NeoHookean(NeoHookean::new(20e3, 0.45)?);
//! let linear = LinearElastic::new(20e3, 0.45)?;
//! let shear = |gamma| Matrix3::new(0.0, gamma, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
//! // Simple shear by a tenth: P_12 = mu gamma.
//! let P = soft.stress(&shear(0.1));
//! assert!((P[(0, 1)] - 0.1 * soft.mu()).abs() < 1e-9 * soft.mu());
//! // At small strain all laws agree.
//! assert!((soft.stress(&shear(1e-9)) - linear.stress(&shear(1e-9))).norm() < 1e-8 * 1e-9 * soft.mu());
//! # Ok(())
//! # }
//! ```

#![allow(non_snake_case)]

mod error;
mod kinematics;
pub mod lane;
mod law;
mod principal;
mod prony;
mod separated;
mod spectral;
#[cfg(test)]
mod tests;
mod viscoelastic;

pub use error::MaterialError;
pub use kinematics::{less_ln_1p, volume_change};
pub use law::*;
pub use prony::{Prony, PronyStep};
pub use separated::Separated;
pub use viscoelastic::{deviator, relaxed_stress_and_tangent};

use lane::{LaneStrain, Lanes};
use shape::Matrix3;

/// Tangent `A = dP/dF`, (9, 9), Pa: entry `(i + 3 j, k + 3 l)` is `dP_ij / dF_kl`, with the column-major
/// index of a `Matrix3`.
pub type Tangent = nalgebra::SMatrix<f64, 9, 9>;

/// An isotropic elastic law, given by its energy per undeformed volume.
///
/// For `det F <= 0` the laws with a logarithm or a power of `J` (all except the linear and the St.
/// Venant-Kirchhoff law) return values that are not finite. Callers must check `J` first.
pub trait Material {
    /// Whether the law is valid only for small displacement gradients, rotations included.
    fn is_small_strain(&self) -> bool {
        false
    }

    /// Returns the energy per undeformed volume `W(H)`, J/m^3.
    fn energy(&self, H: &Matrix3) -> f64;

    /// Returns the first Piola-Kirchhoff stress `P = dW/dF`, (3, 3), Pa.
    fn stress(&self, H: &Matrix3) -> Matrix3;

    /// Returns the symmetric tangent `dP/dF`, (9, 9), Pa.
    fn tangent(&self, H: &Matrix3) -> Tangent;

    /// Returns stress and tangent; common quantities are computed once.
    fn stress_and_tangent(&self, H: &Matrix3) -> (Matrix3, Tangent) {
        (self.stress(H), self.tangent(H))
    }

    /// Returns the shear modulus in the limit of small strain, Pa.
    fn mu(&self) -> f64;

    /// Returns the first Lame modulus in the limit of small strain, Pa.
    fn lambda(&self) -> f64;

    /// Returns the bulk modulus in the limit of small strain, `lambda + 2 mu / 3`, Pa.
    fn bulk(&self) -> f64 {
        self.lambda() + 2.0 / 3.0 * self.mu()
    }

    /// Computes [`Material::stress`] of eight points, with `P_ij` at [3 i + j], Pa, by straight-line
    /// arithmetic, fused if `FMA`. A law without vectorised code is evaluated point by point.
    #[inline(always)]
    fn stress_lanes<const FMA: bool>(&self, strain: &LaneStrain, p: &mut [Lanes; 9])
    where
        Self: Sized,
    {
        lane::one_by_one(self, strain, p);
    }

    /// Computes [`Material::stress_lanes`] of many groups of eight points; laws with a long dependency chain
    /// overlap several groups.
    #[inline(always)]
    fn stress_batch<const FMA: bool>(&self, strains: &[LaneStrain], p: &mut [[Lanes; 9]])
    where
        Self: Sized,
    {
        for (strain, p) in strains.iter().zip(p) {
            self.stress_lanes::<FMA>(strain, p);
        }
    }

    /// Splits the law into a part without volumetric energy and the volumetric energy. The result is `None`
    /// unless the energy is a sum of the two and the first part does not depend on `J`. A shared dilation
    /// then acts only on the second part.
    fn split(&self) -> Option<(Self, Volumetric)>
    where
        Self: Sized,
    {
        None
    }

    /// Returns the dependence of the energy on a volume change `theta` in place of `J`, at `theta - 1`, for a
    /// law separable into shape and volume. `None` marks a law that is not separable, which only costs time.
    fn separated(&self, _theta_minus_1: f64) -> Option<Separated> {
        None
    }
}

/// Volumetric energy `quadratic / 2 (J - 1)^2 + logarithmic / 2 (ln J)^2`; moduli in Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Volumetric {
    pub quadratic: f64,
    pub logarithmic: f64,
}
