//! Bodies from surfaces, and meshes and clouds of any size on bodies from files.

mod common;

use common::implicit::stl;
use common::{assert_fails, inside, tissuebench, write};
use serde_json::Value;

/// An ellipsoid with half axes of 20 x 15 x 10 mm, as STL, without its last `left_out` triangles.
fn ellipsoid(left_out: usize) -> String {
    let (along, around) = (24, 32);
    let at = |i: usize, j: usize| {
        let (t, p) = (
            std::f64::consts::PI * i as f64 / along as f64,
            std::f64::consts::TAU * (j % around) as f64 / around as f64,
        );
        let ring = if i == 0 || i == along { 0.0 } else { t.sin() };
        [20.0 * ring * p.cos(), 15.0 * ring * p.sin(), 10.0 * t.cos()]
    };
    let mut triangles = Vec::new();
    for i in 0..along {
        for j in 0..around {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            if i + 1 < along {
                triangles.push([a, b, c]);
            }
            if i > 0 {
                triangles.push([a, c, d]);
            }
        }
    }
    triangles.truncate(triangles.len() - left_out);
    stl("ellipsoid", &triangles)
}

#[test]
fn a_surface_is_filled_and_described() {
    let dir = tempfile::tempdir().unwrap();
    let (from, to) = (write(&dir, "organ.stl", &ellipsoid(0)), inside(&dir, "organ.msh"));
    let done = tissuebench(&["mesh", "make", &from, "--size", "3 mm", "--out", &to]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let says = [
        "  surface     1472 triangles, ",
        "  surfaces    ellipsoid: ",
        "  spacing     3.000 mm, up to 4 times that inside",
        "% of the surface's 12.4",
        "degrees between",
    ];
    assert!(says.iter().all(|says| done.stdout.contains(says)), "{}", done.stdout);
    let info = tissuebench(&["mesh", "info", &to]);
    assert!(
        info.code == 0
            && info.stdout.contains("surfaces    ellipsoid: ")
            && info.stdout.contains(" surface: "),
        "{}{}",
        info.stdout,
        info.stderr
    );
    let surface = tissuebench(&["mesh", "info", &from]);
    let says = ["a closed surface of 1472 triangles", "unit        mm: 40.000 mm long", "area        "];
    assert!(says.iter().all(|says| surface.stdout.contains(says)), "{}", surface.stdout);
    let metres = tissuebench(&["mesh", "info", "--unit", "m", &from]);
    assert!(
        metres.stdout.contains("40.000 m long: if the file is in mm, give --unit mm"),
        "{}",
        metres.stdout
    );
    let [one, eight] = ["500", "4000"].map(|nodes| {
        let done = tissuebench(&["mesh", "make", &from, "--nodes", nodes, "--uniform", "--out", &to]);
        let count: f64 = done.stdout.split(' ').nth(1).unwrap().parse().unwrap();
        count / nodes.parse::<f64>().unwrap()
    });
    assert!((one - 1.0).abs() < 0.1 && (eight - 1.0).abs() < 0.05, "{one} {eight}");
}

/// A plate of 60 x 60 x 3 mm, as OBJ with four-cornered faces, which precede their vertices.
const PLATE: &str = "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8
v 0 0 0\nv 60 0 0\nv 60 60 0\nv 0 60 0\nv 0 0 3\nv 60 0 3\nv 60 60 3\nv 0 60 3\n";

#[test]
fn more_nodes_wanted_of_a_thin_plate_are_never_fewer_made() {
    let dir = tempfile::tempdir().unwrap();
    let (from, to) = (write(&dir, "plate.obj", PLATE), inside(&dir, "plate.msh"));
    let counts = ["100", "400", "800", "1600", "3000"].map(|nodes| {
        let done = tissuebench(&["mesh", "make", &from, "--nodes", nodes, "--uniform", "--out", &to]);
        let count: usize = done.stdout.split(' ').nth(1).unwrap().parse().unwrap();
        let says = done.stdout.contains(&format!("wanted      {nodes} nodes; no tried cell size"));
        assert_eq!(says, (count as f64 / nodes.parse::<f64>().unwrap() - 1.0).abs() > 0.1, "{}", done.stdout);
        count
    });
    assert!(counts.is_sorted() && counts[0] < 1000, "{counts:?}");
    let crossed = write(&dir, "crossed.obj", &PLATE.replace("5 6 7 8", "5 7 6 8"));
    let done = tissuebench(&["mesh", "make", &crossed, "--nodes", "100", "--out", &to]);
    assert_fails(&done, 2, "crossed.obj:2: edges 1 and 3 of face 2 (numbered by their first corners) cross");
}

#[test]
fn an_open_surface_is_refused_with_its_place() {
    let dir = tempfile::tempdir().unwrap();
    let (from, to) = (write(&dir, "organ.stl", &ellipsoid(3)), inside(&dir, "organ.msh"));
    let done = tissuebench(&["mesh", "make", &from, "--size", "3 mm", "--out", &to]);
    assert_fails(&done, 2, "organ.stl: the surface is open: the edge (");
    assert!(!std::path::Path::new(&to).exists());
    let scene = write(&dir, "scene.toml", &scene("organ.stl", TET));
    assert_fails(&tissuebench(&["run", &scene]), 2, "key 'body.path': 'organ.stl' can't be read:");
}

#[test]
fn options_that_make_no_mesh_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let (from, to) = (write(&dir, "organ.stl", &ellipsoid(0)), inside(&dir, "organ.msh"));
    let make = |more: &[&str]| tissuebench(&[&["mesh", "make", &from, "--out", &to], more].concat());
    assert_fails(&make(&["--size", "3"]), 2, "unit");
    assert_fails(&make(&["--size", "0 mm"]), 2, "above zero");
    assert_fails(&make(&["--size", "3 mm", "--nodes", "100"]), 2, "cannot be used with");
    assert_fails(&make(&[]), 2, "--size");
    assert_fails(&make(&["--size", "90 mm"]), 2, "is too large for the surface");
    assert_fails(&make(&["--size", "1 um"]), 2, "gives about");
}

