//! Hexahedra with one point: the energy of hourglass control in JSON, table and warnings, and its limits.

mod common;

use common::{assert_fails, objects, tissuebench, write};
use serde_json::Value;

/// A cantilever of hexahedra with one point, two cells across unless `cells` says otherwise.
fn scene(procedure: &str, law: &str, hourglass: &str, cells: &str) -> String {
    format!(
        r#"title = "A cantilever"
body = {{ shape = "box", size = ["40 mm", "10 mm", "10 mm"] }}
material = {{ law = "{law}", young = "20 kPa", poisson = 0.3, density = "1000 kg/m^3" }}
support = [{{ on = "x-min", fix = "xyz" }}]
load = [{{ on = "x-max", traction = ["0 Pa", "0 Pa", "20 Pa"] }}]
procedure = {{ {procedure} }}
method = [{{ id = "one-point", family = "fem", element = "hex8", reduced = true, {hourglass} size = {{ cells = {cells} }} }}]
"#
    )
}

#[track_caller]
fn run(text: &str) -> Value {
    let dir = tempfile::tempdir().unwrap();
    let done = tissuebench(&["run", &write(&dir, "scene.toml", text), "--once", "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    objects(&done.stdout).remove(0)
}

fn number(of: &Value, name: &str) -> f64 {
    of["metrics"][name]["value"].as_f64().unwrap_or_else(|| panic!("no {name} in {of}"))
}

fn warned(of: &Value) -> Option<f64> {
    let all = of["warnings"].as_array().unwrap();
    let own = all.iter().find(|warning| warning["code"] == "hourglass-control")?;
    assert_eq!(own["where"], "method.hourglass");
    own["value"].as_f64()
}

const LINEAR: &str = "kind = \"linear\"";
const STATIC: &str = "kind = \"static\", steps = 2";
const EXPLICIT: &str =
    "kind = \"explicit\", duration = \"0.2 s\", over = \"0.1 s\", steps = 4, damping = \"40 /s\"";

#[test]
fn the_energy_of_hourglass_control_is_reported_and_large_parts_are_warned_of() {
    for (procedure, law) in [(LINEAR, "linear"), (STATIC, "neo-hookean"), (EXPLICIT, "neo-hookean")] {
        let coarse = run(&scene(procedure, law, "", "[8, 2, 2]"));
        let part = number(&coarse, "hourglass-energy");
        assert!(part > 0.1 && part < 0.25, "{procedure}: {part}");
        assert_eq!(warned(&coarse), Some(part), "{procedure}");
        let fine = run(&scene(procedure, law, "", "[16, 4, 4]"));
        let finer = number(&fine, "hourglass-energy");
        assert!(finer > 0.15 * part && finer < 0.4 * part, "{procedure}: {finer} after {part}");
        assert_eq!(warned(&fine), None, "{procedure}");
    }
}

/// The energy of every procedure contains that of hourglass control: dead loads do twice the work.
#[test]
fn the_strain_energy_is_half_the_work_of_a_dead_load() {
    let of = run(&scene(LINEAR, "linear", "", "[8, 1, 1]"));
    let small = run(&scene(STATIC, "linear", "", "[8, 1, 1]"));
    let [energy, again] = [&of, &small].map(|of| number(of, "strain-energy"));
    assert!((again / energy - 1.0).abs() < 1e-9, "{again} {energy}");
    // One cell across: all of the bending is hourglassing, but not the shear.
    assert!(number(&of, "hourglass-energy") > 0.8);
    assert!((number(&small, "hourglass-energy") / number(&of, "hourglass-energy") - 1.0).abs() < 1e-9);
}

#[test]
fn the_modulus_and_the_table_are_named() {
    let part = |hourglass| number(&run(&scene(LINEAR, "linear", hourglass, "[8, 2, 2]")), "hourglass-energy");
    let (whole, shear) = (part(""), part("hourglass = { modulus = \"shear\", coefficient = 0.175 },"));
    // lambda + 2 mu = 3.5 mu at nu = 0.3.
    assert!((shear / whole - 1.0).abs() < 1e-9, "{shear} {whole}");
    let dir = tempfile::tempdir().unwrap();
    let scene = write(&dir, "scene.toml", &scene(LINEAR, "linear", "", "[8, 2, 2]"));
    let done = tissuebench(&["run", &scene, "--once"]);
    assert!(done.stdout.contains("hourglass [%]"), "{}", done.stdout);
}

#[test]
fn patterns_without_control_say_what_would_help() {
    let dir = tempfile::tempdir().unwrap();
    let text = scene(STATIC, "neo-hookean", "hourglass = { coefficient = 0 },", "[8, 1, 1]");
    let done = tissuebench(&["run", &write(&dir, "scene.toml", &text), "--once"]);
    assert_fails(&done, 3, "one point without hourglass control leaves motions without energy");
}
