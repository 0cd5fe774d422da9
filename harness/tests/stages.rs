//! Supports that begin late or end early.

mod common;

use common::{assert_fails, number, solved, tissuebench, write};
use serde_json::Value;

#[track_caller]
fn run(text: &str) -> Value {
    solved(&tempfile::tempdir().unwrap(), text)
}

const METHODS: [&str; 2] = [
    r#"
[[method]]
id = "hex8"
family = "fem"
element = "hex8"
size = { cells = [2, 2, 2] }
"#,
    r#"
[[method]]
id = "efg"
family = "efg"
size = { cells = [2, 2, 2] }
kernel = "cubic-spline"
support_scale = 1.6
basis = "linear"
integration = { rule = "cell-smoothed" }
essential = { method = "penalty", factor = 1e6 }
"#,
];

/// A cube of 20 mm on rollers, with E = 20 kPa and nu = 0.
fn cube(procedure: &str, rest: &str, method: &str) -> String {
    format!(
        r#"title = "A cube on rollers"
body = {{ shape = "box", size = ["20 mm", "20 mm", "20 mm"] }}
material = {{ law = "linear", young = "20 kPa", poisson = 0.0, density = "1000 kg/m^3" }}
{procedure}
[[support]]
on = "x-min"
fix = "x"
[[support]]
on = "y-min"
fix = "y"
[[support]]
on = "z-min"
fix = "z"
{rest}
[output]
probes = [["20 mm", "20 mm", "20 mm"]]
{method}"#
    )
}

/// Forces of a support and the height of a probe in each step, N and m.
fn course(object: &Value, support: usize) -> Vec<[f64; 2]> {
    let steps = object["steps"].as_array().unwrap();
    let each = steps.iter().map(|step| {
        [&step["supports"][support][2], &step["probes"][0][2]].map(|value| value.as_f64().unwrap())
    });
    each.collect()
}

#[track_caller]
fn assert_course(found: &[[f64; 2]], expected: &[[f64; 2]], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    for (step, (found, expected)) in found.iter().zip(expected).enumerate() {
        let [force, height] = [0, 1].map(|k| (found[k] - expected[k]).abs());
        assert!(force < 0.4 * tolerance && height < 1e-3 * tolerance, "{step}: {found:?} {expected:?}");
    }
}

/// The stiffness of the cube is 400 N/m.
#[test]
fn a_support_pulls_lets_go_and_another_catches_the_loaded_face() {
    for (method, tolerance) in METHODS.into_iter().zip([1e-8, 1e-4]) {
        let object = run(&cube(
            r#"
procedure = { kind = "static", steps = 10 }
curve = [
    { name = "load", part = [0.4, 0.6, 1], factor = [0, 1, 0] },
    { name = "push", part = [0.7, 1], factor = [0.5, -0.5] },
]"#,
            r#"
[[support]]
on = "z-max"
move = { z = "1 mm" }
during = [0, 0.35]
[[load]]
on = "z-max"
traction = ["0 kPa", "0 kPa", "1 kPa"]
curve = "load"
[[support]]
on = "z-max"
move = { z = "1 mm" }
curve = "push"
during = [0.7, 0.9]
"#,
            method,
        ));
        // The first support moves 1 mm over the whole loading, and lets go from 0.35 to 0.4. The second
        // catches the face at 0.75 mm, where the load alone holds it, and takes it back by a third of a
        // millimetre a step.
        let third = 1e-3 / 3.0;
        let heights =
            [0.1e-3, 0.2e-3, 0.3e-3, 0.0, 0.5e-3, 1e-3, 0.75e-3, 0.75e-3 - third, 0.75e-3 - 2.0 * third, 0.0];
        let pulled: Vec<[f64; 2]> =
            (0..10).map(|k| [if k < 3 { 400.0 * heights[k] } else { 0.0 }, heights[k]]).collect();
        assert_course(&course(&object, 3), &pulled, tolerance);
        let caught: Vec<[f64; 2]> = (0..10)
            .map(|k| {
                let load = 0.4 * (1.0 - (k as f64 + 1.0 - 6.0) / 4.0);
                [if matches!(k, 7 | 8) { 400.0 * heights[k] - load } else { 0.0 }, heights[k]]
            })
            .collect();
        assert_course(&course(&object, 4), &caught, tolerance);
    }
}

