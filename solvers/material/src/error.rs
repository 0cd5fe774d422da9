//! Errors in the constants of a law.

use catalogue::Problem;

/// A constant that a law refuses.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum MaterialError {
    /// A Young's modulus that is not positive and finite.
    #[error("Young's modulus is {young} Pa; it must be positive and finite")]
    Young {
        /// The modulus given, Pa.
        young: f64,
    },
    /// A Poisson's ratio outside the open interval from -1 to 0.5.
    #[error("Poisson's ratio is {poisson}; it must lie between -1 and 0.5, both excluded")]
    Poisson {
        /// The ratio given.
        poisson: f64,
    },
    /// Constants whose shear modulus is not positive and finite.
    #[error("the constants give a shear modulus of {mu} Pa; it must be positive and finite")]
    Shear {
        /// `2 (C10 + C01)` or `sum mu_p alpha_p / 2`, Pa.
        mu: f64,
    },
    /// A bulk modulus that is not positive and finite.
    #[error("the bulk modulus is {bulk} Pa; it must be positive and finite")]
    Bulk {
        /// The modulus given, Pa.
        bulk: f64,
    },
    /// A share of the second Mooney-Rivlin term outside 0 to 1.
    #[error("C01 / (C10 + C01) is {share}; it must lie between 0 and 1")]
    Share {
        /// The share given.
        share: f64,
    },
    /// An Ogden term that is not finite or has a zero exponent.
    #[error("Ogden term {} is mu = {mu} Pa, alpha = {alpha}; both must be finite and alpha not zero", term + 1)]
    OgdenTerm {
        /// Index of the term, from 0.
        term: usize,
        /// Constant of the term, Pa.
        mu: f64,
        /// Exponent of the term.
        alpha: f64,
    },
    /// A constant that is not positive and finite.
    #[error("{name} is {value}; it must be positive and finite")]
    Constant {
        /// Name of the constant.
        name: &'static str,
        /// The value given.
        value: f64,
    },
    /// A constant outside its range.
    #[error("{name} is {value}; it must be {allowed}")]
    Range {
        /// Name of the constant.
        name: &'static str,
        /// The value given.
        value: f64,
        /// Range in words.
        allowed: &'static str,
    },
    /// A Prony term that is not positive and finite.
    #[error("Prony term {} is g = {g}, tau = {tau} s; both must be positive and finite", term + 1)]
    PronyTerm {
        /// Index of the term, from 0.
        term: usize,
        /// Share of the term.
        g: f64,
        /// Relaxation time of the term, s.
        tau: f64,
    },
    /// A Prony series whose shares leave nothing that does not relax.
    #[error("the coefficients g of the Prony series sum to {sum}; the sum must be below 1")]
    PronySum {
        /// `sum g_i`.
        sum: f64,
    },
    /// A negative time step.
    #[error("the time step is {dt} s; it must not be negative")]
    TimeStep {
        /// The step given, s.
        dt: f64,
    },
}

impl MaterialError {
    /// Checks that shear and bulk modulus (Pa) are positive and finite.
    pub(crate) fn check_moduli(mu: f64, bulk: f64) -> Result<(), MaterialError> {
        if !(mu > 0.0 && mu.is_finite()) {
            return Err(MaterialError::Shear { mu });
        }
        if !(bulk > 0.0 && bulk.is_finite()) {
            return Err(MaterialError::Bulk { bulk });
        }
        Ok(())
    }

    /// Checks that a constant is positive and finite.
    pub(crate) fn check_positive(name: &'static str, value: f64) -> Result<(), MaterialError> {
        if value > 0.0 && value.is_finite() { Ok(()) } else { Err(MaterialError::Constant { name, value }) }
    }

    /// Checks that a constant is finite and zero or more.
    pub(crate) fn check_not_negative(name: &'static str, value: f64) -> Result<(), MaterialError> {
        MaterialError::check_range(name, value, value >= 0.0, "zero or more, and finite")
    }

    /// Checks that a constant is finite and `sound`; `allowed` says which values are.
    pub(crate) fn check_range(
        name: &'static str,
        value: f64,
        sound: bool,
        allowed: &'static str,
    ) -> Result<(), MaterialError> {
        if sound && value.is_finite() { Ok(()) } else { Err(MaterialError::Range { name, value, allowed }) }
    }
}

/// Converts the error to a problem at the scene's parameter, if there is one.
impl From<MaterialError> for Problem {
    fn from(bad: MaterialError) -> Problem {
        let parameter = match bad {
            MaterialError::Young { .. } => Some("young"),
            MaterialError::Poisson { .. } => Some("poisson"),
            MaterialError::Bulk { .. } => Some("bulk"),
            MaterialError::Share { .. } => Some("share"),
            MaterialError::OgdenTerm { .. } => Some("alpha"),
            MaterialError::Constant { name, .. } | MaterialError::Range { name, .. } => Some(name),
            MaterialError::Shear { .. }
            | MaterialError::PronyTerm { .. }
            | MaterialError::PronySum { .. }
            | MaterialError::TimeStep { .. } => None,
        };
        let problem = Problem::new(format!("can't be used: {bad}"));
        match parameter {
            Some(parameter) => problem.of(parameter),
            None => problem,
        }
    }
}
