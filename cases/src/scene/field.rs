//! Given values over space: a constant, an expression, or those of the exact solution.

use super::expression::{Expression, NotFinite};

/// A scalar over space, in SI.
#[derive(Clone, Debug)]
pub enum ScalarField {
    /// The same everywhere.
    Constant(f64),
    /// An expression in the coordinates, times the factor of its unit to SI.
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
                // The unit may take a large number out of range.
                value.is_finite().then_some(value).ok_or_else(wrong)
            }
        }
    }
}

/// A vector over space, in SI.
#[derive(Clone, Debug)]
pub enum VectorField {
    /// By components.
    Components([ScalarField; 3]),
    /// That of the exact solution in `[reference]`.
    Exact,
}

/// What a support prescribes along one axis, in metres.
#[derive(Clone, Debug)]
pub enum Prescribed {
    /// A given displacement.
    Field(ScalarField),
    /// That of the exact solution in `[reference]`.
    Exact,
}
