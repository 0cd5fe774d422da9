//! Neo-Hookean law of a porous solid whose pores can close but not vanish.

use catalogue::{Build, Dimension, Entry, Parameter, Range};
use shape::Matrix3;

use super::moduli::YOUNG;
use crate::differences::exp_m1_less;
use crate::error::MaterialError;
use crate::kinematics::{Kinematics, tangent_of};
use crate::material::{Material, Tangent};

/// Porous neo-Hookean law `W = mu/2 (R I1 - 3 - 2 ln Jp)` with the volume ratio of the pores
/// `Jp = (J - phi) / (1 - phi)`, `R = (Jp / J)^(2/3)` and the solid fraction `phi`; `mu` in Pa.
///
/// It is the neo-Hookean law without `lambda` of the deformation whose volume ratio is `Jp`: the stress
/// grows without limit as `J` falls to `phi`. With `phi = 0` it is that law itself. Young's modulus is `6
/// mu / (2 + (1 - phi)^2)`. Source: FEBio User Manual, Porous Neo-Hookean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PorousNeoHookean {
    mu: f64,
    solid: f64,
}

pub(super) const ENTRY: Entry<Build<PorousNeoHookean>> = Entry {
    name: "porous-neo-hookean",
    meaning: "mu/2 (R I1 - 3 - 2 ln Jp), Jp = (J - solid) / (1 - solid), R = (Jp / J)^(2/3), mu = young (2 + (1 - solid)^2) / 6",
    source: "FEBio User Manual, Porous Neo-Hookean",
    parameters: &[
        YOUNG,
        Parameter::required("solid", Dimension::None, "fraction of the solid in the undeformed volume")
            .within(Range::NotNegative),
    ],
    build: |values| Ok(PorousNeoHookean::new(values.number("young")?, values.number("solid")?)?),
};

/// Quantities of a state.
struct State {
    k: Kinematics,
    /// `J - phi`, the volume of the pores per undeformed volume.
    pores: f64,
    /// `R - 1`.
    scale: f64,
    /// `R I1 / 3 - 1`.
    grown: f64,
    /// `ln(R I1 / 3)`.
    log: f64,
}

impl PorousNeoHookean {
    /// Builds the law from Young's modulus (Pa, positive) and the fraction of the solid (0 to below 1).
    ///
    /// # Errors
    /// A constant out of its range.
    pub fn new(young: f64, solid: f64) -> Result<PorousNeoHookean, MaterialError> {
        if !(young > 0.0 && young.is_finite()) {
            return Err(MaterialError::Young { young });
        }
        MaterialError::check_range("solid", solid, (0.0..1.0).contains(&solid), "0 to below 1")?;
        let pores = 1.0 - solid;
        Ok(PorousNeoHookean { mu: young * (2.0 + pores * pores) / 6.0, solid })
    }

    fn state(&self, H: &Matrix3) -> State {
        let k = Kinematics::new(H);
        let pores = 1.0 - self.solid;
        let ln_pores = (k.j / pores).ln_1p();
        let log = k.ln_i1_bar() + 2.0 / 3.0 * ln_pores;
        let scale = (2.0 / 3.0 * (ln_pores - k.ln_j())).exp_m1();
        State { pores: pores + k.j, scale, grown: log.exp_m1(), log, k }
    }
}

impl Material for PorousNeoHookean {
    /// `3/2 (R I1/3 - 1) - ln Jp = 3/2 (exp(y) - 1 - y) + 3/2 ln(J^(-2/3) I1 / 3)` with `y = ln(R I1 / 3)`:
    /// the first-order terms cancel and are left out.
    fn energy(&self, H: &Matrix3) -> f64 {
        let state = self.state(H);
        1.5 * self.mu * (exp_m1_less(state.log) + state.k.ln_i1_bar())
    }

    /// Returns `mu R F + s G` with `G = F^-T` and `s = mu (phi (R I1/3 - 1) / (J - phi) - 1)`.
    fn stress(&self, H: &Matrix3) -> Matrix3 {
        let State { k, pores, scale, grown, .. } = self.state(H);
        (k.F_less_G + k.F * scale + k.G * (self.solid * grown / pores)) * self.mu
    }

    /// Returns `mu R I + 2/3 mu R phi / (J - phi) (F x G + G x F) + J ds/dJ G x G - s G_il G_kj`.
    fn tangent(&self, H: &Matrix3) -> Tangent {
        let State { k, pores, scale, grown, .. } = self.state(H);
        let (F, G, J, R) = (&k.F, &k.G, 1.0 + k.j, 1.0 + scale);
        let s = self.mu * (self.solid * grown / pores - 1.0);
        let mixed = 2.0 / 3.0 * self.mu * R * self.solid / pores;
        // The slope of R I1/3 over J is 2/3 phi / (J (J - phi)) times itself.
        let slope = self.mu * (2.0 / 3.0 * self.solid * self.solid * (1.0 + grown) / pores - J) - s * J;
        let outer = slope / pores;
        let mut tangent = tangent_of(|i, j, k, l| {
            mixed * (F[(i, j)] * G[(k, l)] + G[(i, j)] * F[(k, l)]) + outer * G[(i, j)] * G[(k, l)]
                - s * G[(i, l)] * G[(k, j)]
        });
        for n in 0..9 {
            tangent[(n, n)] += self.mu * R;
        }
        tangent
    }

    fn mu(&self) -> f64 {
        self.mu
    }

    fn lambda(&self) -> f64 {
        2.0 / 3.0 * self.mu * ((1.0 - self.solid).powi(-2) - 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::NeoHookean;

    #[test]
    fn without_solid_it_is_the_neo_hookean_law_of_poissons_ratio_0() {
        let H = Matrix3::new(0.2, 0.1, -0.05, 0.0, -0.1, 0.2, 0.3, 0.0, 0.15);
        let (law, plain) = (PorousNeoHookean::new(3e3, 0.0).unwrap(), NeoHookean::new(3e3, 0.0).unwrap());
        assert!((law.energy(&H) - plain.energy(&H)).abs() < 1e-14 * 3e3);
        assert!((law.stress(&H) - plain.stress(&H)).norm() < 1e-13 * 3e3);
    }

    /// `sigma = mu R / J (l^2 + phi I1/3 / (J - phi)) - mu / (J - phi)` of a stretch l with the sides held.
    #[test]
    fn a_held_bar_has_the_stress_of_the_formula() {
        let (mu, phi) = (3e3 * (2.0 + 0.64) / 6.0, 0.2);
        let law = PorousNeoHookean::new(3e3, phi).unwrap();
        for l in [0.4_f64, 0.9, 1.3] {
            let H = Matrix3::from_diagonal(&shape::Vector3::new(l - 1.0, 0.0, 0.0));
            let R = ((l - phi) / (0.8 * l)).powf(2.0 / 3.0);
            let expected = mu * R / l * (l * l + phi * (l * l + 2.0) / 3.0 / (l - phi)) - mu / (l - phi);
            // With the sides held the nominal stress along the bar is the Cauchy stress.
            let found = law.stress(&H)[(0, 0)];
            assert!((found - expected).abs() < 1e-12 * mu, "{l}: {found} {expected}");
        }
    }

    #[test]
    fn bad_constants_are_refused() {
        assert!(PorousNeoHookean::new(0.0, 0.1).is_err());
        for solid in [-0.1, 1.0, f64::NAN] {
            assert!(PorousNeoHookean::new(1.0, solid).unwrap_err().to_string().contains("solid is"), "{solid}");
        }
    }
}
