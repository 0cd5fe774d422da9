//! Tolerances between numbers from two kinds of processors.
//!
//! Fused multiply-adds and register widths change the last bits of sums, and a method amplifies these by the
//! condition of its system. Numbers that consist only of rounding are not compared.

use catalogue::metric::{self, Metric};

/// Relative tolerance of quantities without a rule.
const RELATIVE: f64 = 1e-6;

/// A larger tolerance of a quantity.
struct Rule {
    quantity: &'static Metric,
    /// Relative tolerance.
    relative: f64,
    /// Absolute tolerance, in the quantity's unit.
    absolute: f64,
}

static RULES: [Rule; 4] = [
    // A residual below the solver's tolerance is rounding.
    Rule { quantity: &metric::RESIDUAL, relative: 0.0, absolute: 1e-6 },
    // A residual close to its tolerance may take another iteration.
    Rule { quantity: &metric::NEWTON_ITERATIONS, relative: 0.1, absolute: 2.0 },
    // Shear on a section sums to rounding, 1e-17 N from 1e-2 N on each half, and the run has no other force.
    Rule { quantity: &metric::LOAD, relative: RELATIVE, absolute: 1e-14 },
    // An ordering breaks ties by the order in which they are met.
    Rule { quantity: &metric::FACTOR_NONZEROS, relative: 0.01, absolute: 0.0 },
];

/// Fraction of the largest number of the same unit in a run below which a number is rounding.
const ROUNDING: f64 = 1e-9;

/// Whether two values of a quantity, named with its unit (`load-x [N]`), may come from the same method on two
/// processors. `scale` is the largest number of the unit in the run, or 1 for pure numbers.
pub(super) fn close(quantity: &str, scale: f64, before: f64, now: f64) -> bool {
    let metric = quantity.split(' ').next().and_then(metric::find).map(|of| of.metric);
    let (relative, absolute) = match RULES.iter().find(|rule| metric == Some(rule.quantity)) {
        Some(rule) => (rule.relative, rule.absolute),
        None => (RELATIVE, 0.0),
    };
    let allowed = (relative * before.abs().max(now.abs())).max(absolute).max(ROUNDING * scale);
    (before - now).abs() <= allowed
}
