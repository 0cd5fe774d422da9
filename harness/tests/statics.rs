//! The static procedure from scene files: tool forces, load histories, paths that end early, and comparison
//! with a reference at each step.

mod common;

use common::{BLOCK, PRESSED, assert_fails, inside, objects, tissuebench, write};
use serde_json::Value;
use tempfile::TempDir;

fn metric(object: &Value, name: &str) -> f64 {
    object["metrics"][name]["value"].as_f64().unwrap_or_else(|| panic!("{name}: {object}"))
}

/// Nominal stress (Pa) of a neo-Hookean bar of E = 20 kPa, nu = 0.45 at stretch `l` with free sides. With `W
/// = mu/2 (I1 - 3 - 2 ln J) + lambda/2 (ln J)^2` the side stretch `t` solves `mu (t - 1/t) + lambda ln(l t^2)
/// / t = 0`, and `P = mu (l - 1/l) + lambda ln(l t^2) / l`.
fn uniaxial(l: f64) -> f64 {
    let mu = 20e3 / 2.9;
    let lambda = 20e3 * 0.45 / (1.45 * 0.1);
    let (mut low, mut high) = (0.5f64, 2.0f64);
    for _ in 0..200 {
        let t = 0.5 * (low + high);
        let side = mu * (t - 1.0 / t) + lambda * (l * t * t).ln() / t;
        if side > 0.0 { high = t } else { low = t }
    }
    mu * (l - 1.0 / l) + lambda * (l * low * low).ln() / l
}

