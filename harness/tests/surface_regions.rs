//! Bodies of several closed surfaces, in one file or several: regions of meshes, and materials of a scene.

mod common;

use common::implicit::stl;
use common::{assert_fails, inside, objects, tissuebench, write};

type Triangles = Vec<[[f64; 3]; 3]>;

/// A box of twelve triangles, mm.
fn cuboid(min: [f64; 3], max: [f64; 3]) -> Triangles {
    let corner = |i: usize| [0, 1, 2].map(|axis| if i >> axis & 1 == 1 { max[axis] } else { min[axis] });
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    // The last two faces have the same diagonal, so that boxes in a row have the same triangles at their
    // wall.
    sides.iter().flat_map(|&[a, b, c, d]| [[b, c, d], [b, d, a]].map(|t| t.map(corner))).collect()
}

#[test]
fn two_solids_of_a_file_are_two_regions() {
    let dir = tempfile::tempdir().unwrap();
    let text = stl("organ", &cuboid([0.0; 3], [10.0; 3])) + &stl("tumour", &cuboid([3.0; 3], [7.0; 3]));
    let (from, to) = (write(&dir, "both.stl", &text), inside(&dir, "both.inp"));
    let info = tissuebench(&["mesh", "info", &from]);
    assert!(
        info.stdout.contains("regions     organ: 0.936") && info.stdout.contains("tumour: 0.064"),
        "{}",
        info.stdout
    );
    let done = tissuebench(&["mesh", "make", &from, "--size", "1 mm", "--out", &to]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert!(done.stdout.contains("  regions     organ: 0.9"), "{}", done.stdout);
    let info = tissuebench(&["mesh", "info", &to, "--format", "json"]);
    assert_eq!(info.code, 0, "{}", info.stderr);
    let regions = &objects(&info.stdout)[0]["regions"];
    let volume = |k: usize| regions[k]["volume_m3"].as_f64().unwrap();
    assert_eq!([&regions[0]["name"], &regions[1]["name"]], ["organ", "tumour"], "{regions}");
    assert!((volume(0) / 936e-9 - 1.0).abs() < 0.01 && (volume(1) / 64e-9 - 1.0).abs() < 0.1, "{regions}");
}

/// Two blocks in series, 10 mm long, under 100 Pa: 100 Pa * (10 mm / 10 kPa + 10 mm / 20 kPa) = 0.15 mm.
#[test]
fn surfaces_of_a_list_have_their_own_materials() {
    let dir = tempfile::tempdir().unwrap();
    write(&dir, "left.stl", &stl("part", &cuboid([0.0; 3], [10.0; 3])));
    write(&dir, "right.stl", &stl("part", &cuboid([10.0, 0.0, 0.0], [20.0, 10.0, 10.0])));
    let text = r#"title = "Two blocks in series"
body = { shape = "file", path = ["left.stl", "right.stl"], unit = "mm" }
material = { law = "linear", young = "10 kPa", poisson = 0.0 }
region = [{ name = "stiff", on = "right", material = { law = "linear", young = "20 kPa", poisson = 0.0 } }]
support = [{ where = "x <= 0.01 mm", fix = "xyz" }]
load = [{ where = "x >= 19.99 mm", pressure = "-100 Pa" }]
output = { probes = [["19.9 mm", "5 mm", "5 mm"], ["10 mm", "5 mm", "5 mm"]] }
method = [
    { id = "tet4", family = "fem", element = "tet4", size = { nodes = 1500 } },
    { id = "tet10", family = "fem", element = "tet10", size = { nodes = 3000 } },
]
"#;
    let done = tissuebench(&["run", &write(&dir, "scene.toml", text), "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    for run in objects(&done.stdout) {
        let moved = |k: usize| run["probes"][k]["u"][0].as_f64().unwrap();
        let [whole, half] = [moved(0) / 0.1495e-3 - 1.0, moved(1) / 0.1e-3 - 1.0];
        assert!(whole.abs() < 2e-3 && half.abs() < 2e-3, "{whole} {half} {run}");
    }
    let unknown = text.replace("on = \"right\"", "on = \"wrong\"");
    let done = tissuebench(&["run", &write(&dir, "unknown.toml", &unknown)]);
    assert_fails(&done, 2, "the mesh has left, right");
}

#[test]
fn files_that_do_not_fit_together_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let organ = write(&dir, "organ.stl", &stl("a", &cuboid([0.0; 3], [10.0; 3])));
    let tumour = write(&dir, "tumour.stl", &stl("b", &cuboid([8.0, 2.0, 2.0], [12.0, 6.0, 6.0])));
    let to = inside(&dir, "made.msh");
    let done = tissuebench(&["mesh", "make", &organ, &tumour, "--size", "1 mm", "--out", &to]);
    assert_fails(&done, 2, "organ.stl, ");
    assert_fails(&done, 2, "they belong to two bodies");
    let text = r#"title = "A surface and a mesh"
body = { shape = "file", path = ["organ.stl", "made.msh"], unit = "mm" }
material = { law = "linear", young = "10 kPa", poisson = 0.0 }
support = [{ where = "x <= 0.01 mm", fix = "xyz" }]
method = [{ id = "tet4", family = "fem", element = "tet4", size = { nodes = 1500 } }]
"#;
    assert_eq!(tissuebench(&["mesh", "make", &organ, "--size", "2 mm", "--out", &to]).code, 0);
    let done = tissuebench(&["run", &write(&dir, "scene.toml", text)]);
    assert_fails(&done, 2, "made.msh is not a surface");
    let done = tissuebench(&[
        "run",
        &write(&dir, "none.toml", &text.replace("[\"organ.stl\", \"made.msh\"]", "[]")),
    ]);
    assert_fails(&done, 2, "body.path");
}
