//! Springs and dampers on parts of the surface.

mod common;

use common::{assert_fails, objects, tissuebench, write};
use serde_json::Value;

/// A bar of 60 x 20 x 20 mm on rollers along y and z.
fn bar(foundation: &str, more: &str) -> String {
    format!(
        r#"title = "A bar"
body = {{ shape = "box", size = ["60 mm", "20 mm", "20 mm"] }}
material = {{ law = "linear", young = "20 kPa", poisson = 0.3, density = "1000 kg/m^3" }}
support = [{{ on = "y-min", fix = "y" }}, {{ on = "z-min", fix = "z" }}]
foundation = [{foundation}]
load = [{{ on = "x-max", traction = ["1 kPa", "0 kPa", "0 kPa"] }}]
output = {{ probes = [["60 mm", "10 mm", "10 mm"], ["0 mm", "10 mm", "10 mm"]] }}
{more}

[[method]]
id = "hex8"
family = "fem"
element = "hex8"
size = {{ cells = [6, 2, 2] }}

[[method]]
id = "efg"
family = "efg"
size = {{ cells = [6, 2, 2] }}
kernel = "cubic-spline"
support_scale = 1.6
basis = "linear"
integration = {{ rule = "cell-smoothed", points = 1 }}
essential = "coupling"
"#
    )
}

#[track_caller]
fn run(scene: &str, more: &[&str]) -> Vec<Value> {
    let dir = tempfile::tempdir().unwrap();
    let scene = write(&dir, "scene.toml", scene);
    let done = tissuebench(&[&["run", &scene, "--once", "--format", "json"], more].concat());
    assert_eq!(done.code, 0, "{}", done.stderr);
    objects(&done.stdout)
}

fn number(of: &Value, name: &str) -> f64 {
    of["metrics"][name]["value"].as_f64().unwrap_or_else(|| panic!("no {name} in {of}"))
}

#[track_caller]
fn is_near(found: f64, value: f64, by: f64) {
    assert!((found - value).abs() <= by * value.abs(), "{found} for {value}");
}