#[test]
fn plates_push_with_the_force_that_their_closure_takes() {
    let dir = tempfile::tempdir().unwrap();
    let done = tissuebench(&["run", &write(&dir, "pressed.toml", PRESSED), "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let objects = objects(&done.stdout);
    assert_eq!(objects.len(), 5);
    for object in &objects {
        let id = object["method"].as_str().unwrap();
        assert_eq!(object["status"], "ok");
        let tools = object["tools"].as_array().unwrap();
        let names: Vec<&str> = tools.iter().map(|t| t["name"].as_str().unwrap()).collect();
        assert_eq!(names, ["top", "base"]);
        let closures: Vec<f64> = tools.iter().map(|t| t["closure"].as_f64().unwrap()).collect();
        assert_eq!(closures, [2e-3, 1e-3]);
        let force = |k: usize| -> Vec<f64> {
            tools[k]["force"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
        };
        // The tissue pushes the upper plate up and the lower plate down with the same force.
        let (up, down) = (force(0), force(1));
        assert!(up[2] > 0.0 && (up[2] + down[2]).abs() < 1e-7 * up[2], "{id}: {up:?} {down:?}");
        assert!(up[0].abs() + up[1].abs() < 1e-9 * up[2], "{id}: {up:?}");
        // The penetration is the same at both plates.
        let height = 20e-3 - 3e-3 + 2.0 * metric(object, "penetration");
        let exact = -uniaxial(height / 20e-3) * 1.6e-3;
        // The cloud's sides are constrained by a penalty of 1e3 E / h.
        let tolerance = if id == "efg" { 1e-3 } else { 1e-7 };
        let found = metric(object, "tool-force");
        assert!((found / exact - 1.0).abs() < tolerance, "{id}: {found} {exact}");
        assert!((found - up[2]).abs() < 1e-12 * found, "{id}");
        // There are two steps; the first is at half of the load.
        let steps = object["steps"].as_array().unwrap();
        assert_eq!(steps.len(), 2, "{id}");
        assert!((steps[0]["load"].as_f64().unwrap() - 0.5).abs() < 1e-15, "{id}");
        assert!((steps[0]["tools"][0]["closure"].as_f64().unwrap() - 1e-3).abs() < 1e-15, "{id}");
        let probe = steps[1]["probes"][0][2].as_f64().unwrap();
        assert!((probe + 2e-3).abs() < 5e-6, "{id}: {probe}");
        // The stress at the probe is the true stress: the nominal stress divided by the growth of the
        // section.
        let stress = object["probes"][0]["stress"][2].as_f64().unwrap();
        let pushed = uniaxial(height / 20e-3);
        assert!(stress < 0.0 && stress > pushed, "{id}: {stress} {pushed}");
    }
}

#[test]
fn forces_and_pressures_drive_to_the_closure_that_carries_them() {
    let dir = tempfile::tempdir().unwrap();
    // Either 4 N on the upper plate, or a box larger than the block, whose face of 60 x 60 mm gives 4 N at
    // 1111 Pa.
    let force = PRESSED.replace("closure = \"2 mm\"", "force = \"4 N\"");
    let jaw = "shape = \"rounded-box\", half = [\"30 mm\", \"30 mm\", \"5 mm\"], radius = \"1 mm\", \
               at = [\"20 mm\", \"20 mm\", \"25 mm\"]";
    let pressure = PRESSED
        .replacen("shape = \"plate\", at = [\"20 mm\", \"20 mm\", \"20 mm\"]", jaw, 1)
        .replace("closure = \"2 mm\"", "pressure = \"1111.1111111111111 Pa\"");
    let mut closures = Vec::new();
    for (name, text) in [("force.toml", force), ("pressure.toml", pressure)] {
        assert_ne!(text, PRESSED);
        let path = write(&dir, name, &text);
        let done = tissuebench(&["run", &path, "--format", "json", "--method", "hex8"]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        let object = &objects(&done.stdout)[0];
        let found = metric(object, "tool-force");
        assert!((found - 4.0).abs() < 1e-7, "{name}: {found}");
        closures.push(metric(object, "closure"));
    }
    assert!((closures[0] / closures[1] - 1.0).abs() < 1e-6 && closures[0] > 0.5e-3, "{closures:?}");
}

#[test]
fn slender_columns_go_on_past_their_critical_load() {
    // Elastica of a column clamped at its foot with an end rotation of 60 degrees: P over the critical load
    // pi^2 EI / (4 L^2), and the lateral and axial displacement of the end over L (Timoshenko and Gere 1961,
    // table 2-4).
    let (load, aside, down) = (1.1517, 0.5932, 0.2590);
    for (length, cells) in [(0.4, 25), (0.6, 30)] {
        let critical = std::f64::consts::PI.powi(2) * 1e6 / (12.0 * 4.0 * length * length) * 1e-4;
        let down_by = critical * load;
        let scene = format!(
            r#"title = "A slender column"
body = {{ shape = "box", size = ["10 mm", "10 mm", "{length} m"] }}
material = {{ law = "saint-venant-kirchhoff", young = "1 MPa", poisson = 0.0 }}
support = [{{ on = "z-min", fix = "xyz" }}]
load = [{{ on = "z-max", traction = ["{} Pa", "0 Pa", "-{down_by} Pa"] }}]
procedure = {{ kind = "static", steps = 20, iterations = 40 }}
output = {{ probes = [["5 mm", "5 mm", "{length} m"]] }}
method = [{{ id = "hex20", family = "fem", element = "hex20", size = {{ cells = [1, 1, {cells}] }} }}]
"#,
            1e-4 * down_by
        );
        let dir = tempfile::tempdir().unwrap();
        let done = tissuebench(&["run", &write(&dir, "column.toml", &scene), "--format", "json"]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        let steps = objects(&done.stdout)[0]["steps"].clone();
        let end = &steps.as_array().unwrap().last().unwrap()["probes"][0];
        let [x, z] = [0, 2].map(|axis| end[axis].as_f64().unwrap() / length);
        assert!((x / aside - 1.0).abs() < 0.01 && (-z / down - 1.0).abs() < 0.02, "{length} m: {x} {z}");
    }
}

/// The St. Venant-Kirchhoff law never carries more than 0.19 E in compression, so a load of 0.3 E cannot be
/// reached.
const BEYOND: &str = r#"title = "More than the law carries"
body = { shape = "box", size = ["10 mm", "10 mm", "10 mm"] }
material = { law = "saint-venant-kirchhoff", young = "20 kPa", poisson = 0.0 }
support = [{ where = "x == 0 mm", fix = "x" }, { where = "y == 0 mm", fix = "y" }, { where = "z == 0 mm", fix = "z" }]
load = [{ on = "z-max", pressure = "6 kPa" }]
procedure = { kind = "static", steps = 10 }
method = [
    { id = "hex8", family = "fem", element = "hex8", size = { cells = [1, 1, 1] } },
    { id = "tet4", family = "fem", element = "tet4", size = { cells = [1, 1, 1] } },
]
"#;

#[test]
fn a_path_that_ends_early_keeps_what_it_carried_and_exits_with_3() {
    let dir = tempfile::tempdir().unwrap();
    let scene = write(&dir, "beyond.toml", BEYOND);
    let out = inside(&dir, "out");
    let done = tissuebench(&["run", &scene, "--format", "json", "--method", "hex8", "--out", &out]);
    assert_fails(&done, 3, "stalled: ");
    assert!(done.stderr.contains(&format!("{scene}:8: key 'method[0]': stopped at 0.6")), "{}", done.stderr);
    let object = &objects(&done.stdout)[0];
    assert_eq!(object["status"], "stalled");
    assert!(object["message"].as_str().unwrap().contains("stopped at"));
    // The largest nominal stress is E / (3 sqrt 3) = 0.19245 E, 0.6415 of the load.
    let carried = metric(object, "load-carried");
    assert!(carried > 0.6 && carried <= 0.6416, "{carried}");
    assert_eq!(object["steps"].as_array().unwrap().len(), 6);
    assert!(metric(object, "cut-backs") >= 6.0);
    let records = std::fs::read_to_string(format!("{out}/records.csv")).unwrap();
    let of = |step: u32| records.matches(&format!(",strain-energy,,,J,,{step},,value,")).count();
    assert_eq!((of(6), of(7)), (1, 0));
    let report = std::fs::read_to_string(format!("{out}/report/report.html")).unwrap();
    assert!(report.contains("stalled: "), "the report says nothing of it");
    // The other method's result is kept, and a study keeps both.
    let done = tissuebench(&["run", &scene, "--format", "json"]);
    assert_eq!((done.code, objects(&done.stdout).len()), (3, 2));
}

#[test]
fn a_path_known_to_end_early_does_not_fail_its_study() {
    let dir = tempfile::tempdir().unwrap();
    for (band, code) in [("[0.6, 0.65]", 0), ("[0.7, 0.8]", 1)] {
        let check = format!(
            "check = [{{ metric = \"load-carried\", known_band = {band}, reason = \"past the largest stress\" }}]"
        );
        let scene =
            write(&dir, "known.toml", &BEYOND.replacen("method = [", &format!("{check}\nmethod = ["), 1));
        let study = write(&dir, "study.toml", &format!("title = \"Known\"\n[[run]]\nscene = '{scene}'\n"));
        let out = inside(&dir, "out");
        let done = tissuebench(&["verify", &study, "--out", &out]);
        // An unexpected stall gives exit code 3 even if a check fails.
        assert_eq!(done.code, code, "{}", done.stderr);
        let report = std::fs::read_to_string(format!("{out}/report/report.html")).unwrap();
        assert!(report.contains("stalled: "), "the report says nothing of it");
    }
}

fn run_referenced(dir: &TempDir, text: &str) -> (common::Done, Vec<Value>) {
    let done = tissuebench(&["run", &write(dir, "referenced.toml", text), "--format", "json"]);
    let objects = objects(&done.stdout);
    (done, objects)
}

#[test]
fn errors_against_a_method_are_taken_at_equal_steps() {
    let dir = tempfile::tempdir().unwrap();
    // A bonded base replaces the lower plate: the state is no longer uniform, so the methods differ.
    let slides = "{ where = \"y == 0 mm\", fix = \"y\" }";
    let bonded = PRESSED.replace(slides, "{ where = \"z == 0 mm\", fix = \"xyz\" }");
    let bonded: String =
        bonded.lines().filter(|l| !l.contains("\"base\"")).map(|l| format!("{l}\n")).collect();
    let text = format!(
        "{bonded}reference = {{ method = \"hex8\" }}\n[[check]]\nmetric = \"tool-force-error\"\nmethod = \"hex8\"\nat_most = 1e-15\n[[check]]\nmetric = \"tool-force\"\nmethod = \"hex8\"\nat_most = \"1 N\"\n"
    );
    let (done, objects) = run_referenced(&dir, &text);
    // hex8 is its own reference, and its force is above 1 N.
    assert_fails(&done, 1, "FAILED: referenced hex8 tool-force: at most 1e0");
    assert!(!done.stderr.contains("FAILED: referenced hex8 tool-force-error"), "{}", done.stderr);
    assert_eq!(
        (metric(&objects[0], "tool-force-error"), metric(&objects[0], "probe-difference")),
        (0.0, 0.0)
    );
    for other in &objects[1..] {
        let (force, probe) = (metric(other, "tool-force-error"), metric(other, "probe-difference"));
        let expected = (metric(other, "tool-force") / metric(&objects[0], "tool-force") - 1.0).abs();
        assert!((force - expected).abs() < 1e-12 && force > 1e-4 && force < 0.5, "{force} {expected}");
        assert!(probe > 0.0 && probe < 1e-3, "{probe}");
        assert!(metric(other, "rms") > 0.0);
    }
}

#[test]
fn a_reference_that_ends_early_is_compared_with_as_far_as_it_came() {
    let dir = tempfile::tempdir().unwrap();
    let (done, objects) = run_referenced(&dir, &format!("{BEYOND}reference = {{ method = \"hex8\" }}\n"));
    assert_fails(&done, 3, "reference stalled: ");
    for object in &objects {
        assert_eq!(object["status"], "stalled");
        assert!(object["metrics"].get("rms").is_none() && object["metrics"].get("max-z").is_some());
    }
}

#[test]
fn a_cloud_keeps_a_large_factor_and_reaches_the_same_force() {
    let dir = tempfile::tempdir().unwrap();
    let run = |cells: &str| {
        let text = PRESSED.replace("[3, 3, 2]", cells);
        let done =
            tissuebench(&["run", &write(&dir, "cloud.toml", &text), "--method", "efg", "--format", "json"]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        let object = objects(&done.stdout).remove(0);
        let work = |name: &str| object["work"][name].as_u64().unwrap();
        let factors = [work("factorisations"), work("assemblies"), work("inner_iterations")];
        (factors, metric(&object, "tool-force"))
    };
    // 144 and 2178 unknowns: a dense factor of every tangent, and a sparse factor for several.
    let ([small, tangents, none], coarse) = run("[3, 3, 2]");
    assert!(small >= tangents && none == 0, "{small} {tangents} {none}");
    let ([large, tangents, some], fine) = run("[10, 10, 5]");
    assert!(large < tangents && some > 0, "{large} {tangents} {some}");
    assert!((fine / coarse - 1.0).abs() < 1e-3, "{fine} {coarse}");
}

#[test]
fn bad_static_scenes_name_file_line_and_key() {
    let dir = tempfile::tempdir().unwrap();
    let law = "law = \"neo-hookean\", young = \"20 kPa\", poisson = 0.45";
    for (name, from, to, code, line, says) in [
        (
            "no-penalty",
            "closure = \"2 mm\" }, penalty = \"5 MPa/mm\"",
            "closure = \"2 mm\" }",
            2,
            7,
            "'tool[0].penalty': is missing",
        ),
        (
            "no-stick",
            "closure = \"1 mm\" }, ",
            "closure = \"1 mm\" }, friction = 0.1, ",
            2,
            8,
            "'tool[1].stick': is missing",
        ),
        (
            "mixed-tet4",
            "\"nodal-mean\"",
            "\"mixed\"",
            2,
            12,
            "'method[1].dilation': 'mixed' has no stable pressure field",
        ),
        (
            "share",
            law,
            "law = \"neo-hookean\", young = \"20 kPa\", poisson = 0.45, share = 0.1",
            2,
            3,
            "'material.share'",
        ),
        ("linear", "kind = \"static\"", "kind = \"linear\"", 2, 3, "'neo-hookean' is a law of large strain"),
        (
            "tool-linear",
            "procedure = { kind = \"static\", steps = 2 }\n",
            "",
            2,
            7,
            "'top' touches the body, but the procedure is linear",
        ),
        (
            "multipliers",
            "essential = \"penalty\"",
            "essential = \"multipliers\"",
            2,
            15,
            "'method[4].essential': 'multipliers' is available for linear procedures and modes, not for kind = \"static\"",
        ),
        (
            "nitsche",
            "essential = \"penalty\"",
            "essential = \"nitsche\"",
            2,
            15,
            "'method[4].essential': 'nitsche' is available for linear procedures and modes",
        ),
    ] {
        let text = PRESSED.replacen(from, to, 1);
        assert_ne!(text, PRESSED, "{name}");
        let path = write(&dir, &format!("{name}.toml"), &text);
        for command in ["run", "plan"] {
            let done = tissuebench(&[command, &path]);
            assert_fails(&done, code, says);
            // Without the line of the procedure, the following lines move up.
            let line = if name == "tool-linear" { line - 1 } else { line };
            assert!(done.stderr.contains(&format!("{path}:{line}:")), "{name}: {}", done.stderr);
        }
    }
}

#[test]
fn where_newton_stalls_relaxation_comes_to_the_same_rest() {
    let dir = tempfile::tempdir().unwrap();
    let force = PRESSED.replace("closure = \"2 mm\"", "force = \"4 N\"");
    for (name, text) in [("led.toml", PRESSED), ("forced.toml", force.as_str())] {
        // A single iteration never confirms convergence.
        let stuck = text.replace("steps = 2 }", "steps = 2, iterations = 1, on_stall = \"relax\" }");
        let coupled = |text: &str| text.replace("\"penalty\" }", "\"coupling\" }");
        let free_cloud = write(&dir, &format!("cloud-{name}"), &coupled(text));
        let stuck_cloud = write(&dir, &format!("stuck-cloud-{name}"), &coupled(&stuck));
        let free = write(&dir, name, text);
        let stuck = write(&dir, &format!("stuck-{name}"), &stuck);
        for (method, free, stuck) in
            [("hex8", &free, &stuck), ("tet4-nodal", &free, &stuck), ("efg", &free_cloud, &stuck_cloud)]
        {
            let run = |path: &str| tissuebench(&["run", path, "--format", "json", "--method", method]);
            let (newton, relaxed) = (run(free), run(stuck));
            assert_eq!((newton.code, relaxed.code), (0, 0), "{}", relaxed.stderr);
            assert!(relaxed.stderr.contains("relaxed: "), "{}", relaxed.stderr);
            let (newton, relaxed) = (&objects(&newton.stdout)[0], &objects(&relaxed.stdout)[0]);
            assert_eq!((&newton["status"], &relaxed["status"]), (&"ok".into(), &"relaxed".into()));
            assert_eq!(metric(relaxed, "limit-load"), 0.0);
            for quantity in ["closure", "tool-force", "tool-force-2", "max-z", "strain-energy"] {
                let (a, b) = (metric(newton, quantity), metric(relaxed, quantity));
                assert!((a / b - 1.0).abs() < 1e-3, "{name} {method} {quantity}: {a} {b}");
            }
            assert_eq!(relaxed["steps"].as_array().unwrap().len(), 2);
            let made = metric(relaxed, "relaxation-steps");
            assert_eq!(relaxed["work"]["relaxation_steps"].as_f64(), Some(made));
            let stage = |object: &Value| {
                let stages = object["plan"].as_array().unwrap().clone();
                stages.into_iter().find(|s| s["stage"] == "dynamic relaxation").unwrap()["ran"].clone()
            };
            assert_eq!((stage(newton), stage(relaxed)), (false.into(), true.into()));
        }
        // A cloud with supports by penalty cannot relax: its load path ends when it stalls, and the plan
        // says why.
        let plan = tissuebench(&["plan", &stuck, "--method", "efg"]);
        assert!(plan.stdout.contains("not available for clouds"), "{}", plan.stdout);
    }
}

/// Frictionless plates leave the body free to slide between them, so its position would be arbitrary.
/// Friction prevents this motion.
#[test]
fn a_motion_that_nothing_prevents_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let line = PRESSED.lines().find(|line| line.starts_with("support")).unwrap();
    let free = PRESSED.replace(line, "");
    let run = |text: &str| tissuebench(&["run", &write(&dir, "free.toml", text), "--method", "hex8"]);
    let says = "key 'body': has no [[support]]: rigid motion is left free: translation along x, \
                translation along y, rotation about z";
    assert_fails(&run(&free), 3, says);
    let sticks = "penalty = \"5 MPa/mm\", friction = 0.5, stick = \"5 MPa/mm\"";
    let held = run(&free.replace("penalty = \"5 MPa/mm\"", sticks));
    assert_eq!(held.code, 0, "{}", held.stderr);
    // Without tools, the scene is refused before anything is solved.
    let tools = &free[free.find("tool = [").unwrap()..=free.find("\n]\n").unwrap() + 2];
    let alone = free.replace(tools, "load = [{ on = \"z-max\", pressure = \"1 kPa\" }]\n");
    assert_fails(&run(&alone), 3, "rotation about x");
}

/// A cantilever with one reduced element across: the hourglass modes of such a row have no energy.
#[test]
fn reduced_elements_in_a_row_say_why_they_end() {
    let dir = tempfile::tempdir().unwrap();
    let text = r#"title = "A row of reduced elements"
body = { shape = "box", size = ["10 mm", "10 mm", "80 mm"] }
material = { law = "neo-hookean", young = "20 kPa", poisson = 0.45 }
support = [{ on = "z-min", fix = "xyz" }]
load = [{ on = "z-max", traction = ["20 Pa", "0 Pa", "0 Pa"] }]
procedure = { kind = "static", steps = 2 }
method = [{ id = "reduced", family = "fem", element = "hex20", reduced = true, size = { cells = [1, 1, 8] } }]
"#;
    let done = tissuebench(&["run", &write(&dir, "row.toml", text)]);
    assert_fails(&done, 3, "reduced integration leaves motions without energy");
    // A wrong unit is reported at the body, not at the method's size.
    let flat = BLOCK.replace("\"20 mm\"]", "\"20e-9 mm\"]").replace("cells = [2, 2, 1]", "level = 2");
    let done = tissuebench(&["run", &write(&dir, "flat.toml", &flat)]);
    assert_fails(&done, 2, "flat.toml:2: key 'body'");
    assert!(done.stderr.contains("check the units of its extents"), "{}", done.stderr);
}
