//! The simulator's loop after the first solution: its answers agree with the solution, and only static scenes
//! have a loop.

mod common;

use common::{BLOCK, assert_fails, tissuebench, write};
use serde_json::Value;

fn run(text: &str, method: &str) -> Value {
    let dir = tempfile::tempdir().unwrap();
    let scene = write(&dir, "loop.toml", text);
    let done = tissuebench(&["run", &scene, "--format", "json", "--method", method]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    serde_json::from_str(done.stdout.lines().next().unwrap()).unwrap()
}

#[test]
fn a_condensed_operator_answers_as_a_solve_does() {
    let scene = common::written_out("pure-bending.toml");
    for method in ["tet10", "efg-projected"] {
        let object = run(&scene, method);
        let error = object["metrics"]["repeated-error"]["value"].as_f64().unwrap();
        assert!(error < 1e-10, "{method}: {error:e}");
        let time =
            |phase: &str| object["phases"][phase].as_f64().unwrap_or_else(|| panic!("{method}: no {phase}"));
        assert!(time("repeated") > 0.0 && time("repeated") <= time("repeated-p99"));
        assert!(time("repeated-p99") <= time("repeated-p99.9"));
        assert!(time("repeated-field") > 0.0 && time("condense") > 0.0);
    }
}

#[test]
fn frames_of_a_static_path_come_to_its_end() {
    let scene = common::written_out("plates.toml");
    let scene = scene + "\n[output]\nrepeated = { frames = 30, cycle = 8 }\n";
    let dir = tempfile::tempdir().unwrap();
    let path = write(&dir, "plates.toml", &scene);
    let out = common::inside(&dir, "out");
    let done = tissuebench(&["run", &path, "--method", "hex8", "--out", &out]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let records = records::read_run(std::path::Path::new(&out)).unwrap().records;
    let told = |statistic: &str| -> f64 {
        let found = records.iter().find(|r| r.phase == "repeated" && r.statistic == statistic);
        found.unwrap_or_else(|| panic!("no {statistic}")).value
    };
    assert_eq!(told("frames"), 30.0);
    assert!(told("iterations") >= 1.0);
    assert!(told("deviation") < 1e-6, "{}", told("deviation"));
}

#[test]
fn motion_has_no_loop() {
    let dir = tempfile::tempdir().unwrap();
    for (keys, key, problem) in [
        ("{ frames = 0 }", "output.repeated.frames", "is no number of frames"),
        ("{ frames = 4000000000 }", "output.repeated.frames", "is no number of frames"),
        ("{ frames = 10, cycle = 3 }", "output.repeated.cycle", "is no way up and down"),
        ("{ frames = 10, tolerance = -1.0 }", "output.repeated.tolerance", "is not positive"),
    ] {
        let scene = write(&dir, "bad.toml", &format!("{BLOCK}\n[output]\nrepeated = {keys}\n"));
        let done = tissuebench(&["run", &scene]);
        assert_fails(&done, 2, problem);
        assert!(done.stderr.contains(key), "{}", done.stderr);
    }
    let bar = common::written_out("bar-wave-explicit.toml");
    let scene = write(&dir, "bar.toml", &bar.replacen("[output]", "[output]\nrepeated = { frames = 10 }", 1));
    assert_fails(&tissuebench(&["run", &scene]), 2, "is of solutions at rest, not of motion");
}
