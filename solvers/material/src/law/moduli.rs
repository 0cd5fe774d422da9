//! Parameters for the moduli of a law.

use catalogue::{Dimension, Parameter, Problem, Range, Values};

pub(super) const YOUNG: Parameter =
    Parameter::required("young", Dimension::Pressure, "Young's modulus; soft tissue has 1 to 100 kPa")
        .within(Range::Positive);
pub(super) const POISSON: Parameter = Parameter::required(
    "poisson",
    Dimension::None,
    "Poisson's ratio; nearly incompressible tissue has 0.49 to 0.4999",
)
.within(Range::Between(-1.0, 0.5));
pub(super) const BULK: Parameter =
    Parameter::required("bulk", Dimension::Pressure, "bulk modulus").within(Range::Positive);

/// Parameters of a law that is defined by its moduli at small strain.
pub(super) const MODULI: &[Parameter] = &[YOUNG, POISSON];

/// Returns Young's modulus (Pa) and Poisson's ratio.
pub(super) fn moduli(values: &Values) -> Result<(f64, f64), Problem> {
    Ok((values.number("young")?, values.number("poisson")?))
}
