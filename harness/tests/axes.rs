//! A scene varied along an axis: the outcome of each method, and a check that no result is wrong without a
//! warning.

mod common;

use common::{assert_fails, inside, tissuebench, write};
use serde_json::Value;
use tempfile::TempDir;

const SCENE: &str = r#"
title = "Pure bending of a small prism"
body = { shape = "box", min = ["0 mm", "-20 mm", "-20 mm"], max = ["80 mm", "20 mm", "20 mm"] }
material = { law = "linear", young = "20 kPa", poisson = 0.3 }
support = [{ on = "x-min", move = "exact" }]
load = [{ on = "x-max", traction = "exact" }]
reference = { exact = "pure-bending", curvature = "0.5 /m" }
check = [{ metric = "l2", at_most = 0 }]
method = [
    { id = "tet4", family = "fem", element = "tet4", size = { cells = [8, 4, 4] } },
    { id = "hex8-mean", family = "fem", element = "hex8", dilation = "element-mean", size = { cells = [8, 4, 4] } },
    { id = "tet10", family = "fem", element = "tet10", size = { cells = [2, 1, 1] } },
]
"#;

/// A study of the scene along Poisson's ratio. Errors from `wrong` on count as wrong.
fn study(dir: &TempDir, wrong: &str, set: &str) -> String {
    write(dir, "bending.toml", SCENE);
    let text = format!(
        "title = \"Bending\"\n[[run]]\nscene = \"bending.toml\"\nmethods = [\"tet4\", \"hex8-mean\"]\n[run.axis]\n\
         name = \"Poisson's ratio\"\nvalues = [0.3, 0.4999, 0.5]\njudge = \"l2\"\nwrong = {wrong}\nset = {set}\n"
    );
    write(dir, "study.toml", &text)
}

const POISSON: &str = "{ \"material.poisson\" = \"{x}\" }";

#[test]
fn methods_along_an_axis_bend_break_and_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let out = inside(&dir, "out");
    // The scene's own bound, which no method satisfies, applies to the unvaried scene only.
    let done = tissuebench(&["verify", &study(&dir, "0.25", POISSON), "--out", &out]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let read = |name: &str| std::fs::read_to_string(dir.path().join("out").join(name)).unwrap();
    let axes: Value = serde_json::from_str(&read("axes.json")).unwrap();
    let trial = |method: &str, value: f64| {
        let all = axes[0]["trials"].as_array().unwrap();
        all.iter().find(|t| t["method"] == method && t["value"] == value).unwrap_or_else(|| panic!("{axes}"))
    };
    // The locked mesh has an error of 88 % and a warning, and the projected mesh is accurate. No linear
    // material has a ratio of 1/2.
    assert!(trial("tet4", 0.4999)["error"].as_f64().unwrap() > 0.8);
    assert_eq!(trial("tet4", 0.4999)["warnings"][0], "stress-jump");
    assert!(trial("hex8-mean", 0.4999)["error"].as_f64().unwrap() < 0.01);
    assert_eq!(trial("hex8-mean", 0.5)["ended"], "refused");
    let table = read("report/tables/stability.csv");
    let row = |method: &str| table.lines().find(|l| l.contains(&format!(",{method},"))).unwrap().to_string();
    assert!(row("tet4").contains(",0.4999,"), "{table}");
    assert!(row("hex8-mean").ends_with(",0.5,0"), "{table}");
    assert!(read("report/report.html").contains(r#""maps":[{"case":""#));
    // Runs along an axis do not count as runs of the case.
    assert!(!dir.path().join("out/report/figures/convergence-l2.svg").exists());
}

#[test]
fn a_method_that_is_wrong_without_a_word_fails_the_study() {
    let dir = tempfile::tempdir().unwrap();
    let done = tissuebench(&["verify", &study(&dir, "0.005", POISSON), "--out", &inside(&dir, "out")]);
    assert_fails(&done, 1, "FAILED: bending along Poisson's ratio hex8-mean silent-wrong");
    assert!(done.stderr.contains("no warning"), "{}", done.stderr);
    assert!(!done.stderr.contains("tet4 silent-wrong"), "{}", done.stderr);
}

#[test]
fn an_axis_that_drives_nothing_is_refused_with_its_key() {
    let dir = tempfile::tempdir().unwrap();
    let refused = |set: &str, says: &str| {
        let done = tissuebench(&["verify", &study(&dir, "0.25", set), "--out", &inside(&dir, "out")]);
        assert_fails(&done, 2, says);
        assert!(done.stderr.contains("study.toml:5: key 'run[0].axis'"), "{}", done.stderr);
    };
    refused("{ \"materiel.poisson\" = \"{x}\" }", "'materiel'");
    refused("{ \"body.max[3]\" = \"{x} mm\" }", "[3] is out of range; the list has 3");
    refused("{ \"material.young\" = \"{20 * } kPa\" }", "material.young");
}
