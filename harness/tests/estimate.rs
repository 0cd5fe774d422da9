//! Estimated errors of runs.

mod common;

use common::{assert_fails, number, solved, tissuebench, write};

fn block(procedure: &str, rest: &str, output: &str) -> String {
    format!(
        r#"title = "A sheared block"
body = {{ shape = "box", size = ["20 mm", "20 mm", "20 mm"] }}
material = {{ law = "neo-hookean", young = "20 kPa", poisson = 0.3, density = "1000 kg/m^3" }}
procedure = {{ {procedure} }}
support = [{{ on = "z-min", fix = "xyz" }}, {{ on = "z-max", move = {{ x = "4 mm", y = "0 mm", z = "0 mm" }} {rest} }}]
{output}
[[method]]
id = "hex8"
family = "fem"
element = "hex8"
size = {{ cells = [3, 3, 3] }}
"#
    )
}

/// Predicted energy before its correction by a coarser mesh.
fn energy_before(found: &serde_json::Value) -> f64 {
    let own = number(found, "strain-energy");
    let saturation = number(found, "strain-energy-error-saturation");
    assert!(saturation < 0.5, "{saturation}");
    own - (own - number(found, "strain-energy-predicted")) * (1.0 - saturation)
}

/// The richer method is a method of its own: hex20 on the same cells, whose path ends in the predicted state.
#[test]
fn the_prediction_is_the_solution_of_quadratic_elements() {
    let dir = tempfile::tempdir().unwrap();
    let scene = block(r#"kind = "static", steps = 2"#, "", "output = { estimate = true }");
    let found = solved(&dir, &scene);
    let richer = scene.replace("element = \"hex8\"", "element = \"hex20\"\nreduced = true");
    let richer = solved(&dir, &richer.replace("estimate = true", "estimate = false"));
    let energy = number(&richer, "strain-energy");
    let (own, predicted) = (number(&found, "strain-energy"), energy_before(&found));
    assert!(own > 1.02 * energy && (predicted / energy - 1.0).abs() < 1e-6, "{predicted} {energy}");
    let force = |object: &serde_json::Value| number(object, "reaction-x-2");
    let error = (force(&found) / force(&richer) - 1.0).abs();
    let beyond = 1.0 - number(&found, "reaction-error-saturation-2");
    let estimate = beyond * number(&found, "reaction-error-estimate-2");
    assert!((estimate / error - 1.0).abs() < 0.1, "{error} {estimate}");
}

/// The richer elements are eighths of the cells with a pressure field.
#[test]
fn a_nearly_incompressible_body_is_estimated_from_its_pressure() {
    let dir = tempfile::tempdir().unwrap();
    let scene = block(r#"kind = "static", steps = 4"#, "", "output = { estimate = true }");
    let scene = scene.replace("poisson = 0.3", "poisson = 0.4999");
    let found = solved(&dir, &scene.replace("element = \"hex8\"", "element = \"hex20\"\nreduced = true"));
    let finer = scene.replace("[3, 3, 3]", "[6, 6, 6]").replace("estimate = true", "estimate = false");
    let finer = solved(&dir, &finer.replace("\"hex8\"\nsize", "\"hex20\"\ndilation = \"mixed\"\nsize"));
    let [predicted, energy] = [energy_before(&found), number(&finer, "strain-energy")];
    assert!((predicted / energy - 1.0).abs() < 1e-5, "{predicted} {energy}");
}

/// The bonded edges of a block are singular: half of the error of its energy is also that of quadratic
/// elements on the same cells. Extrapolation of tet10 on 4, 8 and 12 cells gives 5.680e-3 J.
#[test]
fn a_coarser_mesh_tells_what_quadratic_elements_do_not_see() {
    let dir = tempfile::tempdir().unwrap();
    let scene = r#"title = "A bonded block, a quarter of it"
body = { shape = "box", size = ["1 m", "1 m", "1 m"] }
material = { law = "linear", young = "1 Pa", poisson = 0.3 }
support = [
    { on = "z-min", fix = "xyz" },
    { on = "x-min", fix = "x" },
    { on = "y-min", fix = "y" },
    { on = "z-max", move = { x = "0 m", y = "0 m", z = "-0.1 m" } },
]
output = { estimate = true }
method = [{ id = "m", family = "fem", element = "hex8", dilation = "element-mean", size = { cells = [4, 4, 4] } }]
"#;
    let found = solved(&dir, scene);
    let error = number(&found, "strain-energy") / 5.680e-3 - 1.0;
    let before = number(&found, "strain-energy") / energy_before(&found) - 1.0;
    let estimate = number(&found, "strain-energy-error-estimate");
    assert!((0.4..0.6).contains(&(before / error)), "{before} {error}");
    assert!((0.8..1.2).contains(&(estimate / error)), "{estimate} {error}");
    let alone = solved(&dir, &scene.replace("[4, 4, 4]", "[1, 1, 1]"));
    let warned = alone["warnings"].as_array().unwrap();
    assert!(warned.iter().any(|warning| warning["code"] == "single-estimate"), "{alone}");
}

#[test]
fn only_bodies_at_rest_have_an_estimate() {
    let dir = tempfile::tempdir().unwrap();
    let scene = block(r#"kind = "explicit", duration = "1 s""#, "", "output = { estimate = true }");
    let path = write(&dir, "scene.toml", &scene);
    assert_fails(&tissuebench(&["run", &path]), 2, "output.estimate");
    let ends = block(r#"kind = "static", steps = 2"#, ", during = [0, 0.5]", "output = { estimate = true }");
    let path = write(&dir, "ends.toml", &ends);
    assert_fails(&tissuebench(&["run", &path]), 2, "is not available with supports of a part of the loading");
}

#[test]
fn a_plan_without_an_estimate_says_nothing_of_it() {
    let dir = tempfile::tempdir().unwrap();
    for estimate in [true, false] {
        let output = format!("output = {{ estimate = {estimate} }}");
        let path = write(&dir, "scene.toml", &block(r#"kind = "static", steps = 2"#, "", &output));
        let plan = tissuebench(&["plan", &path]).stdout;
        assert_eq!(plan.contains("error estimate"), estimate, "{plan}");
    }
}
