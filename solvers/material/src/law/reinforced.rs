//! Laws of a matrix with families of fibres: `W = W_matrix + sum_i g_i(q_i)`,
//! `q_i = A_i : (C - I) = 2 A_i : E`.
//!
//! The symmetric structure tensor `A_i` is written in the axes fibre (1), sheet (2) and normal (3): `q` is
//! the squared stretch less one, `I4 - 1`, for `A = a x a`, and the shear `I8` between two directions for
//! their symmetric product. A law gives its matrix and the functions `g_i`.

use shape::{Matrix3, Vector3};

use super::of_strain::{OfStrain, Shape, StrainEnergy};
use crate::kinematics::volume_change;
use crate::material::{Material, Tangent};
use crate::split::{Split, flat};

/// Energy of a family of fibres at a strain.
pub(super) struct Family {
    /// Structure tensor `A`, symmetric.
    pub tensor: Matrix3,
    /// `g(q)` and its first and second derivative, Pa.
    pub energy: [f64; 3],
}

impl Family {
    /// Evaluates `g` at `q = 2 A : E`.
    pub fn new(tensor: Matrix3, E: &Matrix3, g: impl Fn(f64) -> [f64; 3]) -> Family {
        Family { energy: g(2.0 * tensor.dot(E)), tensor }
    }
}

/// Returns the structure tensor `(a x b + b x a) / 2` of two directions.
pub(super) fn tensor(a: &Vector3, b: &Vector3) -> Matrix3 {
    (a * b.transpose() + b * a.transpose()) * 0.5
}

/// Exponential energy `g = a/(2 b) (exp(b q^2) - 1)` with `a` in Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Exponential {
    pub a: f64,
    pub b: f64,
}

impl Exponential {
    /// Returns `g` and its first and second derivative.
    pub fn at(&self, q: f64) -> [f64; 3] {
        let Exponential { a, b } = *self;
        let grown = a * (b * q * q).exp();
        [0.5 * a / b * (b * q * q).exp_m1(), grown * q, grown * (1.0 + 2.0 * b * q * q)]
    }

    /// Returns [`Exponential::at`] in extension and zero in compression, in which fibres buckle. A body at
    /// rest has the stiffness of extension.
    pub fn in_extension(&self, q: f64) -> [f64; 3] {
        if q < 0.0 { [0.0; 3] } else { self.at(q) }
    }
}

/// A law of a matrix with fibres.
pub(super) trait Reinforced: Clone {
    /// Law of the matrix.
    type Matrix: Material;

    /// Whether the fibres see the isochoric strain `(J^(-2/3) C - I) / 2` in place of `E`.
    const ISOCHORIC: bool;

    /// Law of the matrix, with the volumetric energy.
    fn matrix(&self) -> &Self::Matrix;

    /// Returns the law with another matrix.
    fn with_matrix(&self, matrix: Self::Matrix) -> Self;

    /// Returns the energies of the families at the strain that they see.
    fn families(&self, E: &Matrix3) -> impl Iterator<Item = Family>;

    /// Whether the fibres do not all lie along the first axis.
    fn needs_sheets(&self) -> bool;

    /// Largest shear modulus that fibres in extension add at small strain, Pa: half the largest eigenvalue of
    /// their stiffness `sum 4 g''(0) A x A` among deviatoric strains.
    fn fibre_shear(&self) -> f64;
}

/// Energy of the fibres alone.
struct Fibres<'a, T>(&'a T);

impl<T: Reinforced> StrainEnergy for Fibres<'_, T> {
    fn shear(&self) -> f64 {
        self.0.fibre_shear()
    }

    fn of_strain(&self, E: &Matrix3, stiff: bool) -> OfStrain {
        let mut sum = OfStrain { energy: 0.0, stress: Matrix3::zeros(), stiffness: Tangent::zeros() };
        for Family { tensor, energy: [g, slope, second] } in self.0.families(E) {
            sum.energy += g;
            sum.stress += tensor * (2.0 * slope);
            if stiff && second != 0.0 {
                let of = flat(&tensor);
                sum.stiffness += of * of.transpose() * (4.0 * second);
            }
        }
        sum
    }
}

/// Returns the split of `F` that takes the volume change off it.
fn isochoric<T: Reinforced>(law: &T, H: &Matrix3) -> Split {
    Split::new(&Shape(&Fibres(law)), H, volume_change(H), 0.0)
}

/// Returns the energy `W`, J/m^3.
pub(super) fn energy<T: Reinforced>(law: &T, H: &Matrix3) -> f64 {
    let fibres = &Fibres(law);
    let of_fibres =
        if T::ISOCHORIC { isochoric(law, H).energy(&Shape(fibres)) } else { Shape(fibres).energy(H) };
    law.matrix().energy(H) + of_fibres
}

/// Returns the stress of [`energy`], Pa.
pub(super) fn stress<T: Reinforced>(law: &T, H: &Matrix3) -> Matrix3 {
    let fibres = &Fibres(law);
    let of_fibres =
        if T::ISOCHORIC { isochoric(law, H).first(&Shape(fibres)).by_F } else { Shape(fibres).stress(H) };
    law.matrix().stress(H) + of_fibres
}

/// Returns stress and tangent of [`energy`], Pa.
pub(super) fn stress_and_tangent<T: Reinforced>(law: &T, H: &Matrix3) -> (Matrix3, Tangent) {
    let fibres = &Fibres(law);
    let (P, tangent) = if T::ISOCHORIC {
        let (first, second) = isochoric(law, H).second(&Shape(fibres));
        (first.by_F, second.by_FF)
    } else {
        Shape(fibres).stress_and_tangent(H)
    };
    let (of_matrix, matrix_tangent) = law.matrix().stress_and_tangent(H);
    (of_matrix + P, matrix_tangent + tangent)
}

/// Implements [`Material`] for a law that is [`Reinforced`].
macro_rules! material_of_reinforced {
    ($law:ident) => {
        impl Material for $law {
            fn energy(&self, H: &Matrix3) -> f64 {
                reinforced::energy(self, H)
            }

            fn stress(&self, H: &Matrix3) -> Matrix3 {
                reinforced::stress(self, H)
            }

            fn tangent(&self, H: &Matrix3) -> Tangent {
                reinforced::stress_and_tangent(self, H).1
            }

            fn stress_and_tangent(&self, H: &Matrix3) -> (Matrix3, Tangent) {
                reinforced::stress_and_tangent(self, H)
            }

            fn without_volume(&self) -> Option<($law, Volumetric)> {
                let (matrix, volume) = self.matrix().split()?;
                Some((self.with_matrix(matrix), volume))
            }

            /// Fibres that see the whole strain change with the volume.
            fn split(&self) -> Option<($law, Volumetric)> {
                if $law::ISOCHORIC { self.without_volume() } else { None }
            }

            fn separated(&self, theta_minus_1: f64) -> Option<Separated> {
                if $law::ISOCHORIC { self.matrix().separated(theta_minus_1) } else { None }
            }

            fn has_axes(&self) -> bool {
                true
            }

            fn has_sheets(&self) -> bool {
                self.needs_sheets()
            }

            fn mu(&self) -> f64 {
                Material::mu(self.matrix()) + self.fibre_shear()
            }

            fn lambda(&self) -> f64 {
                Material::bulk(self.matrix()) - 2.0 / 3.0 * Material::mu(self)
            }
        }
    };
}
pub(super) use material_of_reinforced;
