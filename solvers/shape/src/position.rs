//! Positions and lengths in messages, in the unit and with the digits that fit the body.

use crate::Point3;

/// Significant digits relative to the size.
const DIGITS: f64 = 3.0;

/// Writes a position (m) in a body of this size (m), such as `(12.3, 0.0, 4.5) mm` for a size of 60 mm.
pub fn position(x: &Point3, size: f64) -> String {
    text(&[x.x, x.y, x.z], size)
}

/// Writes a position (m) in a body of unknown size, with four significant digits of its largest coordinate.
pub fn position_alone(x: &Point3) -> String {
    position(x, 0.1 * x.coords.amax())
}

/// Writes a length (m) with three significant digits, such as `12.3 um`.
pub fn length(value: f64) -> String {
    text(&[value], value.abs())
}

/// Writes numbers (m) in the unit of the largest number, with three significant digits of `size` (m).
fn text(numbers: &[f64], size: f64) -> String {
    let largest = numbers.iter().fold(size, |most, number| most.max(number.abs()));
    let (unit, metres) = match largest {
        m if m >= 1.0 => ("m", 1.0),
        m if m >= 1e-3 => ("mm", 1e-3),
        _ => ("um", 1e-6),
    };
    let places = if size > 0.0 { DIGITS - 1.0 - (size / metres).log10().floor() } else { 0.0 };
    let places = places.clamp(0.0, 12.0) as usize;
    let one = |number: &f64| {
        let text = format!("{:.places$}", number / metres);
        // A negative number that is rounded to zero has no sign.
        let is_zero = text.bytes().all(|c| matches!(c, b'-' | b'0' | b'.'));
        if is_zero { text.trim_start_matches('-').to_string() } else { text }
    };
    let all: Vec<String> = numbers.iter().map(one).collect();
    match &all[..] {
        [single] => format!("{single} {unit}"),
        _ => format!("({}) {unit}", all.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unit_and_digits_fit_the_body() {
        let x = Point3::new(12.345e-3, -1e-9, 40e-3);
        let with = |factor: f64| position(&(x * factor), 60e-3 * factor);
        assert_eq!(with(1.0), "(12.3, 0.0, 40.0) mm");
        assert_eq!(with(1e-3), "(12.3, 0.0, 40.0) um");
        assert_eq!(with(1e-5), "(0.123, 0.000, 0.400) um");
        assert_eq!(with(100.0), "(1.23, 0.00, 4.00) m");
        // A small body far from the origin.
        assert_eq!(position(&Point3::new(0.5, 0.250_012_3, 0.0), 20e-6), "(500.0000, 250.0123, 0.0000) mm");
        assert_eq!(position_alone(&x), "(12.35, 0.00, 40.00) mm");
        assert_eq!(position_alone(&Point3::origin()), "(0, 0, 0) um");
    }

    #[test]
    fn lengths_have_three_digits() {
        let all = [0.0123, -1.5, 4.2e-7, 0.0, 1.0].map(length);
        assert_eq!(all, ["12.3 mm", "-1.50 m", "0.420 um", "0 um", "1.00 m"]);
    }
}
