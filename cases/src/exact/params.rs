//! Parameters of an exact solution: what it takes, what was given, and what is wrong with that.

use std::collections::BTreeMap;

use catalogue::nearest;

/// Material and case parameters, all in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Params {
    /// Young's modulus, Pa.
    pub young: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// The solution's own parameters by name, in the units of [`Parameter::unit`].
    pub values: BTreeMap<String, f64>,
}

/// One parameter that a solution takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Name in scene files.
    pub name: &'static str,
    /// SI unit: "m", "1/m", "N", "N/m", "Pa", "rad", or "" for a plain number.
    pub unit: &'static str,
    /// What it is, in a few words.
    pub meaning: &'static str,
    /// Value when not given; `None` means that it must be given.
    pub default: Option<f64>,
}

impl Parameter {
    pub(super) const fn required(name: &'static str, unit: &'static str, meaning: &'static str) -> Parameter {
        Parameter { name, unit, meaning, default: None }
    }

    pub(super) const fn optional(
        name: &'static str,
        unit: &'static str,
        meaning: &'static str,
        default: f64,
    ) -> Parameter {
        Parameter { name, unit, meaning, default: Some(default) }
    }
}

/// What makes an exact solution impossible to build.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ExactError {
    /// A solution name that does not exist.
    #[error("no exact solution '{name}'{}; known: {known}", hint(nearest))]
    UnknownSolution {
        /// The name asked for.
        name: String,
        /// The nearest known name.
        nearest: Option<&'static str>,
        /// All known names.
        known: String,
    },
    /// A parameter that the solution does not take.
    #[error("exact solution '{solution}' takes no '{name}'{}; it takes: {known}", hint(nearest))]
    UnknownParameter {
        /// The solution.
        solution: &'static str,
        /// The parameter given.
        name: String,
        /// The nearest parameter it does take.
        nearest: Option<&'static str>,
        /// All parameters it takes.
        known: String,
    },
    /// A parameter that the solution needs and was not given.
    #[error("exact solution '{solution}' needs '{name}': {meaning}{}", unit_note(unit))]
    MissingParameter {
        /// The solution.
        solution: &'static str,
        /// The parameter it needs.
        name: &'static str,
        /// What the parameter is.
        meaning: &'static str,
        /// Its SI unit.
        unit: &'static str,
    },
    /// A parameter outside of its range.
    #[error("exact solution '{solution}': '{name}' is {value}; it must be {need}")]
    BadParameter {
        /// The solution.
        solution: &'static str,
        /// The parameter.
        name: &'static str,
        /// Its value, SI.
        value: f64,
        /// What would do.
        need: String,
    },
    /// A modulus or Poisson's ratio that no material has.
    #[error("'{what}' is {value}; it must be {need}")]
    Material {
        /// "young" or "poisson".
        what: &'static str,
        /// Its value.
        value: f64,
        /// What would do.
        need: &'static str,
    },
}

fn hint(nearest: &Option<&'static str>) -> String {
    nearest.map_or(String::new(), |n| format!(" (did you mean '{n}'?)"))
}

fn unit_note(unit: &str) -> String {
    if unit.is_empty() { " (a plain number)".into() } else { format!(" ({unit})") }
}

/// The parameters of one solution after defaults: every one present and finite.
pub(super) struct Values {
    values: Vec<f64>,
    any_given: bool,
}

impl Values {
    /// Matches what was given with what the solution takes.
    pub fn resolve(
        solution: &'static str,
        parameters: &'static [Parameter],
        params: &Params,
    ) -> Result<Values, ExactError> {
        let known: Vec<&'static str> = parameters.iter().map(|p| p.name).collect();
        if let Some(name) = params.values.keys().find(|k| !known.contains(&k.as_str())) {
            return Err(ExactError::UnknownParameter {
                solution,
                name: name.clone(),
                nearest: nearest(name, known.iter().copied()),
                known: known.join(", "),
            });
        }
        let mut values = Vec::with_capacity(parameters.len());
        for p in parameters {
            let value =
                params.values.get(p.name).copied().or(p.default).ok_or(ExactError::MissingParameter {
                    solution,
                    name: p.name,
                    meaning: p.meaning,
                    unit: p.unit,
                })?;
            if !value.is_finite() {
                let need = "a finite number".into();
                return Err(ExactError::BadParameter { solution, name: p.name, value, need });
            }
            values.push(value);
        }
        Ok(Values { values, any_given: !params.values.is_empty() })
    }

    /// True when at least one parameter was given rather than taken from its default.
    pub fn any_given(&self) -> bool {
        self.any_given
    }

    /// Value at a place of the solution's own parameter list.
    pub fn at(&self, index: usize) -> f64 {
        self.values[index]
    }
}
