//! Models of other programs: imported to a scene, and run as they are.

mod common;

use std::fs;
use std::path::Path;

use common::tissuebench;
use serde_json::Value;
use tempfile::TempDir;

const MODELS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../cases/tests/models");

/// A folder with a copy of a model, and the path of the copy.
fn copied(name: &str) -> (TempDir, String) {
    let dir = TempDir::new().unwrap();
    let copy = dir.path().join(name);
    fs::copy(Path::new(MODELS).join(name), &copy).unwrap();
    (dir, copy.display().to_string())
}

#[track_caller]
fn object(file: &str) -> Value {
    let done = tissuebench(&["run", file, "--once", "--quiet", "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    serde_json::from_str(&done.stdout).unwrap()
}

fn numbers(object: &Value) -> [&Value; 3] {
    [&object["free_norm"], &object["metrics"]["strain-energy"], &object["supports"]]
}

#[test]
fn a_model_runs_as_its_scene_does() {
    for name in ["two-blocks.feb", "beam.inp"] {
        let (dir, model) = copied(name);
        let scene = dir.path().join("scene.toml").display().to_string();
        let done = tissuebench(&["import", &model, "--out", &scene]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        assert!(done.stdout.contains("left out:\n"), "{}", done.stdout);
        let first = fs::read(&scene).unwrap();
        assert_eq!(tissuebench(&["import", &model, "--out", &scene]).code, 0);
        assert!(first == fs::read(&scene).unwrap(), "{name}: importing twice");
        let (as_scene, as_model) = (object(&scene), object(&model));
        assert_eq!(numbers(&as_scene), numbers(&as_model), "{name}");
    }
}

/// The loads of the deck: four forces of 2 N along x, one of -0.5 N along z, 10 Pa on 2 m^2, and the weight
/// of 2 m^3 of 2 kg/m^3.
#[test]
fn the_supports_of_a_deck_carry_its_loads() {
    let (_dir, deck) = copied("beam.inp");
    let found = object(&deck);
    let force: Vec<f64> =
        found["supports"][0]["force"].as_array().unwrap().iter().map(|f| f.as_f64().unwrap()).collect();
    let expected = [-8.0, 0.0, 0.5 + 20.0 + 4.0 * 9.81];
    for (found, expected) in force.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-9, "{force:?}");
    }
}

#[test]
fn a_scene_by_hand_gives_the_same_bits() {
    let (dir, model) = copied("two-blocks.feb");
    let text = r#"title = "The same by hand"
body = { shape = "file", path = "two-blocks.feb", unit = "m" }
material = { law = "neo-hookean", young = "1 kPa", poisson = 0.3 }
region = [{ name = "Firm", on = "Upper", material = { law = "saint-venant-kirchhoff", young = "2 kPa", poisson = 0.4 } }]
curve = [
    { name = "late", part = [0.5, 0.75], factor = [0, 1] },
    { name = "ramp", part = [0, 0.5], factor = [0, 2] },
]
support = [
    { on = "Top", fix = "xy" },
    { on = "Top", move = { z = "0.1 m" }, curve = "ramp" },
    { on = "Base", fix = "xyz" },
]
load = [
    { on = "Side", pressure = "50 Pa", curve = "late" },
    { force = ["1 N", "0 N", "0 N"], at = [["0 m", "0 m", "2 m"], ["1 m", "0 m", "2 m"]] },
    { body = ["0 N/m^3", "0 N/m^3", "-10 N/m^3"] },
]
procedure = { kind = "static", steps = 4 }
method = [{ id = "hex8", family = "fem", element = "hex8", size = { file = "two-blocks.feb", unit = "m" } }]
"#;
    let scene = dir.path().join("by-hand.toml");
    fs::write(&scene, text).unwrap();
    let (by_hand, imported) = (object(&scene.display().to_string()), object(&model));
    assert_eq!(numbers(&by_hand)[..2], numbers(&imported)[..2]);
}

/// Force of a block of area 1 m^2 and height 1 m between plates that close by 0.2 m and give way by their
/// penalty.
fn pressed() -> f64 {
    let (young, poisson, penalty) = (1000.0, 0.3, 1e5);
    let mu = young / 2.0 / (1.0 + poisson);
    let lambda = 2.0 * mu * poisson / (1.0 - 2.0 * poisson);
    let side = |height: f64| {
        let free = |t: f64| mu * (t - 1.0 / t) + lambda * (height * t * t).ln() / t;
        let halve = |(low, high): (f64, f64), _| {
            let middle = (low + high) / 2.0;
            if free(middle) < 0.0 { (middle, high) } else { (low, middle) }
        };
        (0..60).fold((0.5, 2.0), halve).0
    };
    (0..60).fold(0.0, |force, _| {
        let height = 0.8 + 2.0 * force / penalty;
        let t = side(height);
        -(mu * (height - 1.0 / height) + lambda * (height * t * t).ln() / height)
    })
}

#[test]
fn a_block_between_a_rigid_wall_and_a_rigid_body_has_the_force_of_the_closed_form() {
    let (_dir, model) = copied("pressed-block.feb");
    let found = object(&model);
    for (tool, sign) in found["tools"].as_array().unwrap().iter().zip([1.0, -1.0]) {
        let force = sign * tool["force"][2].as_f64().unwrap();
        assert!((force / pressed() - 1.0).abs() < 1e-8, "{force} for {}", pressed());
    }
}

/// The bar of `scenes/import/pulled-in-steps.inp`: at the end of its first step 1 MPa and 4 x 0.5 N on 1
/// mm^2, with sides that are held at its end; at the end of the last step 3 MPa alone.
#[test]
fn a_step_of_a_deck_is_the_scene_by_hand() {
    let dir = TempDir::new().unwrap();
    let deck = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/scenes/import/pulled-in-steps.inp");
    let copy = dir.path().join("pulled-in-steps.inp");
    fs::copy(deck, &copy).unwrap();
    let scene = |name: &str, text: &str| {
        let file = dir.path().join(name);
        fs::write(&file, text).unwrap();
        object(&file.display().to_string())
    };
    let step = |number: &str| {
        let out = dir.path().join(format!("step-{number}.toml")).display().to_string();
        let model = copy.display().to_string();
        let done = tissuebench(&["import", &model, "--unit", "mm", "--step", number, "--out", &out]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        object(&out)
    };
    let body = r#"title = "By hand"
body = { shape = "file", path = "pulled-in-steps.inp", unit = "mm" }
material = { law = "linear", young = "30 MPa", poisson = 0.25 }
method = [{ id = "hex8", family = "fem", element = "hex8", size = { file = "pulled-in-steps.inp", unit = "mm" } }]
output = { probes = [["4 mm", "0 mm", "0 mm"], ["4 mm", "1 mm", "0 mm"], ["4 mm", "0 mm", "1 mm"], ["4 mm", "1 mm", "1 mm"]] }
"#;
    let first = r#"support = [
    { on = "LEFT", fix = "x" },
    { on = "FRONT", fix = "y" },
    { on = "BELOW", fix = "z" },
    { on = "RIGHT", fix = "yz" },
]
load = [
    { force = ["0.5 N", "0 N", "0 N"], at = [["4 mm", "0 mm", "0 mm"], ["4 mm", "1 mm", "0 mm"], ["4 mm", "0 mm", "1 mm"], ["4 mm", "1 mm", "1 mm"]] },
    { on = "P4 of LAST", pressure = "-1 MPa" },
]
"#;
    let second = r#"support = [{ on = "LEFT", fix = "x" }, { on = "FRONT", fix = "y" }, { on = "BELOW", fix = "z" }]
load = [{ on = "P4 of LAST", pressure = "-3 MPa" }]
"#;
    for (number, conditions) in [("1", first), ("2", second)] {
        let (by_hand, imported) = (scene("by-hand.toml", &format!("{body}{conditions}")), step(number));
        assert_eq!(numbers(&by_hand)[..2], numbers(&imported)[..2], "step {number}");
        assert_eq!(by_hand["probes"], imported["probes"], "step {number}");
    }
    // Uniaxial stress: 3 MPa / 30 MPa over 4 mm, and a quarter of it across.
    let end = step("2")["probes"][3]["u"].clone();
    for (axis, exact) in [0.4e-3, -0.025e-3, -0.025e-3].into_iter().enumerate() {
        assert!((end[axis].as_f64().unwrap() - exact).abs() < 1e-16, "{end}");
    }
}

#[test]
fn a_refused_model_writes_no_scene() {
    for name in ["hostile.feb", "hostile.inp"] {
        let (dir, model) = copied(name);
        let scene = dir.path().join("scene.toml");
        let done = tissuebench(&["import", &model, "--out", &scene.display().to_string()]);
        assert_eq!(done.code, 2, "{}", done.stderr);
        let places = done.stderr.lines().filter(|line| line.starts_with(&format!("{model}:")));
        assert!(places.count() >= 8, "{}", done.stderr);
        assert!(!scene.exists());
        assert_eq!(tissuebench(&["run", &model]).code, 2);
    }
}

#[test]
fn an_import_never_replaces_its_model() {
    let (_dir, model) = copied("beam.inp");
    let before = fs::read(&model).unwrap();
    let done = tissuebench(&["import", &model, "--out", &model]);
    assert_eq!(done.code, 2, "{}", done.stderr);
    assert!(before == fs::read(&model).unwrap());
}
