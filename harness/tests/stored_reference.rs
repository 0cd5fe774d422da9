//! References that one command stores and scenes compare with.

mod common;

use common::{Done, PRESSED, assert_fails, inside, tissuebench, write};
use serde_json::Value;
use tempfile::TempDir;

/// A tetrahedron inside the block (mm), at whose corners displacements are stored.
fn points(dir: &TempDir, corners: [[f64; 3]; 4]) -> String {
    let mut text = String::from("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n");
    for (n, [x, y, z]) in corners.iter().enumerate() {
        text += &format!("{} {x} {y} {z}\n", n + 1);
    }
    text += "$EndNodes\n$Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n";
    write(dir, "points.msh", &text)
}

/// [`PRESSED`] on a bonded base, so that methods differ, with two of its methods.
fn bonded() -> String {
    bonded_without(&["\"base\"", "\"tet4-nodal\"", "\"tet10-p1\"", "\"efg\""])
}

fn bonded_without(words: &[&str]) -> String {
    let slides = "{ where = \"y == 0 mm\", fix = \"y\" }";
    PRESSED
        .replace(slides, "{ where = \"z == 0 mm\", fix = \"xyz\" }")
        .lines()
        .filter(|l| !words.iter().any(|w| l.contains(w)))
        .map(|l| format!("{l}\n"))
        .collect()
}

/// Makes the reference of a scene.
fn made(dir: &TempDir, scene: &str, out: &str) -> Done {
    let corners = [[5.0, 5.0, 5.0], [30.0, 5.0, 5.0], [5.0, 30.0, 5.0], [5.0, 5.0, 15.0]];
    let scene = write(dir, "made.toml", scene);
    let made = tissuebench(&["reference", &scene, "--points", &points(dir, corners), "--out", out]);
    assert_eq!(made.code, 0, "{}", made.stderr);
    made
}

fn stored(dir: &TempDir) -> String {
    let out = inside(dir, "reference.json");
    let made = made(dir, &bonded(), &out);
    // The only warning is that two cells across are few.
    let mut said = made.stderr.lines().filter(|line| line.contains("warning"));
    assert!(said.all(|line| line.ends_with("(few-cells)")), "{}", made.stderr);
    assert_eq!(made.stdout.lines().count(), 2, "{}", made.stdout);
    out
}

#[test]
fn what_is_to_be_said_against_a_reference_is_told_as_it_is_made() {
    let dir = tempfile::tempdir().unwrap();
    let far = bonded().replace("\"20 mm\"], along = [0, 0, -1]", "\"30 mm\"], along = [0, 0, -1]");
    let made = made(&dir, &far, &inside(&dir, "reference.json"));
    for method in ["hex8", "hex20-mixed"] {
        assert!(made.stderr.contains(&format!("warning: {method}: key 'tool[0]'")), "{}", made.stderr);
    }
}