#[test]
fn springs_on_parts_of_a_face_add_up() {
    // A third of the face, which cuts its cells, and the rest.
    let whole = run(&bar(r#"{ on = "x-min", stiffness = "1 kPa/mm", along = "normal" }"#, ""), &[]);
    let parts = r#"{ where = "x == 0 mm and z <= 7 mm", stiffness = "1 kPa/mm", along = "normal" },
                   { where = "x == 0 mm and z >= 7 mm", stiffness = "1 kPa/mm", along = "normal" }"#;
    // Functions of elements are integrated exactly on parts of their faces too, those of clouds are not.
    for ((whole, parts), by) in whole.iter().zip(run(&bar(parts, ""), &[])).zip([1e-6, 1e-2]) {
        is_near(number(whole, "foundation-force-x"), -0.4, 1e-9);
        is_near(number(&parts, "foundation-force-x"), -0.14, by);
        is_near(number(&parts, "foundation-force-x-2"), -0.26, by);
        is_near(number(&parts, "probe-x"), number(whole, "probe-x"), by);
    }
}

#[test]
fn dampers_alone_creep_at_the_rate_of_their_force() {
    // Without inertia 1 kPa on dampers of 20 kPa s/m moves the end by 50 mm/s, after the bar has stretched at once.
    let more = r#"procedure = { kind = "implicit-dynamic", inertia = false, over = "0 s", duration = "40 ms", steps = 4 }"#;
    let dampers = r#"{ on = "x-min", damping = "20 kPa s/m", along = "normal" }"#;
    for object in run(&bar(dampers, more), &["--method", "hex8"]) {
        is_near(number(&object, "probe-x-2"), 2e-3, 1e-6);
        is_near(number(&object, "probe-x"), 5e-3, 1e-6);
        is_near(number(&object, "foundation-force-x"), -0.4, 1e-6);
    }
}

#[test]
fn a_support_that_moves_drags_dampers() {
    // The whole body moves at 50 mm/s, and so do the dampers on its other face.
    let scene = bar(r#"{ on = "x-max", damping = "20 kPa s/m" }"#, r#"procedure = { kind = "implicit-dynamic", inertia = false, over = "40 ms", duration = "40 ms", steps = 4 }"#)
        .replace("load = [{ on = \"x-max\", traction = [\"1 kPa\", \"0 kPa\", \"0 kPa\"] }]", "")
        .replace("support = [", "support = [{ where = \"x >= 0 mm\", move = { x = \"2 mm\" } }, ");
    for object in run(&scene, &["--method", "hex8"]) {
        is_near(number(&object, "foundation-force-x"), -0.4, 1e-9);
        is_near(number(&object, "reaction-x"), 0.4, 1e-9);
    }
}

#[test]
fn frequencies_of_a_rigid_block_are_those_of_its_springs() {
    let scene = r#"title = "A block on springs"
body = { shape = "box", size = ["20 mm", "20 mm", "20 mm"] }
material = { law = "linear", young = "20 MPa", poisson = 0, density = "1000 kg/m^3" }
support = [{ on = "x-min", fix = "x" }, { on = "y-min", fix = "y" }]
foundation = [{ on = "z-min", stiffness = "0.2 kPa/mm", along = "normal" }]
procedure = { kind = "modes", modes = 2 }
method = [{ id = "hex8", family = "fem", element = "hex8", size = { cells = [2, 2, 2] }, mass = "consistent" }]
"#;
    let found = run(scene, &[]);
    let frequency =
        found[0]["modes"][0]["frequency"]["value"].as_f64().unwrap_or_else(|| panic!("{}", found[0]));
    // x tan x = k L / E gives 15.914964 Hz, a little below sqrt(K / m) / 2 pi of a rigid block.
    is_near(frequency, 15.914964, 5e-6);
}

#[test]
fn stiff_springs_and_dampers_shorten_the_critical_step() {
    let step = |foundation: &str| {
        let more = r#"procedure = { kind = "explicit", over = "0 s", duration = "4 ms", steps = 2 }"#;
        number(&run(&bar(foundation, more), &["--method", "hex8"])[0], "critical-step")
    };
    let soft = step(r#"{ on = "x-min", stiffness = "1 Pa/m", along = "normal" }"#);
    assert!(step(r#"{ on = "x-min", stiffness = "100 kPa/mm", along = "normal" }"#) < 0.5 * soft);
    assert!(step(r#"{ on = "x-min", damping = "100 kPa s/m", along = "normal" }"#) < 0.5 * soft);
}

#[test]
fn foundations_that_cannot_act_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let refused = |foundation: &str, says: &str| {
        let scene = write(&dir, "scene.toml", &bar(foundation, ""));
        assert_fails(&tissuebench(&["run", &scene, "--once"]), 2, says);
    };
    refused(
        r#"{ on = "x-min", stiffness = "1 kPa/mm", damping = "1 Pa s/m" }"#,
        "key 'foundation[0].damping': '1 Pa s/m' has no effect: kind = \"linear\" has no velocities",
    );
    refused(
        r#"{ where = "x == -1 mm", stiffness = "1 kPa/mm" }"#,
        "key 'foundation[0].where': 'x == -1 mm' touches no part of the body",
    );
    let text = bar(r#"{ on = "x-min", stiffness = "1 kPa/mm", along = "normal" }"#, "");
    let checked = format!("{text}\n[[check]]\nmetric = \"foundation-force-x-2\"\nat_most = \"0 N\"\n");
    assert_fails(
        &tissuebench(&["run", &write(&dir, "scene.toml", &checked), "--once"]),
        2,
        "needs foundation number 2, but the scene has 1",
    );
    let held = bar(r#"{ on = "x-min", stiffness = "1 kPa/mm", along = "normal" }"#, "")
        .replace("on = \"y-min\", fix = \"y\"", "on = \"z-max\", fix = \"z\"");
    assert_fails(
        &tissuebench(&["run", &write(&dir, "scene.toml", &held), "--once"]),
        3,
        "translation along y",
    );
}
