//! Well-posed problems whose residual exceeds rounding of the load: they are solved, and the run warns if few
//! digits are reliable.

mod common;

use common::{objects, tissuebench, write, written_out};
use serde_json::Value;
use tempfile::TempDir;

/// Runs a scene, which must succeed; returns its JSON objects.
#[track_caller]
fn run(dir: &TempDir, text: &str) -> Vec<Value> {
    let done = tissuebench(&["run", &write(dir, "scene.toml", text), "--once", "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    objects(&done.stdout)
}

fn metric(run: &Value, name: &str) -> f64 {
    run["metrics"][name]["value"].as_f64().unwrap_or_else(|| panic!("no {name} in {run}"))
}

/// Number of reliable digits in a run's warning, if any.
fn few_digits(run: &Value) -> Option<f64> {
    let warnings = run["warnings"].as_array().unwrap();
    warnings.iter().find(|w| w["code"] == "few-digits").map(|w| w["value"].as_f64().unwrap())
}

/// A cantilever under an end load, 10 mm high and `times` as long. `elements` are method ids with their keys.
fn slender(times: usize, elements: &[(&str, &str)]) -> String {
    let length = 10 * times;
    let method = |(id, keys): &(&str, &str)| {
        format!(
            "    {{ id = \"{id}\", family = \"fem\", {keys}, size = {{ cells = [{}, 2, 2] }} }},\n",
            2 * times
        )
    };
    let methods: String = elements.iter().map(method).collect();
    format!(
        r#"title = "Slender"
body = {{ shape = "box", size = ["{length} mm", "10 mm", "10 mm"] }}
material = {{ law = "linear", young = "20 kPa", poisson = 0.3 }}
support = [{{ on = "x-min", fix = "xyz" }}]
load = [{{ on = "x-max", traction = ["0 Pa", "0 Pa", "-0.001 Pa"] }}]
method = [
{methods}]
"#
    )
}

/// The residuals are 1e-8 to 2e-7 of the load.
#[test]
fn slender_beams_bend_as_beams_do() {
    let elements = [
        ("tet4-nodal", "element = \"tet4\", dilation = \"nodal-mean\""),
        ("tet10", "element = \"tet10\""),
        ("tet10-mean", "element = \"tet10\", dilation = \"element-mean\""),
        ("hex8-mean", "element = \"hex8\", dilation = \"element-mean\""),
        ("hex20", "element = \"hex20\""),
        ("hex20-reduced", "element = \"hex20\", reduced = true"),
    ];
    let dir = tempfile::tempdir().unwrap();
    for times in [60, 80, 100] {
        let runs = run(&dir, &slender(times, &elements));
        assert_eq!(runs.len(), elements.len());
        for run in runs {
            let (h, l) = (0.01f64, 0.01 * times as f64);
            let bent = 1e-3 * h * h * l.powi(3) / (3.0 * 20e3 * h.powi(4) / 12.0);
            let method = run["method"].as_str().unwrap();
            // Two linear elements over the height are too stiff or too soft in bending.
            let within = match method {
                "tet4-nodal" => 0.4,
                "tet10-mean" | "hex8-mean" => 0.1,
                _ => 0.01,
            };
            let deflection = metric(&run, "max-z");
            assert!((deflection / bent - 1.0).abs() < within, "{method} {times}: {deflection} for {bent}");
            assert_eq!(few_digits(&run), None, "{method} {times}");
        }
    }
}

#[test]
fn a_beam_of_few_certain_digits_says_how_many() {
    let dir = tempfile::tempdir().unwrap();
    let run = run(&dir, &slender(300, &[("hex20", "element = \"hex20\"")])).remove(0);
    let digits = few_digits(&run).expect("a warning");
    assert!((1.0..4.0).contains(&digits), "{digits}");
    let text = run["warnings"].to_string();
    assert!(text.contains(&format!("at most {digits:.1} digits")), "{text}");
}

/// The sphere is solved by every method of the scene; many of them lock.
#[test]
fn a_nearly_incompressible_sphere_is_solved() {
    let dir = tempfile::tempdir().unwrap();
    let text = written_out("thick-sphere.toml").replace("poisson = 0.3", "poisson = 0.499999");
    let runs = run(&dir, &text);
    assert!(runs.len() >= 10);
    for run in runs {
        assert_eq!(few_digits(&run), None, "{run}");
    }
}
