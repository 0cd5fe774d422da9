//! Tools that turn: twists after a press, and hinges.

mod common;

use common::{assert_fails, number, solved, tissuebench, write};
use serde_json::Value;

fn scene(support: &str, tool: &str, drive: &str, procedure: &str) -> String {
    format!(
        r#"title = "A block under a tool that turns"
body = {{ shape = "box", size = ["20 mm", "20 mm", "10 mm"] }}
material = {{ law = "linear", young = "20 kPa", poisson = 0, density = "1000 kg/m^3" }}
support = [{support}]
{procedure}
tool = [{tool}]

[output]
moments_about = ["10 mm", "10 mm", "0 mm"]

[[method]]
id = "hex8"
family = "fem"
element = "hex8"
size = {{ cells = [6, 6, 3] }}
"#
    )
    .replace("DRIVE", drive)
}

const BOTTOM: &str = "{ on = \"z-min\", fix = \"xyz\" }";
const STATIC: &str = "procedure = { kind = \"static\", steps = 4 }";

fn plate(friction: f64) -> String {
    format!(
        "{{ name = \"plate\", shape = \"plate\", at = [\"10 mm\", \"10 mm\", \"10 mm\"], axis = [0, 0, -1], \
         penalty = \"200 kPa/mm\", friction = {friction}, stick = \"200 kPa/mm\", drive = {{ DRIVE }} }}"
    )
}

fn twist(angle: &str) -> String {
    format!(
        "path = [[\"0 mm\", \"0 mm\", \"-0.5 mm\"], {{ turn = \"{angle}\", about = {{ axis = [0, 0, 1], arm = \"10 mm\" }} }}]"
    )
}

#[track_caller]
fn run(text: &str) -> Value {
    solved(&tempfile::tempdir().unwrap(), text)
}

/// Moment of a square of side 20 mm that slips with the coefficient 0.1 under E d / (h + E / k_n), N m.
fn of_slip() -> f64 {
    let pressure = 20e3 * 0.5e-3 / (10e-3 + 20e3 / 2e8);
    (2f64.sqrt() + 1f64.asinh()) / 6.0 * 0.1 * pressure * 0.02f64.powi(3)
}

#[test]
fn a_plate_that_slips_has_coulombs_moment_in_every_procedure() {
    let expected = of_slip();
    let slow = "kind = \"PROCEDURE\", duration = \"1 s\", steps = 4, damping = \"40 /s\"";
    for (procedure, tolerance) in [
        (STATIC.to_string(), 0.01),
        (format!("procedure = {{ {} }}", slow.replace("PROCEDURE", "explicit")), 0.02),
        (format!("procedure = {{ {} }}", slow.replace("PROCEDURE", "implicit-dynamic")), 0.02),
    ] {
        let object = run(&scene(BOTTOM, &plate(0.1), &twist("20 deg"), &procedure));
        let moment = number(&object, "tool-moment-z");
        assert!((-moment / expected - 1.0).abs() < tolerance, "{procedure}: {moment} {expected}");
        let force = number(&object, "tool-force");
        assert!((force * 10e-3 + moment).abs() < 1e-9 * moment.abs().max(1e-9), "{procedure}: {force}");
        let reaction = number(&object, "reaction-moment-z");
        assert!((-reaction / expected - 1.0).abs() < tolerance, "{procedure}: {reaction}");
    }
}

#[test]
fn a_plate_that_sticks_twists_as_a_face_that_is_turned() {
    let stuck = run(&scene(BOTTOM, &plate(2.0), &twist("0.02 rad"), STATIC));
    let turned = "{ on = \"z-max\", move = { x = { of = \"-0.02 * (y - 0.01)\", unit = \"m\" }, \
                  y = { of = \"0.02 * (x - 0.01)\", unit = \"m\" }, z = \"-0.5 mm\" } }";
    let text = scene(&format!("{BOTTOM}, {turned}"), "", "", STATIC);
    let turned = run(&text);
    let [stuck, turned] =
        [(stuck, "reaction-moment-z"), (turned, "reaction-moment-z")].map(|(of, name)| number(&of, name));
    // The elastic slip takes G / (k_t h) = 0.5 % of the angle; a square is stiffer than its rim.
    assert!((stuck / turned - 0.995).abs() < 0.003, "{stuck} {turned}");
}

