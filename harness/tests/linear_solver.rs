//! Solvers of a linear procedure: their choice, their names in the plan, requests, and refusals.

mod common;

use common::{BLOCK, PRESSED, assert_fails, objects, tissuebench, write};
use serde_json::Value;

/// [`BLOCK`] with elements of each kind and a cloud, by this solver.
fn block(solver: &str) -> String {
    let methods = r#"method = [
    { id = "tet4", family = "fem", element = "tet4", size = { cells = [8, 8, 6] } },
    { id = "tet10", family = "fem", element = "tet10", size = { cells = [5, 5, 3] } },
    { id = "hex8-mean", family = "fem", element = "hex8", dilation = "element-mean", size = { cells = [8, 8, 6] } },
    { id = "hex20", family = "fem", element = "hex20", size = { cells = [5, 5, 3] } },
    { id = "efg", family = "efg", size = { cells = [8, 8, 5] }, kernel = "cubic-spline", support_scale = 1.6, basis = "linear", integration = { rule = "cell-smoothed" }, essential = "nitsche" },
]"#;
    let first = BLOCK.lines().filter(|line| !line.starts_with("method"));
    let text: String = first.map(|line| format!("{line}\n")).collect();
    format!(
        "{text}procedure = {{ kind = \"linear\", linear_solver = \"{solver}\" }}\n{methods}\noutput = {{ probes = [[\"20 mm\", \"20 mm\", \"20 mm\"]] }}\n"
    )
}

