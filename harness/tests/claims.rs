//! Published claims, checked against results.

mod common;

use common::{assert_fails, inside, tissuebench, write};

const BALL: &str = r#"title = "A thick sphere under internal pressure"
body = { shape = "sphere-shell", inner = "10 mm", outer = "20 mm", octant = true }
material = { law = "linear", young = "20 kPa", poisson = 0.3 }
support = [{ on = "x-min", fix = "x" }, { on = "y-min", fix = "y" }, { on = "z-min", fix = "z" }]
load = [{ on = "inner", pressure = "2 kPa" }]
reference = { exact = "thick-sphere", inner = "10 mm", outer = "20 mm", inner_pressure = "2 kPa" }
method = [
    { id = "tet4", family = "fem", element = "tet4", size = { level = 1 } },
    { id = "hex20", family = "fem", element = "hex20", size = { level = 1 } },
]
"#;

const CLAIM: &str = r#"[[claim]]
id = "quadratic"
source = "every textbook"
says = "quadratic hexahedra are a tenth as far off as linear tetrahedra of as many cells"
scenes = ["ball"]
left = { methods = ["hex20"] }
right = { family = "fem", methods = ["tet4"] }
relation = [{ kind = "error-ratio", error = "l2", at_most = 0.1 }]
"#;

#[test]
fn a_claim_is_judged_by_runs() {
    let dir = tempfile::tempdir().unwrap();
    let scene = write(&dir, "ball.toml", BALL);
    let results = inside(&dir, "results");
    let done = tissuebench(&["run", &scene, "--once", "--out", &results]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let judge = |text: &str| tissuebench(&["claims", &results, "--file", &write(&dir, "claims.toml", text)]);
    let done = judge(CLAIM);
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert!(done.stdout.starts_with("validated: quadratic: quadratic hexahedra"), "{}", done.stdout);
    assert!(done.stdout.contains("  ball: relative L2 error: the best hex20 run has"), "{}", done.stdout);
    let expected = CLAIM.replace("scenes", "expect = \"refuted\"\nscenes");
    assert_fails(&judge(&expected), 1, "quadratic: refuted was expected");
    let refuted = judge(&expected.replace("at_most = 0.1", "at_most = 1e-9"));
    assert!(refuted.code == 0 && refuted.stdout.starts_with("refuted: "), "{}", refuted.stdout);
    let untested = judge(&CLAIM.replace("\"ball\"", "\"cube\""));
    assert!(untested.code == 4 && untested.stdout.starts_with("untested: "), "{}", untested.stdout);
    assert_fails(&judge(&CLAIM.replace("at_most", "most")), 2, "claims.toml");
    let own = tissuebench(&["claims", &results]);
    assert!(own.code == 4 && own.stdout.starts_with("untested: saghaei-2016: "), "{}", own.stdout);
}

#[test]
fn the_claims_of_the_project_name_scenes_that_there_are() {
    for scene in reports::own_claims().iter().flat_map(|claim| &claim.scenes) {
        common::cases(&format!("{scene}.toml"));
    }
}
