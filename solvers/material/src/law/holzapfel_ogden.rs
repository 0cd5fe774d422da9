//! Holzapfel and Ogden's law of the passive heart wall.

use catalogue::{Build, Dimension, Entry, Parameter, Problem, Range, Values};
use shape::{Matrix3, Vector3};

use super::fung_demiray::FungDemiray;
use super::moduli::BULK;
use super::reinforced::{self, Exponential, Family, Reinforced, material_of_reinforced, tensor};
use crate::error::MaterialError;
use crate::material::{Material, Tangent};
use crate::separated::Separated;
use crate::volumetric::Volumetric;

/// Holzapfel and Ogden's law, orthotropic in fibre (f), sheet (s) and normal: constants `a` in Pa, `b`
/// without unit.
///
/// ```text
/// W = a/(2 b) (exp(b (J^(-2/3) I1 - 3)) - 1) + kappa/2 (J - 1)^2
///     + sum_(i = f, s) af/(2 bf) (exp(bf (I4i - 1)^2) - 1)     only where I4i > 1
///     + afs/(2 bfs) (exp(bfs I8fs^2) - 1)
/// ```
///
/// The invariant `I1` of the matrix is isochoric. The invariants of the fibres are not: `I4i = |F i|^2` is
/// the squared stretch of a fibre and `I8fs = F f . F s` the shear between fibre and sheet. With isochoric
/// invariants fibres would not resist a change of volume, and a body that is stretched would swell instead of
/// stretching its fibres (Sansour 2008; Nolan et al. 2014). At `J = 1` the two are the same. The tangent
/// jumps where a fibre passes its rest length; at rest it is that of extension.
///
/// Sources: Holzapfel and Ogden, Phil. Trans. R. Soc. A 367 (2009) 3445-3475; Sansour, Eur. J. Mech. A/Solids
/// 27 (2008) 28-39; Nolan et al., J. Mech. Behav. Biomed. Mater. 39 (2014) 48-60.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HolzapfelOgden {
    matrix: FungDemiray,
    fibre: Exponential,
    sheet: Exponential,
    shear: Exponential,
}

const SHEET: &str = "constant of the sheet in extension, with bs; none unless given";
const SHEAR: &str = "constant of the shear between fibre and sheet, with bfs; none unless given";

pub(super) const ENTRY: Entry<Build<HolzapfelOgden>> = Entry {
    name: "holzapfel-ogden",
    meaning: "a/(2 b) (exp(b (J^(-2/3) I1 - 3)) - 1) + sum_(i = f, s) ai/(2 bi) (exp(bi (I4i - 1)^2) - 1) + afs/(2 bfs) (exp(bfs I8fs^2) - 1) + kappa/2 (J - 1)^2, I4 only in extension: takes fibers and sheets",
    source: "Holzapfel and Ogden, Phil. Trans. R. Soc. A 367 (2009) 3445-3475",
    parameters: &[
        Parameter::required("a", Dimension::Pressure, "shear modulus of the matrix").within(Range::Positive),
        Parameter::required("b", Dimension::None, "exponent of the matrix").within(Range::Positive),
        Parameter::required("af", Dimension::Pressure, "constant of the fibre in extension").within(Range::Positive),
        Parameter::required("bf", Dimension::None, "exponent of the fibre").within(Range::Positive),
        Parameter::optional("as", Dimension::Pressure, SHEET).within(Range::Positive),
        Parameter::optional("bs", Dimension::None, "exponent of the sheet").within(Range::Positive),
        Parameter::optional("afs", Dimension::Pressure, SHEAR).within(Range::Positive),
        Parameter::optional("bfs", Dimension::None, "exponent of the shear between fibre and sheet")
            .within(Range::Positive),
        BULK,
    ],
    build: |values| {
        let matrix = [values.number("a")?, values.number("b")?];
        let fibre = [values.number("af")?, values.number("bf")?];
        let (sheet, shear) = (pair(values, "as", "bs")?, pair(values, "afs", "bfs")?);
        Ok(HolzapfelOgden::new(matrix, fibre, sheet, shear, values.number("bulk")?)?)
    },
};

/// Returns a constant with its exponent, or the constant 0 if neither is given.
fn pair(values: &Values, constant: &'static str, exponent: &'static str) -> Result<[f64; 2], Problem> {
    match (values.get(constant), values.get(exponent)) {
        (Some(a), Some(b)) => Ok([a, b]),
        (None, None) => Ok([0.0, 1.0]),
        (Some(_), None) => {
            let help = format!("give the exponent of {constant}, such as {exponent} = 10.0");
            Err(Problem::new("is missing").help(help).of(exponent))
        }
        (None, Some(_)) => {
            let help = format!("give the constant of {exponent}, such as {constant} = \"1 kPa\"");
            Err(Problem::new("is missing").help(help).of(constant))
        }
    }
}

