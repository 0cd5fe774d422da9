//! Tolerances between numbers from two kinds of processors.
//!
//! Fused multiply-adds and register widths change the last bits of sums, and a method amplifies these by the
//! condition of its system. Numbers that consist only of rounding are not compared.

/// Relative tolerance of quantities without a rule.
const RELATIVE: f64 = 1e-6;

/// A larger tolerance of a quantity.
struct Rule {
    /// Prefix of the quantity's name.
    quantity: &'static str,
    /// Relative tolerance.
    relative: f64,
    /// Absolute tolerance, in the quantity's unit.
    absolute: f64,
}

const RULES: &[Rule] = &[
    // A residual below the solver's tolerance is rounding.
    Rule { quantity: "residual", relative: 0.0, absolute: 1e-6 },
    // A residual close to its tolerance may take another iteration.
    Rule { quantity: "newton-iterations", relative: 0.1, absolute: 2.0 },
    // Shear on a section sums to rounding, 1e-17 N from 1e-2 N on each half, and the run has no other force.
    Rule { quantity: "load-x", relative: RELATIVE, absolute: 1e-14 },
    Rule { quantity: "load-y", relative: RELATIVE, absolute: 1e-14 },
    Rule { quantity: "load-z", relative: RELATIVE, absolute: 1e-14 },
    // An ordering breaks ties by the order in which they are met.
    Rule { quantity: "factor-nonzeros", relative: 0.01, absolute: 0.0 },
];

/// Fraction of the largest number of the same unit in a run below which a number is rounding.
const ROUNDING: f64 = 1e-9;

/// Whether two values of a quantity may come from the same method on two processors. `scale` is the largest
/// number of the unit in the run, or 1 for pure numbers.
pub(super) fn close(quantity: &str, scale: f64, before: f64, now: f64) -> bool {
    let (relative, absolute) = match RULES.iter().find(|rule| quantity.starts_with(rule.quantity)) {
        Some(rule) => (rule.relative, rule.absolute),
        None => (RELATIVE, 0.0),
    };
    let allowed = (relative * before.abs().max(now.abs())).max(absolute).max(ROUNDING * scale);
    (before - now).abs() <= allowed
}
