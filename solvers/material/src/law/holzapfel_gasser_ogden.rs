//! Holzapfel, Gasser and Ogden's law of arterial walls.

use catalogue::{Build, Dimension, Entry, Parameter, Range};
use shape::{Matrix3, Vector3};

use super::moduli::BULK;
use super::mooney_rivlin::MooneyRivlin;
use super::reinforced::{self, Exponential, Family, Reinforced, material_of_reinforced, tensor};
use crate::error::MaterialError;
use crate::material::{Material, Tangent};
use crate::separated::Separated;
use crate::volumetric::Volumetric;

/// Holzapfel, Gasser and Ogden's law of two families of dispersed fibres: `c` and `k1` in Pa, `k2` and the
/// dispersion `d` (`kappa` in the paper) without unit.
///
/// ```text
/// W = c/2 (J^(-2/3) I1 - 3) + kappa/2 (J - 1)^2 + k1/(2 k2) sum_(i = 1, 2) (exp(k2 Ei^2) - 1)
/// Ei = d (I1 - 3) + (1 - 3 d) (I4i - 1)     only where Ei > 0
/// ```
///
/// The families lie at `+angle` and `-angle` from the fibre towards the sheet. In an artery the fibre is the
/// circumferential direction, the sheet the axial one. With `d = 0` all fibres of a family are parallel; with
/// `d = 1/3` they have no direction. At `angle = 0` the families coincide, so their constants add up.
///
/// `I1` of the matrix is isochoric. `I1` and `I4i` of the fibres are not: `Ei + 1` is the mean squared
/// stretch of the fibres of a family. With isochoric invariants fibres would not resist a change of volume,
/// and a wall that is stretched would swell instead of stretching its fibres (Sansour 2008; Nolan et al.
/// 2014). At `J = 1` the two are the same. The tangent jumps where a family passes its rest length; at rest
/// it is that of extension.
///
/// Sources: Gasser, Ogden and Holzapfel, J. R. Soc. Interface 3 (2006) 15-35; Sansour, Eur. J. Mech. A/Solids
/// 27 (2008) 28-39; Nolan et al., J. Mech. Behav. Biomed. Mater. 39 (2014) 48-60.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HolzapfelGasserOgden {
    matrix: MooneyRivlin,
    fibres: Exponential,
    dispersion: f64,
    /// Angle of both families, rad.
    angle: f64,
}

pub(super) const ENTRY: Entry<Build<HolzapfelGasserOgden>> = Entry {
    name: "holzapfel-gasser-ogden",
    meaning: "c/2 (J^(-2/3) I1 - 3) + k1/(2 k2) sum_(i = 1, 2) (exp(k2 Ei^2) - 1) + kappa/2 (J - 1)^2, Ei = d (I1 - 3) + (1 - 3 d) (I4i - 1), only where Ei > 0: takes fibers and sheets",
    source: "Gasser, Ogden and Holzapfel, J. R. Soc. Interface 3 (2006) 15-35",
    parameters: &[
        Parameter::required("c", Dimension::Pressure, "shear modulus of the matrix").within(Range::Positive),
        Parameter::required("k1", Dimension::Pressure, "constant of the fibres in extension").within(Range::Positive),
        Parameter::required("k2", Dimension::None, "exponent of the fibres").within(Range::Positive),
        Parameter::required(
            "angle",
            Dimension::Angle,
            "angle of the two families from the fibre towards the sheet, one on each side",
        ),
        Parameter::default("dispersion", Dimension::None, 0.0, "d, 0 if the fibres of a family are parallel, 1/3 if they have no direction")
            .within(Range::Within(0.0, 1.0 / 3.0)),
        BULK,
    ],
    build: |values| {
        let fibres = [values.number("k1")?, values.number("k2")?];
        let (angle, dispersion) = (values.number("angle")?, values.number("dispersion")?);
        Ok(HolzapfelGasserOgden::new(values.number("c")?, fibres, angle, dispersion, values.number("bulk")?)?)
    },
};

impl HolzapfelGasserOgden {
    /// Builds the law from the shear modulus `c` (Pa, positive) of the matrix, the constants `k1` (Pa, zero
    /// or more) and `k2` (positive) of the fibres, the angle (rad) and the dispersion (0 to 1/3) of both
    /// families, and the bulk modulus (Pa, positive).
    pub fn new(
        c: f64,
        [k1, k2]: [f64; 2],
        angle: f64,
        dispersion: f64,
        bulk: f64,
    ) -> Result<HolzapfelGasserOgden, MaterialError> {
        MaterialError::check_positive("c", c)?;
        MaterialError::check_not_negative("k1", k1)?;
        MaterialError::check_positive("k2", k2)?;
        MaterialError::check_range("angle", angle, true, "finite")?;
        let sound = (0.0..=1.0 / 3.0).contains(&dispersion);
        MaterialError::check_range("dispersion", dispersion, sound, "0 to 1/3")?;
        let matrix = MooneyRivlin::new(0.5 * c, 0.0, bulk)?;
        Ok(HolzapfelGasserOgden { matrix, fibres: Exponential { a: k1, b: k2 }, dispersion, angle })
    }