#[test]
fn jaws_close_like_scissors() {
    // Two boxes on arms of 30 mm, whose inner faces touch the block.
    let jaw = |name: &str, z: &str, pin: &str, turn: &str| {
        format!(
            "{{ name = \"{name}\", shape = \"rounded-box\", half = [\"20 mm\", \"6 mm\", \"3 mm\"], radius = \"1 mm\", \
             at = [\"15 mm\", \"10 mm\", \"{z}\"], penalty = \"2 MPa/mm\", friction = 0.3, stick = \"1 MPa/mm\", \
             drive = {{ turn = \"{turn}\", about = {{ point = [\"-15 mm\", \"10 mm\", \"{pin}\"], axis = [0, 1, 0] }} }} }}"
        )
    };
    let tools = format!(
        "{}, {}",
        jaw("upper", "13 mm", "13 mm", "1.5 deg"),
        jaw("lower", "-3 mm", "-3 mm", "-1.5 deg")
    );
    let back = "{ on = \"x-max\", fix = \"xyz\" }";
    let slow = "procedure = { kind = \"explicit\", duration = \"0.5 s\", steps = 4, damping = \"60 /s\" }";
    let [still, moved] = [STATIC, slow].map(|procedure| run(&scene(back, &tools, "", procedure)));
    for object in [&still, &moved] {
        let [upper, lower] = ["tool-force", "tool-force-2"].map(|name| number(object, name));
        assert!(upper > 0.1 && (upper / lower - 1.0).abs() < 1e-4, "{upper} {lower}");
        assert!(number(object, "reaction-z").abs() < 1e-4 * upper);
    }
    let [still, moved] = [still, moved].map(|of| number(&of, "tool-force"));
    assert!((moved / still - 1.0).abs() < 0.03, "{moved} {still}");
}

#[test]
fn turns_that_cannot_be_made_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let refused = |tool: &str, drive: &str, says: &str| {
        let text = scene(BOTTOM, tool, drive, STATIC);
        assert_fails(&tissuebench(&["run", &write(&dir, "scene.toml", &text)]), 2, says);
    };
    let about = "about = { axis = [0, 0, 1], arm = \"10 mm\" }";
    let plate = plate(0.1);
    refused(&plate, "turn = \"20 deg\"", "key 'tool[0].drive.about': is missing");
    refused(
        &plate,
        &format!("closure = \"1 mm\", {about}"),
        "key 'tool[0].drive.about': goes with turn only",
    );
    refused(&plate, &format!("turn = \"0 deg\", {about}"), "key 'tool[0].drive.turn': '0 deg' is no turn");
    refused(
        &plate,
        "turn = \"1 deg\", about = { axis = [0, 0, 0], arm = \"1 mm\" }",
        "key 'tool[0].drive.about.axis': has no direction",
    );
    refused(
        &plate,
        "turn = \"1 deg\", about = { axis = [0, 0, 1] }",
        "key 'tool[0].drive.about.arm': is missing; a plate has no farthest place",
    );
    refused(
        &plate,
        &format!("turn = \"1 deg\", {about}, closure = \"1 mm\""),
        "key 'tool[0].drive': is not one drive",
    );
    let with_path = format!("path = [[\"0 mm\", \"0 mm\", \"-1 mm\"], {{ turn = \"0 deg\", {about} }}]");
    refused(&plate, &with_path, "key 'tool[0].drive.path[1].turn': '0 deg' is no turn");
    let along = plate.replace("axis = [0, 0, -1]", "axis = [0, 0, -1], along = [0, 0, -1]");
    refused(
        &along,
        &format!("turn = \"1 deg\", {about}"),
        "key 'tool[0].along': can't be combined with drive.turn",
    );
    let touch = plate.replace("at = [\"10 mm\", \"10 mm\", \"10 mm\"]", "at = { touch = \"z-max\" }");
    refused(
        &touch,
        &format!("turn = \"1 deg\", {about}"),
        "key 'tool[0].at.touch': 'z-max' has no direction",
    );
    let ball = "{ name = \"ball\", shape = \"sphere\", radius = \"5 mm\", at = [\"10 mm\", \"10 mm\", \"15 mm\"], \
                penalty = \"1 MPa/mm\", drive = { DRIVE } }";
    refused(
        ball,
        &format!("turn = \"1 deg\", {about}"),
        "key 'tool[0].drive.about.arm': '10 mm' is for a plate only",
    );
}
