//! Own error of a reference: large if the reference locks, small if it is accurate, unknown if there is
//! nothing to compare it with.

mod common;

use std::path::Path;

use common::{inside, tissuebench, write};
use serde_json::Value;
use tempfile::TempDir;

/// A bonded block of nearly incompressible tissue under a pressure, compared with a reference.
fn block(reference: &str) -> String {
    format!(
        r#"title = "A bonded block"
body = {{ shape = "box", size = ["30 mm", "30 mm", "15 mm"] }}
material = {{ law = "linear", young = "10 kPa", poisson = 0.495 }}
support = [{{ on = "z-min", fix = "xyz" }}]
load = [{{ on = "z-max", pressure = "200 Pa" }}]
reference = {{ {reference} }}
method = [
    {{ id = "tet4", family = "fem", element = "tet4", size = {{ cells = [3, 3, 2] }} }},
    {{ id = "hex8", family = "fem", element = "hex8", size = {{ cells = [3, 3, 2] }} }},
    {{ id = "hex20", family = "fem", element = "hex20", size = {{ cells = [6, 6, 3] }} }},
]
"#
    )
}

const LOCKING: &str = "method = \"tet4\", size = { cells = [4, 4, 2] }";
const GOOD: &str = "method = \"hex20\", size = { cells = [8, 8, 4] }";

