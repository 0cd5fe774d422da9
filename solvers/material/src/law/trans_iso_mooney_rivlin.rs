//! Mooney-Rivlin matrix with one family of fibres that straighten, for ligaments and tendons.

use catalogue::{Build, Dimension, Entry, Parameter, Problem, Range};
use shape::{Matrix3, Vector3};

use super::moduli::BULK;
use super::mooney_rivlin::MooneyRivlin;
use super::reinforced::{self, Family, Reinforced, material_of_reinforced, tensor};
use crate::error::MaterialError;
use crate::material::{Material, Tangent};
use crate::separated::Separated;
use crate::volumetric::Volumetric;

/// Transversely isotropic Mooney-Rivlin law
/// `W = C10 (J^(-2/3) I1 - 3) + C01 (J^(-4/3) I2 - 3) + F2(l) + kappa/2 (J - 1)^2` with the isochoric stretch
/// `l = J^(-1/3) |F f|` of the fibre; constants in Pa except `c4` and `lm`.
///
/// ```text
/// l dF2/dl = 0                         l <= 1        crimped
///          = c3 (exp(c4 (l - 1)) - 1)  1 < l < lm    straightening
///          = c5 l + c6                 lm <= l       straight; c6 follows by continuity
/// ```
///
/// The fibres see the isochoric stretch, as in FEBio. FEBio's volumetric energy is the logarithmic one. The
/// tangent jumps at `l = 1` and at `l = lm`; at rest it is that of extension. Sources: Weiss, Maker and
/// Govindjee, Comput. Methods Appl. Mech. Eng. 135 (1996) 107-128; FEBio User Manual, Transversely Isotropic
/// Mooney-Rivlin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransIsoMooneyRivlin {
    matrix: MooneyRivlin,
    c3: f64,
    c4: f64,
    c5: f64,
    c6: f64,
    lm: f64,
    /// `F2(lm)`, J/m^3.
    straight: f64,
}

pub(super) const ENTRY: Entry<Build<TransIsoMooneyRivlin>> = Entry {
    name: "trans-iso-mooney-rivlin",
    meaning: "C10 (J^(-2/3) I1 - 3) + C01 (J^(-4/3) I2 - 3) + F2(l) + kappa/2 (J - 1)^2, l dF2/dl = c3 (exp(c4 (l - 1)) - 1) for l < lm, c5 l + c6 beyond, only where l > 1: takes fibers",
    source: "Weiss, Maker and Govindjee, Comput. Methods Appl. Mech. Eng. 135 (1996) 107-128",
    parameters: &[
        Parameter::required("c10", Dimension::Pressure, "constant of the first invariant"),
        Parameter::default("c01", Dimension::Pressure, 0.0, "constant of the second invariant; 0 unless given"),
        Parameter::required("c3", Dimension::Pressure, "constant of the straightening fibres").within(Range::NotNegative),
        Parameter::required("c4", Dimension::None, "exponent of the straightening fibres").within(Range::Positive),
        Parameter::required("c5", Dimension::Pressure, "modulus of the straight fibres").within(Range::NotNegative),
        Parameter::required("lm", Dimension::None, "stretch at which the fibres are straight").within(Range::AtLeast(1.0)),
        BULK,
    ],
    build: |values| {
        let matrix = [values.number("c10")?, values.number("c01")?];
        let [c3, c4, c5, lm] =
            [values.number("c3")?, values.number("c4")?, values.number("c5")?, values.number("lm")?];
        TransIsoMooneyRivlin::new(matrix, [c3, c4, c5], lm, values.number("bulk")?).map_err(|bad| match bad {
            MaterialError::Shear { .. } => Problem::new("does not give a positive shear modulus")
                .help("c10 + c01, which is half the shear modulus of the matrix, must be positive")
                .of("c10"),
            bad => bad.into(),
        })
    },
};

/// Abscissas and weights of Gauss's rule with eight points on -1 to 1, the positive half. Source: Abramowitz
/// and Stegun, Handbook of Mathematical Functions, table 25.4.
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];

