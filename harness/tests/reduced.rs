//! Reduced models: their errors fall with their modes, sampled cells give the forces of all, what they cannot
//! do is refused, and a run says how far it is from its training.

mod common;

use common::{assert_fails, inside, objects, tissuebench, write};
use serde_json::Value;

/// A ball on a block, at a place between those of the training.
const BALL: &str = r#"title = "A ball on a block"
body = { shape = "box", size = ["40 mm", "40 mm", "20 mm"] }
material = { law = "neo-hookean", young = "20 kPa", poisson = 0.45 }
support = [{ on = "z-min", fix = "xyz" }]
procedure = { kind = "static", steps = 5 }
output = { probes = [["20 mm", "20 mm", "10 mm"]] }
reference = { method = "full" }
tool = [{ name = "ball", shape = "sphere", radius = "10 mm", at = ["20 mm", "20 mm", "30 mm"], along = [0, 0, -1], drive = { closure = "2 mm" }, penalty = "0.1 MPa/mm" }]
method = [
    { id = "full", family = "fem", element = "hex8", dilation = "element-mean", size = { cells = [6, 6, 3] } },
    { id = "four", family = "fem", element = "hex8", dilation = "element-mean", size = { cells = [6, 6, 3] }, pod = { modes = 4 } },
    { id = "sixteen", family = "fem", element = "hex8", dilation = "element-mean", size = { cells = [6, 6, 3] }, pod = { modes = 16 } },
    { id = "sampled", family = "fem", element = "hex8", dilation = "element-mean", size = { cells = [6, 6, 3] }, pod = { modes = 8, cells = "40 %" } },
    { id = "all", family = "fem", element = "hex8", dilation = "element-mean", size = { cells = [6, 6, 3] }, pod = { modes = 8 } },
]

[[training]]
"tool[0].at" = ["18 mm", "18 mm", "30 mm"]

[[training]]
"tool[0].at" = ["22 mm", "18 mm", "30 mm"]

[[training]]
"tool[0].at" = ["18 mm", "22 mm", "30 mm"]

[[training]]
"tool[0].at" = ["22 mm", "22 mm", "30 mm"]
"#;

fn runs(text: &str, options: &[&str]) -> Vec<Value> {
    let dir = tempfile::tempdir().unwrap();
    let scene = write(&dir, "ball.toml", text);
    let done = tissuebench(&[&["run", &scene, "--once", "--format", "json"], options].concat());
    assert_eq!(done.code, 0, "{}", done.stderr);
    objects(&done.stdout)
}

fn number(of: &Value, metric: &str) -> f64 {
    of["metrics"][metric]["value"].as_f64().unwrap_or_else(|| panic!("no {metric} in {of}"))
}

/// A block held at one end shortens along its fibres, most at half of the path. Nothing pulls at its other
/// end.
const MUSCLE: &str = r#"title = "A contracting block"
body = { shape = "box", size = ["30 mm", "10 mm", "10 mm"] }
material = { law = "neo-hookean", young = "20 kPa", poisson = 0.3, fibers = [1, 0, 0], active = "4 kPa", active_curve = "twitch" }
curve = [{ name = "twitch", part = [0.0, 0.5, 1.0], factor = [0.0, 1.0, 0.5] }]
support = [{ on = "x-min", fix = "xyz" }, { on = "z-min", fix = "z" }]
procedure = { kind = "static", steps = 4 }
method = [
    { id = "sampled", family = "fem", element = "hex8", dilation = "element-mean", size = { cells = [6, 3, 3] }, pod = { modes = 4, cells = "30 %" } },
]

[[training]]
material.active = "2 kPa"

[[training]]
material.active = "5 kPa"
"#;

#[test]
fn a_sampled_muscle_has_the_active_stress_of_its_time() {
    let [run] = &runs(MUSCLE, &[])[..] else { panic!("one run") };
    assert!(number(run, "sampled-cells") < 0.5, "all cells are chosen");
    // The active force is 0.2 N at the end. With the full active stress in the cells that are not chosen, the
    // support had a fifth of it.
    let force = number(run, "reaction-x");
    assert!(force.abs() < 2e-3, "{force} N");
    assert!(number(run, "sampling-error") < 0.02, "{run}");
}

#[test]
fn errors_fall_with_the_modes_and_sampled_cells_give_the_forces_of_all() {
    let runs = runs(BALL, &[]);
    let of = |id: &str| runs.iter().find(|run| run["method"] == id).unwrap();
    let error = |id: &str| [number(of(id), "relative-rms"), number(of(id), "tool-force-error")];
    let [few, many] = [error("four"), error("sixteen")];
    assert!(few[0] > many[0] && few[1] > 2.0 * many[1], "{few:?} {many:?}");
    assert!(many[0] < 0.02 && many[1] < 0.001, "{many:?}");
    let [all, some] = ["all", "sampled"].map(of);
    assert_eq!(number(all, "sampled-cells"), 1.0);
    assert!(number(some, "sampled-cells") <= 0.4 && number(some, "sampling-error") < 0.02, "{some}");
    let force = |run: &Value| number(run, "tool-force");
    assert!((force(some) / force(all) - 1.0).abs() < 0.01, "{} for {}", force(some), force(all));
    // The support carries the force of the tool, but for what the modes leave unbalanced.
    for run in [all, some] {
        assert!((number(run, "reaction-z") / force(run) - 1.0).abs() < 0.04, "{run}");
        let distance = number(run, "training-distance");
        assert!(distance > 0.01 && distance < 0.6, "{distance}");
    }
    assert!(of("full")["metrics"]["training-distance"].is_null());
}