/// Runs a scene and returns the JSON objects of its methods.
#[track_caller]
fn objects(dir: &TempDir, text: &str) -> Vec<Value> {
    let done = tissuebench(&["run", &write(dir, "scene.toml", text), "--once", "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    done.stdout.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn own(object: &Value, metric: &str) -> f64 {
    object["reference"]["band"][metric].as_f64().unwrap_or_else(|| panic!("{object}"))
}

fn error(object: &Value, metric: &str) -> f64 {
    object["metrics"][metric]["value"].as_f64().unwrap()
}

fn warns(object: &Value, code: &str) -> bool {
    object["warnings"].as_array().unwrap().iter().any(|warning| warning["code"] == code)
}

#[test]
fn a_reference_that_locks_is_seen_and_a_good_one_is_not_blamed() {
    let dir = tempfile::tempdir().unwrap();
    for element in ["tet4", "hex8"] {
        let bad = objects(&dir, &block(&LOCKING.replace("tet4", element)));
        // Second-order elements are closest to the true solution: the error of the reference is about their
        // difference.
        let far = error(&bad[2], "relative-rms");
        let known = own(&bad[2], "relative-rms");
        assert!(far > 0.5 && known > 0.8 * far && known < 2.0 * far, "{element}: {known} of {far}");
        assert!(warns(&bad[2], "reference-coarser") && !warns(&bad[0], "reference-coarser"), "{element}");
    }
    let good = objects(&dir, &block(GOOD));
    assert!(good.iter().all(|object| !warns(object, "reference-coarser")));
    let known = own(&good[0], "relative-rms");
    // A finer reference shows the true error.
    let fine = block("method = \"hex20\", size = { cells = [12, 12, 6] }")
        .replace("cells = [6, 6, 3]", "cells = [8, 8, 4]");
    let far = error(&objects(&dir, &fine)[2], "relative-rms");
    assert!(known < 0.1 && known > far && known < 5.0 * far, "{known} of {far}");
}

#[test]
fn the_reference_is_named_with_its_error_and_records_have_it() {
    let dir = tempfile::tempdir().unwrap();
    let out = inside(&dir, "out");
    let done = tissuebench(&["run", &write(&dir, "scene.toml", &block(LOCKING)), "--once", "--out", &out]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let line = done.stdout.lines().find(|line| line.starts_with("compared with ")).unwrap();
    assert!(line.starts_with("compared with tet4 with 75 nodes, whose own error is about "), "{line}");
    assert!(line.contains("(by tet4 with 18 nodes and tet10 with 75 nodes)"), "{line}");
    let results = records::read_run(Path::new(&out)).unwrap();
    assert_eq!(results.references.len(), 1);
    let bands: Vec<f64> = (results.records.iter())
        .filter(|r| r.name() == "relative-rms" && r.statistic == "band")
        .map(|r| r.value)
        .collect();
    assert_eq!(bands, [results.references[0].band["relative-rms"]; 3]);
    let page = std::fs::read_to_string(Path::new(&out).join("report/report.html")).unwrap();
    assert!(page.contains("tet4 with 75 nodes, whose own error is about"));
}

#[test]
fn warnings_of_a_reference_are_shown_with_it() {
    let dir = tempfile::tempdir().unwrap();
    // The linear law is used far beyond small strain.
    let text = block(GOOD).replace("200 Pa", "4 kPa");
    let done = tissuebench(&["run", &write(&dir, "scene.toml", &text), "--once", "--method", "tet4"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert!(
        done.stdout.contains("warning: reference hex20: ") && done.stdout.contains("(large-strain)"),
        "{}",
        done.stdout
    );
}

/// A column of 20 x 20 x 20 mm, with two cells from a file.
fn column(dir: &TempDir, reference: &str, check: &str) -> String {
    let corners = [[0, 0], [20, 0], [20, 20], [0, 20]];
    let nodes: String = (0..12)
        .map(|k| format!("{} {} {} {}\n", k + 1, corners[k % 4][0], corners[k % 4][1], k / 4 * 10))
        .collect();
    let mesh = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n12\n{nodes}$EndNodes\n$Elements\n2\n1 5 0 1 2 3 4 5 6 7 8\n2 5 0 5 6 7 8 9 10 11 12\n\
         $EndElements\n"
    );
    write(dir, "column.msh", &mesh);
    format!(
        r#"title = "A column of two cells"
body = {{ shape = "file", path = "column.msh", unit = "mm" }}
material = {{ law = "linear", young = "20 kPa", poisson = 0.3 }}
support = [{{ where = "z <= 0 mm", fix = "xyz" }}]
load = [{{ where = "z >= 20 mm", pressure = "100 Pa" }}]
reference = {{ method = "{reference}" }}
method = [
    {{ id = "hex8", family = "fem", element = "hex8", size = {{ file = "column.msh" }} }},
    {{ id = "hex20", family = "fem", element = "hex20", size = {{ file = "column.msh" }} }},
]
{check}"#
    )
}

/// The cells of a file cannot be coarsened, but second-order elements can add nodes on their edges.
#[test]
fn a_reference_on_cells_of_a_file_is_held_against_second_order_on_them() {
    let dir = tempfile::tempdir().unwrap();
    let runs = objects(&dir, &column(&dir, "hex8", ""));
    // The reference is compared with the same elements as the other method of the scene.
    assert_eq!(runs[0]["reference"]["by"][0], "hex20 with 32 nodes", "{}", runs[0]);
    assert!(
        (own(&runs[0], "relative-rms") / error(&runs[1], "relative-rms") - 1.0).abs() < 1e-9,
        "{}",
        runs[1]
    );
    let unknown = &objects(&dir, &column(&dir, "hex20", ""))[0]["reference"];
    let why = "its mesh is the file column.msh, no coarser mesh is known, and no method here is of higher order: also solve \
               on a finer mesh";
    assert_eq!(unknown["unknown"], why, "{unknown}");
    assert!(unknown["band"].as_object().unwrap().is_empty(), "{unknown}");
}

/// A bound below the reference's own error passes and proves nothing, in one run and in a study.
#[test]
fn a_bound_below_the_own_error_of_the_reference_is_told() {
    const TOLD: &str = "the bound is below the reference's own error";
    let dir = tempfile::tempdir().unwrap();
    let check = |most: f64| {
        let check = format!("[[check]]\nmethod = \"hex8\"\nmetric = \"relative-rms\"\nat_most = {most}\n");
        write(&dir, "column.toml", &column(&dir, "hex8", &check))
    };
    write(&dir, "study.toml", "title = \"A column\"\n[[run]]\nscene = \"column.toml\"\ntags = [\"quick\"]\n");
    for (most, told) in [(1e-3, true), (0.9, false)] {
        let scene = check(most);
        let run = tissuebench(&["run", &scene, "--once"]);
        assert_eq!((run.code, run.stderr.contains(TOLD)), (0, told), "{}", run.stderr);
        let out = inside(&dir, &format!("out-{most}"));
        let study = tissuebench(&["verify", &inside(&dir, "study.toml"), "--out", &out]);
        assert_eq!((study.code, study.stderr.contains(TOLD)), (0, told), "{}", study.stderr);
        let page = std::fs::read_to_string(Path::new(&out).join("report/report.html")).unwrap();
        assert_eq!(page.contains(TOLD), told);
    }
}

#[test]
fn an_exact_solution_has_no_own_error() {
    let dir = tempfile::tempdir().unwrap();
    let exact = r#"title = "A block in a linear field"
body = { shape = "box", size = ["30 mm", "20 mm", "20 mm"] }
material = { law = "linear", young = "20 kPa", poisson = 0.3 }
support = [{ on = "surface", move = "exact" }]
reference = { exact = "affine" }
method = [{ id = "tet4", family = "fem", element = "tet4", size = { level = 1 } }]
"#;
    let run = &objects(&dir, exact)[0];
    assert_eq!((&run["reference"]["method"], &run["reference"]["unknown"]), (&"affine".into(), &"".into()));
    assert_eq!(run["work"]["factorisations"], 1, "{}", run["work"]);
}

/// By its own estimate hex20 is more than 15 % off on 4 x 4 x 2 cells and 8 % on 8 x 8 x 4 cells.
#[test]
fn the_spacing_of_a_reference_is_halved_until_it_is_accurate() {
    let dir = tempfile::tempdir().unwrap();
    let coarse = "method = \"hex20\", size = { cells = [4, 4, 2] }, accuracy = \"15 %\"";
    let [found, good] = [coarse, GOOD].map(|reference| objects(&dir, &block(reference)));
    assert_eq!(found[0]["reference"]["nodes"], good[0]["reference"]["nodes"]);
    assert_eq!(own(&found[0], "relative-rms"), own(&good[0], "relative-rms"));
    assert!(!warns(&found[0], "reference-rough"));
    let bad = write(&dir, "bad.toml", &block(&format!("{GOOD}, accuracy = \"200 %\"")));
    common::assert_fails(
        &tissuebench(&["run", &bad]),
        2,
        "key 'reference.accuracy': '200 %' is not between 0 and 100 %",
    );
    let bad = write(&dir, "bad.toml", &block("exact = \"affine\", accuracy = \"1 %\""));
    common::assert_fails(&tissuebench(&["run", &bad]), 2, "applies to method only");
}
