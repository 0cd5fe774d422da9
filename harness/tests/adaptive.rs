//! Errors traced to cells, and meshes refined until a number is accurate.

mod common;

use common::{assert_fails, number, solved, tissuebench, write};

/// A quarter of a cube under a bonded plate, whose edge is singular.
fn punch(poisson: f64, method: &str, output: &str) -> String {
    format!(
        r#"title = "A cube under a bonded plate, a quarter of it"
body = {{ shape = "box", size = ["1 m", "1 m", "1 m"] }}
material = {{ law = "linear", young = "1 Pa", poisson = {poisson} }}
procedure = {{ kind = "linear" }}
support = [
    {{ on = "z-min", fix = "xyz" }},
    {{ where = "z == 1 m and x <= 0.5 m and y <= 0.5 m", move = ["0 m", "0 m", "-0.1 m"] }},
    {{ on = "x-min", fix = "x" }},
    {{ on = "y-min", fix = "y" }},
]
output = {{ {output} }}
[[method]]
id = "m"
family = "fem"
{method}
"#
    )
}

const TET10: &str = r#"element = "tet10"
dilation = "element-mean"
size = { cells = [4, 4, 4] }
"#;

/// The refined mesh has a smaller error than an even mesh with seven times as many nodes. Graded meshes of hex20
/// give 0.0520 N at a Poisson's ratio of 0.3 by extrapolation.
#[test]
fn a_mesh_is_refined_until_its_force_is_accurate() {
    let dir = tempfile::tempdir().unwrap();
    let tet10 = TET10.replace("dilation = \"element-mean\"\n", "");
    let refine = format!("{tet10}refine = {{ by = \"reaction-z-2\", error = \"2 %\" }}");
    let found = solved(&dir, &punch(0.3, &refine, ""));
    let error = |found: &serde_json::Value| number(found, "reaction-z-2") / -0.0520 - 1.0;
    assert!(error(&found).abs() < 0.02, "{}", error(&found));
    assert!(number(&found, "remaining-error") <= 0.02);
    let nodes = |found: &serde_json::Value| found["nodes"].as_u64().unwrap();
    let even = solved(&dir, &punch(0.3, &tet10.replace("[4, 4, 4]", "[16, 16, 16]"), ""));
    assert!(error(&even) > 1.5 * error(&found).abs(), "{} {}", error(&even), error(&found));
    assert!(nodes(&found) * 3 < nodes(&even), "{} {}", nodes(&found), nodes(&even));
    let again = solved(&dir, &punch(0.3, &refine, ""));
    for metric in ["reaction-z-2", "remaining-error", "strain-energy"] {
        assert_eq!(number(&found, metric), number(&again, metric));
    }
}

/// At the edge of the plate half of the error comes from a small part of the cube.
#[test]
fn the_error_of_a_force_comes_from_the_edge_of_the_plate() {
    let dir = tempfile::tempdir().unwrap();
    let found = solved(&dir, &punch(0.495, TET10, r#"error_of = "reaction-z-2""#));
    let volume = number(&found, "error-volume");
    assert!(volume > 0.0 && volume < 0.05, "{volume}");
}

#[test]
fn meshes_that_are_not_accurate_after_all_rounds_are_warned_of() {
    let dir = tempfile::tempdir().unwrap();
    let refine = format!("{TET10}refine = {{ by = \"reaction-z-2\", error = \"0.01 %\", rounds = 2 }}");
    let found = solved(&dir, &punch(0.3, &refine, ""));
    let warned = found["warnings"].as_array().unwrap();
    assert!(warned.iter().any(|warning| warning["code"] == "not-accurate"), "{found}");
    assert_eq!(number(&found, "meshes"), 2.0);
}

#[test]
fn numbers_and_meshes_that_cannot_be_refined_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let refused = |method: &str, output: &str, why: &str| {
        let path = write(&dir, "scene.toml", &punch(0.3, method, output));
        assert_fails(&tissuebench(&["run", &path]), 2, why);
    };
    let by = |by: &str| format!("{TET10}refine = {{ by = \"{by}\", error = \"2 %\" }}");
    refused(&by("max"), "", "is not a number whose error can be traced");
    refused(&by("reaction"), "", "reaction");
    refused(&by("reaction-x-4"), "", "is a force along an axis that the support leaves free");
    refused(&by("tool-force"), "", "needs number 1 of [[tool]], but the scene has 0");
    refused(&by("reaction-z-9"), "", "needs number 9 of [[support]], but the scene has 4");
    refused(TET10, r#"error_of = "probe""#, "needs number 1 of output.probes");
    let hex8 = by("reaction-z-2").replace("tet10", "hex8");
    refused(&hex8, "", "applies to tet4 and tet10 only, not to hex8");
    refused(&by("reaction-z-2").replace("2 %", "200 %"), "", "is not between 0 and 100 %");
}
