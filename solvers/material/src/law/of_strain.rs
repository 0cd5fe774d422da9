//! Laws of the isochoric Green-Lagrange strain in the axes of the material:
//! `W = f(E) + kappa/2 (J - 1)^2` with `E = (J^(-2/3) C - I) / 2`.
//!
//! A law gives `f` with its derivatives. It may depend on the directions fibre (1), sheet (2) and normal (3).

use shape::Matrix3;

use crate::kinematics::{green_lagrange, volume_change};
use crate::material::{Material, Tangent};
use crate::split::{Split, add_dilation_hessian, cofactor, flat};

/// Energy of a strain `E` in the axes of the material, with its derivatives.
pub(super) struct OfStrain {
    /// `f(E)`, J/m^3.
    pub energy: f64,
    /// `S = df/dE` (3, 3), symmetric, Pa.
    pub stress: Matrix3,
    /// `d2f/dE2` (9, 9), Pa, with the index of [`Tangent`].
    pub stiffness: Tangent,
}

/// An energy `f(E)`.
pub(super) trait StrainEnergy {
    /// Largest shear modulus at small strain, Pa.
    fn shear(&self) -> f64;

    /// Computes `f` and its derivatives; the stiffness is left zero unless `stiff`.
    fn of_strain(&self, E: &Matrix3, stiff: bool) -> OfStrain;
}

/// A law of the isochoric strain.
pub(super) trait Anisotropic: StrainEnergy + Clone {
    /// Bulk modulus `kappa`, Pa.
    fn kappa(&self) -> f64;

    /// Returns the law without its volumetric energy.
    fn of_shape(&self) -> Self;
}

/// The function `f(E(F))` of an energy of the strain, as a law of its own.
pub(super) struct Shape<'a, T>(pub &'a T);

impl<T: StrainEnergy> Material for Shape<'_, T> {
    fn energy(&self, H: &Matrix3) -> f64 {
        self.0.of_strain(&green_lagrange(H), false).energy
    }

    fn stress(&self, H: &Matrix3) -> Matrix3 {
        let S = self.0.of_strain(&green_lagrange(H), false).stress;
        S + H * S
    }

    fn tangent(&self, H: &Matrix3) -> Tangent {
        self.stress_and_tangent(H).1
    }

    /// Returns `P = F S` and `dP_ij/dF_ml = delta_im S_jl + F_ip C_pjkl F_mk` with the stiffness `C`.
    fn stress_and_tangent(&self, H: &Matrix3) -> (Matrix3, Tangent) {
        let F = Matrix3::identity() + H;
        let OfStrain { stress: S, stiffness: C, .. } = self.0.of_strain(&green_lagrange(H), true);
        let mut tangent = Tangent::zeros();
        for j in 0..3 {
            for l in 0..3 {
                // A symmetric change of E meets both (k, l) and (l, k).
                let of =
                    Matrix3::from_fn(|p, k| 0.5 * (C[(p + 3 * j, k + 3 * l)] + C[(p + 3 * j, l + 3 * k)]));
                let block = F * of * F.transpose() + Matrix3::identity() * S[(j, l)];
                for i in 0..3 {
                    for m in 0..3 {
                        tangent[(i + 3 * j, m + 3 * l)] = block[(i, m)];
                    }
                }
            }
        }
        (S + H * S, tangent)
    }

    fn mu(&self) -> f64 {
        self.0.shear()
    }

    fn lambda(&self) -> f64 {
        -2.0 / 3.0 * self.0.shear()
    }
}

/// Returns the split of `F` with the volume of the undeformed state.
fn isochoric<T: Anisotropic>(law: &T, H: &Matrix3) -> (Split, f64) {
    let j = volume_change(H);
    (Split::new(&Shape(law), H, j, 0.0), j)
}

/// Returns `f + kappa/2 (J - 1)^2`.
pub(super) fn energy(law: &impl Anisotropic, H: &Matrix3) -> f64 {
    let (split, j) = isochoric(law, H);
    split.energy(&Shape(law)) + 0.5 * law.kappa() * j * j
}

/// Returns the stress of [`energy`].
pub(super) fn stress(law: &impl Anisotropic, H: &Matrix3) -> Matrix3 {
    let (split, j) = isochoric(law, H);
    split.first(&Shape(law)).by_F + cofactor(false, H) * (law.kappa() * j)
}

/// Returns stress and tangent of [`energy`].
pub(super) fn stress_and_tangent(law: &impl Anisotropic, H: &Matrix3) -> (Matrix3, Tangent) {
    let (split, j) = isochoric(law, H);
    let (first, second) = split.second(&Shape(law));
    let cof = cofactor(false, H);
    let volume = flat(&cof);
    let mut tangent = second.by_FF + volume * volume.transpose() * law.kappa();
    add_dilation_hessian(false, H, law.kappa() * j, &mut tangent);
    (first.by_F + cof * (law.kappa() * j), tangent)
}

/// Implements [`Material`] for a law that is [`Anisotropic`].
macro_rules! material_of_strain {
    ($law:ident) => {
        impl Material for $law {
            fn energy(&self, H: &Matrix3) -> f64 {
                of_strain::energy(self, H)
            }

            fn stress(&self, H: &Matrix3) -> Matrix3 {
                of_strain::stress(self, H)
            }

            fn tangent(&self, H: &Matrix3) -> Tangent {
                of_strain::stress_and_tangent(self, H).1
            }

            fn stress_and_tangent(&self, H: &Matrix3) -> (Matrix3, Tangent) {
                of_strain::stress_and_tangent(self, H)
            }

            fn split(&self) -> Option<($law, Volumetric)> {
                Some((self.of_shape(), Volumetric::quadratic(self.kappa())))
            }

            fn separated(&self, theta_minus_1: f64) -> Option<Separated> {
                Some(Separated::of_volume(Volumetric::quadratic(self.kappa()), theta_minus_1))
            }

            fn has_axes(&self) -> bool {
                true
            }

            fn mu(&self) -> f64 {
                self.shear()
            }

            fn lambda(&self) -> f64 {
                self.kappa() - 2.0 / 3.0 * self.shear()
            }
        }
    };
}
pub(super) use material_of_strain;
