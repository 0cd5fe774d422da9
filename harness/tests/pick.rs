//! `tissuebench pick`: the cheapest method within an error, and no accidental hit.

mod common;

use std::path::Path;

use common::{BLOCK, assert_fails, inside, tissuebench, write};
use serde_json::Value;
use tempfile::TempDir;

/// A block whose methods have one size each, compared with hex20 on a finer mesh.
fn block() -> String {
    let methods = r#"method = [
    { id = "tet4", family = "fem", element = "tet4", size = { level = 1 } },
    { id = "hex20", family = "fem", element = "hex20", size = { level = 1 } },
]
reference = { method = "hex20", size = { cells = [8, 8, 4] } }
"#;
    BLOCK
        .lines()
        .filter(|line| !line.starts_with("method"))
        .map(|line| format!("{line}\n"))
        .collect::<String>()
        + methods
}

/// A block fixed at its base under a plate.
const PLATE: &str = r#"title = "A block under a plate"
body = { shape = "box", size = ["40 mm", "40 mm", "20 mm"] }
material = { law = "neo-hookean", young = "20 kPa", poisson = 0.45 }
support = [{ on = "z-min", fix = "xyz" }]
tool = [{ name = "plate", shape = "plate", at = ["20 mm", "20 mm", "20 mm"], along = [0, 0, -1], drive = { closure = "1 mm" }, penalty = "0.5 MPa/mm" }]
procedure = { kind = "static", steps = 1 }
method = [
    { id = "hex8", family = "fem", element = "hex8", dilation = "nodal-mean", size = { level = 1 } },
    { id = "tet10", family = "fem", element = "tet10", size = { level = 1 } },
]
"#;

/// Runs a search and parses its answer.
#[track_caller]
fn answer(dir: &TempDir, text: &str, args: &[&str], code: i32) -> Value {
    let scene = write(dir, "scene.toml", text);
    let done = tissuebench(&[&["pick", &scene, "--format", "json"], args].concat());
    assert_eq!(done.code, code, "{}", done.stderr);
    serde_json::from_str(&done.stdout).unwrap_or_else(|bad| panic!("{bad}: {}", done.stdout))
}

fn runs(answer: &Value) -> Vec<&Value> {
    answer["runs"].as_array().unwrap().iter().collect()
}

#[test]
fn the_cheapest_within_the_error_is_named_and_nothing_is_written() {
    let dir = tempfile::tempdir().unwrap();
    let answer = answer(&dir, &block(), &["--error", "8%"], 0);
    let best = &answer["cheapest"];
    assert!(best["error"].as_f64().unwrap() <= 0.08 && best["within"] == true, "{answer}");
    let least = |of: &dyn Fn(&&&Value) -> bool| {
        runs(&answer).iter().filter(of).map(|run| run["seconds"].as_f64().unwrap()).fold(f64::MAX, f64::min)
    };
    assert_eq!(best["seconds"].as_f64().unwrap(), least(&|run| run["within"] == true));
    for method in ["tet4", "hex20"] {
        let nodes: Vec<u64> = (runs(&answer).iter())
            .filter(|run| run["method"] == method)
            .map(|run| run["nodes"].as_u64().unwrap())
            .collect();
        let reached = runs(&answer).into_iter().find(|run| run["method"] == method && run["within"] == true);
        // A method is not refined further once it is within the error.
        let finest = nodes.iter().max().unwrap();
        assert!(reached.is_none_or(|run| run["nodes"].as_u64() == Some(*finest)), "{answer}");
    }
    assert!(
        answer["sentence"].as_str().unwrap().starts_with("Cheapest within 8 % of displacement: "),
        "{answer}"
    );
    assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 1);
    let scene = write(&dir, "scene.toml", &block());
    let table = tissuebench(&["pick", &scene, "--error", "8%", "--method", "hex20"]);
    assert_eq!(table.code, 0, "{}", table.stderr);
    let head = table.stdout.lines().next().unwrap();
    assert!(
        head.starts_with("method") && head.ends_with("front") && head.contains("displacement [%]"),
        "{head}"
    );
    assert!(!table.stdout.contains("tet4"), "{}", table.stdout);
}

#[test]
fn what_no_method_reaches_is_said() {
    let dir = tempfile::tempdir().unwrap();
    let coarse = block()
        .replace("\"hex20\", size = { level = 1 }", "\"hex20\", size = { cells = [2, 2, 1] }")
        .replace("family = \"fem\"", "series = \"all\", family = \"fem\"");
    let answer = answer(&dir, &coarse, &["--error", "2%"], 1);
    assert!(answer["cheapest"].is_null() && runs(&answer).len() == 2, "{answer}");
    assert!(
        answer["sentence"]
            .as_str()
            .unwrap()
            .contains("No method is within 2 % of displacement; the nearest is")
    );
}