#[test]
fn what_was_trained_is_near_and_what_was_not_is_far() {
    let at = |place: &str| {
        let text = BALL.replace("at = [\"20 mm\", \"20 mm\"", &format!("at = [{place}"));
        number(&runs(&text, &["--method", "sixteen"])[0], "training-distance")
    };
    let [trained, between, outside] =
        ["\"18 mm\", \"22 mm\"", "\"20 mm\", \"21 mm\"", "\"10 mm\", \"28 mm\""].map(at);
    assert!(
        trained < 1e-3 && between > 10.0 * trained && outside > 1.5 * between,
        "{trained} {between} {outside}"
    );
}

#[test]
fn it_has_the_same_bits_on_any_number_of_threads() {
    let of = |threads: &str| {
        let run = &runs(BALL, &["--method", "sampled", "--threads", threads])[0];
        ["tool-force", "relative-rms", "sampling-error"].map(|metric| number(run, metric).to_bits())
    };
    assert_eq!(of("1"), of("2"));
}

#[test]
fn what_it_cannot_do_is_refused_at_its_key() {
    let refused = |from: &str, to: &str, key: &str, says: &str| {
        let text = BALL.replacen(from, to, 1);
        assert_ne!(text, BALL, "{from}");
        let dir = tempfile::tempdir().unwrap();
        let done = tissuebench(&["run", &write(&dir, "ball.toml", &text)]);
        assert_fails(&done, 2, key);
        assert_fails(&done, 2, says);
    };
    let training = &BALL[BALL.find("\n[[training]]").unwrap()..];
    refused(training, "", "method[1].pod", "learns from nothing");
    refused("pod = { modes = 4 }", "pod = { modes = 0 }", "method[1].pod.modes", "give 1 to 500");
    refused("cells = \"40 %\"", "cells = \"140 %\"", "method[3].pod.cells", "at most \"100 %\"");
    refused(
        "kind = \"static\", steps = 5",
        "kind = \"implicit-dynamic\", duration = \"1 s\", steps = 5",
        "method[1].pod",
        "static",
    );
    refused("fix = \"xyz\"", "fix = \"xy\", move = { z = \"1 mm\" }", "method[1].pod", "support[0]");
    refused("output = {", "output = { estimate = true,", "method[1].pod", "error estimate");
    refused("\"tool[0].at\"", "\"body.size\"", "training[0].body.size", "does not belong to a training run");
    refused("\"tool[0].at\"", "\"tool[3].at\"", "tool[3].at", "out of range");
    refused("[\"18 mm\", \"18 mm\", \"30 mm\"]", "[\"18 mm\", \"18 s\", \"30 mm\"]", "tool[0].at", "18 s");
    let mixed =
        "element = \"tet10\", dilation = \"mixed\", size = { cells = [6, 6, 3] }, pod = { modes = 4 }";
    let four =
        "element = \"hex8\", dilation = \"element-mean\", size = { cells = [6, 6, 3] }, pod = { modes = 4 }";
    refused(four, mixed, "method[1].pod", "pressure field");
    let nodal = "element = \"tet4\", dilation = \"nodal-mean\", size = { cells = [6, 6, 3] }, pod = { modes = 8, cells = \"40 %\" }";
    let eight = "element = \"hex8\", dilation = \"element-mean\", size = { cells = [6, 6, 3] }, pod = { modes = 8, cells = \"40 %\" }";
    refused(eight, nodal, "method[3].pod.cells", "share dilations");
    let pods = [
        ", pod = { modes = 4 }",
        ", pod = { modes = 16 }",
        ", pod = { modes = 8, cells = \"40 %\" }",
        ", pod = { modes = 8 }",
    ];
    let without = pods.iter().fold(BALL.to_string(), |text, pod| text.replace(pod, ""));
    let dir = tempfile::tempdir().unwrap();
    assert_fails(&tissuebench(&["run", &write(&dir, "ball.toml", &without)]), 2, "trains nothing");
}

/// Found when the training has been run: this method fails, and the others go on.
#[test]
fn more_modes_than_states_and_training_that_fails_are_told() {
    let dir = tempfile::tempdir().unwrap();
    let text = BALL.replacen("modes = 4 ", "modes = 40 ", 1);
    let done = tissuebench(&["run", &write(&dir, "ball.toml", &text), "--method", "four", "--method", "all"]);
    assert_fails(&done, 3, "20 states of the training are combinations of");
    assert!(done.stderr.contains("ball.toml") && done.stderr.contains("pod.modes"), "{}", done.stderr);
    let deep = BALL.replacen("\"tool[0].at\"", "\"tool[0].drive.closure\" = \"19 mm\"\n\"tool[0].at\"", 1);
    let scene = inside(&dir, "deep.toml");
    std::fs::write(&scene, deep).unwrap();
    let done = tissuebench(&["run", &scene, "--method", "four"]);
    assert_fails(&done, 3, "training[0]");
    assert_fails(&done, 3, "can't be run to its end");
}
