//! Compressible neo-Hookean matrix with one family of fibres that straighten.

use catalogue::{Build, Entry};
use shape::{Matrix3, Vector3};

use super::moduli::{MODULI, moduli};
use super::neo_hookean::NeoHookean;
use super::reinforced::{self, Family, Reinforced, material_of_reinforced, tensor};
use super::straightening::{FIBRES, Straightening, fibres};
use crate::error::MaterialError;
use crate::material::{Material, Tangent};
use crate::separated::Separated;
use crate::volumetric::Volumetric;

/// Transversely isotropic neo-Hookean law `W = mu/2 (I1 - 3 - 2 ln J) + lambda/2 (ln J)^2 + F2(l)` with the
/// stretch `l = |F f|` of the fibre and the energy `F2` of fibres that straighten; moduli of the matrix in
/// Pa.
///
/// The fibres see the whole stretch. Shape and volume are not split. Sources: Weiss, Maker and Govindjee,
/// Comput. Methods Appl. Mech. Eng. 135 (1996) 107-128; FEBio User Manual, Coupled Transversely Isotropic
/// Mooney-Rivlin, for c2 = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransIsoNeoHookean {
    matrix: NeoHookean,
    fibre: Straightening,
}

pub(super) const ENTRY: Entry<Build<TransIsoNeoHookean>> = Entry {
    name: "trans-iso-neo-hookean",
    meaning: "mu/2 (I1 - 3 - 2 ln J) + lambda/2 (ln J)^2 + F2(l), l dF2/dl = c3 (exp(c4 (l - 1)) - 1) for l < lm, c5 l + c6 beyond, only where l > 1: takes fibers",
    source: "Weiss, Maker and Govindjee, Comput. Methods Appl. Mech. Eng. 135 (1996) 107-128; FEBio User Manual, Coupled Transversely Isotropic Mooney-Rivlin",
    parameters: &[MODULI[0], MODULI[1], FIBRES[0], FIBRES[1], FIBRES[2], FIBRES[3]],
    build: |values| {
        let ((young, poisson), (constants, lm)) = (moduli(values)?, fibres(values)?);
        Ok(TransIsoNeoHookean::new([young, poisson], constants, lm)?)
    },
};

impl TransIsoNeoHookean {
    /// Builds the law from Young's modulus (Pa, positive) and Poisson's ratio (-1 < nu < 0.5) of the
    /// matrix, the constants `c3` (Pa, zero or more), `c4` (positive) and `c5` (Pa, zero or more) of the
    /// fibres, and the stretch `lm` (1 or more) at which they are straight.
    ///
    /// # Errors
    /// A constant out of its range.
    pub fn new(
        [young, poisson]: [f64; 2],
        constants: [f64; 3],
        lm: f64,
    ) -> Result<TransIsoNeoHookean, MaterialError> {
        let matrix = NeoHookean::new(young, poisson)?;
        Ok(TransIsoNeoHookean { matrix, fibre: Straightening::new(constants, lm)? })
    }
}

impl Reinforced for TransIsoNeoHookean {
    type Matrix = NeoHookean;

    const ISOCHORIC: bool = false;

    fn matrix(&self) -> &NeoHookean {
        &self.matrix
    }

    fn with_matrix(&self, matrix: NeoHookean) -> TransIsoNeoHookean {
        TransIsoNeoHookean { matrix, ..*self }
    }

    fn families(&self, E: &Matrix3) -> impl Iterator<Item = Family> {
        let f = Vector3::x();
        [Family::new(tensor(&f, &f), E, |q| self.fibre.at(q))].into_iter()
    }

    fn needs_sheets(&self) -> bool {
        false
    }

    fn fibre_shear(&self) -> f64 {
        self.fibre.shear()
    }
}

material_of_reinforced!(TransIsoNeoHookean);

#[cfg(test)]
mod tests {
    use super::*;

    /// `sigma_11 J = mu (l^2 - 1) + lambda ln J + l dF2/dl` of a stretch along the fibre, with the sides
    /// held.
    #[test]
    fn a_held_bar_along_the_fibre_has_the_stress_of_the_formula() {
        let law = TransIsoNeoHookean::new([3e3, 0.25], [2e3, 4.0, 9e3], 1.2).unwrap();
        let pull = |l: f64| 2e3 * (4.0 * (l - 1.0)).exp_m1();
        for (l, pulled) in [(0.9_f64, 0.0), (1.1, pull(1.1)), (1.3, 9e3 * 0.1 + pull(1.2))] {
            let H = Matrix3::from_diagonal(&Vector3::new(l - 1.0, 0.0, 0.0));
            let expected = 1.2e3 * (l * l - 1.0) + 1.2e3 * l.ln() + pulled;
            let found = law.stress(&H)[(0, 0)] * l;
            assert!((found - expected).abs() < 1e-12 * expected.abs(), "{l}: {found} {expected}");
        }
    }

    #[test]
    fn bad_constants_are_refused() {
        let refused = |e, c, lm| TransIsoNeoHookean::new(e, c, lm).unwrap_err().to_string();
        assert!(refused([1.0, 0.6], [1.0; 3], 1.1).contains("0.6"));
        assert!(refused([1.0, 0.2], [1.0, 0.0, 1.0], 1.1).contains("c4 is 0"));
        assert!(refused([1.0, 0.2], [1.0; 3], 0.9).contains("lm is 0.9"));
    }
}