impl TransIsoMooneyRivlin {
    /// Builds the law from `C10` and `C01` (Pa, their sum positive), the constants `c3` (Pa, zero or more),
    /// `c4` (positive) and `c5` (Pa, zero or more) of the fibres, the stretch `lm` (1 or more) at which they
    /// are straight, and the bulk modulus (Pa, positive).
    pub fn new(
        [c10, c01]: [f64; 2],
        [c3, c4, c5]: [f64; 3],
        lm: f64,
        bulk: f64,
    ) -> Result<TransIsoMooneyRivlin, MaterialError> {
        let matrix = MooneyRivlin::new(c10, c01, bulk)?;
        MaterialError::check_not_negative("c3", c3)?;
        MaterialError::check_positive("c4", c4)?;
        MaterialError::check_not_negative("c5", c5)?;
        MaterialError::check_range("lm", lm, lm >= 1.0, "1 or more, and finite")?;
        let c6 = c3 * (c4 * (lm - 1.0)).exp_m1() - c5 * lm;
        MaterialError::check_range("c4", c4, c6.is_finite(), "such that c3 exp(c4 (lm - 1)) is finite")?;
        let law = TransIsoMooneyRivlin { matrix, c3, c4, c5, c6, lm, straight: 0.0 };
        Ok(TransIsoMooneyRivlin { straight: law.straightening(lm - 1.0), ..law })
    }

    /// Returns `F2` at the extension `x = l - 1` of straightening fibres,
    /// `c3 int_0^x (exp(c4 t) - 1) / (1 + t) dt`.
    ///
    /// The closed form is a difference of exponential integrals, which cancels at small extension. Gauss's
    /// rule adds positive terms only. Its panels are so short that the remainder is below 1e-17 of the sum.
    fn straightening(&self, x: f64) -> f64 {
        let panels = ((self.c4 + 4.0) * x).ceil().max(1.0);
        let half = 0.5 * x / panels;
        let mut sum = 0.0;
        for panel in 0..panels as usize {
            let middle = half * (2 * panel + 1) as f64;
            for (at, weight) in GAUSS {
                for t in [middle - half * at, middle + half * at] {
                    sum += weight * (self.c4 * t).exp_m1() / (1.0 + t);
                }
            }
        }
        self.c3 * half * sum
    }

    /// Returns `F2` and its first two derivatives with respect to `q = l^2 - 1`.
    ///
    /// With `p = l dF2/dl` they are `dF2/dq = p / (2 l^2)` and `d2F2/dq2 = (l dp/dl - 2 p) / (4 l^4)`.
    fn fibre(&self, q: f64) -> [f64; 3] {
        if q < 0.0 {
            return [0.0; 3];
        }
        let square = 1.0 + q;
        let l = square.sqrt();
        let x = q / (1.0 + l);
        let (energy, p, slope) = if l < self.lm {
            let grown = (self.c4 * x).exp();
            (self.straightening(x), self.c3 * (self.c4 * x).exp_m1(), self.c3 * self.c4 * grown)
        } else {
            let straight = self.c5 * (l - self.lm) + self.c6 * (l / self.lm).ln();
            (self.straight + straight, self.c5 * l + self.c6, self.c5)
        };
        [energy, p / (2.0 * square), (l * slope - 2.0 * p) / (4.0 * square * square)]
    }
}

impl Reinforced for TransIsoMooneyRivlin {
    type Matrix = MooneyRivlin;

    const ISOCHORIC: bool = true;

    fn matrix(&self) -> &MooneyRivlin {
        &self.matrix
    }

    fn with_matrix(&self, matrix: MooneyRivlin) -> TransIsoMooneyRivlin {
        TransIsoMooneyRivlin { matrix, ..*self }
    }

    fn families(&self, E: &Matrix3) -> impl Iterator<Item = Family> {
        let f = Vector3::x();
        [Family::new(tensor(&f, &f), E, |q| self.fibre(q))].into_iter()
    }

    fn needs_sheets(&self) -> bool {
        false
    }

    /// `F2 = c3 c4/2 Eff^2` at small strain, on a tensor whose deviator has the square 2/3.
    fn fibre_shear(&self) -> f64 {
        4.0 / 3.0 * self.fibre(0.0)[2]
    }
}

