//! Volumetric energies `U(J)`.

use crate::differences::less_ln_1p;

/// Form of a volumetric energy. All forms have the bulk modulus `kappa` at small strain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VolumetricForm {
    /// `kappa/2 (J - 1)^2`, as in Abaqus and CalculiX.
    Quadratic,
    /// `kappa/2 (ln J)^2`, as in the uncoupled laws of FEBio.
    Logarithmic,
    /// `kappa/4 (J^2 - 1 - 2 ln J)`, which resists both `J -> 0` and `J -> infinity`. Source: Simo and
    /// Taylor, Comput. Methods Appl. Mech. Eng. 85 (1991) 273-310.
    SimoTaylor,
}

/// Volumetric energy of a law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Volumetric {
    /// Form of the energy.
    pub form: VolumetricForm,
    /// Bulk modulus `kappa`, Pa.
    pub bulk: f64,
}

impl Volumetric {
    /// Energy `kappa/2 (J - 1)^2` with the bulk modulus (Pa).
    pub fn quadratic(bulk: f64) -> Volumetric {
        Volumetric { form: VolumetricForm::Quadratic, bulk }
    }

    /// Energy `kappa/2 (ln J)^2` with the bulk modulus (Pa).
    pub fn logarithmic(bulk: f64) -> Volumetric {
        Volumetric { form: VolumetricForm::Logarithmic, bulk }
    }

    /// Returns `U`, `dU/dJ` and `d2U/dJ2` (Pa) at `J - 1`. They are NaN for `J < 0` in the forms with a
    /// logarithm.
    pub fn derivatives(&self, j_minus_1: f64) -> [f64; 3] {
        let (kappa, j) = (self.bulk, j_minus_1);
        let J = 1.0 + j;
        match self.form {
            VolumetricForm::Quadratic => [0.5 * kappa * j * j, kappa * j, kappa],
            VolumetricForm::Logarithmic => {
                let log = j.ln_1p();
                [0.5 * log * log, log / J, (1.0 - log) / (J * J)].map(|u| kappa * u)
            }
            // J^2 - 1 - 2 ln J = j^2 + 2 (j - ln J) and J - 1/J = j (1 + J) / J.
            VolumetricForm::SimoTaylor => {
                [0.25 * (j * j + 2.0 * less_ln_1p(j)), 0.5 * j * (1.0 + J) / J, 0.5 * (1.0 + 1.0 / (J * J))]
                    .map(|u| kappa * u)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_are_those_of_the_formulas() {
        let kappa = 3e5;
        for J in [0.6_f64, 0.999, 1.0, 1.3, 2.5] {
            let log = J.ln();
            for (form, expected) in [
                (VolumetricForm::Quadratic, [0.5 * (J - 1.0).powi(2), J - 1.0, 1.0]),
                (VolumetricForm::Logarithmic, [0.5 * log * log, log / J, (1.0 - log) / (J * J)]),
                (
                    VolumetricForm::SimoTaylor,
                    [0.25 * (J * J - 1.0 - 2.0 * log), 0.5 * (J - 1.0 / J), 0.5 * (1.0 + 1.0 / (J * J))],
                ),
            ] {
                let found = Volumetric { form, bulk: kappa }.derivatives(J - 1.0);
                for (found, expected) in found.iter().zip(expected) {
                    assert!((found - kappa * expected).abs() < 1e-14 * kappa, "{form:?} {J}: {found}");
                }
            }
        }
    }

    #[test]
    fn small_volume_changes_keep_their_digits() {
        for form in [VolumetricForm::Quadratic, VolumetricForm::Logarithmic, VolumetricForm::SimoTaylor] {
            let [U, slope, second] = Volumetric { form, bulk: 2.0 }.derivatives(1e-12);
            assert!(
                (U - 1e-24).abs() < 1e-35 && (slope - 2e-12).abs() < 1e-23 && (second - 2.0).abs() < 1e-11
            );
        }
    }
}
