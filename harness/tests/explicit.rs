//! Explicit dynamics from scene files: recorded states and their energies, the static limit, and runs that
//! end early.

mod common;

use common::{BLOCK, Done, PRESSED, assert_fails, inside, moving, objects, tissuebench, write};
use serde_json::Value;

fn metric(object: &Value, name: &str) -> f64 {
    object["metrics"][name]["value"].as_f64().unwrap_or_else(|| panic!("{name}: {object}"))
}

fn run(text: &str) -> (Done, Vec<Value>) {
    let dir = tempfile::tempdir().unwrap();
    let done = tissuebench(&["run", &write(&dir, "moving.toml", text), "--format", "json"]);
    let objects = objects(&done.stdout);
    (done, objects)
}

#[test]
fn states_are_recorded_with_energies_that_balance() {
    let dir = tempfile::tempdir().unwrap();
    let rubbed = moving(PRESSED).replace("/mm\" }", "/mm\", friction = 0.1, stick = \"1 MPa/mm\" }");
    let out = inside(&dir, "out");
    let scene = write(&dir, "moving.toml", &rubbed);
    let done = tissuebench(&["run", &scene, "--format", "json", "--out", &out]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let objects = objects(&done.stdout);
    assert_eq!(objects.len(), 2);
    for object in &objects {
        assert_eq!(object["status"], "ok");
        let (kernel, path) =
            (object["force_kernel"].as_str().unwrap(), object["lane_path"].as_str().unwrap());
        let said = format!("internal forces: {kernel} kernel in {path} lanes");
        assert!(object["plan"].to_string().contains(&said), "{said}");
        let states = object["steps"].as_array().unwrap();
        assert_eq!(states.len(), 4);
        for (k, state) in states.iter().enumerate() {
            let of = |name: &str| state["metrics"][name]["value"].as_f64().unwrap();
            assert!((of("time") - 5e-3 * (k + 1) as f64).abs() < 1e-15);
            let closure = |tool: usize| state["tools"][tool]["closure"].as_f64().unwrap();
            let part = 0.25 * (k + 1) as f64;
            assert!((closure(0) - 2e-3 * part).abs() < 1e-9 && (closure(1) - 1e-3 * part).abs() < 1e-9);
            let kept = of("kinetic-energy")
                + state["strain_energy"].as_f64().unwrap()
                + of("contact-energy")
                + of("friction-dissipation")
                + of("damping-dissipation");
            let given = of("external-work");
            assert!(given > 1e-6 && (kept / given - 1.0).abs() < 1e-2, "{k}: {kept} {given}");
            assert!(of("energy-drift").abs() < 1e-2 && of("friction-dissipation") >= 0.0);
        }
        assert!(metric(object, "energy-drift") < 1e-2 && metric(object, "energy-drift") > 0.0);
        // The compression is 3 mm of 20 mm, a mean stretch of 0.85 along z; at nu = 0.45 the sides expand.
        assert!(metric(object, "smallest-j") > 0.8 && metric(object, "smallest-j") < 1.0);
        let steps = metric(object, "time-steps");
        assert_eq!(steps, object["work"]["time_steps"].as_f64().unwrap());
        // The last state takes an additional step.
        assert!((steps - 1.0) * 0.9 * metric(object, "critical-step") >= 20e-3 * 0.9, "{steps}");
        assert!((metric(object, "mass") / 0.032 - 1.0).abs() < 1e-12);
        assert_eq!((metric(object, "tool-mass"), metric(object, "load-carried")), (0.0, 1.0));
        let each = object["phases"]["element-step"].as_f64().unwrap();
        assert!(each > 1e-10 && each < object["phases"]["solve"].as_f64().unwrap());
    }
    let records = records::read_run(std::path::Path::new(&out)).unwrap().records;
    let count = |name: &str| records.iter().filter(|r| r.step == Some(4) && r.name() == name).count();
    for name in ["kinetic-energy", "strain-energy", "smallest-j", "external-work", "time"] {
        assert_eq!(count(name), 2, "{name}");
    }
    assert_eq!(count("newton-iterations"), 0);
}

/// If slow and damped, and without friction, dynamics ends in the static solution.
#[test]
fn a_slow_damped_motion_ends_where_a_static_path_does() {
    let slow = |drive: &str| {
        moving(PRESSED)
            .replace("duration = \"20 ms\"", "duration = \"0.6 s\", damping = \"60 /s\", tool_mass = 1.0")
            .replace("drive = { closure = \"2 mm\" }", &format!("drive = {{ {drive}, over = \"0.3 s\" }}"))
            .replace("drive = { closure = \"1 mm\" }", "drive = { closure = \"1 mm\", over = \"0.3 s\" }")
    };
    let still = PRESSED.lines().filter(|l| !l.contains("\"mixed\"") && !l.contains("\"efg\""));
    let (done, at_rest) = run(&still.map(|l| format!("{l}\n")).collect::<String>());
    assert_eq!(done.code, 0, "{}", done.stderr);
    let force = metric(&at_rest[0], "tool-force");
    for drive in ["closure = \"2 mm\"".to_string(), format!("force = \"{force} N\"")] {
        let (done, moved) = run(&slow(&drive));
        assert_eq!(done.code, 0, "{}", done.stderr);
        for (a, b) in moved.iter().zip(&at_rest) {
            assert_eq!(a["method"], b["method"]);
            for name in ["tool-force", "closure", "max-z", "strain-energy"] {
                let (found, expected) = (metric(a, name), metric(b, name));
                assert!((found / expected - 1.0).abs() < 2e-3, "{drive} {name}: {found} {expected}");
            }
        }
    }
}

#[test]
fn loads_and_led_supports_grow_over_the_duration() {
    let text = BLOCK.replace("poisson = 0.3", "poisson = 0.3, density = \"1000 kg/m^3\"").replace(
        "where = \"z == 0 mm\", fix = \"xyz\"",
        "where = \"z == 0 mm\", move = { x = \"0 mm\", y = \"0 mm\", z = \"1 mm\" }",
    );
    let moved = format!(
        "{text}procedure = {{ kind = \"explicit\", duration = \"2 s\", damping = \"20 /s\", steps = 2 }}\n"
    );
    let ((done, dynamic), (_, linear)) = (run(&moved), run(&text));
    assert_eq!(done.code, 0, "{}", done.stderr);
    for name in ["max-x", "max-z", "strain-energy"] {
        let (found, expected) = (metric(&dynamic[0], name), metric(&linear[0], name));
        assert!((found / expected - 1.0).abs() < 1e-2, "{name}: {found} {expected}");
    }
}

#[test]
fn a_step_too_large_and_an_inversion_are_named_and_exit_with_3() {
    let large = moving(PRESSED).replace("steps = 4", "steps = 4, step = \"5 ms\"");
    let (done, told) = run(&large);
    assert_fails(&done, 3, "key 'procedure.step': ");
    assert!(done.stderr.contains("exceeds the critical"), "{}", done.stderr);
    for object in &told {
        assert_eq!(object["status"], "step-too-large");
        assert_eq!((metric(object, "load-carried"), metric(object, "time-steps")), (0.0, 0.0));
    }

    // Only inertia resists the load at the top: 60 kPa on 20 kPa in 20 ms.
    let text = BLOCK
        .replace("law = \"linear\"", "law = \"neo-hookean\", density = \"1000 kg/m^3\"")
        .replace("1 kPa", "200 kPa")
        .replace("[2, 2, 1]", "[4, 4, 2]");
    let text = format!("{text}procedure = {{ kind = \"explicit\", duration = \"50 ms\", steps = 50 }}\n");
    let (done, told) = run(&text);
    assert_fails(&done, 3, "inverted: ");
    let object = &told[0];
    assert_eq!(object["status"], "inverted");
    let message = object["message"].as_str().unwrap();
    assert!(
        message.contains("quadrature point") && message.contains("t = ") && message.contains("det F = -"),
        "{message}"
    );
    let states = object["steps"].as_array().unwrap().len();
    assert!(states > 0 && states < 50, "{states}");
    assert!((metric(object, "load-carried") - states as f64 / 50.0).abs() < 1e-12);
    assert!(metric(object, "smallest-j") > 0.0 && metric(object, "max-z") > 0.0);
}

/// A ball of 5 mm radius that starts 1 mm above a block and moves down by 10 mm.
const STRUCK: &str = r#"title = "A ball on a block"
body = { shape = "box", size = ["40 mm", "40 mm", "20 mm"] }
material = { law = "neo-hookean", young = "20 kPa", poisson = 0.45, density = "1000 kg/m^3" }
support = [{ where = "z == 0 mm", fix = "xyz" }]
procedure = { kind = "explicit", duration = "20 ms", steps = 10 }
tool = [{ name = "ball", shape = "sphere", radius = "5 mm", at = ["20 mm", "20 mm", "26 mm"], along = [0, 0, -1], drive = { closure = "10 mm" }, penalty = "1e-4 MPa/mm" }]
method = [
    { id = "hex8", family = "fem", element = "hex8", size = { cells = [8, 8, 4] } },
    { id = "tet4", family = "fem", element = "tet4", size = { cells = [8, 8, 4] } },
]
"#;

#[test]
fn a_tool_that_loses_its_contact_is_named_and_exits_with_3() {
    let (done, told) = run(STRUCK);
    assert_fails(&done, 3, "contact-lost: ");
    assert_fails(&done, 3, "key 'tool[0]': ");
    for object in &told {
        assert_eq!(object["status"], "contact-lost", "{object}");
        let message = object["message"].as_str().unwrap();
        // The limit is half of the ball's radius.
        assert!(message.contains("(limit 2.5e-3 m, half the tool's inradius)"), "{message}");
        // The ball touches the block at 1 mm or somewhat later. If the block does not yield, this depth is
        // reached at 3.5 mm. States are 0.9 mm apart.
        let states = object["steps"].as_array().unwrap().len();
        let closure = metric(object, "closure");
        assert!(states == 3 && closure > 2.6e-3 && closure < 4.4e-3, "{states}: {closure}");
        assert!((metric(object, "load-carried") - 0.3).abs() < 1e-12);
        assert!(metric(object, "tool-force") > 0.0 && metric(object, "penetration") < 2.5e-3);
    }
    // With a stiffer contact, the ball stays outside to the end.
    let (done, told) = run(&STRUCK.replace("1e-4 MPa", "1e-1 MPa"));
    assert_eq!((done.code, &told[0]["status"]), (0, &"ok".into()), "{}", done.stderr);

    // A ball slips between the points of a coarse surface and would be held from inside, also at rest.
    let coarse = STRUCK.replace("1e-4 MPa", "1e-2 MPa").replace("[8, 8, 4]", "[4, 4, 2]");
    let still = coarse.replace("kind = \"explicit\", duration = \"20 ms\"", "kind = \"static\"");
    for (scene, status) in [(&coarse, "contact-lost"), (&still, "stalled")] {
        let (done, told) = run(scene);
        assert_fails(&done, 3, "acts outwards from inside the body");
        assert_eq!((&told[0]["method"], &told[0]["status"]), (&"hex8".into(), &status.into()));
        let carried = metric(&told[0], "load-carried");
        assert!((0.5..0.75).contains(&carried) && metric(&told[0], "tool-force") > 0.0, "{carried}");
    }

    // A force-controlled tool oscillates on its contact with its own mass.
    let light = STRUCK
        .replace("closure = \"10 mm\"", "force = \"2 N\"")
        .replace("steps = 10", "steps = 10, tool_mass = 1e-6")
        .replace("1e-4 MPa", "5 MPa");
    let (done, told) = run(&light);
    assert_fails(&done, 3, "key 'procedure': ");
    for object in &told {
        assert_eq!(object["status"], "contact-lost", "{object}");
        assert!(object["message"].as_str().unwrap().contains("give the tool more mass"), "{object}");
    }
}

#[test]
fn what_overflows_is_named_and_exits_with_3() {
    // Accelerations of 1e200 m/s^2 are finite numbers; the square of the velocity overflows.
    let text = BLOCK.replace("poisson = 0.3", "poisson = 0.3, density = \"1000 kg/m^3\"");
    let text = text.replace("1 kPa", "1e200 Pa");
    let text = format!("{text}procedure = {{ kind = \"explicit\", duration = \"50 ms\", steps = 50 }}\n");
    let (done, told) = run(&text);
    assert_fails(&done, 3, "not-finite: ");
    assert_eq!(told[0]["status"], "not-finite");
    assert!(told[0]["message"].as_str().unwrap().contains("is not finite"), "{}", told[0]);
    assert_eq!((metric(&told[0], "load-carried"), metric(&told[0], "max-z")), (0.0, 0.0));
}

#[test]
fn bad_explicit_scenes_name_the_key() {
    let good = moving(PRESSED);
    let dir = tempfile::tempdir().unwrap();
    for (from, to, code, says) in [
        (", density = \"1000 kg/m^3\"", "", 2, "'material.density': is missing"),
        ("duration = \"20 ms\", ", "", 2, "'procedure.duration': is missing"),
        ("steps = 4", "steps = 4, safety = 1.5", 2, "'procedure.safety'"),
        ("steps = 4", "steps = 4, safety = 0.5, step = \"1 us\"", 2, "give step or safety"),
        (
            "steps = 4",
            "steps = 4, step = \"1e-15 s\"",
            2,
            "'procedure.step': '1e-15 s' needs 2.00e13 time steps of 1.00e-15 s",
        ),
        ("steps = 4", "steps = 4, damping = 5", 2, "needs a unit: /s"),
        ("steps = 4", "steps = 4, damping = \"-5 /s\"", 2, "'procedure.damping'"),
        ("steps = 4", "steps = 4, tool_mass = 0", 2, "'procedure.tool_mass'"),
        ("steps = 4", "steps = 4, tolerance = 1e-9", 2, "it goes with static, implicit-dynamic"),
        (
            "\"explicit\", duration = \"20 ms\"",
            "\"static\", damping = \"5 /s\"",
            2,
            "it goes with explicit, implicit-dynamic",
        ),
        (
            "element = \"tet4\", dilation = \"nodal-mean\"",
            "element = \"tet10\", dilation = \"mixed\"",
            3,
            "dilation = \"mixed\" in explicit dynamics is not available",
        ),
    ] {
        assert!(good.contains(from), "{from}");
        let path = write(&dir, "bad.toml", &good.replace(from, to));
        assert_fails(&tissuebench(&["run", &path]), code, says);
    }
}

/// A block held at its base and pulled by a load that grows over a time, by elements and by a cloud on the
/// same vertices.
fn pulled(over: &str, cloud: &str) -> String {
    format!(
        r#"title = "A sudden pull"
body = {{ shape = "box", size = ["40 mm", "40 mm", "40 mm"] }}
material = {{ law = "neo-hookean", young = "20 kPa", poisson = 0.3, density = "1000 kg/m^3" }}
support = [{{ on = "z-min", fix = "xyz" }}]
load = [{{ on = "z-max", traction = ["0 Pa", "0 Pa", "200 Pa"] }}]
procedure = {{ kind = "explicit", over = "{over}", duration = "60 ms", steps = 12 }}
method = [
    {{ id = "hex8", family = "fem", element = "hex8", size = {{ cells = [8, 8, 8] }} }},
    {{ id = "cloud", family = "efg", size = {{ cells = [8, 8, 8] }}, kernel = "cubic-spline", basis = "linear", integration = {{ rule = "cell-smoothed" }}, {cloud} }},
]
output = {{ probes = [["20 mm", "20 mm", "40 mm"]] }}
"#
    )
}

/// Heights of the probe at every state, m, by method.
fn heights(objects: &[Value]) -> Vec<Vec<f64>> {
    let height = |state: &Value| state["probes"][0][2].as_f64().unwrap();
    objects.iter().map(|o| o["steps"].as_array().unwrap().iter().map(height).collect()).collect()
}

#[test]
fn a_cloud_with_coupled_supports_moves_as_elements_do() {
    let (done, objects) = run(&pulled("40 ms", r#"essential = "coupling", support_scale = 1.2"#));
    assert_eq!(done.code, 0, "{}", done.stderr);
    let [hex8, cloud] = &heights(&objects)[..] else { panic!("{objects:?}") };
    let largest = hex8.iter().fold(0.0f64, |l, z| l.max(z.abs()));
    for (a, b) in hex8.iter().zip(cloud) {
        assert!((a - b).abs() < 0.02 * largest, "{hex8:?} {cloud:?}");
    }
    assert!(metric(&objects[1], "energy-drift") < 1e-3);
    assert!(!done.stdout.contains("spurious-motion"), "{}", done.stdout);
}

#[test]
fn wide_supports_with_a_lumped_mass_warn() {
    let (done, objects) = run(&pulled("0 s", r#"essential = "coupling", support_scale = 3.0"#));
    assert_eq!(done.code, 0, "{}", done.stderr);
    let warning = &objects[1]["warnings"][0];
    assert_eq!(
        (&warning["code"], objects[0]["warnings"].as_array().map(Vec::len)),
        (&"spurious-motion".into(), Some(0))
    );
    assert!(warning["value"].as_f64().unwrap() > 0.1);
}

/// A damped motion between plates in both precisions. Undamped, stiff plates chatter, and their forces depend
/// on every digit.
#[test]
fn single_precision_ends_where_double_precision_does() {
    let text = moving(PRESSED).replace("duration = \"20 ms\"", "duration = \"0.3 s\", damping = \"60 /s\"");
    let single = text.replace("steps = 4", "steps = 4, precision = \"single\"");
    assert_ne!(text, single);
    let ((done, double), (other, single)) = (run(&text), run(&single));
    assert_eq!((done.code, other.code), (0, 0), "{}", other.stderr);
    for (a, b) in double.iter().zip(&single) {
        for name in ["tool-force", "max-z", "strain-energy", "critical-step"] {
            let (found, expected) = (metric(b, name), metric(a, name));
            assert!((found / expected - 1.0).abs() < 3e-4, "{name}: {found} {expected}");
        }
        let rounding = metric(b, "force-rounding");
        assert!(rounding > 1e-9 && rounding < 1e-4, "{rounding}");
        assert!(a["metrics"]["force-rounding"].is_null());
        let kernel = format!("single-precision {}", a["force_kernel"].as_str().unwrap());
        assert_eq!(b["force_kernel"], kernel.as_str());
        assert!(b["plan"].to_string().contains(&format!("internal forces: {kernel} kernel")));
    }
}

#[test]
fn what_has_no_single_precision_is_refused_at_its_line() {
    let dir = tempfile::tempdir().unwrap();
    let cloud = pulled("0 s", r#"essential = "coupling", support_scale = 1.6"#);
    let wedge = moving(PRESSED).replace("element = \"hex8\"", "element = \"wedge6\"");
    for (name, text, said) in [
        ("cloud", cloud, "precision = \"single\" with clouds is not available"),
        ("wedge", wedge, "single precision is not available for method 'hex8'"),
    ] {
        let text = text.replacen("kind = \"explicit\"", "kind = \"explicit\", precision = \"single\"", 1);
        let path = write(&dir, &format!("{name}.toml"), &text);
        let line = 1 + text.lines().position(|line| line.contains("precision")).unwrap();
        let done = tissuebench(&["run", &path]);
        assert_fails(&done, 3, said);
        assert!(
            done.stderr.contains(&format!("{path}:{line}: key 'procedure.precision'")),
            "{}",
            done.stderr
        );
    }
}

#[test]
fn a_cloud_with_weak_supports_is_refused_in_explicit_dynamics() {
    let dir = tempfile::tempdir().unwrap();
    let path = write(&dir, "cloud.toml", &pulled("0 s", r#"essential = "penalty", support_scale = 1.6"#));
    let said = "a cloud without coupled elements at its supports in explicit dynamics is not available";
    assert_fails(&tissuebench(&["run", &path]), 3, said);
}
