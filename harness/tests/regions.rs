//! Clouds on a body of two materials, with shape functions that cross the interface or end at it.

mod common;

use common::{assert_fails, objects, tissuebench, write};
use serde_json::Value;
use tempfile::TempDir;

/// A stack under shear or pressure whose upper half is 50,000 times stiffer.
fn layers(cells: usize, load: &str, methods: &[&str]) -> String {
    let cloud = "kernel = \"cubic-spline\", basis = \"linear\", support_scale = 1.6";
    let rule = "integration = { rule = \"cell-smoothed\", order = 2, points = 6 }";
    let method = |keys: &&str| match keys.contains("family") {
        true => format!("{{ {keys}, size = {{ cells = [{cells}, {cells}, {cells}] }} }}"),
        false => format!(
            "{{ family = \"efg\", {cloud}, {rule}, {keys}, size = {{ cells = [{cells}, {cells}, {cells}] }} }}"
        ),
    };
    let methods: Vec<String> = methods.iter().map(method).collect();
    format!(
        r#"title = "Two layers"
body = {{ shape = "box", size = ["20 mm", "20 mm", "20 mm"] }}
material = {{ law = "linear", young = "20 kPa", poisson = 0.3 }}
region = [{{ name = "upper", where = "z >= 10 mm", material = {{ law = "linear", young = "1 GPa", poisson = 0.3 }} }}]
support = [{{ on = "z-min", fix = "xyz" }}]
load = [{{ on = "z-max", traction = {load} }}]
reference = {{ method = "tet10" }}
method = [{}]
"#,
        methods.join(",\n")
    )
}

const TET10: &str = "id = \"tet10\", family = \"fem\", element = \"tet10\"";
const BLENDED: &str = "id = \"blended\", essential = \"coupling\"";
const SEPARATE: &str = "id = \"separate\", essential = \"coupling\", regions = \"separate\"";

#[track_caller]
fn run(text: &str) -> Vec<Value> {
    let dir = TempDir::new().unwrap();
    let done = tissuebench(&["run", &write(&dir, "scene.toml", text), "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    objects(&done.stdout)
}

/// Relative error of a run's displacement against the first method, and whether the run warns of blended
/// regions.
fn judged(run: &Value) -> (f64, bool) {
    let error = run["metrics"]["relative-rms"]["value"].as_f64().unwrap_or_else(|| panic!("{run}"));
    (error, run["warnings"].as_array().unwrap().iter().any(|w| w["code"] == "regions-blended"))
}

#[test]
fn a_cloud_whose_supports_end_at_a_border_follows_a_jump_of_stiffness() {
    for (load, blended, separate) in
        [("[\"0 Pa\", \"0 Pa\", \"-100 Pa\"]", 0.15, 0.05), ("[\"50 Pa\", \"0 Pa\", \"0 Pa\"]", 0.13, 0.06)]
    {
        let runs = run(&layers(8, load, &[TET10, BLENDED, SEPARATE]).replace("1 GPa", "100 MPa"));
        let [across, ends] = [&runs[1], &runs[2]].map(judged);
        assert!(across.0 > blended && across.1, "{}", runs[1]);
        assert!(ends.0 < separate && !ends.1, "{}", runs[2]);
    }
    // With two cells in each layer, the nodes of a layer lie in one plane between elements.
    let runs = run(&layers(4, "[\"0 Pa\", \"0 Pa\", \"-100 Pa\"]", &[TET10, BLENDED, SEPARATE]));
    assert!(judged(&runs[1]).0 > 0.4 && judged(&runs[2]).0 < 0.08, "{} {}", runs[1], runs[2]);
}

#[test]
fn separate_regions_want_regions_and_elements_along_their_borders() {
    let load = "[\"0 Pa\", \"0 Pa\", \"-100 Pa\"]";
    let held = layers(4, load, &[&SEPARATE.replace("coupling", "elimination")]);
    let one = layers(4, load, &[SEPARATE]);
    let one: String =
        one.lines().filter(|line| !line.starts_with("region")).map(|line| format!("{line}\n")).collect();
    for (text, expected) in [(held, "take essential = \"coupling\""), (one, "the scene has no [[region]]")] {
        let dir = TempDir::new().unwrap();
        let done = tissuebench(&[
            "plan",
            &write(&dir, "scene.toml", &text.replace("reference = { method = \"tet10\" }\n", "")),
        ]);
        assert_fails(&done, 2, expected);
        assert!(done.stderr.contains("'method[0].regions'"), "{}", done.stderr);
    }
}
