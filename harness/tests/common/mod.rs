//! Helpers that run the built program and return its output.

#![allow(dead_code)] // each test file uses its share

pub mod blocks;
pub mod implicit;

use std::path::Path;
use std::process::Command;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde_json::Value;
use tempfile::TempDir;

/// A block fixed at its base under a pressure: the smallest scene that runs.
pub const BLOCK: &str = r#"title = "A block"
body = { shape = "box", size = ["40 mm", "40 mm", "20 mm"] }
material = { law = "linear", young = "20 kPa", poisson = 0.3 }
support = [{ where = "z == 0 mm", fix = "xyz" }]
load = [{ on = "z-max", pressure = "1 kPa" }]
method = [{ id = "tet4", family = "fem", element = "tet4", size = { cells = [2, 2, 1] } }]
"#;

/// A block of 40 x 40 x 20 mm, free to slide, compressed by 3 mm between two plates, in a uniform state.
pub const PRESSED: &str = r#"title = "A block between two plates"
body = { shape = "box", size = ["40 mm", "40 mm", "20 mm"] }
material = { law = "neo-hookean", young = "20 kPa", poisson = 0.45 }
support = [{ where = "x == 0 mm", fix = "x" }, { where = "y == 0 mm", fix = "y" }]
procedure = { kind = "static", steps = 2 }
tool = [
    { name = "top", shape = "plate", at = ["20 mm", "20 mm", "20 mm"], along = [0, 0, -1], drive = { closure = "2 mm" }, penalty = "5 MPa/mm" },
    { name = "base", shape = "plate", at = ["20 mm", "20 mm", "0 mm"], along = [0, 0, 1], drive = { closure = "1 mm" }, penalty = "5 MPa/mm" },
]
method = [
    { id = "hex8", family = "fem", element = "hex8", size = { cells = [2, 2, 1] } },
    { id = "tet4-nodal", family = "fem", element = "tet4", dilation = "nodal-mean", size = { cells = [2, 2, 1] } },
    { id = "tet10-p1", family = "fem", element = "tet10", dilation = "mixed", size = { cells = [2, 2, 1] } },
    { id = "hex20-mixed", family = "fem", element = "hex20", dilation = "mixed", size = { cells = [1, 1, 1] } },
    { id = "efg", family = "efg", size = { cells = [3, 3, 2] }, kernel = "cubic-spline", support_scale = 1.6, basis = "linear", integration = { rule = "cell-smoothed" }, essential = "penalty" },
]
output = { probes = [["20 mm", "20 mm", "20 mm"]] }
"#;

/// Converts [`PRESSED`] to explicit dynamics, without elements with a pressure field and without clouds.
pub fn moving(pressed: &str) -> String {
    let kept = pressed.lines().filter(|l| !l.contains("\"mixed\"") && !l.contains("\"efg\""));
    let text: String = kept.map(|l| format!("{l}\n")).collect();
    text.replace("poisson = 0.45", "poisson = 0.45, density = \"1000 kg/m^3\"")
        .replace("kind = \"static\", steps = 2", "kind = \"explicit\", duration = \"20 ms\", steps = 4")
}

/// Reports that a test is skipped because a tool is missing. With `CI=true` the test fails unless `.ci/skips`
/// names the tool.
pub fn skipped(tool: &str, why: &str) {
    eprintln!("skipped: {why}");
    let list = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../.ci/skips")).unwrap();
    let listed = list.lines().any(|line| line.starts_with(&format!("{tool}: ")));
    let must = std::env::var("CI").is_ok_and(|ci| ci == "true");
    assert!(listed || !must, "CI=true, and .ci/skips has no line '{tool}: ...'; {why}");
}

/// Exit code and output of a finished process.
pub struct Done {
    pub code: i32,
    pub stdout: String,
    pub stderr: String,
}

/// Runs the program and waits for its end.
pub fn tissuebench(args: &[&str]) -> Done {
    let output = Command::new(env!("CARGO_BIN_EXE_tissuebench")).args(args).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    let done = Done {
        code: output.status.code().expect("ended by itself"),
        stdout: text(output.stdout),
        stderr: text(output.stderr),
    };
    assert!(!done.stderr.contains("panicked"), "{args:?}: {}", done.stderr);
    done
}

/// Asserts that the process ended with this code and that stderr contains `says`.
#[track_caller]
pub fn assert_fails(done: &Done, code: i32, says: &str) {
    assert_eq!(done.code, code, "{says}: {}", done.stderr);
    assert!(done.stderr.contains(says), "no '{says}' in: {}", done.stderr);
}

/// Runs the one method of a scene once and returns its JSON object.
#[track_caller]
pub fn solved(dir: &TempDir, scene: &str) -> Value {
    let done = tissuebench(&["run", &write(dir, "scene.toml", scene), "--once", "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    objects(&done.stdout).remove(0)
}

/// Value of a metric of a run's JSON object.
#[track_caller]
pub fn number(of: &Value, metric: &str) -> f64 {
    of["metrics"][metric]["value"].as_f64().unwrap_or_else(|| panic!("no {metric} in {of}"))
}

/// Parses the JSON objects of a run, one per line.
pub fn objects(stdout: &str) -> Vec<Value> {
    stdout.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// Decodes numbers packed in single precision for the three-dimensional view.
pub fn packed(text: &Value) -> Vec<f32> {
    let bytes = STANDARD.decode(text.as_str().unwrap()).unwrap();
    bytes.chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect()
}

/// Path of a scene of the project, by the name of its file in any folder.
pub fn cases(name: &str) -> String {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/scenes");
    let folders = std::fs::read_dir(&scenes).unwrap().map(|entry| entry.unwrap().path());
    let found = folders.chain([scenes.clone()]).map(|folder| folder.join(name)).find(|path| path.is_file());
    utf8(&found.unwrap_or_else(|| panic!("no scene {name}")))
}

/// Text of a scene of the project with all methods written out, so that it can be changed and run elsewhere.
pub fn written_out(name: &str) -> String {
    cases::scene::load(Path::new(&cases(name))).unwrap().text().to_string()
}

/// Writes a file and returns its path.
pub fn write(dir: &TempDir, name: &str, text: &str) -> String {
    let path = dir.path().join(name);
    std::fs::write(&path, text).unwrap();
    utf8(&path)
}

/// Path of a file in a temporary folder.
pub fn inside(dir: &TempDir, name: &str) -> String {
    utf8(&dir.path().join(name))
}

fn utf8(path: &Path) -> String {
    path.to_str().unwrap().to_string()
}

/// Returns a scene without one of its keys.
pub fn without(scene: &str, key: &str) -> String {
    scene.lines().filter(|line| !line.starts_with(key)).map(|line| format!("{line}\n")).collect()
}
