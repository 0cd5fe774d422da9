//! Number of findings in a file, and messages about parts or files that are missing.

use tissuebench_cases::scene::parse;

use crate::{SCENE, edited};

#[test]
fn one_mistake_gives_one_message() {
    for (from, to) in [
        ("young = \"20 kPa\"", "young = 20"),
        ("fix = \"xyz\"", "fix = \"abc\""),
        ("nodes = 83", "nodes = 0"),
        ("curvature = \"0.5 /m\"", "curvature = 1"),
    ] {
        let errors = parse(&edited(from, to), "s.toml").expect_err(to);
        assert_eq!(errors.len(), 1, "{errors:?}");
    }
}

#[test]
fn only_half_a_kidney_is_graded() {
    let body = &SCENE[SCENE.find("[body]").expect("body")..SCENE.find("[material]").expect("material")];
    let text = edited(body, "[body]\nshape = \"kidney\"\nmildly_graded = true\n");
    let errors = parse(&text, "s.toml").expect_err("a whole kidney");
    let graded = errors.iter().find(|e| e.key == "body.mildly_graded").expect("refused");
    assert_eq!(graded.problem, "applies to the half only");
}

#[test]
fn all_mistakes_of_a_file_are_told_in_the_order_of_its_lines() {
    let text = edited("young = \"20 kPa\"", "young = 20\ncolour = 1").replace("fix = \"xyz\"", "fix = 3");
    let errors = parse(&text, "s.toml").expect_err("three mistakes");
    let keys: Vec<&str> = errors.iter().map(|e| e.key.as_str()).collect();
    assert_eq!(keys, ["material.young", "material.colour", "support[0].fix"]);
}

#[test]
fn a_mistake_in_one_part_hides_none_in_another() {
    let beside = |text: String| {
        let text = text.replace("where = \"z == 0 mm\"", "on = \"zmin\"");
        let errors = parse(&text, "s.toml").expect_err("several mistakes");
        errors.into_iter().map(|e| e.key).collect::<Vec<_>>()
    };
    // A number out of range, a number without unit, an unknown key.
    assert_eq!(beside(edited("poisson = 0.45", "poisson = 0.7")), ["material.poisson", "support[0].on"]);
    assert_eq!(beside(edited("young = \"20 kPa\"", "young = 20")), ["material.young", "support[0].on"]);
    let shared = edited("poisson = 0.45", "poisson = 0.7").replace("element = \"tet4\"", "elemen = \"tet4\"");
    assert_eq!(beside(shared), ["material.poisson", "support[0].on", "method[0].elemen"]);
}

#[test]
fn parts_that_are_missing_altogether_are_told() {
    for (text, key) in [("", "title"), ("", "body"), ("", "material"), ("title = \"t\"", "body")] {
        let errors = parse(text, "s.toml").expect_err("no scene");
        assert!(errors.iter().any(|e| e.key == key && e.line == 1), "{key}: {errors:?}");
    }
    let cut = &SCENE[..SCENE.find("[[method]]").expect("methods")];
    let errors = parse(cut, "s.toml").expect_err("no method");
    assert!(errors[0].to_string().contains("key 'method': is missing; add a [[method]]"), "{}", errors[0]);
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let errors = tissuebench_cases::scene::load(std::path::Path::new("no/such.toml")).expect_err("no file");
    assert_eq!(errors[0].to_string(), "no/such.toml: can't be read: there is no such file");
}

#[test]
fn a_mesh_file_is_no_scene() {
    let mesh = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/kidney/kidney-1331.msh");
    let errors = tissuebench_cases::scene::load(std::path::Path::new(mesh)).expect_err("a mesh");
    assert!(errors[0].to_string().contains("is a mesh file, not a scene; a scene names it"), "{}", errors[0]);
}
