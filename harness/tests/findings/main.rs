//! Errors that only a run can find. Every error names the file, line and key and a correction, and does not
//! affect other methods.

mod cases;
#[path = "../common/mod.rs"]
mod common;

use cases::{CASES, Case, MESH, SCENE};
use common::{Done, tissuebench, write};
use serde_json::Value;
use tempfile::TempDir;

fn replaced(text: &str, (from, to): (&str, &str), name: &str) -> String {
    let new = text.replacen(from, to, 1);
    assert!(from.is_empty() || new != text, "{name}: '{from}' is not in the scene");
    new
}

/// Writes the case; returns the scene's path and the line that the error must name.
fn written(case: &Case, dir: &TempDir) -> (String, usize) {
    let base = case.base.iter().fold(SCENE.to_string(), |text, edit| replaced(&text, *edit, case.name));
    let text = replaced(&base, case.edit, case.name);
    write(dir, "two.msh", &replaced(MESH, case.mesh, case.name));
    let line = 1 + text.lines().position(|l| l.ends_with("#<")).expect(case.name);
    (write(dir, "scene.toml", &text), line)
}

fn json(done: &Done) -> Vec<Value> {
    done.stdout.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
fn a_finding_names_file_line_and_key_and_stops_only_its_method() {
    for case in CASES {
        let dir = tempfile::tempdir().unwrap();
        let (path, line) = written(case, &dir);
        let done = tissuebench(&["run", &path, "--format", "json"]);
        let name = case.name;
        assert_eq!(done.code, case.code, "{name}: {}", done.stderr);
        let place = format!("{path}:{line}: key '{}':", case.key);
        let blamed: Vec<&str> = done.stderr.lines().filter(|l| l.starts_with(&place)).collect();
        assert!(!blamed.is_empty(), "{name}: no '{place}' in {}", done.stderr);
        for text in case.says {
            assert!(blamed[0].contains(text), "{name}: no '{text}' in {}", blamed[0]);
        }
        // An error that is found before a plan exists leaves no objects.
        for object in json(&done) {
            let method = object["method"].as_str().unwrap();
            if case.stops.contains(&method) {
                let status = if case.code == 2 { "bad-input" } else { "could-not-run not-available" };
                assert!(status.contains(object["status"].as_str().unwrap()), "{name}: {}", object["status"]);
                let message = object["message"].as_str().unwrap();
                assert!(message.starts_with(path.as_str()), "{name}: {message}");
            } else {
                assert_eq!(object["status"], "ok", "{name} {method}: {}", done.stderr);
                assert!(object["metrics"]["max-z"]["value"].as_f64().unwrap() > 0.0, "{name}");
            }
        }
        assert_eq!(json(&done).len(), 2, "{name}");
    }
}

#[test]
fn a_plan_finds_empty_places_as_a_run_does() {
    let mut found = 0;
    for case in CASES.iter().filter(|c| c.code == 2 && (c.key.ends_with(".where") || c.key.ends_with(".on")))
    {
        let dir = tempfile::tempdir().unwrap();
        let (path, _) = written(case, &dir);
        let (run, plan) = (tissuebench(&["run", &path]), tissuebench(&["plan", &path]));
        assert_eq!((plan.code, &plan.stderr), (2, &run.stderr), "{}", case.name);
        assert!(plan.stdout.is_empty(), "{}: {}", case.name, plan.stdout);
        found += 1;
    }
    assert_eq!(found, 6);
}

const SECOND_ORDER: &str = "{ rule = \"cell-smoothed\", order = 2 }\nbackground = { cells = [4, 4, 4] }";
const NODAL: &str = "{ rule = \"node-smoothed\", stabilisation = 0 }\nbackground = { cells = [4, 4, 4] }";
const STABILISED: &str =
    "{ rule = \"node-smoothed\", stabilisation = 0.05 }\nbackground = { cells = [4, 4, 4] }";

#[test]
fn a_plan_holds_a_cloud_wherever_a_run_holds_it() {
    // No facet lies in a slab inside the body. Points of the volume lie in it, or nodes if multipliers
    // constrain them.
    for (essential, integration, place, code) in [
        ("nitsche", "{ rule = \"gauss\", points = 4 }", "z >= 5 mm and z <= 12 mm", 0),
        ("penalty", "{ rule = \"cell-smoothed\", points = 1 }", "z >= 5 mm and z <= 12 mm", 0),
        ("penalty", "{ rule = \"grid\", points = 8 }", "z >= 5 mm and z <= 12 mm", 0),
        // The slab contains one of a cell's four points, but not its centroid.
        ("penalty", SECOND_ORDER, "z >= 2.75 mm and z <= 3 mm", 0),
        // Vertices are at z = 0, 5, .. 20 mm. Points of the cells between them count only if their part
        // belongs to the vertex.
        ("penalty", NODAL, "z >= 9.5 mm and z <= 10.5 mm", 0),
        ("penalty", NODAL, "z >= 1 mm and z <= 4 mm", 2),
        ("penalty", STABILISED, "z >= 1 mm and z <= 4 mm", 0),
        ("nitsche", "{ rule = \"gauss\", points = 4 }", "z > 9.999 mm and z < 9.9991 mm", 2),
        ("multipliers", "{ rule = \"gauss\", points = 4 }", "z > 9.999 mm and z < 9.9991 mm", 2),
    ] {
        let dir = tempfile::tempdir().unwrap();
        let text = SCENE
            .replace("\"nitsche\"", &format!("\"{essential}\""))
            .replace("{ rule = \"gauss\", points = 4 }", integration)
            .replace("z == 0 mm", place);
        let path = write(&dir, "scene.toml", &text);
        for command in ["plan", "run"] {
            let done = tissuebench(&[command, &path, "--method", "efg"]);
            assert_eq!(done.code, code, "{command} {essential} {integration} {place}: {}", done.stderr);
        }
    }
}

#[test]
fn a_failed_run_still_says_what_it_would_have_done() {
    let dir = tempfile::tempdir().unwrap();
    let path = write(&dir, "free.toml", &SCENE.replace("\"xyz\"", "\"z\""));
    let objects = json(&tissuebench(&["run", &path, "--format", "json"]));
    // The mesh has 3 x 3 x 3 nodes and 2 x 2 x 2 boxes of six tetrahedra.
    assert_eq!((&objects[0]["nodes"], &objects[0]["elements"]), (&27.into(), &48.into()));
    assert_eq!(objects[1]["nodes"], 60);
    for object in &objects {
        assert_eq!(object["status"], "could-not-run");
        let stages: Vec<&str> =
            object["plan"].as_array().unwrap().iter().map(|s| s["stage"].as_str().unwrap()).collect();
        assert!(stages.contains(&"factorisation") && stages.contains(&"contact search"), "{stages:?}");
        assert_eq!(object["metrics"], Value::Object(serde_json::Map::new()));
    }
}