#[test]
fn a_quasi_static_body_lets_go_in_time() {
    let object = run(&cube(
        r#"procedure = { kind = "implicit-dynamic", inertia = false, duration = "2 s", over = "2 s", steps = 4 }"#,
        r#"
[[support]]
on = "z-max"
move = { z = "1 mm" }
during = ["0 s", "1 s"]
"#,
        METHODS[0],
    ));
    assert_course(&course(&object, 3), &[[0.1, 0.25e-3], [0.2, 0.5e-3], [0.0, 0.0], [0.0, 0.0]], 1e-8);
}

/// Theory of bars: a bar that is stretched and let go at one end is a triangular wave of the period
/// `4 L / c`.
#[test]
fn a_body_with_mass_that_is_let_go_vibrates() {
    let (length, density, young) = (0.02, 1000.0, 20e3f64);
    let quarter = length / (young / density).sqrt();
    // The stretch takes forty quarters of a period, so that the bar is at rest when it is let go.
    let start = 40.0 * quarter;
    let end = 44.0 * quarter;
    // The second explicit run lets go half-way between two of its states.
    for (procedure, until) in [
        (r#"kind = "implicit-dynamic", steps = 880, spectral_radius = 1"#, start),
        (r#"kind = "explicit", steps = 44"#, start),
        (r#"kind = "explicit", steps = 880"#, start + quarter / 40.0),
    ] {
        let scene = cube(
            &format!(
                r#"
procedure = {{ {procedure}, duration = "{end} s" }}
curve = [{{ name = "stretch", time = ["0 s", "{start} s"], factor = [0, 1], smooth = true }}]
"#
            ),
            &format!(
                r#"
[[support]]
on = "z-max"
move = {{ z = "1 mm" }}
curve = "stretch"
during = ["0 s", "{until} s"]
"#
            ),
            &METHODS[0].replace("[2, 2, 2]", "[1, 1, 16]"),
        );
        let object = run(&scene);
        let course = course(&object, 3);
        let each = course.len() / 44;
        for (quarters, expected) in [(40, 1e-3), (41, 0.0), (42, -1e-3), (43, 0.0), (44, 1e-3)] {
            let [force, height] = course[each * quarters - 1];
            assert!((height - expected).abs() < 1e-4, "{procedure} {quarters}: {height} {expected}");
            // The stiffness of the cube is 400 N/m.
            let held = if quarters == 40 { 0.4 } else { 0.0 };
            assert!((force - held).abs() < 1e-3, "{procedure} {quarters}: {force} {held}");
        }
        let drift = number(&object, "energy-drift");
        assert!(drift < 1e-2, "{procedure}: {drift}");
    }
}

#[test]
fn a_body_that_is_let_go_with_nothing_left_to_hold_it_ends_there() {
    let scene = cube(
        r#"procedure = { kind = "static", steps = 4 }"#,
        r#"
[[support]]
on = "z-max"
move = { z = "1 mm" }
"#,
        METHODS[0],
    )
    .replace("fix = \"x\"\n", "fix = \"x\"\nduring = [0, 0.5]\n");
    let dir = tempfile::tempdir().unwrap();
    let path = write(&dir, "scene.toml", &scene);
    assert_fails(
        &tissuebench(&["run", &path]),
        3,
        "stopped at 0.5000 of the load, after which rigid motion is left free",
    );
}

#[test]
fn supports_that_contradict_each_other_at_the_same_time_are_refused() {
    let two = |first: &str, second: &str| {
        cube(
            r#"procedure = { kind = "static", steps = 4 }"#,
            &format!(
                r#"
[[support]]
on = "z-max"
move = {{ z = "1 mm" }}
during = {first}
[[support]]
on = "z-max"
move = {{ z = "2 mm" }}
during = {second}
"#
            ),
            METHODS[0],
        )
    };
    run(&two("[0, 0.5]", "[0.5, 1]"));
    let dir = tempfile::tempdir().unwrap();
    let path = write(&dir, "scene.toml", &two("[0, 0.5]", "[0.4, 1]"));
    assert_fails(&tissuebench(&["run", &path]), 2, "prescribes 2.000000e0 mm along z");
}
