//! Guccione's law of the passive heart wall.

use catalogue::{Build, Dimension, Entry, Parameter, Range};
use shape::Matrix3;

use super::moduli::BULK;
use super::of_strain::{self, Anisotropic, OfStrain, StrainEnergy, material_of_strain};
use crate::error::MaterialError;
use crate::differences::exp_m1_less;
use crate::material::{Material, Tangent};
use crate::separated::Separated;
use crate::split::flat;
use crate::volumetric::Volumetric;

/// Guccione's law `W = c/2 (exp(Q) - 1) + kappa/2 (J - 1)^2` with
/// `Q = bf Eff^2 + bt (Ess^2 + Enn^2 + 2 Esn^2) + 2 bfs (Efs^2 + Efn^2)`; `c` in Pa.
///
/// `E = (J^(-2/3) C - I) / 2` is the isochoric strain in the axes fibre, sheet and normal; the law is
/// transversely isotropic about the fibre. Source: Guccione, McCulloch and Waldman, J. Biomech. Eng. 113
/// (1991) 42-55.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guccione {
    c: f64,
    /// `bf`, `bt`, `bfs`.
    b: [f64; 3],
    bulk: f64,
}

pub(super) const ENTRY: Entry<Build<Guccione>> = Entry {
    name: "guccione",
    meaning: "c/2 (exp(Q) - 1) + kappa/2 (J - 1)^2, Q = bf Eff^2 + bt (Ess^2 + Enn^2 + 2 Esn^2) + 2 bfs (Efs^2 + Efn^2): takes fibers",
    source: "Guccione, McCulloch and Waldman, J. Biomech. Eng. 113 (1991) 42-55",
    parameters: &[
        Parameter::required("c", Dimension::Pressure, "constant").within(Range::Positive),
        Parameter::required("bf", Dimension::None, "exponent along the fibre").within(Range::Positive),
        Parameter::required("bt", Dimension::None, "exponent across the fibre").within(Range::Positive),
        Parameter::required("bfs", Dimension::None, "exponent of shear along the fibre").within(Range::Positive),
        BULK,
    ],
    build: |values| {
        let c = values.number("c")?;
        let b = [values.number("bf")?, values.number("bt")?, values.number("bfs")?];
        Ok(Guccione::new(c, b, values.number("bulk")?)?)
    },
};

impl Guccione {
    /// Builds the law from `c` (Pa, positive), the exponents `bf`, `bt` and `bfs` (positive) and the bulk
    /// modulus (Pa, positive).
    pub fn new(c: f64, b: [f64; 3], bulk: f64) -> Result<Guccione, MaterialError> {
        for (name, value) in [("c", c), ("bf", b[0]), ("bt", b[1]), ("bfs", b[2])] {
            MaterialError::check_positive(name, value)?;
        }
        MaterialError::check_moduli(c, bulk)?;
        Ok(Guccione { c, b, bulk })
    }

    /// Exponent of the component `E_ij`.
    fn exponent(&self, i: usize, j: usize) -> f64 {
        let [along, across, shear] = self.b;
        match (i, j) {
            (0, 0) => along,
            (0, _) | (_, 0) => shear,
            _ => across,
        }
    }
}

impl Anisotropic for Guccione {
    fn kappa(&self) -> f64 {
        self.bulk
    }

    fn of_shape(&self) -> Guccione {
        Guccione { bulk: 0.0, ..*self }
    }
}

impl StrainEnergy for Guccione {
    fn shear(&self) -> f64 {
        0.5 * self.c * self.b.into_iter().fold(0.0, f64::max)
    }

    fn of_strain(&self, E: &Matrix3, stiff: bool) -> OfStrain {
        let weighted = Matrix3::from_fn(|i, j| self.exponent(i, j) * E[(i, j)]);
        let Q = weighted.dot(E);
        let factor = self.c * Q.exp();
        let mut stiffness = Tangent::zeros();
        if stiff {
            let of = flat(&weighted);
            stiffness = of * of.transpose() * (2.0 * factor);
            for j in 0..3 {
                for i in 0..3 {
                    stiffness[(i + 3 * j, i + 3 * j)] += factor * self.exponent(i, j);
                }
            }
        }
        OfStrain { energy: 0.5 * self.c * (Q + exp_m1_less(Q)), stress: weighted * factor, stiffness }
    }
}

material_of_strain!(Guccione);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bar_along_the_fibre_has_the_stress_of_the_formula() {
        // Incompressible uniaxial stretch l along the fibre: E = diag(l^2 - 1, 1/l - 1, 1/l - 1) / 2, and the
        // Cauchy stress differs by l^2 S_11 - S_22 / l between the directions.
        let law = Guccione::new(2e3, [8.0, 2.0, 4.0], 1e7).unwrap();
        let l = 1.15f64;
        let side = l.powf(-0.5);
        let F = Matrix3::from_diagonal(&shape::Vector3::new(l, side, side));
        let P = law.stress(&(F - Matrix3::identity()));
        let sigma = P * F.transpose();
        let (a, t) = (0.5 * (l * l - 1.0), 0.5 * (1.0 / l - 1.0));
        let factor = 2e3 * (8.0 * a * a + 4.0 * t * t).exp();
        let expected = factor * (8.0 * a * l * l - 2.0 * t / l);
        assert!((sigma[(0, 0)] - sigma[(1, 1)] - expected).abs() < 1e-9 * expected);
    }

    #[test]
    fn bad_constants_are_refused() {
        assert!(Guccione::new(2e3, [8.0, 0.0, 4.0], 1e6).unwrap_err().to_string().contains("bt is 0"));
        assert!(Guccione::new(-1.0, [8.0, 2.0, 4.0], 1e6).is_err());
        assert!(Guccione::new(2e3, [8.0, 2.0, 4.0], f64::NAN).is_err());
    }
}