fn run(text: &str) -> Vec<Value> {
    let dir = tempfile::tempdir().unwrap();
    let done = tissuebench(&["run", &write(&dir, "block.toml", text), "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    objects(&done.stdout)
}

fn metric(run: &Value, name: &str) -> Option<f64> {
    run["metrics"][name]["value"].as_f64()
}

fn factorisation(run: &Value) -> &str {
    let stages = run["plan"].as_array().unwrap();
    stages.iter().find(|stage| stage["stage"] == "factorisation").unwrap()["why"].as_str().unwrap()
}

#[test]
fn iterations_that_are_asked_for_come_to_what_a_factor_gives() {
    let (iterated, factored) = (run(&block("amg")), run(&block("direct")));
    assert_eq!(iterated.len(), 5);
    for (a, b) in iterated.iter().zip(&factored) {
        assert_eq!(a["linear_solver"], "multigrid", "{a}");
        assert_eq!(factorisation(a), "multigrid levels for conjugate gradients (requested)");
        assert_eq!(factorisation(b), "one, for all load levels (requested)");
        let count = metric(a, "linear-iterations").unwrap();
        // The parameters of a cloud are not displacements, and rough parameter fields are nearly as soft as
        // smooth parameter fields.
        let most = if a["method"] == "efg" { 250.0 } else { 25.0 };
        assert!((5.0..=most).contains(&count), "{count} iterations: {a}");
        assert!(metric(a, "operator-complexity").is_some_and(|c| c > 1.0 && c < 2.5), "{a}");
        assert!(metric(b, "linear-iterations").is_none());
        for name in ["max", "strain-energy"] {
            let (a, b) = (metric(a, name).unwrap(), metric(b, name).unwrap());
            assert!((a - b).abs() < 1e-6 * b, "{name}: {a} and {b}");
        }
        assert!(metric(a, "residual").unwrap() <= 1e-8);
    }
}

#[test]
fn the_plan_says_which_and_why() {
    let small = run(&block("auto"));
    assert_eq!(small[0]["linear_solver"], "sparse-llt");
    let said = "one, for all load levels (1701 unknowns; iterative solution from 2000 for this shape at lambda / mu = 1.500)";
    assert_eq!(factorisation(&small[0]), said);
    let large = block("auto").replace("[8, 8, 6]", "[22, 22, 22]");
    let dir = tempfile::tempdir().unwrap();
    let args = ["run", &write(&dir, "block.toml", &large), "--format", "json", "--method", "tet4"];
    let large = &objects(&tissuebench(&args).stdout)[0];
    assert_eq!(large["linear_solver"], "multigrid", "{large}");
    let said = "multigrid levels for conjugate gradients (36501 unknowns; iterative solution from 2000 for this shape at \
                lambda / mu = 1.500)";
    assert_eq!(factorisation(large), said);
    // Clouds are iterated later, because their levels are more expensive.
    let cloud = block("auto").replace("size = { cells = [8, 8, 5] }", "size = { cells = [17, 17, 13] }");
    let args = ["run", &write(&dir, "cloud.toml", &cloud), "--format", "json", "--method", "efg"];
    let cloud = &objects(&tissuebench(&args).stdout)[0];
    assert_eq!(cloud["linear_solver"], "multigrid", "{cloud}");
    let said = "multigrid levels for conjugate gradients (13608 unknowns; iterative solution from 8980 for this shape at \
                lambda / mu = 1.500)";
    assert_eq!(factorisation(cloud), said);
    let wide = block("auto").replace("support_scale = 1.6", "support_scale = 2.0");
    let said = "one, for all load levels (the supports of the cloud are too wide for iterations)";
    assert_eq!(factorisation(run(&wide).last().unwrap()), said);
    // A nearly incompressible body takes so many iterations that a small one is factored.
    let stiff = block("auto").replace("[8, 8, 6]", "[18, 18, 18]").replace("poisson = 0.3", "poisson = 0.49");
    let plan = tissuebench(&["plan", &write(&dir, "stiff.toml", &stiff), "--method", "tet4"]).stdout;
    assert!(plan.contains("for this shape at lambda / mu = 49.000"), "{plan}");
}

#[test]
fn nearly_incompressible_elements_that_share_dilations_are_iterated_with_pressures() {
    let stiff = |solver: &str| block(solver).replace("poisson = 0.3", "poisson = 0.4999");
    let dir = tempfile::tempdir().unwrap();
    let of = |solver: &str| {
        let scene = write(&dir, "block.toml", &stiff(solver));
        let done = tissuebench(&["run", &scene, "--format", "json", "--method", "hex8-mean"]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        objects(&done.stdout).remove(0)
    };
    let (iterated, factored) = (of("amg"), of("direct"));
    assert_eq!(iterated["linear_solver"], "multigrid-pressures", "{iterated}");
    assert_eq!(factorisation(&iterated), "multigrid levels for displacements and pressures (requested)");
    for name in ["max", "strain-energy"] {
        let (a, b) = (metric(&iterated, name).unwrap(), metric(&factored, name).unwrap());
        assert!((a - b).abs() < 1e-7 * b, "{name}: {a} and {b}");
    }
    assert!(metric(&iterated, "residual").unwrap() <= 1e-8);
    // Small systems are factored.
    assert_eq!(of("auto")["linear_solver"], "sparse-llt");
}

/// In the Euclidean norm of the residual, iterations with pressures stand still on such bodies: at 1.06 on
/// the kidney, at 1e-5 on the beam.
#[test]
fn pressures_converge_on_curved_and_long_bodies() {
    let kidney = (r#"body = { shape = "kidney" }"#, r#"where = "y >= 30 mm""#, "level = 3");
    let beam = (
        r#"body = { shape = "box", size = ["10 mm", "10 mm", "100 mm"] }"#,
        r#"on = "z-min""#,
        "cells = [7, 7, 70]",
    );
    for ((body, support, size), most) in [(kidney, 80.0), (beam, 60.0)] {
        let text = format!(
            r#"title = "Pressures"
methods_from = "{}/../cases/methods.toml"
{body}
material = {{ law = "linear", young = "20 kPa", poisson = 0.495 }}
support = [{{ {support}, fix = "xyz" }}]
load = [{{ body = ["0 N/m^3", "0 N/m^3", "-100 N/m^3"] }}]
procedure = {{ kind = "linear", linear_solver = "amg" }}
method = [{{ use = "hex8-mean", size = {{ {size} }} }}]
"#,
            env!("CARGO_MANIFEST_DIR")
        );
        let dir = tempfile::tempdir().unwrap();
        let done = tissuebench(&["run", &write(&dir, "body.toml", &text), "--format", "json"]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        let found = &objects(&done.stdout)[0];
        assert_eq!(found["linear_solver"], "multigrid-pressures");
        assert!(metric(found, "linear-iterations").unwrap() <= most, "{found}");
    }
}

#[test]
fn large_tangents_of_elements_are_iterated_and_others_factored() {
    let dir = tempfile::tempdir().unwrap();
    let text = PRESSED
        .replace("\"hex8\", size = { cells = [2, 2, 1] }", "\"hex8\", size = { cells = [20, 20, 10] }");
    let text = text.replace("steps = 2", "steps = 1");
    let args = ["run", &write(&dir, "large.toml", &text), "--method", "hex8", "--format", "json"];
    let done = tissuebench(&args);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let large = &objects(&done.stdout)[0];
    assert_eq!(large["linear_solver"], "multigrid", "{large}");
    let said = "multigrid levels, each for several iterations, and a factor where they do not converge (14553 \
                unknowns; iterative solution from 11225 for this shape)";
    assert_eq!(factorisation(large), said);
    let count = |name: &str| large["work"][name].as_u64().unwrap();
    assert!(count("factorisations") < count("assemblies") && count("inner_iterations") > 0, "{large}");
    let forced = text.replace("closure = \"2 mm\"", "force = \"1 N\"");
    let plan = tissuebench(&["plan", &write(&dir, "forced.toml", &forced), "--method", "hex8"]).stdout;
    assert!(plan.contains("one for each iteration, analysed once"), "{plan}");
}

#[test]
fn constraint_rows_are_not_for_iterations() {
    let dir = tempfile::tempdir().unwrap();
    let text = block("amg").replace("\"nitsche\"", "\"multipliers\"");
    let done = tissuebench(&["run", &write(&dir, "block.toml", &text), "--method", "efg"]);
    assert_fails(
        &done,
        2,
        "block.toml:6: key 'procedure.linear_solver': 'amg' iterates over nodal parameters",
    );
    assert!(done.stderr.contains("essential = \"nitsche\""), "{}", done.stderr);
    let free = text.replace("\"amg\"", "\"auto\"");
    let done = tissuebench(&["run", &write(&dir, "free.toml", &free), "--method", "efg", "--format", "json"]);
    assert_eq!(factorisation(&objects(&done.stdout)[0]), "one, for all load levels (multipliers)");
    let wrong = block("cg");
    let done = tissuebench(&["run", &write(&dir, "wrong.toml", &wrong)]);
    assert_fails(&done, 2, "known here: auto, direct, amg");
}