impl HolzapfelOgden {
    /// Builds the law from pairs of a constant (Pa) and an exponent: those of the matrix (positive), the
    /// fibre, the sheet and the shear between the two (constants zero or more, exponents positive), and the
    /// bulk modulus (Pa, positive).
    pub fn new(
        matrix: [f64; 2],
        fibre: [f64; 2],
        sheet: [f64; 2],
        shear: [f64; 2],
        bulk: f64,
    ) -> Result<HolzapfelOgden, MaterialError> {
        MaterialError::check_positive("a", matrix[0])?;
        let pair = |names: [&'static str; 2], [a, b]: [f64; 2]| {
            MaterialError::check_not_negative(names[0], a)?;
            MaterialError::check_positive(names[1], b)?;
            Ok(Exponential { a, b })
        };
        Ok(HolzapfelOgden {
            matrix: FungDemiray::new(matrix[0], bulk, matrix[1])?,
            fibre: pair(["af", "bf"], fibre)?,
            sheet: pair(["as", "bs"], sheet)?,
            shear: pair(["afs", "bfs"], shear)?,
        })
    }
}

impl Reinforced for HolzapfelOgden {
    type Matrix = FungDemiray;

    const ISOCHORIC: bool = false;

    fn matrix(&self) -> &FungDemiray {
        &self.matrix
    }

    fn with_matrix(&self, matrix: FungDemiray) -> HolzapfelOgden {
        HolzapfelOgden { matrix, ..*self }
    }

    fn families(&self, E: &Matrix3) -> impl Iterator<Item = Family> {
        let (f, s) = (Vector3::x(), Vector3::y());
        let fibre = Family::new(tensor(&f, &f), E, |q| self.fibre.in_extension(q));
        let sheet = Family::new(tensor(&s, &s), E, |q| self.sheet.in_extension(q));
        let shear = Family::new(tensor(&f, &s), E, |q| self.shear.at(q));
        [fibre, sheet, shear].into_iter()
    }

    fn needs_sheets(&self) -> bool {
        self.sheet.a > 0.0 || self.shear.a > 0.0
    }

    /// The shear between fibre and sheet is orthogonal to the stretches of both, which share the deviatoric
    /// strains of a plane.
    fn fibre_shear(&self) -> f64 {
        let (f, s) = (self.fibre.a, self.sheet.a);
        (2.0 / 3.0 * (f + s + (f * f - f * s + s * s).sqrt())).max(self.shear.a)
    }
}

material_of_reinforced!(HolzapfelOgden);

#[cfg(test)]
mod tests {
    use super::*;

    /// Constants of the shear tests on pig myocardium, Holzapfel and Ogden (2009), table 1.
    fn law() -> HolzapfelOgden {
        HolzapfelOgden::new([59.0, 8.023], [18472.0, 16.026], [2481.0, 11.12], [216.0, 11.436], 1e6).unwrap()
    }

    /// Simple shear of amount g keeps the volume: `I1 = 3 + g^2`, `I4 = 1 + g^2` of the sheared direction and
    /// `I8fs = g` between fibre and sheet, so the shear stress is `2 (W1 + W4) g + W8`.
    #[test]
    fn simple_shear_has_the_stress_of_the_formula() {
        let law = law();
        for g in [0.05_f64, 0.3] {
            let matrix = 59.0 * (8.023 * g * g).exp() * g;
            let of_shear = 216.0 * g * (11.436 * g * g).exp();
            let stretched = |a: f64, b: f64| 2.0 * a * g.powi(3) * (b * g.powi(4)).exp();
            for (direction, along, expected) in [
                (0, 1, matrix + stretched(18472.0, 16.026) + of_shear),
                (1, 0, matrix + stretched(2481.0, 11.12) + of_shear),
                (0, 2, matrix + stretched(18472.0, 16.026)),
                (1, 2, matrix + stretched(2481.0, 11.12)),
                (2, 0, matrix),
            ] {
                let mut H = Matrix3::zeros();
                H[(along, direction)] = g;
                let cauchy = law.stress(&H) * (Matrix3::identity() + H).transpose();
                let shear = cauchy[(along, direction)];
                assert!((shear - expected).abs() < 1e-12 * expected, "{direction} {along}: {shear} {expected}");
            }
        }
    }

    #[test]
    fn shortened_fibres_add_nothing() {
        let H = Matrix3::from_diagonal(&Vector3::new(-0.1, -0.05, 0.2));
        assert_eq!(law().stress(&H), law().matrix().stress(&H));
    }

    /// A uniform stretch lengthens the fibres. Isochoric invariants would leave only the volumetric stress.
    #[test]
    fn fibres_resist_swelling() {
        let H = Matrix3::identity() * 0.02;
        let (law, q) = (law(), 1.02_f64.powi(2) - 1.0);
        let expected = 2.0 * 18472.0 * q * (16.026 * q * q).exp() * 1.02;
        let P = law.stress(&H) - law.matrix().stress(&H);
        assert!((P[(0, 0)] - expected).abs() < 1e-11 * expected && P[(2, 2)] == 0.0, "{P}");
    }

    #[test]
    fn bad_constants_are_refused() {
        let one = [1.0, 1.0];
        let refused = |a, f, s, fs| HolzapfelOgden::new(a, f, s, fs, 1e3).unwrap_err().to_string();
        assert!(refused([0.0, 1.0], one, one, one).contains("a is 0"));
        assert!(refused(one, [-1.0, 1.0], one, one).contains("af is -1; it must be zero or more"));
        assert!(refused(one, one, [1.0, 0.0], one).contains("bs is 0"));
        assert!(refused(one, one, one, [f64::NAN, 1.0]).contains("afs is NaN"));
        assert!(HolzapfelOgden::new(one, one, one, one, 0.0).is_err());
    }
}