const TET: &str = r#"{ id = "tet4", family = "fem", element = "tet4", size = { level = 2 } }"#;
const REST: &str = r#"family = "efg", kernel = "cubic-spline", support_scale = 1.6, basis = "linear", essential = "nitsche", integration = "#;

/// Scene of a patch test on a body from a file.
fn scene(path: &str, methods: &str) -> String {
    format!(
        r#"title = "A body from a file in an affine field"
body = {{ shape = "file", path = "{path}", unit = "mm" }}
material = {{ law = "linear", young = "20 kPa", poisson = 0.3 }}
support = [{{ on = "surface", move = "exact" }}]
reference = {{ exact = "affine" }}
procedure = {{ kind = "linear", linear_solver = "direct" }}
method = [{methods}]
"#
    )
}

/// Runs a scene; returns the number of nodes and the error of every method.
fn run(scene: &str) -> Vec<(u64, f64)> {
    let done = tissuebench(&["run", scene, "--once", "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let objects = done.stdout.lines().map(|line| serde_json::from_str::<Value>(line).unwrap());
    objects.map(|o| (o["nodes"].as_u64().unwrap(), o["metrics"]["l2"]["value"].as_f64().unwrap())).collect()
}

#[test]
fn elements_and_clouds_of_any_size_pass_the_patch_test() {
    let dir = tempfile::tempdir().unwrap();
    write(&dir, "organ.stl", &ellipsoid(0));
    let smoothed = r#"{ rule = "cell-smoothed", points = 1 }"#;
    let methods = format!(
        "{TET}, {{ id = \"tet10\", family = \"fem\", element = \"tet10\", size = {{ nodes = 1200 }} }}, \
         {{ id = \"cloud\", nodes = 150, {REST}{smoothed} }}, {{ id = \"mesh\", size = {{ spacing = \"4 mm\" }}, {REST}{smoothed} }}"
    );
    let found = run(&write(&dir, "scene.toml", &scene("organ.stl", &methods)));
    assert_eq!(found.len(), 4);
    let passes = |found: &[(u64, f64)]| found.iter().all(|(_, error)| *error < 1e-10);
    assert!(passes(&found), "{found:?}");
    assert!(found[2].0 == 150 && (1200.0 / found[1].0 as f64 - 1.0).abs() < 0.35, "{found:?}");
    // The same body, given by a volume mesh of the surface instead of the surface.
    let made = inside(&dir, "organ.msh");
    assert_eq!(
        tissuebench(&["mesh", "make", &inside(&dir, "organ.stl"), "--nodes", "800", "--out", &made]).code,
        0
    );
    let found = run(&write(&dir, "of-mesh.toml", &scene("organ.msh", &methods)));
    assert!(passes(&found) && found[2].0 == 150, "{found:?}");
}

/// Regions and named surfaces of a mesh file also apply to meshes of other sizes made inside its boundary.
#[test]
fn names_of_a_mesh_file_are_kept_at_other_sizes() {
    let dir = tempfile::tempdir().unwrap();
    let block = std::path::Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../solvers/mesh-files/tests/files/hex8-2.2-text.msh");
    let text = format!(
        r#"title = "Two cubes of a file, one softer"
body = {{ shape = "file", path = "{}", unit = "cm" }}
material = {{ law = "linear", young = "20 kPa", poisson = 0.3 }}
region = [{{ name = "soft", on = "right", material = {{ law = "linear", young = "5 kPa", poisson = 0.3 }} }}]
support = [{{ on = "held", fix = "xyz" }}]
load = [{{ on = "pressed", traction = ["1 kPa", "0 Pa", "0 Pa"] }}]
output = {{ probes = [["2 cm", "0.5 cm", "0.5 cm"]] }}
method = [{{ id = "made", family = "fem", element = "tet4", size = {{ spacing = "1 mm" }} }}]
"#,
        block.display()
    );
    let done = tissuebench(&["run", &write(&dir, "scene.toml", &text), "--once", "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let object: Value = serde_json::from_str(done.stdout.lines().next().unwrap()).unwrap();
    // The strain is 0.05 over 1 cm and 0.2 over the next, and smaller near the support.
    let x = object["metrics"]["max-x"]["value"].as_f64().unwrap();
    assert!((2.0e-3..2.7e-3).contains(&x), "{object}");
}

/// Groups of an OBJ file are named surfaces, for elements and for clouds.
#[test]
fn names_of_a_surface_file_are_held_and_loaded() {
    let dir = tempfile::tempdir().unwrap();
    let cube = "v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nv 0 0 10\nv 10 0 10\nv 10 10 10\nv 0 10 10\n\
        o skin\nf 1 4 3 2\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\n\
        g held\nf 4 1 5 8\ng pressed seen\nf 5 6 7 8\n";
    write(&dir, "cube.obj", cube);
    let text = r#"title = "A cube of an OBJ file"
body = { shape = "file", path = "cube.obj", unit = "mm" }
material = { law = "linear", young = "20 kPa", poisson = 0.3 }
support = [{ on = "held", fix = "xyz" }]
load = [{ on = "seen", traction = ["0 Pa", "0 Pa", "1 kPa"] }]
output = { probes = [["5 mm", "5 mm", "9 mm"]] }
method = [
  { id = "elements", family = "fem", element = "tet10", size = { spacing = "2 mm" } },
  { id = "cloud", nodes = 300, family = "efg", kernel = "cubic-spline", support_scale = 1.6, basis = "linear", integration = { rule = "cell-smoothed", points = 1 }, essential = "nitsche" },
]
"#;
    let done = tissuebench(&["run", &write(&dir, "scene.toml", text), "--once", "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let objects: Vec<Value> = done.stdout.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let moved: Vec<f64> =
        objects.iter().filter_map(|object| object["metrics"]["max-z"]["value"].as_f64()).collect();
    assert!(moved.len() == 2 && (moved[0] / moved[1] - 1.0).abs() < 0.3 && moved[0] > 1e-4, "{moved:?}");
    let other = text.replace("\"seen\"", "\"lid\"");
    let done = tissuebench(&["run", &write(&dir, "other.toml", &other), "--once"]);
    assert_fails(&done, 2, "the mesh has surface, held, pressed, seen, skin");
}

#[test]
fn what_a_surface_has_none_of_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    write(&dir, "organ.stl", &ellipsoid(0));
    let refused = |method: &str, says: &str| {
        let done = tissuebench(&["run", &write(&dir, "scene.toml", &scene("organ.stl", method))]);
        assert_fails(&done, 2, says);
    };
    refused(&TET.replacen("tet4\", size", "hex8\", size", 1), "fills the surface of");
    refused(&TET.replace("level = 2", "cells = [2, 2, 2]"), "is for boxes, not for a file");
    refused(&TET.replace("level = 2", "spacing = \"1 um\""), "at most 3000000 are supported");
    refused(
        &TET.replace("level = 2", "spacing = \"80 mm\""),
        "can't be meshed: a spacing of 0.08 m is too large",
    );
    refused(&TET.replace("level = 2", "file = \"organ.stl\""), "is a surface, not a mesh");
}
