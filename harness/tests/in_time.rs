//! Implicit dynamics and viscoelastic relaxation from scene files.

mod common;

use common::{BLOCK, Done, PRESSED, assert_fails, moving, tissuebench, write};
use serde_json::Value;

fn run(text: &str) -> (Done, Vec<Value>) {
    let dir = tempfile::tempdir().unwrap();
    let done = tissuebench(&["run", &write(&dir, "in-time.toml", text), "--format", "json"]);
    let objects = done.stdout.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    (done, objects)
}

fn metric(object: &Value, name: &str) -> f64 {
    object["metrics"][name]["value"].as_f64().unwrap_or_else(|| panic!("{name}: {object}"))
}

/// A block compressed by the strain `e = e_T t / T` with its sides constrained. The shear response relaxes,
/// the volumetric response does not:
///
/// ```text
/// s(t) = (e_T / T) (K t + 4/3 mu integral_0^t g),   W = V (e_T / T) integral_0^T s
/// ```
#[test]
fn held_tissue_relaxes_as_its_series_says() {
    let young = 20e3;
    let poisson = 0.3;
    let duration = 2.0;
    let strain = -0.05;
    let series = [(0.4, 0.3), (0.2, 5.0)];
    let text = r#"title = "A block that is squeezed slowly"
body = { shape = "box", size = ["40 mm", "40 mm", "20 mm"] }
material = { law = "linear", young = "20 kPa", poisson = 0.3, prony = [{ g = 0.4, tau = "0.3 s" }, { g = 0.2, tau = "5 s" }] }
support = [
    { on = ["x-min", "x-max"], fix = "x" },
    { on = ["y-min", "y-max"], fix = "y" },
    { on = "z-min", fix = "z" },
    { on = "z-max", move = { z = "-1 mm" } },
]
procedure = { kind = "implicit-dynamic", inertia = false, duration = "2 s", steps = 100 }
method = [
    { id = "hex8", family = "fem", element = "hex8", size = { cells = [2, 2, 1] } },
    { id = "tet10-p1", family = "fem", element = "tet10", dilation = "mixed", size = { cells = [2, 2, 1] } },
]
output = { probes = [["20 mm", "20 mm", "10 mm"]] }
"#;
    let mu = young / (2.0 * (1.0 + poisson));
    let bulk = young / (3.0 * (1.0 - 2.0 * poisson));
    let (volume, rate): (f64, f64) = (0.04 * 0.04 * 0.02, strain / duration);
    let work = |t: f64| {
        let relaxed = 1.0 - series.iter().map(|(g, _)| g).sum::<f64>();
        let twice: f64 =
            series.iter().map(|(g, tau)| g * tau * (t - tau * (1.0 - (-t / tau).exp()))).sum::<f64>();
        volume * rate * rate * (0.5 * bulk * t * t + 4.0 / 3.0 * mu * (0.5 * relaxed * t * t + twice))
    };
    let (done, told) = run(text);
    assert_eq!(done.code, 0, "{}", done.stderr);
    for object in &told {
        let states = object["steps"].as_array().unwrap();
        assert_eq!(states.len(), 100);
        for k in [9, 49, 99] {
            let of = |name: &str| states[k]["metrics"][name]["value"].as_f64().unwrap();
            let (t, found) = (of("time"), of("internal-work"));
            assert!(states[k]["strain_energy"].is_null());
            assert!((t - 0.02 * (k + 1) as f64).abs() < 1e-12);
            // The work is summed by the trapezoidal rule, whose error is of second order in the step.
            assert!((found / work(t) - 1.0).abs() < 2e-3 / (k as f64), "{k}: {found:e} {:e}", work(t));
            assert!((of("work-on-body") / found - 1.0).abs() < 1e-6);
            assert_eq!(of("kinetic-energy"), 0.0);
        }
        // The strain history is not followed at a probe: its stress is unknown, its displacement is known.
        assert!(object["probes"][0]["stress"].is_null() && metric(object, "time-steps") == 100.0);
        assert!((object["probes"][0]["u"][2].as_f64().unwrap() + 0.5e-3).abs() < 1e-9);
    }
}

#[test]
fn implicit_and_explicit_dynamics_agree() {
    // The motion is so slow that lumped and consistent mass make no difference.
    let explicit = moving(PRESSED).replace("20 ms", "200 ms");
    let with = |procedure: &str| {
        explicit.replace("kind = \"explicit\", duration = \"200 ms\", steps = 4", procedure)
    };
    let (done, fine) = run(&explicit);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let implicit = "kind = \"implicit-dynamic\", duration = \"200 ms\", steps = 400";
    let (done, told) = run(&with(implicit));
    assert_eq!(done.code, 0, "{}", done.stderr);
    for (a, b) in told.iter().zip(&fine) {
        assert_eq!((&a["status"], &a["method"]), (&"ok".into(), &b["method"]));
        // Without damping, explicit contact oscillates by a hundredth of the closure.
        for (name, allowed) in [("max-z", 2e-2), ("strain-energy", 2e-2), ("closure", 1e-9)] {
            let (found, expected) = (metric(a, name), metric(b, name));
            assert!((found / expected - 1.0).abs() < allowed, "{name}: {found} {expected}");
        }
        assert!(metric(a, "residual") < 1e-8);
        let at = |object: &Value, k: usize, name: &str| {
            object["steps"][k]["metrics"][name]["value"].as_f64().unwrap()
        };
        assert!((at(a, 399, "time") - at(b, 3, "time")).abs() < 1e-15);
        assert!(at(a, 399, "kinetic-energy") > 0.0);
        let (lost, given) = (at(a, 399, "scheme-dissipation"), at(a, 399, "work-on-body"));
        assert!(lost.abs() < 1e-2 * given, "{lost:e} of {given:e}");
        assert!(metric(a, "step-error") > 0.0 && metric(a, "time-steps") >= 400.0);
        assert!(a["work"]["mass_nodes"].as_f64().unwrap() > 0.0 && a["phases"]["element-step"].is_null());
    }
    // A cloud and elements with a pressure field can be integrated too.
    let all = PRESSED.replace("poisson = 0.45", "poisson = 0.45, density = \"1000 kg/m^3\"").replace(
        "kind = \"static\", steps = 2",
        "kind = \"implicit-dynamic\", duration = \"20 ms\", steps = 20, damping = \"20 /s\"",
    );
    let (done, told) = run(&all);
    assert_eq!((done.code, told.len()), (0, 5), "{}", done.stderr);
    let force = metric(&told[0], "tool-force");
    for object in &told {
        assert!((metric(object, "tool-force") / force - 1.0).abs() < 0.1, "{}", object["method"]);
        let damped = object["steps"][19]["metrics"]["damping-dissipation"]["value"].as_f64().unwrap();
        assert!(damped > 0.0);
    }
}

