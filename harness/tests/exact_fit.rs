//! Exact solutions have to be solutions of the scene: otherwise the errors are distances between two
//! problems.

mod common;

use common::{objects, tissuebench, write};
use serde_json::Value;
use tempfile::TempDir;

/// Warning of a scene's only method that the exact solution does not fit, if any.
#[track_caller]
fn misfit(text: &str) -> Option<Value> {
    let dir = TempDir::new().unwrap();
    let done = tissuebench(&["run", &write(&dir, "scene.toml", text), "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let warnings = objects(&done.stdout).remove(0)["warnings"].clone();
    warnings.as_array().unwrap().iter().find(|w| w["code"] == "exact-misfit").cloned()
}

fn patch(support: &str, load: &str) -> String {
    format!(
        r#"title = "Pressed between rollers"
body = {{ shape = "box", size = ["20 mm", "20 mm", "20 mm"] }}
material = {{ law = "linear", young = "20 kPa", poisson = 0.3 }}
support = [{support}]
load = [{load}]
reference = {{ exact = "uniaxial-compression", strain = 0.05 }}
method = [{{ id = "hex8", family = "fem", element = "hex8", size = {{ cells = [2, 2, 2] }} }}]
"#
    )
}

const ROLLERS: &str =
    r#"{ on = "x-min", fix = "x" }, { on = "y-min", fix = "y" }, { on = "z-min", fix = "z" }"#;

#[test]
fn loads_and_supports_that_are_not_those_of_the_solution_are_told() {
    let pressed = |pressure: &str| format!("{{ on = \"z-max\", pressure = \"{pressure}\" }}");
    assert_eq!(misfit(&patch(ROLLERS, &pressed("1 kPa"))), None);
    let near = |found: Option<Value>, value: f64, surface: &str, what: &str| {
        let found = found.unwrap_or_else(|| panic!("{value} {surface}"));
        assert!((found["value"].as_f64().unwrap() - value).abs() < 1e-6, "{found}");
        assert_eq!(found["where"], "reference.exact");
        let message = found["message"].as_str().unwrap();
        assert!(message.contains(surface) && message.contains(what), "{message}");
    };
    // The scene has a load of another magnitude, a load on another surface, or a support with more
    // constraints.
    near(misfit(&patch(ROLLERS, &pressed("1.05 kPa"))), 0.05 / 1.05, "z-max", "traction");
    let beside = format!("{}, {{ on = \"y-max\", pressure = \"200 Pa\" }}", pressed("1 kPa"));
    near(misfit(&patch(ROLLERS, &beside)), 0.2, "y-max", "traction");
    let clamped = ROLLERS.replace("fix = \"z\"", "fix = \"xyz\"");
    // The difference is 0.3 of 0.05 along x and y. It is relative to the largest displacement on a face,
    // z-max, which also moves by 0.05 along z.
    let sideways = (0.06_f64 / 1.06).sqrt();
    near(misfit(&patch(&clamped, &pressed("1 kPa"))), sideways, "z-min", "displacement");
}

/// Flat facets have other normals than the sphere. This is a property of the mesh, not of the scene.
#[test]
fn a_curved_surface_of_flat_facets_fits() {
    let sphere = |inside: &str, level: usize| {
        format!(
            r#"title = "Thick sphere"
body = {{ shape = "sphere-shell", inner = "10 mm", outer = "20 mm", octant = true }}
material = {{ law = "linear", young = "20 kPa", poisson = 0.3 }}
support = [{ROLLERS}]
load = [{{ on = "inner", pressure = "{inside}" }}]
reference = {{ exact = "thick-sphere", inner = "10 mm", outer = "20 mm", inner_pressure = "2 kPa" }}
method = [{{ id = "tet4", family = "fem", element = "tet4", size = {{ level = {level} }} }}]
"#
        )
    };
    assert_eq!((misfit(&sphere("2 kPa", 1)), misfit(&sphere("2 kPa", 2))), (None, None));
    assert!(misfit(&sphere("3 kPa", 2)).is_some());
}