#[test]
fn a_right_force_alone_is_no_answer() {
    let dir = tempfile::tempdir().unwrap();
    let methods =
        "method = [\n    { id = \"hex20\", family = \"fem\", element = \"hex20\", size = { level = 1 } },";
    let plate = PLATE.replace("method = [", methods);
    let text = format!("{plate}reference = {{ method = \"hex20\", size = {{ cells = [8, 8, 4] }} }}\n");
    let force = &["--error", "5%", "--quantity", "force", "--method", "tet10", "--at-most", "2 s"];
    let found = answer(&dir, &text, force, 0);
    // If the quantity is a single number, the displacement must also be right, to three times the error.
    assert_eq!(found["also"], serde_json::json!([["displacement", 3.0 * 0.05]]));
    assert!(found["cheapest"]["error"].as_f64().unwrap() <= 0.05, "{found}");
    // Each method has one size, and no size gives the displacement within the error.
    let text = text.replace("family", "series = \"all\", family");
    let asked = [
        "--error",
        "5%",
        "--quantity",
        "force",
        "--also",
        "displacement=3.5%",
        "--method",
        "hex8",
        "--method",
        "tet10",
    ];
    let found = answer(&dir, &text, &asked, 1);
    assert!(found["cheapest"].is_null(), "{found}");
    let sentence = found["sentence"].as_str().unwrap();
    assert!(
        sentence.contains("meets the bound on force") && sentence.contains("but not the other bounds"),
        "{sentence}"
    );
}

/// A nearly incompressible block whose reference has first-order tetrahedra, which lock.
fn locking() -> String {
    block().replace("poisson = 0.3", "poisson = 0.495").replace(
        "{ method = \"hex20\", size = { cells = [8, 8, 4] } }",
        "{ method = \"tet4\", size = { cells = [4, 4, 2] } }",
    )
}

#[test]
fn no_method_is_named_within_less_than_the_error_of_the_reference() {
    let dir = tempfile::tempdir().unwrap();
    let found = answer(&dir, &locking(), &["--error", "15%"], 1);
    assert!(found["cheapest"].is_null() && runs(&found).is_empty(), "{found}");
    let own = found["reference"]["band"]["relative-rms"].as_f64().unwrap();
    assert!(own > 0.4, "{found}");
    let sentence = found["sentence"].as_str().unwrap();
    assert!(
        sentence.starts_with(
            "No method can be shown to be within 15 % of displacement: the reference's own error"
        ),
        "{sentence}"
    );
    let table = tissuebench(&["pick", &inside(&dir, "scene.toml"), "--error", "300%", "--method", "tet4"]);
    assert_eq!(table.code, 0, "{}", table.stderr);
    assert!(
        table.stdout.contains("\ncompared with tet4 with 75 nodes, whose own error is about "),
        "{}",
        table.stdout
    );
}

#[test]
fn a_scene_without_methods_has_the_usual_ones_that_fit() {
    let dir = tempfile::tempdir().unwrap();
    let text = r#"title = "A block in a linear field"
body = { shape = "box", size = ["30 mm", "20 mm", "20 mm"] }
material = { law = "linear", young = "20 kPa", poisson = 0.3 }
support = [{ on = "surface", move = "exact" }]
reference = { exact = "affine" }
"#;
    let scene = write(&dir, "scene.toml", text);
    let done = tissuebench(&["pick", &scene, "--error", "1%"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert!(
        done.stderr
            .contains("usual methods that suit the scene: tet4, tet4-nodal, tet10, hex8-mean, hex20, efg")
    );
    // The first size of each method is exact to rounding: each method runs once, unless a cheaper method was
    // right before.
    assert!(done.stdout.lines().filter(|line| line.starts_with("tet4 ")).count() == 1, "{}", done.stdout);
}

#[test]
fn results_are_written_where_they_are_asked_for() {
    let dir = tempfile::tempdir().unwrap();
    let out = inside(&dir, "results");
    answer(&dir, &block(), &["--error", "20%", "--method", "hex20", "--out", &out], 0);
    assert!(Path::new(&out).join("report/report.html").is_file());
    assert!(Path::new(&out).join("records.csv").is_file());
}

/// Compared with hex20 on 8 x 8 x 4 cells, tet10 of 405 nodes is 2.0 % off in force.
#[test]
fn without_a_reference_errors_are_estimated() {
    let dir = tempfile::tempdir().unwrap();
    let asked = ["--error", "4%", "--quantity", "force", "--method", "tet10"];
    let scene = PLATE.replace("tet10\", size = { level = 1 }", "tet10\", size = { nodes = 405 }");
    let found = answer(&dir, &scene, &asked, 0);
    assert!(found["reference"].is_null(), "{found}");
    let best = found["cheapest"]["error"].as_f64().unwrap();
    assert!((0.01..0.04).contains(&best), "{found}");
    assert!(found["sentence"].as_str().unwrap().contains("estimated error"), "{found}");
}

#[test]
fn what_is_asked_wrongly_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let refused = |text: &str, args: &[&str], says: &str| {
        let scene = write(&dir, "scene.toml", text);
        assert_fails(&tissuebench(&[&["pick", &scene], args].concat()), 2, says);
    };
    refused(
        BLOCK,
        &["--error", "3%", "--quantity", "stress"],
        "--quantity 'stress' can't be estimated, and the scene has no reference",
    );
    refused(&block(), &["--error", "3"], "is 300 %: write 3% or 0.03");
    refused(
        &block(),
        &["--error", "3%", "--quantity", "forse"],
        "--quantity 'forse' is not a quantity with a relative error: did you mean 'force'?",
    );
    refused(&block(), &["--error", "3%", "--also", "force"], "is not QUANTITY=PERCENT");
    refused(
        &block(),
        &["--error", "3%", "--method", "tet5"],
        "no method 'tet5'; known methods are tet4, hex20",
    );
    refused(&block(), &["--error", "3%", "--quantity", "force"], "runs of this scene have no error of force");
    refused("title = \"nothing\"\n", &["--error", "3%"], "body");
}
