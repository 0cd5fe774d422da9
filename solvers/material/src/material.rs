//! The interface of all laws.

use lanes::LANES;
use shape::Matrix3;

use crate::lane::{LaneStrain, Lanes};
use crate::separated::Separated;
use crate::volumetric::Volumetric;

/// Tangent `A = dP/dF`, (9, 9), Pa: entry `(i + 3 j, k + 3 l)` is `dP_ij / dF_kl`, with the column-major
/// index of a `Matrix3`.
pub type Tangent = nalgebra::SMatrix<f64, 9, 9>;

/// An elastic law, given by its energy per undeformed volume. A law that depends on directions is written in
/// the axes of its material: fibre, sheet and normal are the coordinate axes (see [`AtPoint`](crate::AtPoint)).
///
/// For `det F <= 0` the laws with a logarithm or a power of `J` (all except the linear and the St.
/// Venant-Kirchhoff law) return values that are not finite. Callers must check `J` first.
pub trait Material {
    /// Whether the law is valid only for small displacement gradients, rotations included.
    fn is_small_strain(&self) -> bool {
        false
    }

    /// Whether the law depends on directions of the material.
    fn has_axes(&self) -> bool {
        false
    }

    /// Whether the law distinguishes the sheet from the normal, so that the fibre alone does not define its
    /// axes.
    fn has_sheets(&self) -> bool {
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
        one_by_one(self, strain, p);
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

    /// Returns the law without its volumetric energy, and that energy. In contrast to [`Material::split`],
    /// the rest may still depend on `J`. `None` if no term of the energy is a function of `J` alone.
    fn without_volume(&self) -> Option<(Self, Volumetric)>
    where
        Self: Sized,
    {
        self.split()
    }

    /// Returns the dependence of the energy on a volume change `theta` in place of `J`, at `theta - 1`, for a
    /// law separable into shape and volume. `None` marks a law that is not separable, which only costs time.
    fn separated(&self, _theta_minus_1: f64) -> Option<Separated> {
        None
    }
}

/// Evaluates the scalar law lane by lane, for a law without vectorised code and beyond the range of its
/// series.
#[inline(always)]
pub(crate) fn one_by_one(law: &impl Material, x: &LaneStrain, p: &mut [Lanes; 9]) {
    for l in 0..LANES {
        let P = law.stress(&Matrix3::from_row_slice(&x.lane(l)));
        for k in 0..9 {
            p[k][l] = P[(k / 3, k % 3)];
        }
    }
}
