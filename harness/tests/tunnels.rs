//! Tools that could pass through the body unnoticed: load steps longer than the thickness of a tool, faces
//! larger than a tool, and tools that start or end within the body.

mod common;

use common::{Done, assert_fails, objects, tissuebench, write};
use serde_json::Value;

/// A clamped block of 40 x 40 x 20 mm in cells of 10 mm under a tool that moves down.
fn scene(tool: &str, closure: &str, procedure: &str) -> String {
    format!(
        r#"title = "A block under a tool"
body = {{ shape = "box", size = ["40 mm", "40 mm", "20 mm"] }}
material = {{ law = "neo-hookean", young = "20 kPa", poisson = 0.3, density = "1000 kg/m^3" }}
support = [{{ on = "z-min", fix = "xyz" }}]
procedure = {{ {procedure} }}
tool = [{{ name = "jaw", {tool}, drive = {{ closure = "{closure}" }}, penalty = "5 MPa/mm" }}]
output = {{ probes = [["20 mm", "20 mm", "20 mm"]] }}
method = [{{ id = "hex8", family = "fem", element = "hex8", size = {{ cells = [4, 4, 2] }} }}]
"#
    )
}

fn run(scene: &str) -> Done {
    let dir = tempfile::tempdir().unwrap();
    tissuebench(&["run", &write(&dir, "tool.toml", scene), "--format", "json"])
}

/// Tool force at the end of a run that reached the whole load, and the number of reported steps.
fn force(scene: &str) -> (f64, usize) {
    let done = run(scene);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let object: Value = objects(&done.stdout).remove(0);
    assert_eq!(object["status"], "ok");
    let force = object["metrics"]["tool-force"]["value"].as_f64().unwrap();
    (force, object["steps"].as_array().unwrap().len())
}

const DOWN: &str = "along = [0, 0, -1]";
const STATIC: &str = r#"kind = "static""#;

fn box_of(half_height: &str, radius: &str, z: &str) -> String {
    format!(
        r#"shape = "rounded-box", half = ["10 mm", "10 mm", "{half_height}"], radius = "{radius}", at = ["20 mm", "20 mm", "{z}"], {DOWN}"#
    )
}

fn ball(radius: &str, at: &str) -> String {
    format!(r#"shape = "sphere", radius = "{radius}", at = [{at}], {DOWN}"#)
}

#[test]
fn one_step_gives_the_force_of_many() {
    let jaw = box_of("4 mm", "1 mm", "24.5 mm");
    let sheet = box_of("0.1 mm", "0.1 mm", "25 mm");
    // A ball of 3 mm radius over a vertex, whose nearest contact points are 3 mm away.
    let small = ball("3 mm", r#""20 mm", "20 mm", "23 mm""#);
    for (tool, closure) in [(&jaw, "10 mm"), (&sheet, "8 mm"), (&small, "3 mm")] {
        let [one, five] = [1, 5].map(|steps| {
            let (force, reported) = force(&scene(tool, closure, &format!("{STATIC}, steps = {steps}")));
            assert_eq!(reported, steps, "{tool}");
            force
        });
        assert!(five > 0.1 && (one / five - 1.0).abs() < 1e-6, "{tool}: {one} {five}");
        for inertia in ["false", "true"] {
            let time =
                format!(r#"kind = "implicit-dynamic", duration = "20 s", steps = 1, inertia = {inertia}"#);
            let (slow, reported) = force(&scene(tool, closure, &time));
            assert_eq!(reported, 1, "{tool}");
            assert!((slow / five - 1.0).abs() < 1e-2, "{tool}: {slow} {five}");
        }
    }
}

#[test]
fn tools_that_meet_nothing_end_without_a_force() {
    for (at, closure) in [
        (r#""20 mm", "20 mm", "-5 mm""#, "20 mm"),
        (r#""20 mm", "43.5 mm", "30 mm""#, "60 mm"),
        (r#""20 mm", "20 mm", "25 mm""#, "1.99 mm"),
    ] {
        for steps in [1, 3] {
            let scene = scene(&ball("3 mm", at), closure, &format!("{STATIC}, steps = {steps}"));
            assert_eq!(force(&scene), (0.0, steps), "{at}");
        }
    }
}

#[test]
fn a_tool_between_the_points_is_refused_with_its_depth() {
    // A ball of 10 mm radius penetrates the top by 0.2 mm at the centre of a face, 4 mm from its points.
    let shallow = scene(&ball("10 mm", r#""15 mm", "25 mm", "30 mm""#), "0.2 mm", STATIC);
    let done = run(&shallow);
    assert_fails(&done, 3, "key 'tool[0]'");
    assert_fails(&done, 3, "overlaps the body by 2.000e-4 m near (15.00, 25.00, 20.00) mm");
    assert_fails(&done, 3, "a finer surface is needed");
    let time = r#"kind = "implicit-dynamic", duration = "10 ms", steps = 2"#;
    assert_fails(
        &run(&shallow.replace(STATIC, time)),
        3,
        "overlaps the body by 2.000e-4 m near (15.00, 25.00, 20.00) mm",
    );
    // Over a vertex, the same ball is carried by the vertex: .029 N on these cells, .0103 N on cells of an
    // eighth of the size.
    let over_vertex = scene(&ball("10 mm", r#""20 mm", "20 mm", "30 mm""#), "0.2 mm", STATIC);
    let done = run(&over_vertex);
    assert!(done.code == 0 && done.stdout.contains("few-cells"), "{}", done.stdout);
    // A plate meets a corner of the block along its diagonal: corners count.
    let corner = r#"shape = "plate", at = ["40 mm", "40 mm", "20 mm"], along = [-0.57735027, -0.57735027, -0.57735027]"#;
    let [two, six] = ["2 mm", "6 mm"].map(|closure| force(&scene(corner, closure, STATIC)).0);
    assert!(0.0 < two && two < six, "{two} {six}");
}

#[test]
fn tools_that_cannot_touch_are_refused_before_the_first_step() {
    let within = scene(&ball("2 mm", r#""20 mm", "20 mm", "9 mm""#), "2 mm", STATIC);
    assert_fails(&run(&within), 2, "key 'tool[0].at': (20.00, 20.00, 9.00) mm lies within the body");
    let needle = scene(&ball("20 um", r#""20 mm", "20 mm", "21 mm""#), "2 mm", STATIC);
    let done = run(&needle);
    assert_fails(&done, 3, "key 'method[0].size'");
    assert_fails(&done, 3, "tool[0] is 39.7 um wide and would slip through");
}

#[test]
fn explicit_tools_are_no_faster_than_their_thickness() {
    // At 20 mm in 50 us the tool is beyond the block within two steps.
    let fast = scene(&box_of("0.1 mm", "0.1 mm", "20.5 mm"), "20 mm", STATIC)
        .replace(r#"closure = "20 mm""#, r#"closure = "20 mm", over = "50 us""#)
        .replace(STATIC, r#"kind = "explicit", duration = "1 ms", steps = 2"#);
    let done = run(&fast);
    assert_fails(&done, 3, "would pass through the tool");
    assert_fails(&done, 3, "key 'tool[0]'");
}
