//! Forces on faces and at points.

mod common;

use common::{assert_fails, objects, tissuebench, write};
use serde_json::Value;

fn scene(load: &str) -> String {
    format!(
        r#"title = "A cantilever"
body = {{ shape = "box", size = ["40 mm", "10 mm", "10 mm"] }}
material = {{ law = "linear", young = "200 kPa", poisson = 0.3 }}
support = [{{ on = "x-min", fix = "xyz" }}]
load = [{load}]
output = {{ moments_about = ["0 mm", "5 mm", "5 mm"], probes = [["40 mm", "5 mm", "5 mm"]] }}

[[method]]
id = "hex8"
family = "fem"
element = "hex8"
size = {{ cells = [8, 2, 2] }}

[[method]]
id = "tet10"
family = "fem"
element = "tet10"
size = {{ cells = [8, 2, 2] }}

[[method]]
id = "efg"
family = "efg"
size = {{ cells = [8, 2, 2] }}
kernel = "cubic-spline"
support_scale = 1.6
basis = "linear"
integration = {{ rule = "cell-smoothed", points = 1 }}
essential = "nitsche"
"#
    )
}

#[track_caller]
fn run(load: &str) -> Vec<Value> {
    let dir = tempfile::tempdir().unwrap();
    let done = tissuebench(&["run", &write(&dir, "scene.toml", &scene(load)), "--once", "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    objects(&done.stdout)
}

fn number(of: &Value, name: &str) -> f64 {
    of["metrics"][name]["value"].as_f64().unwrap_or_else(|| panic!("no {name} in {of}"))
}

#[test]
fn a_force_on_a_face_is_the_traction_that_carries_it() {
    // Half of the end face, which the cells of the methods meet, and a third of it, which cuts them.
    for (place, force, traction) in
        [("on = \"x-max\"", "100 mN", "1 kPa"), ("where = \"x == 40 mm and z <= 3 mm\"", "30 mN", "1 kPa")]
    {
        let total = run(&format!("{{ {place}, force = [\"0 N\", \"0 N\", \"{force}\"] }}"));
        let field = run(&format!("{{ {place}, traction = [\"0 kPa\", \"0 kPa\", \"{traction}\"] }}"));
        for (total, field) in total.iter().zip(&field) {
            let [total, field] = [total, field].map(|of| number(of, "probe-z"));
            assert!((total - field).abs() <= 1e-10 * field, "{total} {field}");
        }
    }
}

#[test]
fn forces_at_points_keep_their_resultant_and_their_moment() {
    for object in run(
        "{ at = [[\"20 mm\", \"5 mm\", \"10 mm\"], [\"33 mm\", \"4 mm\", \"2 mm\"]], force = [\"0 N\", \"10 mN\", \"0 N\"] }",
    ) {
        let moment = [-(0.005 - 0.003) * 0.01, 0.0, (0.02 + 0.033) * 0.01];
        for (axis, (force, moment)) in
            ["x", "y", "z"].into_iter().zip([0.0, 0.02, 0.0].into_iter().zip(moment))
        {
            let found = number(&object, &format!("reaction-{axis}"));
            assert!((found + force).abs() < 1e-9, "{axis}: {found} {force}");
            let found = number(&object, &format!("reaction-moment-{axis}"));
            assert!((found + moment).abs() < 1e-9, "{axis}: {found} {moment}");
        }
    }
}

#[test]
fn forces_without_a_place_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let refused = |load: &str, says: &str| {
        assert_fails(&tissuebench(&["run", &write(&dir, "scene.toml", &scene(load))]), 2, says);
    };
    let force = "force = [\"0 N\", \"0 N\", \"1 N\"]";
    refused(&format!("{{ {force} }}"), "key 'load[0].where': is missing");
    refused(&format!("{{ {force}, at = [] }}"), "key 'load[0].at': names no point");
    let outside =
        format!("{{ {force}, at = [[\"20 mm\", \"5 mm\", \"10 mm\"], [\"0 mm\", \"0 mm\", \"90 mm\"]] }}");
    refused(&outside, "key 'load[0].at[1]': (0.0, 0.0, 90.0) mm is 80.0 mm outside the body");
    let both = format!("{{ {force}, at = [[\"20 mm\", \"5 mm\", \"10 mm\"]], on = \"x-max\" }}");
    refused(&both, "gives a place beside the points of 'at'");
    refused(
        "{ at = [[\"20 mm\", \"5 mm\", \"10 mm\"]], on = \"x-max\", pressure = \"1 kPa\" }",
        "key 'load[0].at'",
    );
    refused(&format!("{{ {force}, on = \"x-max\", dead = true }}"), "key 'load[0].dead'");
    refused("{ on = \"x-max\", force = [\"0 N\", \"0 N\", \"1 kPa\"] }", "key 'load[0].force[2]'");
}
