//! Directions of a material from the data of a mesh file.

mod common;

use common::{objects, tissuebench, write};

/// The mesh of `cases/scenes/fibers`, 64 hexahedra with the arrays `layers` of cells and `twist` of nodes.
const TURNING: &str = include_str!("../../cases/scenes/fibers/turning.vtk");

fn scene(fibers: &str, more: &str) -> String {
    format!(
        r#"title = "A block with fibres"
body = {{ shape = "file", path = "block.vtk", unit = "mm" }}
material = {{ law = "guccione", c = "2 kPa", bf = 8.0, bt = 2.0, bfs = 4.0, bulk = "200 kPa", fibers = {fibers} }}
support = [{{ where = "z == 0 mm", fix = "xyz" }}, {{ where = "z == 20 mm", move = {{ x = "2 mm" }} }}]
procedure = {{ kind = "static", steps = 1 }}
{more}

[[method]]
id = "hex8"
family = "fem"
element = "hex8"
size = {{ file = "block.vtk", unit = "mm" }}
"#
    )
}

/// The result of a run on a mesh file.
fn run(file: &str, scene: &str) -> common::Done {
    let dir = tempfile::tempdir().unwrap();
    write(&dir, "block.vtk", file);
    let scene = write(&dir, "scene.toml", scene);
    tissuebench(&["run", &scene, "--once", "--format", "json"])
}

#[track_caller]
fn energy(file: &str, scene: &str) -> f64 {
    let done = run(file, scene);
    assert_eq!(done.code, 0, "{}", done.stderr);
    objects(&done.stdout)[0]["metrics"]["strain-energy"]["value"].as_f64().unwrap()
}

#[test]
fn vectors_of_a_file_are_the_fibres_they_say() {
    let by_file = energy(TURNING, &scene(r#"{ data = "layers" }"#, ""));
    // The same layers as regions with constants.
    let region = |k: usize, angle: f64| {
        let (sin, cos) = angle.to_radians().sin_cos();
        format!(
            r#"{{ name = "layer {k}", where = "z >= {} mm and z <= {} mm", material = {{ law = "guccione", c = "2 kPa", bf = 8.0, bt = 2.0, bfs = 4.0, bulk = "200 kPa", fibers = [{cos}, {sin}, 0] }} }}"#,
            5 * k,
            5 * k + 5
        )
    };
    let regions: Vec<String> =
        [10.0, 20.0, 40.0, 70.0].iter().enumerate().map(|(k, &a)| region(k, a)).collect();
    let by_regions = energy(TURNING, &scene("[1, 0, 0]", &format!("region = [{}]", regions.join(", "))));
    assert!((by_file - by_regions).abs() < 1e-9 * by_regions, "{by_file} {by_regions}");
    let along_x = energy(TURNING, &scene("[1, 0, 0]", ""));
    assert!((along_x - by_regions).abs() > 0.05 * by_regions, "{along_x} {by_regions}");
}

#[test]
fn vectors_that_are_missing_or_no_direction_are_refused_with_their_place() {
    let at = |line: &str, new: &str| {
        assert!(TURNING.contains(line), "{line}");
        TURNING.replacen(line, new, 1)
    };
    let first_cell = "VECTORS layers double\n-0.98480775301220802 -0.17364817766693033 0";
    let zero = at(first_cell, "VECTORS layers double\n0 0 0");
    let nan = at(first_cell, "VECTORS layers double\n0 nan 0");
    let scalars = at("VECTORS layers", "TENSORS layers").replace("VECTORS twist", "NORMALS tw");
    let node = at("VECTORS twist double\n-1 -0 0", "VECTORS twist double\n0 0 0");
    let data = |name: &str| scene(&format!("{{ data = \"{name}\" }}"), "");
    let cases = [
        (
            TURNING,
            data("fibres"),
            "scene.toml:3: key 'material.fibers.data': 'fibres' can't be read: ... has no array 'fibres'; its arrays of vectors are layers, twist",
        ),
        (
            &zero,
            data("layers"),
            "key 'material.fibers.data': 'layers' is zero at cell 0 of the file, (2.500, 2.500, 2.500) mm",
        ),
        (
            &nan,
            data("layers"),
            "key 'material.fibers.data': 'layers' is not finite at cell 0 of the file, (2.500, 2.500, 2.500) mm",
        ),
        (
            &node,
            data("twist"),
            "key 'material.fibers.data': 'twist' is zero at node 0 of the file, (0, 0, 0)",
        ),
        (&scalars, data("layers"), "block.vtk:"),
    ];
    for (file, scene, says) in cases {
        let done = run(file, &scene);
        assert_ne!(done.code, 0, "{says}");
        for words in says.split(" ... ") {
            assert!(done.stderr.contains(words), "{}\n  has no: {words}", done.stderr);
        }
    }
}
