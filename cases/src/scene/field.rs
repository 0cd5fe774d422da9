//! Prescribed values over space: a constant, an expression, or the values of the exact solution.

use super::expression::{Expression, NotFinite};

/// A scalar over space, in SI.
#[derive(Clone, Debug)]
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
}

/// A vector over space, in SI.
#[derive(Clone, Debug)]
pub enum VectorField {
    /// Three scalar components.
    Components([ScalarField; 3]),
    /// The field of the exact solution in `[reference]`.
    Exact,
}

/// Prescribed displacement of a support along one axis, in metres.
#[derive(Clone, Debug)]
pub enum Prescribed {
    /// A given displacement.
    Field(ScalarField),
    /// The displacement of the exact solution in `[reference]`.
    Exact,
}
