//! Supports at points, along edges and on sets of nodes of mesh files.

mod common;

use common::{assert_fails, objects, tissuebench, write};

/// A bar of two hexahedra, 20 x 10 x 10 mm, with a physical point and a physical curve.
const GMSH: &str = r#"$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
0 1 "corner"
1 2 "rim"
3 3 "bar"
$EndPhysicalNames
$Nodes
12
1 0 0 0
2 10 0 0
3 20 0 0
4 0 10 0
5 10 10 0
6 20 10 0
7 0 0 10
8 10 0 10
9 20 0 10
10 0 10 10
11 10 10 10
12 20 10 10
$EndNodes
$Elements
5
1 15 2 1 1 3
2 1 2 2 1 1 4
3 1 2 0 1 4 10
4 5 2 3 1 1 2 5 4 7 8 11 10
5 5 2 3 1 2 3 6 5 8 9 12 11
$EndElements
"#;

/// The same bar as a deck. The set `foot` has the four nodes of a face and one more.
const DECK: &str = "*NODE
1, 0, 0, 0
2, 10, 0, 0
3, 20, 0, 0
4, 0, 10, 0
5, 10, 10, 0
6, 20, 10, 0
7, 0, 0, 10
8, 10, 0, 10
9, 20, 0, 10
10, 0, 10, 10
11, 10, 10, 10
12, 20, 10, 10
*ELEMENT, TYPE=C3D8, ELSET=bar
1, 1, 2, 5, 4, 7, 8, 11, 10
2, 2, 3, 6, 5, 8, 9, 12, 11
*NSET, NSET=corner
3
*NSET, NSET=rim
1, 4
*NSET, NSET=foot
1, 4, 7, 10, 3
*NSET, NSET=end
3, 9
";

fn of_file(file: &str, element: &str, supports: &str) -> String {
    format!(
        r#"title = "A bar of a file"
body = {{ shape = "file", path = "{file}", unit = "mm" }}
material = {{ law = "linear", young = "20 kPa", poisson = 0.3 }}
support = [{supports}]
load = [{{ where = "x == 20 mm", traction = ["1 kPa", "0 Pa", "0 Pa"] }}, {{ where = "x == 0 mm", traction = ["-1 kPa", "0 Pa", "0 Pa"] }}]
output = {{ probes = [["20 mm", "10 mm", "10 mm"]] }}
procedure = {{ kind = "linear", linear_solver = "direct" }}
method = [{{ id = "hex", family = "fem", element = "{element}", size = {{ file = "{file}", unit = "mm" }} }}]
"#
    )
}

/// Six supports on the set `rim` along y, at a point, and on the set `corner`: a free bar under uniaxial stress.
const HELD: &str = r#"{ on = "rim", fix = "xz" }, { at = [["0 mm", "0 mm", "0 mm"]], fix = "y" }, { on = "corner", fix = "z" }"#;

#[test]
fn sets_of_nodes_of_files_hold_a_bar_without_force() {
    for (file, text) in [("bar.msh", GMSH), ("bar.inp", DECK)] {
        // Quadratic elements have a node halfway along the curve.
        for element in ["hex8", "hex20"] {
            let dir = tempfile::tempdir().unwrap();
            write(&dir, file, text);
            let scene = write(&dir, "scene.toml", &of_file(file, element, HELD));
            let done = tissuebench(&["run", &scene, "--once", "--format", "json"]);
            assert_eq!(done.code, 0, "{}", done.stderr);
            let found = &objects(&done.stdout)[0]["metrics"];
            let number = |name: &str| found[name]["value"].as_f64().unwrap_or_else(|| panic!("no {name}"));
            // 1 kPa / 20 kPa x 20 mm, and -0.3 times that strain across.
            for (name, value) in [("probe-x", 1e-3), ("probe-y", -1.5e-4), ("probe-z", -1.5e-4)] {
                assert!((number(name) - value).abs() < 1e-12, "{file} {element} {name}: {}", number(name));
            }
            for name in ["reaction-x", "reaction-z", "reaction-y-2", "reaction-z-3"] {
                assert!(number(name).abs() < 1e-10, "{file} {element} {name}: {}", number(name));
            }
        }
    }
}

