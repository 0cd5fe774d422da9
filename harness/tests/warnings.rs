//! Warnings about results appear in the object of the run, in its table and in its folder.

mod common;

use common::{BLOCK, assert_fails, inside, objects, tissuebench, without, write, written_out};
use serde_json::Value;
use tempfile::TempDir;

/// Runs a scene and returns its JSON objects.
#[track_caller]
fn run(dir: &TempDir, text: &str) -> Vec<Value> {
    let done = tissuebench(&["run", &write(dir, "scene.toml", text), "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    objects(&done.stdout)
}

fn metric(run: &Value, name: &str) -> f64 {
    run["metrics"][name]["value"].as_f64().unwrap_or_else(|| panic!("no {name} in {run}"))
}

fn codes(run: &Value) -> Vec<&str> {
    run["warnings"].as_array().unwrap().iter().map(|w| w["code"].as_str().unwrap()).collect()
}

const TWO_LAYERS: &str = r#"
title = "Two layers"
body = { shape = "box", size = ["20 mm", "20 mm", "20 mm"] }
material = { law = "linear", young = "1 kPa", poisson = 0.3 }
region = [{ name = "upper", where = "z > 11 mm", material = { law = "linear", young = "4 kPa", poisson = 0.3 } }]
support = [{ on = "z-min", fix = "xyz" }]
load = [{ on = "z-max", traction = ["0 Pa", "0 Pa", "-10 Pa"] }]
method = [
    { id = "hex8", family = "fem", element = "hex8", size = { cells = [4, 4, 4] } },
    { id = "hex8-20", family = "fem", element = "hex8", size = { cells = [4, 4, 20] } },
    { id = "efg", family = "efg", size = { nodes = 125 }, kernel = "cubic-spline", basis = "linear", support_scale = 1.6, essential = "multipliers", integration = { rule = "gauss", points = 1 } },
]
"#;

#[test]
fn a_cut_region_and_a_blended_jump_are_told_with_their_numbers() {
    let dir = tempfile::tempdir().unwrap();
    let runs = run(&dir, TWO_LAYERS);
    // The interface at 11 mm cuts the third of four layers of cells, and lies between cells if there are
    // twenty layers.
    let cut = &runs[0]["warnings"][0];
    assert_eq!((cut["code"].as_str(), cut["value"].as_f64()), (Some("region-cut"), Some(0.25)));
    assert_eq!(cut["where"], "region[0].where");
    assert!(cut["message"].as_str().unwrap().contains("16 of 64 cells"), "{cut}");
    assert!(!codes(&runs[1]).contains(&"region-cut"), "{:?}", codes(&runs[1]));
    let blended = runs[2]["warnings"].as_array().unwrap().iter().find(|w| w["code"] == "regions-blended");
    assert!((blended.unwrap()["value"].as_f64().unwrap() - 4.0).abs() < 1e-12);
    for run in &runs {
        assert_eq!(metric(run, "warnings"), codes(run).len() as f64);
    }
}

#[test]
fn a_cloud_with_a_point_in_each_of_few_cells_is_told() {
    let dir = tempfile::tempdir().unwrap();
    let few = "size = { nodes = 125 }, background = { cells = [3, 3, 3] }";
    let [coarse, fine] = ["", few].map(|few| {
        let text = if few.is_empty() {
            TWO_LAYERS.into()
        } else {
            TWO_LAYERS.replace("size = { nodes = 125 }", few)
        };
        codes(&run(&dir, &text)[2]).contains(&"few-points")
    });
    assert!(!coarse && fine);
}

#[test]
fn a_mesh_that_locks_warns_of_its_stress_and_a_good_one_does_not() {
    let dir = tempfile::tempdir().unwrap();
    let bending = |poisson: &str| {
        let text = written_out("pure-bending.toml");
        let kept = text.replace("poisson = 0.3", &format!("poisson = {poisson}"));
        run(&dir, &kept)
            .into_iter()
            .map(|r| (r["method"].as_str().unwrap().to_string(), r))
            .collect::<Vec<_>>()
    };
    let locked = bending("0.4999");
    for (method, warns) in [("tet4", true), ("hex8", true), ("hex8-mean", false), ("tet10", false)] {
        let found = &locked.iter().find(|(m, _)| m == method).unwrap_or_else(|| panic!("no {method}")).1;
        assert_eq!(codes(found).contains(&"stress-jump"), warns, "{method}: {found}");
    }
}

/// Next to the edge of a bonded punch, forces of coarse meshes are too large by tens of percent, and nothing
/// says how far: no number of a run without a reference is called an error. The jump of stress warns.
#[test]
fn no_number_of_a_run_without_a_reference_is_called_an_error() {
    let dir = tempfile::tempdir().unwrap();
    let out = inside(&dir, "out");
    let scene = |moved: &str| {
        let methods = [("tet4-nodal", "tet4", "nodal-mean"), ("hex8-mean", "hex8", "element-mean")];
        let methods = methods.map(|(id, element, dilation)| {
            format!(r#"{{ id = "{id}", family = "fem", element = "{element}", dilation = "{dilation}", size = {{ cells = [5, 5, 4] }} }}"#)
        });
        format!(
            r#"title = "A punch bonded to a block"
body = {{ shape = "box", size = ["50 mm", "50 mm", "40 mm"] }}
material = {{ law = "linear", young = "8 kPa", poisson = 0.49 }}
support = [{{ on = "z-min", fix = "FIX" }}, {{ on = "x-min", fix = "x" }}, {{ on = "y-min", fix = "y" }}, {{ {moved} }}]
method = [{}]
"#,
            methods.join(", ")
        )
    };
    let punch = scene(
        "where = \"z >= 39.9 mm and x <= 20.1 mm and y <= 20.1 mm\", move = [\"0 mm\", \"0 mm\", \"-2 mm\"]",
    );
    let path = write(&dir, "punch.toml", &punch.replace("FIX", "xyz"));
    let done = tissuebench(&["run", &path, "--once", "--format", "json", "--out", &out]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let runs = objects(&done.stdout);
    for run in &runs {
        assert!((0.1..0.5).contains(&metric(run, "stress-jump")), "{run}");
        let mut names = run["metrics"].as_object().unwrap().keys();
        assert!(!names.any(|name| name.contains("error")), "{run}");
    }
    let warning = runs[1]["warnings"].as_array().unwrap().iter().find(|w| w["code"] == "stress-jump");
    let message = warning.expect("a warning of stress")["message"].as_str().unwrap();
    assert!(message.contains("jumps between neighbours") && message.contains(" mm"), "{message}");
    let records = std::fs::read_to_string(inside(&dir, "out/records.csv")).unwrap();
    let wrong = records.lines().find(|line| line.contains("error"));
    assert!(records.contains("stress-jump") && wrong.is_none(), "{wrong:?}");
    // A punch as wide as the block on a smooth base strains it evenly.
    let even = scene("on = \"z-max\", move = { z = \"-2 mm\" }").replace("FIX", "z");
    for run in self::run(&dir, &even) {
        assert!(metric(&run, "stress-jump") < 1e-6 && codes(&run).is_empty(), "{run}");
    }
}

#[test]
fn a_check_can_forbid_warnings_and_a_folder_keeps_them() {
    let dir = tempfile::tempdir().unwrap();
    let still = without(BLOCK, "load")
        .replace("method =", "check = [{ metric = \"warnings\", at_most = 0 }]\nmethod =");
    let scene = write(&dir, "still.toml", &still);
    let out = inside(&dir, "out");
    let done = tissuebench(&["run", &scene, "--out", &out]);
    assert_fails(&done, 1, "FAILED: still tet4 warnings");
    assert!(done.stdout.contains("warning: tet4: nothing moves this body"), "{}", done.stdout);
    let kept = std::fs::read_to_string(dir.path().join("out/warnings.json")).unwrap();
    let kept: Value = serde_json::from_str(&kept).unwrap();
    assert_eq!((&kept[0]["code"], &kept[0]["case"]), (&"nothing-moves".into(), &"still".into()));
    assert!(
        std::fs::read_to_string(dir.path().join("out/report/report.html")).unwrap().contains("nothing-moves")
    );
}

/// A bar with a period of 1.39 s oscillates for 3.8 s in five steps; its energy is conserved nevertheless.
#[test]
fn time_steps_that_are_too_long_are_told() {
    let dir = tempfile::tempdir().unwrap();
    let moved = |steps: usize| {
        let text = BLOCK
            .replace("poisson = 0.3", "poisson = 0.3, density = \"1000 kg/m^3\"")
            .replace("load =", &format!("procedure = {{ kind = \"implicit-dynamic\", duration = \"40 ms\", steps = {steps} }}\nload ="))
            .replace("law = \"linear\"", "law = \"neo-hookean\"")
            .replace("pressure = \"1 kPa\"", "pressure = \"100 Pa\"");
        run(&dir, &text).remove(0)
    };
    let (long, short) = (moved(4), moved(400));
    assert!(codes(&long).contains(&"step-error"), "{long}");
    assert!(!codes(&short).contains(&"step-error"), "{short}");
    assert!(metric(&long, "energy-drift") < 1e-2);
}

/// The leakage through a penalty support of a nearly incompressible solid spoils its pressure, not its
/// displacement.
#[test]
fn a_support_that_gives_way_or_leaks_is_told() {
    let dir = tempfile::tempdir().unwrap();
    let patch = |poisson: &str, essential: &str| {
        let text = format!(
            r#"title = "Patch"
body = {{ shape = "box", size = ["50 mm", "50 mm", "50 mm"] }}
material = {{ law = "linear", young = "20 kPa", poisson = {poisson} }}
support = [{{ on = "surface", move = "exact" }}]
reference = {{ exact = "affine" }}
method = [{{ id = "efg", family = "efg", basis = "linear", kernel = "cubic-spline", support_scale = 1.6, size = {{ cells = [5, 5, 5] }}, integration = {{ rule = "cell-smoothed" }}, essential = {essential} }}]
"#
        );
        run(&dir, &text).remove(0)
    };
    let found = patch("0.4999", "{ method = \"penalty\", factor = 1e4 }");
    // The stress is wrong by a fifth, and the warning gives about this value.
    assert!((metric(&found, "stress") - 0.19).abs() < 0.02, "{found}");
    assert_eq!(codes(&found), ["support-leaks"]);
    assert!((found["warnings"][0]["value"].as_f64().unwrap() - 0.21).abs() < 0.05, "{found}");
    assert!(codes(&patch("0.4999", "\"nitsche\"")).is_empty());
    for poisson in ["0.3", "0.495"] {
        assert!(codes(&patch(poisson, "\"penalty\"")).is_empty());
    }
    assert!(codes(&patch("0.3", "{ method = \"penalty\", factor = 1 }")).contains(&"support-gives"));
}

/// Reduced elements fold between their quadrature points: the force falls as the plate advances.
#[test]
fn elements_that_fold_between_their_points_are_told() {
    let dir = tempfile::tempdir().unwrap();
    let text = r#"title = "Reduced integration under a plate"
body = { shape = "box", size = ["40 mm", "40 mm", "20 mm"] }
material = { law = "neo-hookean", young = "20 kPa", poisson = 0.45 }
support = [{ on = "z-min", fix = "xyz" }]
tool = [{ name = "top", shape = "plate", at = ["20 mm", "20 mm", "20 mm"], along = [0, 0, -1], drive = { closure = "12 mm" }, penalty = "1 MPa/mm" }]
procedure = { kind = "static", steps = 6 }
method = [
    { id = "reduced", family = "fem", element = "hex20", reduced = true, size = { cells = [4, 4, 2] } },
    { id = "full", family = "fem", element = "hex20", size = { cells = [4, 4, 2] } },
]
"#;
    let [reduced, full] = run(&dir, text).try_into().unwrap();
    assert!(metric(&reduced, "smallest-j") > 0.5 && metric(&reduced, "smallest-fine-j") < -1.0, "{reduced}");
    assert!(codes(&reduced).contains(&"folded") && !codes(&full).contains(&"folded"), "{full}");
}

/// A cloud folded between its quadrature points has a meaningless stress at them: two warnings, and an error
/// beyond 100 %.
#[test]
fn a_folded_cloud_is_told() {
    let dir = tempfile::tempdir().unwrap();
    let text = |poisson: f64| {
        format!(
            r#"title = "A block bent by one radian"
body = {{ shape = "box", min = ["-5 mm", "0 mm", "0 mm"], max = ["5 mm", "20 mm", "5 mm"] }}
material = {{ law = "neo-hookean", young = "20 kPa", poisson = {poisson} }}
support = [{{ on = "y-max", move = "exact" }}, {{ on = "y-min", fix = "y" }}, {{ on = ["z-min", "z-max"], fix = "z" }}]
procedure = {{ kind = "static", steps = 4 }}
reference = {{ exact = "finite-bending", thickness = "10 mm", curvature = "50 /m" }}
method = [{{ id = "efg", family = "efg", basis = "linear", kernel = "cubic-spline", support_scale = 1.6, size = {{ cells = [2, 4, 1] }}, integration = {{ rule = "cell-smoothed", points = 1 }}, essential = "penalty" }}]
"#
        )
    };
    let folded = run(&dir, &text(0.4999)).remove(0);
    assert!(metric(&folded, "smallest-fine-j") < 0.0 && codes(&folded).contains(&"folded"), "{folded}");
    assert!(codes(&folded).contains(&"stress-jump") && metric(&folded, "stress") > 1.0, "{folded}");
    assert!(metric(&run(&dir, &text(0.3)).remove(0), "stress") < 1.0);
}

/// A small ball on a coarse block is in contact at one point.
#[test]
fn a_tool_that_stands_on_a_point_or_two_is_told() {
    let dir = tempfile::tempdir().unwrap();
    let text = |cells: &str| {
        format!(
            r#"title = "A small ball"
body = {{ shape = "box", size = ["20 mm", "20 mm", "10 mm"] }}
material = {{ law = "neo-hookean", young = "20 kPa", poisson = 0.3 }}
support = [{{ on = "z-min", fix = "xyz" }}]
tool = [{{ name = "ball", shape = "sphere", radius = "2 mm", at = ["10.3 mm", "10.2 mm", "12 mm"], along = [0, 0, -1], drive = {{ closure = "0.4 mm" }}, penalty = "1 MPa/mm" }}]
procedure = {{ kind = "static", steps = 1 }}
method = [{{ id = "hex8", family = "fem", element = "hex8", size = {{ cells = {cells} }} }}]
"#
        )
    };
    let coarse = run(&dir, &text("[4, 4, 2]")).remove(0);
    let few = coarse["warnings"].as_array().unwrap().iter().find(|w| w["code"] == "few-contact-points");
    assert_eq!(few.unwrap_or_else(|| panic!("{coarse}"))["where"], "tool[0]");
    let fine = run(&dir, &text("[32, 32, 8]")).remove(0);
    assert!(!codes(&fine).contains(&"few-contact-points"), "{fine}");
}

/// Gauss points with a dilation for each node need a factor near 86 at a Poisson's ratio of 0.4999. Below
/// this factor there is no Cholesky factor; slightly above, a Cholesky factor exists and pressures are wrong
/// by a factor of 200.
#[test]
fn a_factor_of_nitsche_s_method_near_the_one_needed_is_told() {
    let dir = tempfile::tempdir().unwrap();
    let text = |factor: f64| {
        format!(
            r#"title = "Bending, nearly incompressible"
body = {{ shape = "box", min = ["0 mm", "-20 mm", "-20 mm"], max = ["80 mm", "20 mm", "20 mm"] }}
material = {{ law = "linear", young = "20 kPa", poisson = 0.4999 }}
support = [{{ on = "x-min", move = "exact" }}]
load = [{{ on = "x-max", traction = "exact" }}]
reference = {{ exact = "pure-bending", curvature = "0.5 /m" }}
method = [{{ id = "efg", family = "efg", basis = "linear", kernel = "cubic-spline", support_scale = 1.6, size = {{ level = 1 }}, integration = {{ rule = "gauss", points = 4 }}, dilation = "nodal-mean", essential = {{ method = "nitsche", factor = {factor} }} }}]
"#
        )
    };
    let above = run(&dir, &text(90.0)).remove(0);
    let needed = metric(&above, "nitsche-factor-needed");
    assert!(needed > 80.0 && needed < 90.0, "{needed}");
    assert!(codes(&above).contains(&"nitsche-factor") && metric(&above, "pressure") > 100.0, "{above}");
    let below = tissuebench(&["run", &write(&dir, "below.toml", &text(80.0))]);
    assert_fails(&below, 3, "not positive definite");
}

/// A thin part is lost between coarse cells, and a plate that does not reach the body exerts no pressure.
#[test]
fn lost_volume_and_a_tool_beside_the_body_are_told() {
    let dir = tempfile::tempdir().unwrap();
    let corners = [[0, 0, 0], [40, 0, 0], [0, 40, 0], [0, 0, 40]];
    let face = |nodes: [usize; 3]| {
        let vertex = |k: usize| format!("vertex {}\n", corners[k].map(|x| x.to_string()).join(" "));
        format!("facet normal 0 0 0\nouter loop\n{}endloop\nendfacet\n", nodes.map(vertex).concat())
    };
    let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(face).concat();
    write(&dir, "tip.stl", &format!("solid tip\n{faces}endsolid tip\n"));
    let text = |spacing: &str, closure: &str| {
        format!(
            r#"title = "A pyramid under a plate"
body = {{ shape = "file", path = "tip.stl", unit = "mm" }}
material = {{ law = "neo-hookean", young = "20 kPa", poisson = 0.3 }}
support = [{{ where = "z <= 2 mm", fix = "xyz" }}]
tool = [{{ name = "plate", shape = "plate", at = ["0 mm", "0 mm", "41 mm"], along = [0, 0, -1], drive = {{ closure = "{closure}" }}, penalty = "0.1 MPa/mm" }}]
procedure = {{ kind = "static", steps = 4 }}
method = [{{ id = "tet4", family = "fem", element = "tet4", size = {{ spacing = "{spacing}" }} }}]
"#
        )
    };
    let coarse = run(&dir, &text("10 mm", "1 mm")).remove(0);
    let lost = coarse["warnings"].as_array().unwrap().iter().find(|w| w["code"] == "volume-differs");
    let lost = lost.unwrap_or_else(|| panic!("{coarse}"));
    let ratio = metric(&coarse, "volume") / (40e-3f64.powi(3) / 6.0);
    assert!((lost["value"].as_f64().unwrap() / ratio - 1.0).abs() < 1e-9 && ratio < 0.95, "{lost} {ratio}");
    let beside = coarse["warnings"].as_array().unwrap().iter().find(|w| w["code"] == "tool-untouched");
    assert_eq!(beside.unwrap_or_else(|| panic!("{coarse}"))["where"], "tool[0]");
    let fine = run(&dir, &text("2 mm", "10 mm")).remove(0);
    let codes = codes(&fine);
    assert!(!codes.contains(&"volume-differs") && !codes.contains(&"tool-untouched"), "{codes:?}");
}

/// A plate may have any position: it has no inside or outside.
#[test]
fn a_plate_that_starts_in_the_body_is_told() {
    let dir = tempfile::tempdir().unwrap();
    let run_at = |z: &str| {
        let text = format!(
            r#"title = "A block under a plate"
body = {{ shape = "box", size = ["20 mm", "20 mm", "20 mm"] }}
material = {{ law = "neo-hookean", young = "20 kPa", poisson = 0.3 }}
support = [{{ where = "z == 0 mm", fix = "xyz" }}]
tool = [{{ name = "plate", shape = "plate", at = ["0 mm", "0 mm", "{z}"], along = [0, 0, -1], drive = {{ closure = "0.5 mm" }}, penalty = "0.1 MPa/mm" }}]
procedure = {{ kind = "static", steps = 2 }}
method = [{{ id = "hex8", family = "fem", element = "hex8", size = {{ cells = [3, 3, 3] }} }}]
"#
        );
        run(&dir, &text).remove(0)
    };
    let deep = run_at("18 mm");
    let found = deep["warnings"].as_array().unwrap().iter().find(|w| w["code"] == "tool-inside");
    let found = found.unwrap_or_else(|| panic!("{deep}"));
    assert_eq!(found["where"], "tool[0]");
    assert!((found["value"].as_f64().unwrap() - 2e-3).abs() < 1e-9, "{found}");
    for near in ["20 mm", "19.9 mm", "20.2 mm"] {
        let run = run_at(near);
        assert!(!codes(&run).contains(&"tool-inside"), "{near}: {run}");
    }
}

/// A tool that presses a block onto another block closes the gap without contact: blocks without common nodes
/// do not touch.
#[test]
fn pieces_that_do_not_feel_each_other_are_told() {
    let dir = tempfile::tempdir().unwrap();
    let run_with = |lift: usize| {
        let levels = [0, 10, 10 + lift, 20 + lift];
        // With a lift of zero, the upper block has the top nodes of the lower block.
        let upper = if lift > 0 { 8 } else { 4 };
        let node = |k: usize| {
            let (level, corner) = (k / 4, k % 4);
            let (x, y) = ([0, 20, 20, 0][corner], [0, 0, 20, 20][corner]);
            format!("{} {x} {y} {}\n", k + 1, levels[if lift > 0 || level < 2 { level } else { 3 }])
        };
        let count = if lift > 0 { 16 } else { 12 };
        let nodes: String = (0..count).map(node).collect();
        let hex = |number: usize, first: usize| {
            let nodes: Vec<String> = (1..=8).map(|k| (first + k).to_string()).collect();
            format!("{number} 5 0 {}\n", nodes.join(" "))
        };
        let cells = hex(1, 0) + &hex(2, upper);
        let mesh = format!(
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{count}\n{nodes}$EndNodes\n$Elements\n2\n{cells}$EndElements\n"
        );
        write(&dir, "blocks.msh", &mesh);
        let text = r#"title = "One block on another"
body = { shape = "file", path = "blocks.msh", unit = "mm" }
material = { law = "neo-hookean", young = "20 kPa", poisson = 0.3 }
support = [{ where = "x <= 0 mm", fix = "xyz" }]
tool = [{ name = "plate", shape = "plate", at = ["0 mm", "0 mm", "TOP"], along = [0, 0, -1], drive = { closure = "1 mm" }, penalty = "0.1 MPa/mm" }]
procedure = { kind = "static", steps = 1 }
method = [{ id = "hex8", family = "fem", element = "hex8", size = { file = "blocks.msh" } }]
"#;
        run(&dir, &text.replace("TOP", &format!("{} mm", 20 + lift))).remove(0)
    };
    let apart = run_with(2);
    let told = apart["warnings"].as_array().unwrap().iter().find(|w| w["code"] == "pieces-apart");
    assert_eq!(told.unwrap_or_else(|| panic!("{apart}"))["value"], 2.0);
    assert!(!codes(&run_with(0)).contains(&"pieces-apart"));
}
