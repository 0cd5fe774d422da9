//! How far numbers may be apart that two kinds of processors give.
//!
//! Fused products and the width of registers change the last bits of sums; a method amplifies them by the condition of what
//! it solves. Numbers that are nothing but rounding have no digits to compare.

/// Relative difference allowed unless a rule says otherwise.
const RELATIVE: f64 = 1e-6;

/// A looser tolerance of a quantity.
struct Rule {
    /// Start of the quantity's name.
    quantity: &'static str,
    /// Relative difference allowed.
    relative: f64,
    /// Difference allowed of numbers of any size, in the quantity's unit.
    absolute: f64,
}

const RULES: &[Rule] = &[
    // What a solver leaves below its tolerance is rounding.
    Rule { quantity: "residual", relative: 0.0, absolute: 1e-6 },
    // A residual close to its tolerance takes one more.
    Rule { quantity: "newton-iterations", relative: 0.1, absolute: 2.0 },
    // Shear on a section sums to rounding, beside which the run has no force: 1e-17 N of 1e-2 N on each half.
    Rule { quantity: "load-x", relative: RELATIVE, absolute: 1e-14 },
    Rule { quantity: "load-y", relative: RELATIVE, absolute: 1e-14 },
    Rule { quantity: "load-z", relative: RELATIVE, absolute: 1e-14 },
    // An ordering breaks ties by the order in which it meets them.
    Rule { quantity: "factor-nonzeros", relative: 0.01, absolute: 0.0 },
];

/// Below this share of the largest number of the same unit in a run, a number is rounding.
const ROUNDING: f64 = 1e-9;

/// Whether two values of a quantity may come from the same method on two processors; `scale` is the largest number of its
/// unit in the run, 1 for pure numbers.
pub(super) fn close(quantity: &str, scale: f64, before: f64, now: f64) -> bool {
    let (relative, absolute) = match RULES.iter().find(|rule| quantity.starts_with(rule.quantity)) {
        Some(rule) => (rule.relative, rule.absolute),
        None => (RELATIVE, 0.0),
    };
    let allowed = (relative * before.abs().max(now.abs())).max(absolute).max(ROUNDING * scale);
    (before - now).abs() <= allowed
}