#[test]
fn a_force_on_a_set_of_nodes_is_spread_evenly_over_them() {
    let held = "{ where = \"x == 0 mm\", fix = \"xyz\" }";
    let at = |load: &str| {
        let dir = tempfile::tempdir().unwrap();
        write(&dir, "bar.inp", DECK);
        let text = of_file("bar.inp", "hex8", held)
            .lines()
            .filter(|line| !line.starts_with("load"))
            .fold(String::new(), |text, line| text + line + "\n");
        let scene = write(&dir, "scene.toml", &format!("{text}load = [{load}]\n"));
        tissuebench(&["run", &scene, "--once", "--format", "json"])
    };
    let probe = |load: &str| {
        let done = at(load);
        assert_eq!(done.code, 0, "{}", done.stderr);
        objects(&done.stdout)[0]["metrics"]["probe-z"]["value"].as_f64().unwrap()
    };
    // The nodes of `end` are those at x = 20 mm, y = 0.
    let set = probe("{ on = \"end\", force = [\"0 N\", \"0 N\", \"2 mN\"] }");
    let points = "at = [[\"20 mm\", \"0 mm\", \"0 mm\"], [\"20 mm\", \"0 mm\", \"10 mm\"]]";
    let points = probe(&format!("{{ {points}, force = [\"0 N\", \"0 N\", \"1 mN\"] }}"));
    assert!(set > 0.0 && (set - points).abs() < 1e-12 * points, "{set} {points}");
    assert_fails(
        &at("{ on = \"end\", traction = [\"0 kPa\", \"0 kPa\", \"1 kPa\"] }"),
        2,
        "names 'end', a set of nodes without faces; name a surface; only a force acts on the nodes of a set",
    );
}

#[test]
fn a_set_with_faces_and_other_nodes_holds_all_its_nodes() {
    let dir = tempfile::tempdir().unwrap();
    write(&dir, "bar.inp", DECK);
    let supports = r#"{ on = "foot", fix = "xyz" }"#;
    let scene = write(&dir, "scene.toml", &of_file("bar.inp", "hex8", supports));
    let done = tissuebench(&[
        "run",
        &scene,
        "--once",
        "--format",
        "json",
        "--set",
        "output.probes=[[\"20 mm\", \"0 mm\", \"0 mm\"]]",
    ]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert_eq!(objects(&done.stdout)[0]["metrics"]["probe-x"]["value"].as_f64(), Some(0.0));
}

#[test]
fn an_edge_is_a_curve_of_a_file_too() {
    let dir = tempfile::tempdir().unwrap();
    write(&dir, "bar.msh", GMSH);
    let run = |on: &str| {
        let scene = write(&dir, "scene.toml", &of_file("bar.msh", "hex8", &HELD.replace("on = \"rim\"", on)));
        let done = tissuebench(&["run", &scene, "--once", "--format", "json"]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        objects(&done.stdout)[0]["metrics"]["probe-x"]["value"].clone()
    };
    assert_eq!(run("edge = \"rim\""), run("on = \"rim\""));
}

#[test]
fn places_without_a_node_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    write(&dir, "bar.msh", GMSH);
    let refused = |supports: &str, says: &str| {
        let scene = write(&dir, "scene.toml", &of_file("bar.msh", "hex8", supports));
        assert_fails(&tissuebench(&["run", &scene, "--once"]), 2, says);
    };
    refused(
        r#"{ on = "rime", fix = "xyz" }"#,
        "key 'support[0].on': 'rime' names 'rime', a surface that the mesh does not have",
    );
    refused(r#"{ on = "rime", fix = "xyz" }"#, "the mesh has surface and the sets of nodes corner, rim");
    refused(
        r#"{ edge = ["rim", "corner"], fix = "xyz" }"#,
        "names rim and corner, which share no node of the mesh",
    );
    refused(
        r#"{ edge = ["rim", "rime"], fix = "xyz" }"#,
        "names 'rime', a surface that the mesh does not have",
    );
    refused(
        r#"{ at = [["0 mm", "0 mm", "0 mm"], ["3 mm", "0 mm", "0 mm"]], fix = "xyz" }"#,
        "(3.0, 0.0, 0.0) mm is no node of the mesh: the nearest, at (0.0, 0.0, 0.0) mm, is 3.000e0 mm away",
    );
    refused(
        r#"{ at = [["0 mm", "0 mm", "90 mm"]], fix = "xyz" }"#,
        "(0.0, 0.0, 90.0) mm is 80.0 mm outside the body",
    );
    // A load needs faces.
    let text = of_file("bar.msh", "hex8", HELD)
        .replace("{ where = \"x == 20 mm\", traction", "{ on = \"rim\", traction");
    assert_fails(
        &tissuebench(&["run", &write(&dir, "scene.toml", &text), "--once"]),
        2,
        "names 'rim', a set of nodes without faces",
    );
}

#[test]
fn a_deck_keeps_sets_of_nodes() {
    let dir = tempfile::tempdir().unwrap();
    let (from, to) = (write(&dir, "bar.msh", GMSH), dir.path().join("out.inp").display().to_string());
    let done = tissuebench(&["mesh", "convert", &from, &to]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let info = tissuebench(&["mesh", "info", &to]);
    assert!(
        info.stdout.contains("corner: 1 nodes") && info.stdout.contains("rim: 2 nodes"),
        "{}",
        info.stdout
    );
}
