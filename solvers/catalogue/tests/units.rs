//! Units, checked by their sizes.

use tissuebench_catalogue::Quantity;

/// The power applies to the unit's factor as well as to its power of ten.
#[test]
fn powers_are_of_all_of_a_unit() {
    for (text, value) in [
        ("60 /min", 1.0),
        ("7200 m/min^2", 2.0),
        ("3600 /h", 1.0),
        ("2 N min^2", 7200.0),
        ("1 deg^2", (std::f64::consts::PI / 180.0).powi(2)),
        ("5 mm\u{b2}", 5e-6),
        ("1 N/mm^2", 1e6),
    ] {
        let found = Quantity::read(text).unwrap().value;
        assert!((found - value).abs() <= 1e-15 * value, "{text}: {found}");
    }
}
