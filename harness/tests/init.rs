//! From the surface of an organ to results and a picture, without editing a file.

mod common;

use std::fmt::Write as _;
use std::path::Path;

use common::implicit::turned;
use common::{assert_fails, inside, objects, tissuebench, write};
use tempfile::TempDir;

/// A bean of about 70 x 40 x 30 mm, as STL: an ellipsoid bent so that its centroid lies near its hollow side,
/// like that of a kidney.
fn bean() -> String {
    let (along, around) = (20, 28);
    let at = |i: usize, j: usize| {
        let (t, p) = (
            std::f64::consts::PI * i as f64 / along as f64,
            std::f64::consts::TAU * (j % around) as f64 / around as f64,
        );
        let ring = if i == 0 || i == along { 0.0 } else { t.sin() };
        let y = 35.0 * t.cos();
        [18.0 * ring * p.cos() + 0.012 * y * y, y, -15.0 * ring * p.sin()]
    };
    let mut text = String::from("solid bean\n");
    let mut triangle = |corners: [[f64; 3]; 3]| {
        text += "facet normal 0 0 0\nouter loop\n";
        for [x, y, z] in corners {
            writeln!(text, "vertex {x} {y} {z}").unwrap();
        }
        text += "endloop\nendfacet\n";
    };
    for i in 0..along {
        for j in 0..around {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            if i + 1 < along {
                triangle([a, b, c]);
            }
            if i > 0 {
                triangle([a, c, d]);
            }
        }
    }
    text + "endsolid\n"
}

/// Whether a folder contains a file with this suffix.
fn has(folder: &Path, suffix: &str) -> bool {
    let entries =
        std::fs::read_dir(folder).map(|entries| entries.map(|e| e.unwrap().path()).collect::<Vec<_>>());
    entries.unwrap_or_default().iter().any(|path| path.extension().is_some_and(|e| e == suffix))
}

/// Creates a folder with the bean; returns the folder and the paths of the file and the scene.
fn folder() -> (TempDir, String, String) {
    let dir = tempfile::tempdir().unwrap();
    let file = write(&dir, "bean.stl", &bean());
    let out = inside(&dir, "bean.toml");
    (dir, file, out)
}