material_of_reinforced!(TransIsoMooneyRivlin);

#[cfg(test)]
mod tests {
    use super::*;

    /// A ligament: crimped up to a stretch of 1.06.
    fn ligament() -> TransIsoMooneyRivlin {
        TransIsoMooneyRivlin::new([1.44e6, 0.2e6], [0.57e6, 48.0, 467.1e6], 1.062, 397e6).unwrap()
    }

    /// `p = l dF2/dl` as the law defines it.
    fn pull(l: f64) -> f64 {
        let at = |l: f64| 0.57e6 * ((48.0 * (l - 1.0)).exp() - 1.0);
        if l <= 1.0 { 0.0 } else if l < 1.062 { at(l) } else { 467.1e6 * (l - 1.062) + at(1.062) }
    }

    /// An incompressible stretch l along the fibre has
    /// `sigma_11 - sigma_22 = 2 (l^2 - 1/l) (C10 + C01/l) + l dF2/dl`.
    #[test]
    fn a_bar_along_the_fibre_has_the_stress_of_the_formula() {
        for l in [0.95_f64, 1.03, 1.0619, 1.1] {
            let side = l.powf(-0.5);
            let H = Matrix3::from_diagonal(&Vector3::new(l - 1.0, side - 1.0, side - 1.0));
            let cauchy = ligament().stress(&H) * (Matrix3::identity() + H).transpose();
            let expected = 2.0 * (l * l - 1.0 / l) * (1.44e6 + 0.2e6 / l) + pull(l);
            let found = cauchy[(0, 0)] - cauchy[(1, 1)];
            assert!((found - expected).abs() < 1e-12 * expected.abs(), "{l}: {found} {expected}");
        }
    }

    /// The energy against Simpson's rule with 2000 intervals.
    #[test]
    fn energy_is_the_integral_of_the_stress() {
        for l in [1.0 + 1e-9, 1.01, 1.06, 1.2] {
            let n = 2000;
            let at = |k: usize| 1.0 + (l - 1.0) * k as f64 / n as f64;
            // The kink at lm limits the accuracy there.
            let tolerance = if l > 1.062 { 1e-6 } else { 1e-7 };
            let sum: f64 = (0..=n)
                .map(|k| pull(at(k)) / at(k) * if k == 0 || k == n { 1.0 } else { 2.0 + 2.0 * (k % 2) as f64 })
                .sum();
            let expected = sum * (l - 1.0) / (3.0 * n as f64);
            let found = ligament().fibre(l * l - 1.0)[0];
            assert!((found - expected).abs() < tolerance * expected, "{l}: {found} {expected}");
        }
    }

    #[test]
    fn stress_is_continuous_where_fibres_are_straight() {
        let at = |l: f64| ligament().fibre(l * l - 1.0);
        let (before, after) = (at(1.062 - 1e-12), at(1.062 + 1e-12));
        for d in 0..2 {
            assert!((before[d] - after[d]).abs() < 1e-9 * after[d], "{d}: {before:?} {after:?}");
        }
    }

    #[test]
    fn bad_constants_are_refused() {
        let refused = |c, fibre, lm| TransIsoMooneyRivlin::new(c, fibre, lm, 1e3).unwrap_err().to_string();
        assert!(refused([1.0, -2.0], [1.0; 3], 1.1).contains("shear modulus of -2"));
        assert!(refused([1.0, 0.0], [-1.0, 1.0, 1.0], 1.1).contains("c3 is -1"));
        assert!(refused([1.0, 0.0], [1.0, 0.0, 1.0], 1.1).contains("c4 is 0"));
        assert!(refused([1.0, 0.0], [1.0, 1.0, -5.0], 1.1).contains("c5 is -5; it must be zero or more"));
        assert!(refused([1.0, 0.0], [1.0; 3], 0.9).contains("lm is 0.9; it must be 1 or more"));
        assert!(refused([1.0, 0.0], [1.0, 1e4, 1.0], 1.5).contains("c4 is 10000"));
    }
}
