//! Results other than errors: support forces, means over faces, frequencies, maxima over time, and warnings
//! if a size or a law differs from the intention.

mod common;

use common::{BLOCK, assert_fails, objects, tissuebench, write};
use serde_json::Value;

/// Runs a scene and returns its JSON objects.
#[track_caller]
fn run(text: &str) -> Vec<Value> {
    let dir = tempfile::tempdir().unwrap();
    let done = tissuebench(&["run", &write(&dir, "scene.toml", text), "--once", "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    objects(&done.stdout)
}

fn metric(run: &Value, name: &str) -> f64 {
    run["metrics"][name]["value"].as_f64().unwrap_or_else(|| panic!("no {name} in {run}"))
}

fn vector(value: &Value) -> [f64; 3] {
    [0, 1, 2].map(|axis| value[axis].as_f64().unwrap_or_else(|| panic!("no vector: {value}")))
}

/// Total force of the supports on the body, N.
fn held(run: &Value) -> [f64; 3] {
    let all = run["supports"].as_array().unwrap_or_else(|| panic!("no supports in {run}")).iter();
    all.map(|support| vector(&support["force"])).fold([0.0; 3], |sum, f| [0, 1, 2].map(|a| sum[a] + f[a]))
}

fn codes(run: &Value) -> Vec<&str> {
    run["warnings"].as_array().unwrap().iter().map(|w| w["code"].as_str().unwrap()).collect()
}

#[track_caller]
fn near(found: f64, expected: f64, within: f64) {
    assert!((found - expected).abs() <= within, "{found}, not {expected}");
}

/// All treatments of essential conditions, with elements and with a cloud.
fn every_essential() -> String {
    let cloud = |essential: &str| {
        format!(
            r#"{{ id = "{essential}", family = "efg", size = {{ cells = [3, 2, 2] }}, kernel = "cubic-spline", support_scale = 1.6, basis = "linear", integration = {{ rule = "cell-smoothed", points = 1 }}, essential = "{essential}" }}"#
        )
    };
    let clouds = ["nitsche", "penalty", "multipliers", "elimination", "coupling"].map(cloud).join(",\n");
    format!(
        r#"method = [
{{ id = "tet4", family = "fem", element = "tet4", size = {{ level = 1 }} }},
{{ id = "hex20", family = "fem", element = "hex20", size = {{ level = 1 }} }},
{clouds}]
"#
    )
}

/// A bar of 40 x 20 x 20 mm on rollers under 0.2 kPa, with the solution `u = (s / E) (x, -nu y, -nu z)`.
const BAR: &str = r#"title = "A bar"
body = { shape = "box", size = ["40 mm", "20 mm", "20 mm"] }
material = { law = "linear", young = "20 kPa", poisson = 0.3 }
support = [{ on = "x-min", fix = "x" }, { on = "y-min", fix = "y" }, { on = "z-min", fix = "z" }]
load = [{ on = "x-max", traction = ["0.2 kPa", "0 Pa", "0 Pa"] }]
output = { means = [{ on = "x-max" }, { where = "z == 20 mm and x <= 15 mm" }] }
"#;

#[test]
fn a_bar_is_held_by_its_load_and_its_faces_move_as_the_linear_field_does() {
    let runs = run(&format!("{BAR}{}", every_essential()));
    assert_eq!(runs.len(), 7);
    for run in &runs {
        let [x, y, z] = held(run);
        near(x, -0.08, 1e-8);
        near(y, 0.0, 1e-8);
        near(z, 0.0, 1e-8);
        assert_eq!(metric(run, "reaction-x"), vector(&run["supports"][0]["force"])[0]);
        // A support has no force along a free axis.
        assert!(run["metrics"]["reaction-y"].is_null() && run["metrics"]["reaction-y-2"].is_object());
        // A penalty support yields by 1e-3 of mesh size times strain.
        let gives = if run["method"] == "penalty" { 4e-7 } else { 1e-10 };
        // Means of x / 100 over the end face, and over the part of the top with x up to 15 mm, which cuts
        // through cells.
        let expected = [[4e-4, -3e-5, -3e-5], [7.5e-5, -3e-5, -6e-5]];
        for (face, expected) in expected.iter().enumerate() {
            let found = vector(&run["means"][face]["u"]);
            (0..3).for_each(|axis| near(found[axis], expected[axis], gives));
        }
        near(metric(run, "mean-x-2"), 7.5e-5, gives);
        assert!(codes(run).is_empty(), "{:?}", codes(run));
    }
    assert_eq!(runs[0]["supports"][1]["name"], "y-min");
    assert_eq!(runs[0]["means"][1]["name"], "z == 20 mm and x <= 15 mm");
}

#[test]
fn a_weight_hangs_on_all_supports_together() {
    let text = BAR.replace("{ on = \"x-min\", fix = \"x\" }", "{ on = \"z-max\", fix = \"xyz\" }").replace(
        "on = \"x-max\", traction = [\"0.2 kPa\", \"0 Pa\", \"0 Pa\"]",
        "body = [\"10 N/m^3\", \"0 N/m^3\", \"-9.81 kN/m^3\"]",
    );
    for run in run(&format!("{text}{}", every_essential())) {
        let [x, y, z] = held(&run);
        near(x, -10.0 * 16e-6, 1e-6 * 9810.0 * 16e-6);
        near(y, 0.0, 1e-6 * 9810.0 * 16e-6);
        near(z, 9810.0 * 16e-6, 1e-6 * 9810.0 * 16e-6);
    }
}

#[test]
fn a_tool_is_borne_by_the_support_at_every_step() {
    let runs = run(r#"title = "A ball on a block"
body = { shape = "box", size = ["40 mm", "20 mm", "20 mm"] }
material = { law = "neo-hookean", young = "20 kPa", poisson = 0.45 }
support = [{ on = "z-min", fix = "xyz" }]
tool = [{ name = "plate", shape = "plate", at = ["20 mm", "10 mm", "20 mm"], along = [0, 0, -1], drive = { closure = "1.5 mm" }, penalty = "0.5 MPa/mm" }]
procedure = { kind = "static", steps = 2 }
output = { means = [{ on = "z-max" }] }
method = [
    { id = "hex8", family = "fem", element = "hex8", dilation = "nodal-mean", size = { cells = [4, 2, 2] } },
    { id = "tet10", family = "fem", element = "tet10", dilation = "mixed", size = { level = 1 } },
    { id = "efg", family = "efg", nodes = 100, kernel = "cubic-spline", support_scale = 1.6, basis = "linear", integration = { rule = "cell-smoothed", points = 1 }, essential = "penalty" },
]
"#);
    for run in &runs {
        let (force, tool) = (held(run), vector(&run["tools"][0]["force"]));
        assert!(tool[2] > 0.5, "{run}");
        (0..3).for_each(|axis| near(force[axis], tool[axis], 1e-5 * tool[2]));
        assert_eq!(run["steps"].as_array().unwrap().len(), 2);
        for step in run["steps"].as_array().unwrap() {
            let support = vector(&step["supports"][0]);
            let tool = vector(&step["tools"][0]["force"]);
            near(support[2], tool[2], 1e-5 * tool[2]);
            assert!(vector(&step["means"][0])[2] < 0.0);
        }
        near(vector(&run["means"][0]["u"])[2], -1.5e-3, 2e-5);
    }
}

/// A suddenly loaded block, which swings to twice its static displacement and back in a quarter of a second.
fn swinging(procedure: &str) -> String {
    let text = BLOCK.replace("poisson = 0.3", "poisson = 0.0, density = \"1000 kg/m^3\"");
    let text = text.replace(
        "fix = \"xyz\"",
        "fix = \"z\" }, { on = \"x-min\", fix = \"x\" }, { on = \"y-min\", fix = \"y\"",
    );
    format!("{}procedure = {{ {procedure} }}\n", text.replace("cells = [2, 2, 1]", "cells = [1, 1, 2]"))
}

#[test]
fn a_swing_has_its_largest_displacement_in_its_middle() {
    // The period of a bar of 20 mm with one end free: 4 L / c = 17.9 ms, c = sqrt(E / rho).
    for kind in ["explicit", "implicit-dynamic"] {
        let runs =
            run(&swinging(&format!("kind = \"{kind}\", over = \"0 s\", duration = \"17 ms\", steps = 34")));
        let (largest, at, end) =
            (metric(&runs[0], "max-over-time"), metric(&runs[0], "time-of-max"), metric(&runs[0], "max"));
        // With two elements along the bar, the wave front overshoots.
        near(largest, 2e-3, 4e-4);
        assert!((0.006..0.012).contains(&at), "{kind}: {at}");
        assert!(end < 0.2 * largest, "{kind}: {end} of {largest}");
        let dir = tempfile::tempdir().unwrap();
        let table = tissuebench(&[
            "run",
            &write(
                &dir,
                "s.toml",
                &swinging(&format!("kind = \"{kind}\", over = \"0 s\", duration = \"17 ms\", steps = 34")),
            ),
        ]);
        assert!(
            table.stdout.contains("largest over time [mm]") && table.stdout.contains("end z [mm]"),
            "{}",
            table.stdout
        );
        assert!(!table.stdout.contains("max z [mm]"), "{}", table.stdout);
    }
}

#[test]
fn a_motion_that_has_come_to_rest_is_borne_by_its_support() {
    for kind in ["explicit", "implicit-dynamic"] {
        let damped = format!(
            "kind = \"{kind}\", over = \"50 ms\", duration = \"0.4 s\", steps = 40, damping = \"200 /s\""
        );
        let runs = run(&swinging(&damped));
        // The load is 1 kPa on 40 x 40 mm.
        near(held(&runs[0])[2], 1.6, 2e-3);
        assert_eq!(runs[0]["steps"].as_array().unwrap().len(), 40);
    }
}

#[test]
fn modes_are_listed_in_hertz() {
    let text = BLOCK.replace("poisson = 0.3", "poisson = 0.3, density = \"1000 kg/m^3\"").replace(
        "load = [{ on = \"z-max\", pressure = \"1 kPa\" }]",
        "procedure = { kind = \"modes\", modes = 3 }",
    );
    let text = text.replace("element = \"tet4\"", "element = \"tet4\", mass = \"consistent\"");
    let object = &run(&text)[0];
    let modes = object["modes"].as_array().unwrap();
    assert_eq!(modes.len(), 3);
    for mode in modes {
        let [hertz, omega] = ["frequency", "omega"].map(|name| mode[name]["value"].as_f64().unwrap());
        near(hertz * std::f64::consts::TAU, omega, 1e-9 * omega);
        assert!(hertz > 0.0 && mode["frequency"]["unit"] == "Hz");
    }
    let dir = tempfile::tempdir().unwrap();
    let table = tissuebench(&["run", &write(&dir, "scene.toml", &text)]).stdout;
    assert!(
        table.contains("[Hz]") && table.lines().filter(|l| l.starts_with("tet4")).count() == 4,
        "{table}"
    );
}

#[test]
fn large_strain_by_a_linear_law_is_warned_of() {
    let soft = BAR.replace("0.2 kPa", "3 kPa");
    let object = &run(&format!("{soft}{}", every_essential()))[0];
    let warning = object["warnings"].as_array().unwrap().iter().find(|w| w["code"] == "large-strain");
    let warning = warning.unwrap_or_else(|| panic!("{object}"));
    near(warning["value"].as_f64().unwrap(), 0.15, 1e-9);
    let message = warning["message"].as_str().unwrap();
    assert!(message.contains("15.0 % at (") && message.contains("in 100.00 % of the volume"), "{message}");
}

#[test]
fn a_size_that_is_not_met_is_said() {
    let text = BLOCK.replace("cells = [2, 2, 1]", "nodes = 100");
    let object = &run(&text)[0];
    let got = object["nodes"].as_f64().unwrap();
    assert!((got / 100.0 - 1.0).abs() > 0.1, "{got}");
    let warning =
        &object["warnings"].as_array().unwrap().iter().find(|w| w["code"] == "nodes-differ").unwrap();
    near(warning["value"].as_f64().unwrap(), got / 100.0, 1e-12);
    assert!(
        warning["message"].as_str().unwrap().contains(&format!("size = {{ nodes = 100 }} gives {got} nodes"))
    );
    let text = BLOCK.replace("cells = [2, 2, 1]", &format!("nodes = {got}"));
    assert!(!codes(&run(&text)[0]).contains(&"nodes-differ"));
}

#[test]
fn a_face_that_is_none_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let refused = |means: &str, says: &str| {
        let text = format!("{BLOCK}output = {{ means = {means} }}\n");
        assert_fails(&tissuebench(&["run", &write(&dir, "scene.toml", &text)]), 2, says);
    };
    refused("[]", "key 'output.means': is empty");
    refused("[{}]", "key 'output.means[0].where'");
    refused("[{ on = \"lid\" }]", "names 'lid', a surface that the mesh does not have");
    refused("[{ where = \"z == 30 mm\" }]", "touches no part of the body");
}
