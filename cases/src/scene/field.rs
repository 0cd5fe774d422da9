//! Prescribed values over space: a constant, an expression, or the values of the exact solution.

use schemars::JsonSchema;
use serde::Deserialize;

use super::expression::{Expression, NotFinite};
use super::units::{Dim, Q, Unit};
use super::words::words;

/// A scalar over space, in SI.
#[derive(Clone, Debug, PartialEq)]
pub enum ScalarField {
    /// One value everywhere.
    Constant(f64),
    /// An expression in the coordinates, multiplied by the conversion factor of its unit to SI.
    Expression {
        /// The expression, in metres.
        of: Expression,
        /// Factor to SI.
        factor: f64,
    },
}

impl ScalarField {
    /// Value in SI at `x` (metres).
    pub fn value(&self, x: [f64; 3]) -> Result<f64, NotFinite> {
        match self {
            ScalarField::Constant(value) => Ok(*value),
            ScalarField::Expression { of, factor } => {
                let value = of.value(x)? * factor;
                let wrong = || NotFinite { expression: of.text().into(), value, at: x };
                // The factor may overflow a large value.
                value.is_finite().then_some(value).ok_or_else(wrong)
            }
        }
    }

    /// Whether the field varies in space.
    pub(crate) fn varies(&self) -> bool {
        matches!(self, ScalarField::Expression { .. })
    }
}

/// A vector over space, in SI.
#[derive(Clone, Debug)]
pub enum VectorField {
    /// Three scalar components.
    Components([ScalarField; 3]),
    /// The field of the exact solution in `[reference]`.
    Exact,
}

impl VectorField {
    /// Whether the field varies in space.
    pub(crate) fn varies(&self) -> bool {
        match self {
            VectorField::Components(components) => components.iter().any(ScalarField::varies),
            VectorField::Exact => true,
        }
    }
}

words! {
    /// A field that is given by its name.
    pub(crate) enum ExactWord {
        /// The values of the exact solution that `[reference]` names.
        Exact = "exact",
    }
}

/// A quantity, or an expression in x, y and z (metres) with the unit of its value
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
#[serde(bound = "")]
pub(crate) enum FieldKeys<D: Dim> {
    Constant(Q<D>),
    Expression(FieldOf<D>),
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, bound = "")]
pub(crate) struct FieldOf<D: Dim> {
    unit: Unit<D>,
    of: Expression,
}

/// Three components, "exact", or three expressions with one unit
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
#[serde(bound = "")]
pub(crate) enum VectorKeys<D: Dim> {
    Exact(ExactWord),
    Components([FieldKeys<D>; 3]),
    Expressions(VectorOf<D>),
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, bound = "")]
pub(crate) struct VectorOf<D: Dim> {
    unit: Unit<D>,
    of: [Expression; 3],
}

impl<D: Dim> From<FieldKeys<D>> for ScalarField {
    fn from(keys: FieldKeys<D>) -> ScalarField {
        match keys {
            FieldKeys::Constant(q) => ScalarField::Constant(q.0),
            FieldKeys::Expression(f) => ScalarField::Expression { of: f.of, factor: f.unit.0 },
        }
    }
}

impl<D: Dim> From<VectorKeys<D>> for VectorField {
    fn from(keys: VectorKeys<D>) -> VectorField {
        match keys {
            VectorKeys::Exact(_) => VectorField::Exact,
            VectorKeys::Components(c) => VectorField::Components(c.map(ScalarField::from)),
            VectorKeys::Expressions(v) => {
                let factor = v.unit.0;
                VectorField::Components(v.of.map(|of| ScalarField::Expression { of, factor }))
            }
        }
    }
}
