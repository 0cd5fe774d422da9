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

/// Parameters of a law that takes its shear modulus or Young's modulus, and Poisson's ratio or its bulk
/// modulus.
pub(super) const EITHER: [Parameter; 4] = [
    YOUNG.may_be_absent(),
    Parameter::optional("mu", Dimension::Pressure, "shear modulus, in place of young")
        .within(Range::Positive),
    POISSON.may_be_absent(),
    Parameter::optional("bulk", Dimension::Pressure, "bulk modulus, in place of poisson")
        .within(Range::Positive),
];

/// Parameters of the volume of a law that has constants for the shape: one of them is given.
pub(super) const VOLUME: [Parameter; 2] = [EITHER[2], EITHER[3]];

/// Returns shear and bulk modulus (Pa) from the parameters [`EITHER`].
pub(super) fn either(values: &Values) -> Result<(f64, f64), Problem> {
    let [young, mu, poisson, bulk] = ["young", "mu", "poisson", "bulk"].map(|name| values.get(name));
    match (young, mu, poisson, bulk) {
        (Some(young), None, Some(poisson), None) => {
            Ok((young / (2.0 * (1.0 + poisson)), young / (3.0 * (1.0 - 2.0 * poisson))))
        }
        // A body with E >= 9 kappa would have a negative first Lame modulus below that of any material.
        (Some(young), None, None, Some(bulk)) if young < 9.0 * bulk => {
            Ok((3.0 * bulk * young / (9.0 * bulk - young), bulk))
        }
        (Some(_), None, None, Some(_)) => Err(Problem::new("is too small for young")
            .help("the bulk modulus must be above a ninth of Young's modulus")
            .of("bulk")),
        (None, Some(mu), _, _) => Ok((mu, volume(values, mu)?)),
        _ => Err(Problem::new("does not have the moduli of this law")
            .help("give young or mu, and poisson or bulk")),
    }
}

/// Returns the bulk modulus (Pa) from the parameters [`VOLUME`] and the shear modulus `mu` (Pa).
pub(super) fn volume(values: &Values, mu: f64) -> Result<f64, Problem> {
    match (values.get("poisson"), values.get("bulk")) {
        (Some(poisson), None) => Ok(2.0 / 3.0 * mu * (1.0 + poisson) / (1.0 - 2.0 * poisson)),
        (None, Some(bulk)) => Ok(bulk),
        _ => Err(Problem::new("does not have one modulus of the volume").help("give poisson or bulk")),
    }
}