#[test]
fn a_surface_becomes_a_scene_that_runs() {
    let (dir, file, out) = folder();
    let done = tissuebench(&["init", "--file", &file, "--unit", "mm", "--nodes", "200", "--out", &out]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    for named in [
        "--young \"20 kPa\"",
        "--poisson \"0.45\"",
        "--press-from \"top\"",
        // A fifth of the body's height, by its own coarsest mesh.
        "--hold \"z <= -8.75 mm\"",
        "--closure \"1.5 mm\"",
    ] {
        assert!(done.stdout.contains(named), "no {named} in {}", done.stdout);
    }
    assert!(!done.stdout.contains("--unit \""), "{}", done.stdout);
    let results = inside(&dir, "results");
    let done = tissuebench(&["run", &out, "--once", "--format", "json", "--out", &results]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert!(!done.stderr.contains("probe-outside"), "{}", done.stderr);
    let runs = objects(&done.stdout);
    assert_eq!(runs.len(), 9);
    let errors = runs.iter().map(|run| run["metrics"]["relative-rms"]["value"].as_f64());
    assert!(errors.clone().all(|error| error.is_some_and(|e| e > 0.0)), "{:?}", errors.collect::<Vec<_>>());
    let results = Path::new(&results);
    assert!(results.join("report/report.html").is_file() && has(&results.join("volumes"), "pvd"));
    for (folder, suffix) in [("report/figures", "svg"), ("report/figures", "png"), ("report/tables", "csv")] {
        assert!(has(&results.join(folder), suffix), "no {suffix} in {folder}");
    }
    let table = std::fs::read_to_string(results.join("report/tables/support-forces.csv")).unwrap();
    assert!(table.lines().count() == 1 + 3, "a support of the finest run of each method: {table}");
    // The support carries the force of the plate.
    for run in &runs {
        let [held, plate] =
            ["reaction-z", "tool-force"].map(|name| run["metrics"][name]["value"].as_f64().unwrap());
        assert!((held - plate).abs() < 1e-4 * plate, "{held} N of {plate} N");
    }
}

#[test]
fn a_scene_is_replaced_only_by_force() {
    let (dir, file, out) = folder();
    let init = |more: &[&str]| tissuebench(&[&["init", "--file", &file, "--out", &out], more].concat());
    assert_eq!(init(&[]).code, 0);
    let first = std::fs::read_to_string(&out).unwrap();
    assert_fails(&init(&["--young", "5 kPa"]), 2, "bean.toml: exists; replace the file with --force");
    assert_eq!(std::fs::read_to_string(&out).unwrap(), first);
    assert_eq!(init(&["--young", "5 kPa", "--force"]).code, 0);
    assert!(std::fs::read_to_string(&out).unwrap().contains("young = \"5 kPa\""));
    let onto = tissuebench(&["init", "--file", &file, "--out", &file, "--force"]);
    assert_fails(&onto, 2, "is the input file");
    drop(dir);
}

/// Cells of a coarse mesh cut off the tip of a pyramid. A probe there would lie outside the mesh.
#[test]
fn a_body_with_a_tip_has_its_probes_inside() {
    let corners = [[0, 0, 0], [30, 0, 0], [0, 30, 0], [0, 0, 30]];
    let face = |name: &str, [a, b, c]: [usize; 3]| {
        let vertex = |k: usize| corners[k].map(|x| x.to_string()).join(" ");
        let loops = [a, b, c].map(|k| format!("vertex {}", vertex(k))).join("\n");
        format!("solid {name}\nfacet normal 0 0 0\nouter loop\n{loops}\nendloop\nendfacet\nendsolid {name}\n")
    };
    let solids = [("base", [0, 2, 1]), ("left", [0, 1, 3]), ("front", [0, 3, 2]), ("slope", [1, 2, 3])];
    let dir = tempfile::tempdir().unwrap();
    let file = write(&dir, "tip.stl", &solids.map(|(name, nodes)| face(name, nodes)).concat());
    let out = inside(&dir, "tip.toml");
    let init = ["init", "--file", &file, "--unit", "mm", "--hold", "base", "--out", &out];
    let done = tissuebench(&init);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let done = tissuebench(&["run", &out, "--once", "--method", "tet4-coarse", "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
}

/// A tip and a blade under the plate, at which faces of different directions meet. No run mistakes the plate
/// for a tool that pushes out of the body from within.
#[test]
fn a_plate_on_a_tip_is_carried_from_outside() {
    let dir = tempfile::tempdir().unwrap();
    let spindle = turned(&[[6.0, 0.0], [9.0, 6.0], [0.0, 36.0]], 10);
    // Flat ends, and a ridge of 1 mm instead of a tip.
    let blade = turned(&[[12.0, 0.0], [0.5, 30.0]], 4);
    for (name, stl) in [("spindle", spindle), ("blade", blade)] {
        let file = write(&dir, &format!("{name}.stl"), &stl);
        let out = inside(&dir, &format!("{name}.toml"));
        let init =
            ["init", "--file", &file, "--methods", "tet4-nodal,tet10", "--nodes", "150", "--out", &out];
        let done = tissuebench(&init);
        assert_eq!(done.code, 0, "{name}: {}", done.stderr);
        let done = tissuebench(&["run", &out, "--once", "--format", "json"]);
        assert_eq!(done.code, 0, "{name}: {}", done.stderr);
        for run in objects(&done.stdout) {
            let value = |metric: &str| run["metrics"][metric]["value"].as_f64().unwrap();
            assert!(value("load-carried") == 1.0 && value("tool-force") > 0.0, "{name}: {run}");
        }
    }
}

/// Every side, method, drive and strain level makes a scene that can be planned; a few scenes are run.
#[test]
fn every_choice_makes_a_scene() {
    let (dir, file, _) = folder();
    let sides = ["top", "bottom", "left", "right", "front", "back"];
    for side in sides {
        let out = inside(&dir, &format!("{side}.toml"));
        let args = [
            "--file",
            &file,
            "--press-from",
            side,
            "--methods",
            "tet4-nodal",
            "--nodes",
            "400",
            "--out",
            &out,
        ];
        let done = tissuebench(&[&["init"][..], &args].concat());
        assert_eq!(done.code, 0, "{side}: {}", done.stderr);
        assert_eq!(tissuebench(&["plan", &out]).code, 0, "{side}");
        let scene = cases::scene::load(Path::new(&out)).unwrap();
        assert_eq!((scene.methods.len(), scene.tools.len(), scene.supports.len()), (3, 1, 1), "{side}");
    }
    let choices: [&[&str]; 4] = [
        &["--strain", "small", "--methods", "tet4,tet4-nodal,tet10,efg"],
        &["--strain", "small", "--load", "1 kPa", "--methods", "efg", "--spacing", "7 mm"],
        &["--load", "0.3 N", "--methods", "tet4", "--press-from", "right"],
        &["--gap", "1 mm", "--closure", "2 mm", "--methods", "tet4", "--spacing", "7 mm"],
    ];
    for (at, choice) in choices.iter().enumerate() {
        let out = inside(&dir, &format!("choice-{at}.toml"));
        let size: &[&str] = if choice.contains(&"--spacing") { &[] } else { &["--nodes", "160"] };
        let done = tissuebench(&[&["init", "--file", &file, "--out", &out], *choice, size].concat());
        assert_eq!(done.code, 0, "{choice:?}: {}", done.stderr);
        let done = tissuebench(&["run", &out, "--once"]);
        assert_eq!(done.code, 0, "{choice:?}: {}", done.stderr);
    }
}

#[test]
fn what_makes_no_scene_is_refused_by_its_option() {
    let (dir, file, out) = folder();
    let refused = |more: &[&str], says: &str| {
        assert_fails(&tissuebench(&[&["init", "--file", &file, "--out", &out], more].concat()), 2, says);
        assert!(!Path::new(&out).exists(), "{more:?}");
    };
    refused(&["--young", "20"], "--young '20': ");
    refused(&["--poisson", "0.5"], "--poisson '0.5': a number from 0 to below 0.5");
    refused(&["--unit", "inch"], "--unit 'inch': is not a length unit: m, cm, mm or um");
    refused(&["--press-from", "botom"], "did you mean 'bottom'?");
    refused(&["--hold", "lid"], "--hold 'lid': the file names bean; or write comparisons");
    refused(&["--hold", "z < 3"], "--hold");
    refused(&["--hold", "z < -30 mm"], "no corner of the surface lies there");
    refused(&["--hold", "z < 30 mm"], "constrains the whole body");
    refused(&["--hold", "z > 10 mm"], "constrains the point that a plate from the top touches first");
    refused(&["--closure", "40 mm"], "the body is only 30 mm high");
    refused(&["--load", "1 kPa"], "--load '1 kPa': ");
    refused(&["--gap", "1 mm", "--strain", "small"], "small strain has no tool");
    refused(&["--methods", "tet4,hex8"], "'hex8' is not one of tet4, tet4-nodal, tet10, efg");
    refused(&["--nodes", "3"], "--nodes '3': a number from 100 to 200000");
    refused(&["--spacing", "20 mm"], "is too large for the body");
    assert_fails(&tissuebench(&["init", "--out", &out]), 2, "--file is needed");
    assert_fails(&tissuebench(&["init", "--file", &inside(&dir, "none.stl")]), 2, "there is no such file");
}

#[test]
fn a_ball_jaws_and_a_file_stand_where_they_touch() {
    let (dir, file, out) = folder();
    let instrument = write(&dir, "instrument.stl", &tetrahedron());
    for (tool, count, sides) in
        [("ball", 1, "z-max"), ("jaws", 2, "z-min"), (instrument.as_str(), 1, "z-max")]
    {
        let made = tissuebench(&[
            "init",
            "--file",
            &file,
            "--tool",
            tool,
            "--friction",
            "0.3",
            "--press-from",
            "top",
            "--closure",
            "1 mm",
            "--methods",
            "tet4",
            "--nodes",
            "300",
            "--out",
            &out,
            "--force",
        ]);
        assert_eq!(made.code, 0, "{tool}: {}", made.stderr);
        let text = std::fs::read_to_string(&out).unwrap();
        assert_eq!(text.matches("[[tool]]").count(), count, "{text}");
        assert!(text.contains(&format!("touch = \"{sides}\"")), "{text}");
        assert!(text.contains("friction = 0.3\nstick"), "{text}");
        let run = tissuebench(&["run", &out, "--method", "tet4-fine", "--format", "json"]);
        let object = &objects(&run.stdout)[0];
        let force =
            object["metrics"]["tool-force"]["value"].as_f64().unwrap_or_else(|| panic!("{}", run.stderr));
        // Each tool touches from the start and pushes; 1 mm into soft tissue is less than 5 N.
        assert!(force > 1e-3 && force < 5.0, "{tool}: {force}");
    }
}

#[test]
fn tools_that_init_cannot_take_are_refused() {
    let (_dir, file, out) = folder();
    let refused = |options: &[&str], says: &str| {
        let all = [&["init", "--file", &file, "--out", &out], options].concat();
        assert_fails(&tissuebench(&all), 2, says);
    };
    refused(&["--tool", "bal"], "--tool 'bal': is not one of plate, ball, jaws; did you mean 'ball'?");
    refused(&["--tool", "ball", "--strain", "small"], "small strain has no tool");
    refused(&["--friction=-1"], "--friction '-1': a coefficient above zero");
}

/// A blunt instrument: a tetrahedron that stands on a face.
fn tetrahedron() -> String {
    let corners = [[0.0, 0.0, 20.0], [12.0, 0.0, 0.0], [-6.0, 10.0, 0.0], [-6.0, -10.0, 0.0]];
    let mut text = String::from("solid tip\n");
    for [a, b, c] in [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]] {
        text += "facet normal 0 0 0\nouter loop\n";
        for [x, y, z] in [a, b, c].map(|k| corners[k]) {
            writeln!(text, "vertex {x} {y} {z}").unwrap();
        }
        text += "endloop\nendfacet\n";
    }
    text + "endsolid\n"
}
