//! Expressions and units.

use tissuebench_cases::scene::*;

use crate::edited;

#[test]
fn expressions_follow_the_rules_of_algebra() {
    let x = [2.0_f64, 3.0, 5.0];
    for (text, value) in [
        ("-x^2", -4.0),
        ("(-x)^2", 4.0),
        ("1 - x^2 + y", 0.0),
        ("z - y - x", 0.0),
        ("z / x / x", 1.25),
        ("z / x * x", 5.0),
        ("z - y + x", 4.0),
        ("2*x^(-1)", 1.0),
        ("(x^y)^x", 64.0),
        ("x^(y^x)", 512.0),
        ("x^y^x", 512.0),
        ("2*-x^2", -8.0),
        ("x^-1", 0.5),
        ("x - -y", 5.0),
        ("hypot(y, x*2)", 5.0),
        ("cosh(ln(x))", 1.25),
        ("atan2(0, -x) / pi", 1.0),
        ("1.5e-3 * 2E3", 3.0),
        ("max(x, y) + min(x + 1, y * 2)", 6.0),
        ("2 * max(x, y)^2", 18.0),
        ("max(-x, -y)", -2.0),
        ("sin(pi / 6) * 2", 1.0),
        ("-sin(-pi / 2)^3", 1.0),
        ("ln(e^2)", 2.0),
        ("sqrt(x^2 + y^2 + 3)", 4.0),
        ("- 3 + x", -1.0),
        ("abs(x - z) * 1e0", 3.0),
        ("x*y + y*z - x/4", 20.5),
    ] {
        let scene = parse(&edited("z^2", text), "s.toml").unwrap_or_else(|e| panic!("{}", e[0]));
        let LoadKind::Pressure(field) = &scene.loads[0].kind else { panic!("pressure") };
        let found = field.value(x).expect("finite");
        assert!((found - value).abs() < 1e-13 * (1.0 + value.abs()), "{text} = {found}, not {value}");
    }
}

#[test]
fn a_field_that_is_not_finite_somewhere_says_where() {
    let scene = parse(&edited("z^2", "1 / (x - 2)"), "s.toml").expect("sound");
    let LoadKind::Pressure(field) = &scene.loads[0].kind else { panic!("pressure") };
    let said = field.value([2.0, 0.0, 1.0]).expect_err("a pole").to_string();
    assert_eq!(said, "expression '1 / (x - 2)' is inf at (2, 0, 1) m");
}

#[test]
fn units_of_the_field_are_known() {
    for (text, si) in [
        ("20 kPa", 2e4),
        ("20kPa", 2e4),
        ("0.02 MPa", 2e4),
        ("0.02 N/mm^2", 2e4),
        ("0.02 N/mm\u{b2}", 2e4),
        ("2e4 Pa", 2e4),
        ("2e1 N / mm / m", 2e4),
        ("20 mN/mm^2", 2e4),
        ("0.2 bar", 2e4),
        ("20000 kg/m/s^2", 2e4),
        ("20 kJ/m^3", 2e4),
        ("10 mmHg", 1333.22387415),
        ("35 \u{b5}Pa", 35e-6),
    ] {
        let scene = parse(&edited("20 kPa", text), "s.toml").unwrap_or_else(|e| panic!("{}", e[0]));
        let young = scene.material.constant("young").expect("linear");
        assert!((young / si - 1.0).abs() < 1e-15, "{text}: {young} Pa");
    }
}

#[test]
fn decimal_units_lose_no_bit() {
    for n in 1..1000 {
        let scene = parse(&edited("\"5 mm\"]]", &format!("\"{n} mm\"]]")), "s.toml").expect("sound");
        let nearest: f64 = format!("{n}e-3").parse().expect("a number");
        assert_eq!(scene.output.probes[0][2].to_bits(), nearest.to_bits(), "{n} mm");
    }
}
