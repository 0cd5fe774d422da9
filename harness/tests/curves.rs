//! Loads, motions, drives and active stress along curves over time.

mod common;

use common::{assert_fails, number, solved, tissuebench, write};
use serde_json::Value;

#[track_caller]
fn run(text: &str) -> Value {
    solved(&tempfile::tempdir().unwrap(), text)
}

const HEX8: &str = r#"
[[method]]
id = "hex8"
family = "fem"
element = "hex8"
size = { cells = [2, 2, 2] }
"#;

/// A cube of 20 mm on rollers, with E = 20 kPa and nu = 0.3.
fn cube(rest: &str) -> String {
    format!(
        r#"title = "A cube on rollers"
body = {{ shape = "box", size = ["20 mm", "20 mm", "20 mm"] }}
material = {{ law = "linear", young = "20 kPa", poisson = 0.3, density = "1000 kg/m^3" }}
{rest}
[[support]]
on = "x-min"
fix = "x"
[[support]]
on = "y-min"
fix = "y"
[[support]]
on = "z-min"
fix = "z"
{HEX8}"#
    )
}

#[test]
fn each_step_has_the_state_of_its_factors() {
    let object = run(&cube(
        r#"
procedure = { kind = "static", steps = 10 }
curve = [
    { name = "pull", part = [0, 0.2, 0.4, 0.5], factor = [0, 1, 1, 0] },
    { name = "press", part = [0.5, 0.6, 1], factor = [0, 1, 0] },
]
[[load]]
on = "z-max"
traction = ["0 kPa", "0 kPa", "2 kPa"]
curve = "pull"
[[tool]]
name = "plate"
shape = "plate"
at = ["10 mm", "20 mm", "10 mm"]
along = [0, -1, 0]
drive = { closure = "1 mm", curve = "press" }
penalty = "5 MPa/mm"
"#,
    ));
    let steps = object["steps"].as_array().unwrap();
    assert_eq!(steps.len(), 10);
    for step in steps {
        let part = step["load"].as_f64().unwrap();
        let pull = 0.8 * (part / 0.2).min(1.0).min((0.5 - part) / 0.1).max(0.0);
        // The penalty of 5 GPa/m is in series with the 1 MPa/m of the cube.
        let press = 0.4 / 1.0002 * ((part - 0.5) / 0.1).min((1.0 - part) / 0.4).max(0.0);
        let held = step["supports"][2][2].as_f64().unwrap();
        let pressed = step["tools"][0]["force"][1].as_f64().unwrap();
        assert!((held + pull).abs() < 1e-9, "{part}: {held} {pull}");
        assert!((pressed - press).abs() < 1e-9, "{part}: {pressed} {press}");
    }
    assert_eq!(number(&object, "load-z"), 0.0);
}

#[test]
fn points_between_steps_are_not_passed_over() {
    let scene = |part: &str| {
        run(&cube(&format!(
            r#"
procedure = {{ kind = "static", steps = 1 }}
curve = [{{ name = "pull", part = {part}, factor = [0, 1, 0.5] }}]
[[load]]
on = "z-max"
traction = ["0 kPa", "0 kPa", "2 kPa"]
curve = "pull"
"#
        )))
    };
    let object = scene("[0, 0.37, 1]");
    // One step is reported, and another one has ended at the point.
    assert_eq!(object["steps"].as_array().unwrap().len(), 1);
    assert!(number(&object, "newton-iterations") >= 2.0);
    assert!((number(&object, "load-z") - 0.4).abs() < 1e-12);
}

#[test]
fn a_moved_base_takes_the_force_of_its_acceleration() {
    let object = run(&r#"title = "A stiff block on a base that moves out and back"
body = { shape = "box", size = ["20 mm", "20 mm", "20 mm"] }
material = { law = "linear", young = "20 MPa", poisson = 0.3, density = "1000 kg/m^3" }
procedure = { kind = "implicit-dynamic", duration = "0.2 s", steps = 80, spectral_radius = 0.0 }
curve = [{ name = "out and back", time = ["0 s", "0.1 s", "0.2 s"], factor = [0, 1, 0], smooth = true }]
[[support]]
on = "x-min"
move = ["5 mm", "0 mm", "0 mm"]
curve = "out and back"
"#
    .replace("[[support]]", &format!("{HEX8}[[support]]")));
    let steps = object["steps"].as_array().unwrap();
    let force = |step: usize| steps[step]["supports"][0][0].as_f64().unwrap();
    // m a = 8 g x 60 s (1 - s) (1 - 2 s) 5 mm / (0.1 s)^2 at s = 1/4 is 22.5 mN, and the opposite on the way back.
    let first = steps.iter().position(|step| step["load"].as_f64().unwrap() > 0.124).unwrap();
    assert!((force(first) - 0.0225).abs() < 5e-4, "{}", force(first));
    let back = steps.iter().position(|step| step["load"].as_f64().unwrap() > 0.624).unwrap();
    assert!((force(back) + 0.0225).abs() < 5e-4, "{}", force(back));
}

