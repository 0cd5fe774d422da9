//! Tools on paths with several legs.

mod common;

use common::{assert_fails, number, solved, tissuebench, write};
use serde_json::Value;

fn scene(tool: &str, path: &str, procedure: &str) -> String {
    format!(
        r#"title = "A block under a tool"
body = {{ shape = "box", size = ["30 mm", "20 mm", "10 mm"] }}
material = {{ law = "neo-hookean", young = "20 kPa", poisson = 0.45, density = "1000 kg/m^3" }}
support = [{{ on = "z-min", fix = "xyz" }}]
{procedure}
tool = [{{ name = "tool", {tool}, penalty = "20 kPa/mm", friction = 0.2, stick = "10 kPa/mm", drive = {{ {path} }} }}]

[[method]]
id = "hex8-mean"
family = "fem"
element = "hex8"
dilation = "element-mean"
size = {{ cells = [9, 6, 3] }}
"#
    )
}

const PLATE: &str = "shape = \"plate\", at = [\"15 mm\", \"10 mm\", \"10 mm\"], axis = [0, 0, -1]";
const BALL: &str = "shape = \"sphere\", radius = \"8 mm\", at = [\"12 mm\", \"10 mm\", \"18 mm\"]";
const DRAG: &str = "path = [[\"0 mm\", \"0 mm\", \"-1 mm\"], [\"4 mm\", \"0 mm\", \"0 mm\"]]";
const STATIC: &str = "procedure = { kind = \"static\", steps = 10 }";

#[track_caller]
fn run(text: &str) -> Value {
    solved(&tempfile::tempdir().unwrap(), text)
}

#[test]
fn a_plate_that_slips_has_coulombs_ratio_and_its_force_is_along_the_leg() {
    let object = run(&scene(PLATE, DRAG, STATIC));
    let [shear, normal] = ["reaction-x", "reaction-z"].map(|name| number(&object, name));
    assert!((shear / normal + 0.2).abs() < 2e-6, "{shear} {normal}");
    assert!((number(&object, "tool-force") + shear).abs() < 1e-8);
    assert!((number(&object, "closure") - 5e-3).abs() < 1e-15);
    // Up to the bend the tool has only pressed.
    let steps = object["steps"].as_array().unwrap();
    let pressed = steps[1]["tools"][0]["force"][2].as_f64().unwrap();
    assert!(pressed > 3.0 * shear.abs(), "{pressed}");
}

#[test]
fn steps_end_at_the_bends_of_a_path() {
    let whole = run(&scene(PLATE, DRAG, STATIC));
    let across = run(&scene(PLATE, DRAG, "procedure = { kind = \"static\", steps = 12 }"));
    for name in ["tool-force", "reaction-x", "reaction-z"] {
        let [whole, across] = [&whole, &across].map(|of| number(of, name));
        assert!((across / whole - 1.0).abs() < 1e-4, "{name}: {across} {whole}");
    }
    assert_eq!(across["steps"].as_array().unwrap().len(), 12);
}

#[test]
fn a_tool_that_is_lifted_leaves_the_body_at_rest() {
    let lifted = "path = [[\"0 mm\", \"0 mm\", \"-2 mm\"], [\"4 mm\", \"0 mm\", \"0 mm\"], [\"0 mm\", \"0 mm\", \"4 mm\"]]";
    let object = run(&scene(BALL, lifted, STATIC));
    assert_eq!(number(&object, "contact-points"), 0.0);
    assert!(number(&object, "tool-force").abs() < 1e-12);
    assert!(number(&object, "reaction-z").abs() < 1e-8);
}

#[test]
fn dynamics_and_statics_drag_alike() {
    let still = run(&scene(BALL, DRAG, STATIC));
    let slow = "procedure = { kind = \"explicit\", duration = \"1 s\", steps = 5, damping = \"40 /s\" }";
    let moved = run(&scene(BALL, DRAG, slow));
    for name in ["tool-force", "reaction-x", "reaction-z"] {
        let [still, moved] = [&still, &moved].map(|of| number(of, name));
        assert!((moved / still - 1.0).abs() < 0.05, "{name}: {moved} {still}");
    }
}

#[test]
fn paths_that_cannot_be_followed_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let refused = |tool: &str, path: &str, procedure: &str, says: &str| {
        let text = scene(tool, path, procedure);
        assert_fails(&tissuebench(&["run", &write(&dir, "scene.toml", &text)]), 2, says);
    };
    refused(PLATE, "path = []", STATIC, "key 'tool[0].drive.path': is empty");
    refused(
        PLATE,
        "path = [[\"0 mm\", \"0 mm\", \"0 mm\"]]",
        STATIC,
        "key 'tool[0].drive.path[0]': has no length",
    );
    refused(PLATE, "path = [[\"0 mm\", \"0 mm\", \"-1 mm\"]], force = \"1 N\"", STATIC, "is not one drive");
    let along = format!("{PLATE}, along = [0, 0, -1]");
    refused(&along, DRAG, STATIC, "key 'tool[0].along'");
    refused(PLATE, "closure = \"1 mm\"", STATIC, "key 'tool[0].along': is missing");
}