#[test]
fn methods_are_compared_with_the_last_one_and_all_span_the_band() {
    let dir = tempfile::tempdir().unwrap();
    stored(&dir);
    let text = format!("{}reference = {{ record = \"reference.json\" }}\n", bonded());
    let out = inside(&dir, "out");
    let done = tissuebench(&["run", &write(&dir, "s.toml", &text), "--format", "json", "--out", &out]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let objects: Vec<Value> = done.stdout.lines().map(|l| serde_json::from_str(l).unwrap()).collect();
    let metric = |k: usize, name: &str| objects[k]["metrics"][name]["value"].as_f64().unwrap();
    assert_eq!((&objects[0]["method"], &objects[1]["method"]), (&"hex8".into(), &"hex20-mixed".into()));
    for name in ["tool-force-error", "probe-difference", "rms", "max-error"] {
        assert_eq!(metric(1, name), 0.0, "{name}");
        assert!(metric(0, name) > 1e-6, "{name}");
    }
    let [first, last] = [metric(0, "tool-force"), metric(1, "tool-force")];
    assert!((metric(0, "tool-force-error") - (first / last - 1.0).abs()).abs() < 1e-12);
    // The reference's own error is the difference of its two solutions.
    let own = |name: &str| objects[0]["reference"]["band"][name].as_f64().unwrap();
    for name in ["tool-force-error", "relative-rms"] {
        assert!((own(name) - metric(0, name)).abs() < 1e-12, "{name}: {}", objects[0]["reference"]);
    }
    // The record contains the forces of both steps, with a band from one method's force to the other's.
    let file: Value =
        serde_json::from_str(&std::fs::read_to_string(inside(&dir, "reference.json")).unwrap()).unwrap();
    let tool = &file["steps"][1]["tools"][0];
    let value = |name: &str| tool[name].as_f64().unwrap();
    assert_eq!((value("low"), value("force"), value("high")), (first.min(last), last, first.max(last)));
    let records = std::fs::read_to_string(format!("{out}/records.csv")).unwrap();
    let rows =
        records.lines().filter(|l| l.contains("reference,hex20-mixed") && l.contains("tool-force,,1,N"));
    assert_eq!(rows.count(), 6, "two steps with value, low and high");
}

#[test]
fn a_record_of_one_solution_does_not_know_its_error() {
    let dir = tempfile::tempdir().unwrap();
    made(
        &dir,
        &bonded_without(&["\"base\"", "\"tet4-nodal\"", "\"tet10-p1\"", "\"efg\"", "\"hex20-mixed\""]),
        &inside(&dir, "reference.json"),
    );
    let text = format!("{}reference = {{ record = \"reference.json\" }}\n", bonded());
    let done = tissuebench(&["run", &write(&dir, "s.toml", &text), "--once"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let line = done.stdout.lines().find(|line| line.starts_with("compared with hex8 with ")).unwrap();
    assert!(line.contains("whose own error is unknown: only the solution by hex8 is stored"), "{line}");
}

#[test]
fn parts_made_one_by_one_join_to_the_same_reference() {
    let dir = tempfile::tempdir().unwrap();
    let three = bonded_without(&["\"base\"", "\"tet10-p1\"", "\"efg\""]);
    let scene = write(&dir, "made.toml", &three);
    let points = points(&dir, [[5.0, 5.0, 5.0], [30.0, 5.0, 5.0], [5.0, 30.0, 5.0], [5.0, 5.0, 15.0]]);
    let make = |methods: &[&str], out: &str, beside: &[&str]| {
        let mut args = vec!["reference", &scene, "--points", &points, "--out", out];
        args.extend(methods.iter().flat_map(|id| ["--method", id]));
        args.extend(beside.iter().flat_map(|file| ["--alongside", file]));
        tissuebench(&args)
    };
    let all = inside(&dir, "all.json");
    assert_eq!(make(&[], &all, &[]).code, 0);
    let whole = std::fs::read_to_string(&all).unwrap();
    let (part, joined) = (inside(&dir, "part.json"), inside(&dir, "joined.json"));
    assert_eq!(make(&["hex8"], &part, &[]).code, 0);
    let alone = std::fs::read_to_string(&part).unwrap();
    assert!(alone.contains("\"beside\":[]") && alone.contains("\"displacement_band\":0.0"));
    assert_eq!(make(&["tet4-nodal", "hex20-mixed"], &joined, &[&part]).code, 0);
    assert_eq!(std::fs::read_to_string(&joined).unwrap(), whole);
    // All solutions may also be made before.
    let (nodal, last) = (inside(&dir, "nodal.json"), inside(&dir, "last.json"));
    assert_eq!((make(&["tet4-nodal"], &nodal, &[]).code, make(&["hex20-mixed"], &last, &[]).code), (0, 0));
    let join = [
        "reference",
        &scene,
        "--points",
        &points,
        "--from",
        &last,
        "--alongside",
        &nodal,
        "--alongside",
        &part,
    ];
    assert_eq!(tissuebench(&[&join[..], &["--out", &joined]].concat()).code, 0);
    assert_eq!(std::fs::read_to_string(&joined).unwrap(), whole);
    // A solution cannot be compared with itself.
    assert_fails(&make(&["hex8"], &joined, &[&part]), 2, "part.json: 'hex8' is already stored");
    assert_eq!(std::fs::read_to_string(&joined).unwrap(), whole);
    // The file is refused before anything is solved, and nothing is written.
    let refused = inside(&dir, "refused.json");
    let fails = |method: &str, says: &str| {
        assert_fails(&make(&[method], &refused, &[&part]), 2, says);
        assert!(!std::path::Path::new(&refused).exists());
    };
    fails("hex9", "no method 'hex9'; known methods are hex8, tet4-nodal, hex20-mixed");
    let change = |from: &str, to: &str| {
        assert!(three.contains(from), "{three}");
        write(&dir, "made.toml", &three.replace(from, to));
    };
    change("steps = 2", "steps = 4");
    fails("hex20-mixed", "part.json: hex8 on ");
    fails("hex20-mixed", " nodes belongs to another scene, or to another text of the scene");
    change("element = \"hex8\"", "element = \"hex8\", dilation = \"element-mean\"");
    fails("hex20-mixed", " nodes was not computed by the scene's 'hex8', but by\n");
    // Titles and other methods do not belong to the solved problem.
    write(
        &dir,
        "made.toml",
        &(three.replace("title = \"", "title = \"Once more: ")
            + "# closer\n\n[[check]]\nmetric = \"max\"\nat_most = \"1 m\"\n"),
    );
    assert_eq!(make(&["tet4-nodal", "hex20-mixed"], &joined, &[&part]).code, 0);
    assert_eq!(std::fs::read_to_string(&joined).unwrap(), whole);
    write(&dir, "made.toml", &three);
    write(&dir, "part.json", &alone.replace("\"points\":[[0.005,", "\"points\":[[0.006,"));
    fails("hex20-mixed", " nodes has other points");
    write(&dir, "part.json", "{}");
    fails("hex20-mixed", "part.json: is not a reference");
}

#[test]
fn the_missing_half_is_the_mirror_image() {
    let dir = tempfile::tempdir().unwrap();
    let scene = r#"title = "Half a kidney in a fluid"
body = { shape = "kidney", half = true }
material = { law = "linear", young = "20 kPa", poisson = 0.3 }
support = [{ where = "y >= 30 mm", fix = "xyz" }, { on = "symmetry", fix = "z" }]
load = [{ on = "surface", pressure = "1 kPa" }]
method = [{ id = "hex8", family = "fem", element = "hex8", size = { level = 1 } }]
"#;
    let out = inside(&dir, "half.json");
    let corners = [[0.0, 0.0, 6.0], [0.0, 0.0, -6.0], [4.0, 0.0, 0.0], [0.0, 5.0, 3.0]];
    let scene = write(&dir, "half.toml", scene);
    let made = tissuebench(&["reference", &scene, "--points", &points(&dir, corners), "--out", &out]);
    assert_eq!(made.code, 0, "{}", made.stderr);
    let file: Value = serde_json::from_str(&std::fs::read_to_string(out).unwrap()).unwrap();
    let u = |n: usize, axis: usize| file["displacement"][n][axis].as_f64().unwrap();
    assert!(u(0, 2) < -1e-5, "pressed inwards: {}", u(0, 2));
    assert_eq!([u(1, 0), u(1, 1), u(1, 2)], [u(0, 0), u(0, 1), -u(0, 2)]);
}

/// Half of a block, held along the normal of its plane of symmetry alone, has the error zero against the
/// whole; held otherwise it has not.
#[test]
fn a_half_of_any_body_takes_the_reference_of_the_whole() {
    let dir = tempfile::tempdir().unwrap();
    let whole = r#"title = "A block under a pressure in its middle"
body = { shape = "box", min = ["-20 mm", "0 mm", "0 mm"], max = ["20 mm", "20 mm", "20 mm"] }
material = { law = "linear", young = "20 kPa", poisson = 0.3 }
support = [{ on = "z-min", fix = "xyz" }]
load = [{ where = "z == 20 mm and x >= -10 mm and x <= 10 mm", pressure = "1 kPa" }]
output = { probes = [["0 mm", "10 mm", "20 mm"]] }
method = [{ id = "hex8", family = "fem", element = "hex8", size = { cells = [8, 4, 4] } }]
"#;
    let corners = [[-15.0, 5.0, 5.0], [15.0, 5.0, 5.0], [-5.0, 15.0, 10.0], [5.0, 5.0, 15.0]];
    let scene = write(&dir, "whole.toml", whole);
    let points = points(&dir, corners);
    let made = tissuebench(&["reference", &scene, "--points", &points, "--out", &inside(&dir, "r.json")]);
    assert_eq!(made.code, 0, "{}", made.stderr);
    let error = |from: &str, to: &str, plane: &str| {
        let half = whole
            .replace(from, to)
            .replace("[8, 4, 4]", "[4, 4, 4]")
            .replace("\"xyz\" }", &format!("\"xyz\" }}, {plane}"));
        let half = write(&dir, "half.toml", &format!("{half}reference = {{ record = \"r.json\" }}\n"));
        let done = tissuebench(&["run", &half, "--once", "--format", "json"]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        let object: Value = serde_json::from_str(done.stdout.trim()).unwrap();
        object["metrics"]["relative-rms"]["value"].as_f64().unwrap()
    };
    let right = |plane: &str| error("[\"-20 mm\"", "[\"0 mm\"", plane);
    let end = "[\"20 mm\", \"20 mm\", \"20 mm\"]";
    for same in [
        right("{ on = \"x-min\", fix = \"x\" }"),
        right("{ where = \"x == 0 mm\", fix = \"x\" }"),
        error(end, &end.replacen("20", "0", 1), "{ on = \"x-max\", fix = \"x\" }"),
    ] {
        assert!(same < 1e-9, "{same}");
    }
    for other in ["{ on = \"x-min\", fix = \"xyz\" }", "{ where = \"x == 0 mm and z <= 5 mm\", fix = \"x\" }"]
    {
        assert!(right(other) > 0.01, "{other}");
    }
}

/// A plate on half of a block has half of its force on the whole, and all of its force on the half.
#[test]
fn a_tool_that_a_plane_of_symmetry_cuts_is_said_of_the_reference() {
    let whole = r#"title = "A block under a plate"
body = { shape = "box", min = ["-20 mm", "0 mm", "0 mm"], max = ["20 mm", "20 mm", "20 mm"] }
material = { law = "neo-hookean", young = "20 kPa", poisson = 0.3 }
support = [{ on = "z-min", fix = "xyz" }]
procedure = { kind = "static", steps = 1 }
tool = [{ name = "plate", shape = "plate", at = ["5 mm", "10 mm", "20 mm"], along = [0, 0, -1], drive = { closure = "1 mm" }, penalty = "5 MPa/mm" }]
method = [{ id = "hex8", family = "fem", element = "hex8", size = { cells = [4, 2, 2] } }]
"#;
    let half = whole
        .replace("[\"-20 mm\"", "[\"0 mm\"")
        .replace("[4, 2, 2]", "[2, 2, 2]")
        .replace("\"xyz\" }", "\"xyz\" }, { on = \"x-min\", fix = \"x\" }");
    for (of, x, error) in [(whole, -15.0, 0.5), (&half, 2.0, 0.0)] {
        let dir = tempfile::tempdir().unwrap();
        let corners = [[x, 5.0, 5.0], [15.0, 5.0, 5.0], [5.0, 15.0, 10.0], [5.0, 5.0, 15.0]];
        let out = inside(&dir, "r.json");
        let scene = write(&dir, "made.toml", of);
        let made = tissuebench(&["reference", &scene, "--points", &points(&dir, corners), "--out", &out]);
        assert_eq!(made.code, 0, "{}", made.stderr);
        let scene = write(&dir, "half.toml", &format!("{half}reference = {{ record = \"r.json\" }}\n"));
        let done = tissuebench(&["run", &scene, "--once", "--format", "json"]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        let object: Value = serde_json::from_str(done.stdout.trim()).unwrap();
        let found = object["metrics"]["tool-force-error"]["value"].as_f64().unwrap();
        assert!((found - error).abs() < 1e-6, "{found}");
        let warnings = &object["reference"]["warnings"];
        let said = warnings.to_string().contains("its force in this scene is 0.5 of that on the whole body");
        assert_eq!(said, error > 0.0, "{warnings}");
    }
}

#[test]
fn bad_records_are_named() {
    let dir = tempfile::tempdir().unwrap();
    let good = std::fs::read_to_string(stored(&dir)).unwrap();
    let scene = write(&dir, "s.toml", &format!("{}reference = {{ record = \"r.json\" }}\n", bonded()));
    let fails = |says: &str| {
        let done = tissuebench(&["run", &scene]);
        assert_fails(&done, 2, "s.toml:");
        assert_fails(&done, 2, "key 'reference.record'");
        assert_fails(&done, 2, says);
    };
    fails("'r.json' can't be read: there is no file ");
    write(&dir, "r.json", "{}");
    fails("'r.json' is not a reference: missing field");
    write(&dir, "r.json", &good.replace("\"probes\":[[0.02,", "\"probes\":[[0.03,"));
    fails("'r.json' was made for other probes");
}
