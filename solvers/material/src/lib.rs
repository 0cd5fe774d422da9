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

mod at_point;
mod differences;
mod error;
mod kinematics;
pub mod lane;
mod law;
mod material;
mod principal;
mod prony;
mod separated;
mod spectral;
pub mod split;
#[cfg(test)]
mod tests;
mod viscoelastic;
mod volumetric;

pub use at_point::AtPoint;
pub use differences::less_ln_1p;
pub use error::MaterialError;
pub use kinematics::volume_change;
pub use law::*;
pub use material::{Material, Tangent};
pub use prony::{Prony, PronyStep};
pub use separated::Separated;
pub use viscoelastic::{deviator, relaxed_stress_and_tangent};
pub use volumetric::{Volumetric, VolumetricForm};
