//! Sound problems whose residual is beyond rounding of the load are solved, and say how many digits they have where these are few.

mod common;

use common::{assert_fails, inside, objects, tissuebench, write, written_out};
use serde_json::Value;
use tempfile::TempDir;

/// The objects of a scene's runs, all of which have to end well.
#[track_caller]
fn run(dir: &TempDir, text: &str) -> Vec<Value> {
    let done = tissuebench(&["run", &write(dir, "scene.toml", text), "--once", "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    objects(&done.stdout)
}

fn metric(run: &Value, name: &str) -> f64 {
    run["metrics"][name]["value"].as_f64().unwrap_or_else(|| panic!("no {name} in {run}"))
}

/// A cantilever under an end load, of a height of 10 mm and a slenderness.
fn slender(slenderness: usize) -> String {
    let methods = include_str!("../../cases/methods.toml");
    let taken = ["tet4-nodal", "tet10", "tet10-mean", "hex8-mean", "hex20", "hex20-reduced"];
    let tables = methods
        .split("[[method]]")
        .filter(|table| taken.iter().any(|id| table.contains(&format!("id = \"{id}\"\n"))));
    let tables: Vec<String> = tables
        .map(|t| {
            format!(
                "[[method]]{}\nsize = {{ cells = [{}, 2, 2] }}\n",
                t.split("\n\n").next().unwrap(),
                2 * slenderness
            )
        })
        .collect();
    assert_eq!(tables.len(), taken.len());
    let (length, traction) = (10 * slenderness, 1e-3);
    format!(
        r#"title = "Slender"
body = {{ shape = "box", size = ["{length} mm", "10 mm", "10 mm"] }}
material = {{ law = "linear", young = "20 kPa", poisson = 0.3 }}
support = [{{ on = "x-min", fix = "xyz" }}]
load = [{{ on = "x-max", traction = ["0 Pa", "0 Pa", "-{traction} Pa"] }}]
output = {{ probes = [["{length} mm", "5 mm", "5 mm"]] }}
{}"#,
        tables.concat()
    )
}

#[test]
fn slender_beams_bend_as_beams_do() {
    let dir = tempfile::tempdir().unwrap();
    for slenderness in [60, 80, 100] {
        for run in run(&dir, &slender(slenderness)) {
            let (h, l) = (0.01f64, 0.01 * slenderness as f64);
            let bent = 1e-3 * h * h * l.powi(3) / (3.0 * 20e3 * h.powi(4) / 12.0);
            let method = run["method"].as_str().unwrap();
            // Linear elements bend too little, and with one dilation for each node too much.
            let within = if method.ends_with("mean") || method.ends_with("nodal") { 0.3 } else { 0.01 };
            let deflection = metric(&run, "max-z");
            assert!(
                (deflection / bent - 1.0).abs() < within,
                "{method} {slenderness}: {deflection} for {bent}"
            );
            println!("{method} {slenderness} {} {}", metric(&run, "residual"), run["warnings"]);
        }
    }
}

#[test]
fn a_nearly_incompressible_sphere_is_solved() {
    let dir = tempfile::tempdir().unwrap();
    let text = written_out("thick-sphere.toml").replace("poisson = 0.3", "poisson = 0.499999");
    for run in run(&dir, &text) {
        println!("{} {} {}", run["method"], metric(&run, "residual"), run["warnings"]);
    }
}