    /// Returns the structure tensor `d I + (1 - 3 d) a x a` of a family at an angle from the fibre.
    fn structure(&self, angle: f64) -> Matrix3 {
        let a = Vector3::new(angle.cos(), angle.sin(), 0.0);
        Matrix3::identity() * self.dispersion + tensor(&a, &a) * (1.0 - 3.0 * self.dispersion)
    }
}

impl Reinforced for HolzapfelGasserOgden {
    type Matrix = MooneyRivlin;

    const ISOCHORIC: bool = false;

    fn matrix(&self) -> &MooneyRivlin {
        &self.matrix
    }

    fn with_matrix(&self, matrix: MooneyRivlin) -> HolzapfelGasserOgden {
        HolzapfelGasserOgden { matrix, ..*self }
    }

    fn families(&self, E: &Matrix3) -> impl Iterator<Item = Family> {
        [self.angle, -self.angle].map(|at| Family::new(self.structure(at), E, |q| self.fibres.in_extension(q))).into_iter()
    }

    fn needs_sheets(&self) -> bool {
        self.angle.sin() != 0.0
    }

    /// The deviators of both structure tensors have the square `2/3 (1 - 3 d)^2` and the product
    /// `(cos^2 2 angle - 1/3) (1 - 3 d)^2`.
    fn fibre_shear(&self) -> f64 {
        let product = (2.0 * self.angle).cos().powi(2) - 1.0 / 3.0;
        2.0 * self.fibres.a * (1.0 - 3.0 * self.dispersion).powi(2) * (2.0 / 3.0 + product.abs())
    }
}

material_of_reinforced!(HolzapfelGasserOgden);

#[cfg(test)]
mod tests {
    use super::*;

    /// Pure shear diag(l, 1/l, 1) keeps the volume. Each family has the stress `2 k1 E exp(k2 E^2) F A F^T`,
    /// and the sum of both has no shear.
    #[test]
    fn pure_shear_has_the_stress_of_the_formula() {
        let (c, k1, k2, angle, d) = (7.64e3, 996.6e3, 524.6, 49.98_f64.to_radians(), 0.226);
        let law = HolzapfelGasserOgden::new(c, [k1, k2], angle, d, 1e8).unwrap();
        for l in [1.05_f64, 0.93] {
            let H = Matrix3::from_diagonal(&Vector3::new(l - 1.0, 1.0 / l - 1.0, 0.0));
            let cauchy = law.stress(&H) * (Matrix3::identity() + H).transpose();
            let square = [l * l, 1.0 / (l * l), 1.0];
            let (cos, sin) = (angle.cos().powi(2), angle.sin().powi(2));
            let E = d * (square.iter().sum::<f64>() - 3.0) + (1.0 - 3.0 * d) * (square[0] * cos + square[1] * sin - 1.0);
            let pull = if E > 0.0 { 4.0 * k1 * E * (k2 * E * E).exp() } else { 0.0 };
            let tensor = [d + (1.0 - 3.0 * d) * cos, d + (1.0 - 3.0 * d) * sin, d];
            let stress = |i: usize| square[i] * (c + pull * tensor[i]);
            for i in 0..2 {
                let (found, expected) = (cauchy[(i, i)] - cauchy[(2, 2)], stress(i) - stress(2));
                // The volumetric term of rounding, kappa times 1e-16, is common to all three.
                assert!((found - expected).abs() < 1e-11 * c, "{l} {i}: {found} {expected}");
            }
            assert!(cauchy[(0, 1)].abs() < 1e-11 * c);
        }
    }

    /// The dispersion 1/3 leaves `E = (I1 - 3) / 3`, without a direction.
    #[test]
    fn full_dispersion_has_no_direction() {
        let law = HolzapfelGasserOgden::new(2e3, [5e3, 1.5], 0.6, 1.0 / 3.0, 1e5).unwrap();
        let H = Matrix3::new(0.2, 0.1, -0.1, 0.0, 0.1, 0.2, 0.1, -0.1, 0.05);
        let swap = Matrix3::new(0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0);
        let turned = swap * law.stress(&(swap.transpose() * H * swap)) * swap.transpose();
        assert!((turned - law.stress(&H)).norm() < 1e-11 * law.stress(&H).norm());
    }

    #[test]
    fn bad_constants_are_refused() {
        let refused = |c, k, d| HolzapfelGasserOgden::new(c, k, 0.5, d, 1e3).unwrap_err().to_string();
        assert!(refused(1.0, [1.0, 1.0], 0.4).contains("dispersion is 0.4; it must be 0 to 1/3"));
        assert!(refused(1.0, [1.0, 1.0], -0.1).contains("dispersion is -0.1"));
        assert!(refused(0.0, [1.0, 1.0], 0.1).contains("c is 0"));
        assert!(refused(1.0, [-1.0, 1.0], 0.1).contains("k1 is -1"));
        assert!(refused(1.0, [1.0, 0.0], 0.1).contains("k2 is 0"));
        assert!(HolzapfelGasserOgden::new(1.0, [1.0; 2], f64::NAN, 0.1, 1.0).is_err());
        assert!(HolzapfelGasserOgden::new(1.0, [1.0; 2], 0.1, 0.1, -1.0).is_err());
    }
}