/// A block under a ball that presses by `drive`.
fn pressed(drive: &str, procedure: &str) -> String {
    format!(
        r#"title = "A block under a ball"
body = {{ shape = "box", size = ["30 mm", "20 mm", "10 mm"] }}
material = {{ law = "neo-hookean", young = "20 kPa", poisson = 0.45, density = "1000 kg/m^3" }}
support = [{{ on = "z-min", fix = "xyz" }}]
{procedure}
[[tool]]
name = "ball"
shape = "sphere"
radius = "8 mm"
at = {{ touch = "z-max", gap = "0.5 mm" }}
along = [0, 0, -1]
penalty = "20 kPa/mm"
drive = {drive}

[[method]]
id = "hex8-mean"
family = "fem"
element = "hex8"
dilation = "element-mean"
size = {{ cells = [9, 6, 3] }}
"#
    )
}

#[test]
fn a_ball_that_presses_and_leaves_is_the_same_in_statics_and_dynamics() {
    let times = r#"time = ["0 s", "0.4 s", "0.5 s", "0.9 s"]"#;
    let dynamic = format!(
        r#"procedure = {{ kind = "explicit", duration = "1 s", steps = 20, damping = "40 /s" }}
curve = [{{ name = "press", {times}, factor = [0, 1, 1, 0], smooth = true }}]"#
    );
    let still = r#"procedure = { kind = "static", steps = 20 }
curve = [{ name = "press", part = [0, 0.4, 0.5, 0.9], factor = [0, 1, 1, 0] }]"#;
    let force = |object: &Value, step: usize| object["steps"][step]["tools"][0]["force"][2].as_f64().unwrap();
    let drive = "{ closure = \"2.5 mm\", curve = \"press\" }";
    let [at_rest, moved] = [still, &dynamic].map(|procedure| run(&pressed(drive, procedure)));
    let [held, dynamic] = [&at_rest, &moved].map(|object| force(object, 9));
    assert!(held > 0.01 && (dynamic / held - 1.0).abs() < 1e-3, "{held} {dynamic}");
    assert!(number(&at_rest, "reaction-z").abs() < 1e-8);
    assert!(number(&moved, "reaction-z").abs() < 0.02 * held);

    let forced = run(&pressed("{ force = \"60 mN\", curve = \"press\" }", still));
    assert!((force(&forced, 9) / 0.06 - 1.0).abs() < 1e-7, "{}", force(&forced, 9));
    assert!(number(&forced, "reaction-z").abs() < 1e-8);
}

#[test]
fn a_twitch_ends_like_a_weaker_contraction() {
    let muscle = |active: &str, curve: &str| {
        run(&format!(
            r#"title = "A contracting cube"
body = {{ shape = "box", size = ["20 mm", "20 mm", "20 mm"] }}
procedure = {{ kind = "static", steps = 4 }}
{curve}
[material]
law = "guccione"
c = "2 kPa"
bf = 8.0
bt = 2.0
bfs = 4.0
bulk = "200 kPa"
fibers = [1, 0, 0]
{active}
[[support]]
on = "x-min"
fix = "xyz"
[output]
probes = [["20 mm", "10 mm", "10 mm"]]
{HEX8}"#
        ))
    };
    let twitch = "curve = [{ name = \"twitch\", part = [0, 0.5, 1], factor = [0, 1, 0.4] }]";
    let twitched = muscle("active = \"5 kPa\"\nactive_curve = \"twitch\"", twitch);
    let plain = muscle("active = \"2 kPa\"", "");
    let [twitched, plain] = [&twitched, &plain].map(|of| number(of, "probe-x"));
    assert!(plain < -1e-4 && (twitched / plain - 1.0).abs() < 1e-8, "{twitched} {plain}");
}

#[test]
fn the_plan_names_what_follows_curves_and_exports_refuse_it() {
    let dir = tempfile::tempdir().unwrap();
    let text = cube(
        r#"
procedure = { kind = "static", steps = 2 }
curve = [{ name = "half", part = [0, 0.5], factor = [0, 1] }]
[[load]]
on = "z-max"
traction = ["0 kPa", "0 kPa", "2 kPa"]
curve = "half"
"#,
    );
    let path = write(&dir, "scene.toml", &text);
    let plan = tissuebench(&["plan", &path]);
    let said = plan.stdout;
    assert!(said.contains("along curves: load[0]"), "{said}");
    let out = dir.path().join("out");
    let export = tissuebench(&["export", &path, "--method", "hex8", "--out", out.to_str().unwrap()]);
    assert_fails(&export, 2, "key 'load[0].curve': 'half' is a curve over time");
}

#[test]
fn supports_on_two_curves_must_not_share_a_moved_node() {
    let dir = tempfile::tempdir().unwrap();
    let text = r#"title = "Two faces with an edge in common"
body = { shape = "box", size = ["20 mm", "20 mm", "20 mm"] }
material = { law = "linear", young = "20 kPa", poisson = 0.3 }
procedure = { kind = "static", steps = 2 }
curve = [{ name = "half", part = [0, 0.5], factor = [0, 1] }]
support = [
    { on = "x-min", move = ["1 mm", "0 mm", "0 mm"] },
    { on = "y-min", move = ["1 mm", "0 mm", "0 mm"], curve = "half" },
]
"#;
    let path = write(&dir, "scene.toml", &format!("{text}{HEX8}"));
    assert_fails(&tissuebench(&["run", &path]), 2, "along another curve than support[0]");
}
