//! Fibres that straighten, then stretch: the part `F2` of the laws of ligaments and tendons.

use catalogue::{Dimension, Parameter, Problem, Range, Values};

use crate::error::MaterialError;

/// Energy `F2(l)` of fibres at the stretch `l`; constants in Pa except `c4` and `lm`.
///
/// ```text
/// l dF2/dl = 0                         l <= 1        crimped
///          = c3 (exp(c4 (l - 1)) - 1)  1 < l < lm    straightening
///          = c5 l + c6                 lm <= l       straight; c6 follows by continuity
/// ```
///
/// The tangent jumps at `l = 1` and at `l = lm`; at rest it is that of extension. Source: Weiss, Maker and
/// Govindjee, Comput. Methods Appl. Mech. Eng. 135 (1996) 107-128.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Straightening {
    c3: f64,
    c4: f64,
    c5: f64,
    c6: f64,
    lm: f64,
    /// `F2(lm)`, J/m^3.
    straight: f64,
}

/// Parameters of the fibres.
pub(super) const FIBRES: [Parameter; 4] = [
    Parameter::required("c3", Dimension::Pressure, "constant of the straightening fibres")
        .within(Range::NotNegative),
    Parameter::required("c4", Dimension::None, "exponent of the straightening fibres")
        .within(Range::Positive),
    Parameter::required("c5", Dimension::Pressure, "modulus of the straight fibres")
        .within(Range::NotNegative),
    Parameter::required("lm", Dimension::None, "stretch at which the fibres are straight")
        .within(Range::AtLeast(1.0)),
];

/// Returns `[c3, c4, c5]` (Pa, dimensionless, Pa) and `lm` of the parameters [`FIBRES`].
pub(super) fn fibres(values: &Values) -> Result<([f64; 3], f64), Problem> {
    Ok(([values.number("c3")?, values.number("c4")?, values.number("c5")?], values.number("lm")?))
}

/// Abscissas and weights of Gauss's rule with eight points on -1 to 1, the positive half. Source: Abramowitz
/// and Stegun, Handbook of Mathematical Functions, table 25.4.
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];

impl Straightening {
    /// Builds the energy from `c3` (Pa, zero or more), `c4` (positive), `c5` (Pa, zero or more) and the
    /// stretch `lm` (1 or more) at which the fibres are straight.
    pub fn new([c3, c4, c5]: [f64; 3], lm: f64) -> Result<Straightening, MaterialError> {
        MaterialError::check_not_negative("c3", c3)?;
        MaterialError::check_positive("c4", c4)?;
        MaterialError::check_not_negative("c5", c5)?;
        MaterialError::check_range("lm", lm, lm >= 1.0, "1 or more, and finite")?;
        let c6 = c3 * (c4 * (lm - 1.0)).exp_m1() - c5 * lm;
        MaterialError::check_range("c4", c4, c6.is_finite(), "such that c3 exp(c4 (lm - 1)) is finite")?;
        let fibre = Straightening { c3, c4, c5, c6, lm, straight: 0.0 };
        Ok(Straightening { straight: fibre.straightening(lm - 1.0), ..fibre })
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
    pub fn at(&self, q: f64) -> [f64; 3] {
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

    /// Largest shear modulus at small strain, Pa: `F2 = c3 c4/2 Eff^2` on a tensor whose deviator has the
    /// square 2/3.
    pub fn shear(&self) -> f64 {
        4.0 / 3.0 * self.at(0.0)[2]
    }
}
