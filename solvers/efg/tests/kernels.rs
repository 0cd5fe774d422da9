//! Properties common to all kernels.

use catalogue::{Value, Values, find};
use proptest::prelude::*;
use tissuebench_efg::{KERNELS, Kernel};

#[test]
fn one_at_the_centre_zero_from_the_rim_on_and_names_go_round() {
    assert_eq!(Kernel::all().count(), KERNELS.len());
    for kernel in Kernel::all() {
        let (w, dw) = kernel.eval(0.0);
        assert!((w - 1.0).abs() < 1e-15 && dw == 0.0, "{}: {w} {dw}", kernel.name());
        for q in [1.0, 1.0 + 1e-12, 1.5, f64::INFINITY] {
            assert_eq!(kernel.eval(q), (0.0, 0.0), "{}", kernel.name());
        }
        // Continuity at the boundary of the support.
        assert!(kernel.eval(1.0 - 1e-9).0.abs() < 1e-7, "{}", kernel.name());
        assert_eq!(Kernel::from_name(kernel.name()), Some(kernel));
    }
    assert_eq!(Kernel::from_name("cubic"), None);
}

/// Values computed by hand, which detect a kernel that is replaced by another.
#[test]
fn values_at_one_half() {
    let rim = (-6.25f64).exp();
    let expected = [
        ("cubic-spline", 0.25),
        ("quartic-spline", 0.3125),
        ("gaussian", ((-1.5625f64).exp() - rim) / (1.0 - rim)),
        ("exponential", ((-1.0f64).exp() - (-16.0f64).exp()) / (1.0 - (-16.0f64).exp())),
        ("wendland-c2", 3.0 / 16.0),
        ("wendland-c4", 83.0 / 4.0 / 192.0),
        ("wendland-c6", 61.0 / 1024.0),
        (
            "regularised-interpolating",
            (1.0 / 0.25001f64.powi(2) - 1.00001f64.powi(-2)) / (1e10 - 1.00001f64.powi(-2)),
        ),
    ];
    for (name, w) in expected {
        let found = Kernel::from_name(name).unwrap().eval(0.5).0;
        assert!((found / w - 1.0).abs() < 1e-13, "{name}: {found} instead of {w}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn positive_decreasing_and_differentiated_rightly(q in 0.02f64..0.98) {
        for kernel in Kernel::all() {
            let (w, dw) = kernel.eval(q);
            prop_assert!(w > 0.0 && dw < 0.0, "{} at {q}: {w} {dw}", kernel.name());
            // Fourth-order differences have errors of 1e-12 of the slope from the formula, and 1e-11 from
            // rounding.
            let h = 1e-3 * q.min(1.0 - q);
            let at = |t: f64| kernel.eval(q + t * h).0;
            let difference = (8.0 * (at(1.0) - at(-1.0)) - at(2.0) + at(-2.0)) / (12.0 * h);
            // The cubic spline's third derivative jumps at 1/2.
            if (q - 0.5).abs() > 2.0 * h {
                prop_assert!((difference - dw).abs() < 1e-8 * dw.abs() + 1e-12 * w / h, "{} at {q}: {dw} or {difference}", kernel.name());
            }
        }
    }
}

#[test]
fn parameters_that_make_no_kernel_are_refused() {
    for (name, parameter, value) in [
        ("gaussian", "alpha", 0.0),
        ("gaussian", "alpha", f64::NAN),
        ("exponential", "alpha", 10.1),
        ("exponential", "power", 0.0),
        ("exponential", "power", 1.5),
        ("regularised-interpolating", "eps", -1.0),
    ] {
        let mut values = Values::new(find(KERNELS, name).unwrap().parameters);
        assert!(values.give(parameter, Value::Number(value)).is_err(), "{name} {parameter} {value}");
    }
}

#[test]
fn parameters_reach_their_kernel() {
    let entry = find(KERNELS, "exponential").unwrap();
    let mut values = Values::new(entry.parameters);
    values.give("power", Value::Number(1.0)).unwrap();
    values.give("alpha", Value::Number(0.4)).unwrap();
    let exponential = (entry.build)(&values).unwrap();
    assert_eq!(exponential.eval(0.3), Kernel::from_name("gaussian").unwrap().eval(0.3));
}