#[test]
fn a_motion_that_ends_early_keeps_its_steps() {
    let text = BLOCK
        .replace("law = \"linear\"", "law = \"saint-venant-kirchhoff\", density = \"1000 kg/m^3\"")
        .replace("1 kPa", "200 kPa");
    let text =
        format!("{text}procedure = {{ kind = \"implicit-dynamic\", duration = \"50 ms\", steps = 50 }}\n");
    let (done, told) = run(&text);
    assert_fails(&done, 3, "key 'method[0]'");
    assert_fails(&done, 3, "stopped at ");
    assert_eq!(told[0]["status"], "stalled");
    let states = told[0]["steps"].as_array().unwrap().len();
    assert!(states > 0 && states < 50, "{states}");
    assert!(metric(&told[0], "load-carried") >= states as f64 / 50.0 - 1e-12);
}

#[test]
fn bad_scenes_in_time_name_the_key() {
    let good = format!(
        "{}procedure = {{ kind = \"implicit-dynamic\", duration = \"1 s\", steps = 2 }}\n",
        BLOCK.replace("poisson = 0.3", "poisson = 0.3, density = \"1000 kg/m^3\"")
    );
    assert_eq!(run(&good).0.code, 0);
    let dir = tempfile::tempdir().unwrap();
    for (from, to, code, says) in [
        (", density = \"1000 kg/m^3\"", "", 2, "'material.density': is missing"),
        ("duration = \"1 s\", ", "", 2, "'procedure.duration': is missing"),
        (
            "steps = 2",
            "steps = 2, spectral_radius = 1.5",
            2,
            "'procedure.spectral_radius': '1.5' is not in [0, 1]",
        ),
        ("steps = 2", "steps = 2, alpha = -0.5", 2, "'procedure.alpha': '-0.5' is not in [-1/3, 0]"),
        (
            "steps = 2",
            "steps = 2, alpha = 0, spectral_radius = 1",
            2,
            "'procedure.alpha': '0' has a spectral radius of its own",
        ),
        ("steps = 2", "steps = 2, accuracy = 0.1", 2, "'procedure.accuracy': '0.1' has no unit"),
        ("steps = 2", "steps = 2, accuracy = \"0 mm\"", 2, "'procedure.accuracy'"),
        ("steps = 2", "steps = 2, safety = 0.5", 2, "it goes with explicit"),
        ("steps = 2", "steps = 2, on_stall = \"relax\"", 2, "it goes with static"),
        (
            "steps = 2",
            "steps = 2, inertia = false, damping = \"5 /s\"",
            2,
            "'procedure.damping': '5 /s' is of a motion, and inertia = false has none",
        ),
        (
            "\"implicit-dynamic\", duration = \"1 s\"",
            "\"static\", inertia = true",
            2,
            "it goes with implicit-dynamic",
        ),
    ] {
        assert!(good.contains(from), "{from}");
        let path = write(&dir, "bad.toml", &good.replace(from, to));
        assert_fails(&tissuebench(&["run", &path]), code, says);
    }
    // If steps may be arbitrarily short, only an accuracy below rounding cannot be reached.
    let exact = good.replace("steps = 2", "steps = 2, accuracy = \"1e-30 mm\"");
    assert_fails(&tissuebench(&["run", &write(&dir, "exact.toml", &exact)]), 3, "key 'procedure.accuracy'");
    let close = |more: &str| {
        let text =
            good.replace("duration = \"1 s\", steps = 2", &format!("duration = \"50 ms\", steps = 2{more}"));
        metric(&run(&text).1[0], "time-steps")
    };
    assert!(close("") == 2.0 && close(", accuracy = \"1e-3 mm\"") > 20.0);
    // Without inertia, no density is needed.
    let still =
        good.replace(", density = \"1000 kg/m^3\"", "").replace("steps = 2", "steps = 2, inertia = false");
    assert_eq!(run(&still).0.code, 0);
    let touched = moving(PRESSED).replace("\"explicit\"", "\"implicit-dynamic\"");
    let path = write(&dir, "mean.toml", &touched.replace("steps = 4", "steps = 4, spectral_radius = 0.5"));
    assert_fails(
        &tissuebench(&["run", &path]),
        3,
        "'procedure.spectral_radius': '0.5' a spectral radius above 0 with tools",
    );
    let ramps = touched.replace("closure = \"1 mm\"", "closure = \"1 mm\", over = \"10 ms\"");
    let path = write(&dir, "ramps.toml", &ramps);
    assert_fails(&tissuebench(&["run", &path]), 3, "'tool[1].drive.over'");
}
