//! Tools from the closed surface of a file.

mod common;

use common::{assert_fails, number, solved, tissuebench, write};
use serde_json::Value;

/// ASCII STL of a box of 12 x 12 x 6 mm whose bottom is the plane z = 0, without its last `left_out`
/// triangles.
fn stl(left_out: usize) -> String {
    let corner = |k: usize| {
        let side = |a: usize, low: f64, high: f64| if (k >> a) & 1 == 1 { high } else { low };
        format!("vertex {} {} {}\n", side(0, -6.0, 6.0), side(1, -6.0, 6.0), side(2, 0.0, 6.0))
    };
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<[usize; 3]> = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let facets = triangles[..triangles.len() - left_out].iter().map(|triangle| {
        let corners: String = triangle.iter().map(|&k| corner(k)).collect();
        format!("facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
    });
    format!("solid box\n{}endsolid box\n", facets.collect::<String>())
}

fn scene(tool: &str) -> String {
    format!(
        r#"title = "A block under a box"
body = {{ shape = "box", size = ["20 mm", "20 mm", "10 mm"] }}
material = {{ law = "neo-hookean", young = "20 kPa", poisson = 0.45 }}
support = [{{ on = "z-min", fix = "xyz" }}]
procedure = {{ kind = "static", steps = 4 }}
tool = [{{ name = "jaw", {tool}, along = [0, 0, -1], drive = {{ closure = "2 mm" }}, penalty = "1 MPa/mm", friction = 0.2, stick = "0.2 MPa/mm" }}]

[[method]]
id = "hex8-mean"
family = "fem"
element = "hex8"
dilation = "element-mean"
size = {{ cells = [6, 6, 3] }}
"#
    )
}

const SURFACE: &str = "shape = \"file\", path = \"box.stl\", unit = \"mm\", rounding = \"1 mm\"";

#[track_caller]
fn run(tool: &str) -> Value {
    let dir = tempfile::tempdir().unwrap();
    write(&dir, "box.stl", &stl(0));
    solved(&dir, &scene(tool))
}

#[test]
fn the_surface_of_a_box_presses_as_the_box() {
    let named = run(
        "shape = \"rounded-box\", half = [\"7 mm\", \"7 mm\", \"4 mm\"], radius = \"1 mm\", at = [\"10 mm\", \"10 mm\", \"14 mm\"]",
    );
    // The bottom of the file is its origin, and the rounding is added.
    let of_file = run(&format!("{SURFACE}, at = [\"10 mm\", \"10 mm\", \"11 mm\"]"));
    // Upside down, the former top is the bottom.
    let turned = run(&format!("{SURFACE}, axis = [0, 0, -1], at = [\"10 mm\", \"10 mm\", \"17 mm\"]"));
    for name in ["tool-force", "reaction-z", "strain-energy"] {
        let [named, of_file, turned] = [&named, &of_file, &turned].map(|of| number(of, name));
        assert!((of_file / named - 1.0).abs() < 1e-7, "{name}: {of_file} {named}");
        assert!((turned / named - 1.0).abs() < 1e-7, "{name}: {turned} {named}");
    }
}

#[test]
fn surfaces_that_are_no_tool_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let at = "at = [\"10 mm\", \"10 mm\", \"11 mm\"]";
    let refused = |tool: &str, says: &[&str]| {
        let text = scene(&format!("{tool}, {at}"));
        let done = tissuebench(&["run", &write(&dir, "scene.toml", &text)]);
        says.iter().for_each(|says| assert_fails(&done, 2, says));
    };
    refused(SURFACE, &["key 'tool[0].path'", "can't be found"]);
    write(&dir, "box.stl", &stl(1));
    refused(SURFACE, &["key 'tool[0].path'", "open"]);
    write(&dir, "box.stl", &stl(0));
    refused(&SURFACE.replace("1 mm", "0 mm"), &["key 'tool[0].rounding'"]);
    refused(&SURFACE.replace("path = \"box.stl\", ", ""), &["key 'tool[0].path': is missing"]);
    refused(
        &format!("{SURFACE}, radius = \"1 mm\""),
        &["key 'tool[0].radius': does not belong to shape = \"file\""],
    );
    let pressed = scene(&format!("{SURFACE}, {at}")).replace("closure = \"2 mm\"", "pressure = \"1 kPa\"");
    let done = tissuebench(&["run", &write(&dir, "scene.toml", &pressed)]);
    assert_fails(&done, 2, "key 'tool[0].drive.pressure': '1 kPa' has no face to act on");
}
