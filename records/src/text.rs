//! Numbers and names as text, for all output formats.

/// Four significant digits as `1.234e-3`, for tables and snapshots.
pub fn scientific(value: f64) -> String {
    format!("{value:.3e}")
}

/// A readable number with `digits` significant digits, plain between 0.001 and 100 000, scientific otherwise.
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".into();
    }
    // Rounding first prevents 9.996 from becoming 10.00 with one digit too many.
    let rounded: f64 = format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value);
    let exponent = rounded.abs().log10().floor() as i32;
    if (-3..5).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        format!("{rounded:.decimals$}")
    } else {
        let text = format!("{rounded:.*e}", digits.saturating_sub(1));
        match text.split_once('e') {
            Some((mantissa, power)) => format!("{mantissa}×10{}", superscript(power)),
            None => text,
        }
    }
}

/// A number on an axis: plain from 0.001 to 1000, a [`power`] of ten otherwise.
pub fn tick(value: f64) -> String {
    let exponent = exponent(value);
    if value == 0.0 {
        "0".into()
    } else if (-3..=3).contains(&exponent) {
        // 0.015 and 1.5 need one more decimal than 0.01 and 1.
        let mantissa = value / 10f64.powi(exponent);
        let finer = i32::from((mantissa - mantissa.round()).abs() > 1e-6);
        let decimals = (finer - exponent).max(0) as usize;
        format!("{value:.decimals$}")
    } else {
        power(value)
    }
}

/// A number with all its digits: plain from 0.001 to 100 000, a [`power`] of ten otherwise.
pub fn short(value: f64) -> String {
    if value == 0.0 || (1e-3..1e5).contains(&value.abs()) { value.to_string() } else { power(value) }
}

/// A number in powers of ten, as `10⁻³`, `2×10⁻³` or `1.5×10⁻³`; plain from 1 to 100.
pub fn power(value: f64) -> String {
    let exponent = exponent(value);
    if value == 0.0 || (0..=1).contains(&exponent) {
        return tick(value);
    }
    let mantissa = value / 10f64.powi(exponent);
    let ten = format!("10{}", superscript(&exponent.to_string()));
    if (mantissa - 1.0).abs() < 1e-6 {
        ten
    } else if (mantissa - mantissa.round()).abs() < 1e-6 {
        format!("{mantissa:.0}×{ten}")
    } else {
        format!("{mantissa:.1}×{ten}")
    }
}

/// Exponent of the power of ten at or below a number, with a tolerance for rounding.
fn exponent(value: f64) -> i32 {
    (value.abs().log10() + 1e-9).floor() as i32
}

/// A spread next to its median: one significant digit, plain if the median is plain.
pub fn spread(value: f64, median: f64) -> String {
    let plain = |v: f64| (1e-3..1e5).contains(&v.abs());
    if value <= 0.0 || plain(value) || !plain(median) {
        return significant(value, 1);
    }
    let decimals = (-value.log10().floor()).clamp(0.0, 6.0) as usize;
    format!("{value:.decimals$}")
}

/// A Poisson's ratio with at most six decimals, because a ratio computed from moduli has seventeen
/// meaningless digits.
pub fn ratio(poisson: f64) -> String {
    format!("{:.6}", poisson).trim_end_matches('0').trim_end_matches('.').to_string()
}

/// A time in the most readable unit, from nanoseconds to hours.
pub fn duration(seconds: f64) -> String {
    let (scale, unit) = match seconds {
        s if s >= 7200.0 => (3600.0, "h"),
        s if s >= 1.0 => (1.0, "s"),
        s if s >= 1e-3 => (1e-3, "ms"),
        s if s >= 1e-6 => (1e-6, "µs"),
        _ => (1e-9, "ns"),
    };
    format!("{} {unit}", significant(seconds / scale, 3))
}

/// A relative error in per cent, or in scientific notation if it is very small.
pub fn percent(value: f64) -> String {
    if value == 0.0 || value.abs() >= 1e-4 {
        format!("{} %", significant(100.0 * value, 3))
    } else {
        significant(value, 2)
    }
}

/// A list in words: `a`, `a and b`, `a, b and c`.
pub fn list(items: &[String]) -> String {
    match items {
        [] => String::new(),
        [one] => one.clone(),
        [head @ .., last] => format!("{} and {last}", head.join(", ")),
    }
}

/// Plural ending `s`; empty for a count of 1.
pub fn plural(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}

fn superscript(power: &str) -> String {
    let digits = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    power.chars().map(|c| c.to_digit(10).map_or('⁻', |d| digits[d as usize])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        assert_eq!(significant(9.996, 3), "10.0");
        assert_eq!(significant(0.00123456, 3), "0.00123");
        assert_eq!(significant(1234.5, 3), "1230");
        assert_eq!(significant(-1.25e-7, 3), "-1.25×10⁻⁷");
        assert_eq!(significant(0.0, 3), "0");
        assert_eq!(scientific(0.0174314), "1.743e-2");
        assert_eq!(tick(0.05), "0.05");
        assert_eq!(tick(1e-6), "10⁻⁶");
        assert_eq!(tick(2e-5), "2×10⁻⁵");
        assert_eq!(tick(1000.0), "1000");
        assert_eq!((tick(1.5), tick(0.015), tick(15.0)), ("1.5".into(), "0.015".into(), "15".into()));
        assert_eq!(tick(1.5e-4), "1.5×10⁻⁴");
        assert_eq!((tick(0.003), tick(300.0), tick(2e4)), ("0.003".into(), "300".into(), "2×10⁴".into()));
        assert_eq!((power(0.3), power(1.0), power(2.0)), ("3×10⁻¹".into(), "1".into(), "2".into()));
        assert_eq!((power(10.0), power(30.0)), ("10".into(), "30".into()));
        assert_eq!(spread(2e-4, 0.0315), "0.0002");
        assert_eq!(spread(0.05, 1.23), "0.05");
        assert_eq!(spread(2e-9, 3e-8), "2×10⁻⁹");
        assert_eq!(
            (ratio(0.49500000000000005), ratio(0.4999), ratio(0.0)),
            ("0.495".into(), "0.4999".into(), "0".into())
        );
        assert_eq!(duration(7200.0), "2.00 h");
        assert_eq!(duration(0.0123), "12.3 ms");
        assert_eq!(percent(0.0123), "1.23 %");
        assert_eq!(percent(3e-15), "3.0×10⁻¹⁵");
        assert_eq!(list(&["a".into(), "b".into(), "c".into()]), "a, b and c");
    }
}
