//! Surfaces that are repaired or wrapped: by `mesh make`, by scenes and by `init`.

mod common;

use common::implicit::{Triangle, Vector, ellipsoid, stl, triangles};
use common::{assert_fails, inside, tissuebench, write};
use serde_json::Value;

/// An ellipsoid about the origin.
fn egg(half: Vector) -> Vec<Triangle> {
    ball([0.0; 3], half)
}

fn ball(at: Vector, half: Vector) -> Vec<Triangle> {
    let bounds = [-1.0, 1.0].map(|end| std::array::from_fn(|x| at[x] + 1.1 * end * half[x]));
    triangles(&|p| ellipsoid(p, at, half), bounds, 20)
}

/// A box of 20 x 10 x 8 mm, without its side at the end of x unless it is closed.
fn bricks(closed: bool) -> Vec<Triangle> {
    let corner = |k: usize| [20.0 * (k & 1) as f64, 10.0 * (k >> 1 & 1) as f64, 8.0 * (k >> 2) as f64];
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let kept = sides.iter().take(if closed { 6 } else { 5 });
    kept.flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]].map(|t| t.map(corner))).collect()
}

/// The triangles whose corners are all below a height.
fn below(triangles: Vec<Triangle>, z: f64) -> Vec<Triangle> {
    triangles.into_iter().filter(|t| t.iter().all(|p| p[2] < z)).collect()
}

/// Faults are refused with the option that gets a body from them, and changes are listed.
#[test]
fn the_treatment_that_fits_is_advised() {
    let dir = tempfile::tempdir().unwrap();
    let egg = egg([20.0, 15.0, 10.0]);
    let small = write(&dir, "small.stl", &stl("egg", &egg[1..]));
    let large = write(&dir, "large.stl", &stl("box", &bricks(false)));
    let to = inside(&dir, "body.msh");
    let make = |from: &str, more: &[&str]| {
        tissuebench(&[&["mesh", "make", from, "--size", "2 mm", "--out", &to], more].concat())
    };
    let says = |done: &common::Done, says: &[&str]| {
        assert_eq!(done.code, 0, "{}", done.stderr);
        says.iter().for_each(|says| assert!(done.stdout.contains(says), "no '{says}' in: {}", done.stdout));
    };
    assert_fails(&make(&small, &[]), 2, "edges near (");
    assert_fails(&make(&small, &[]), 2, "tissuebench mesh make --repair mends this");
    says(
        &make(&small, &["--repair"]),
        &["  repair      holes of up to ", " across closed: 1, near (", "closed\n"],
    );
    let quiet = make(&small, &["--repair", "--quiet"]);
    assert!(
        !quiet.stdout.contains("near (") && quiet.stdout.contains("across closed: 1\n"),
        "{}",
        quiet.stdout
    );
    for more in [&[][..], &["--repair"]] {
        assert_fails(
            &make(&large, more),
            2,
            "a repair closes holes of up to a tenth of the surface's diagonal",
        );
        assert_fails(&make(&large, more), 2, "--wrap SIZE makes a closed surface");
    }
    says(
        &make(&large, &["--wrap", "0.5 mm"]),
        &["  wrap        1.5", "at most 4.0", "mm from the given triangles; the triangles at"],
    );
    let reversed = ball([12.0, 0.0, 0.0], [10.0; 3]).into_iter().map(|[a, b, c]| [a, c, b]);
    let crossed: Vec<Triangle> = ball([0.0; 3], [10.0; 3]).into_iter().chain(reversed).collect();
    let crossed = write(&dir, "crossed.stl", &stl("balls", &crossed));
    assert_fails(&make(&crossed, &["--repair"]), 2, "; tissuebench mesh make --wrap SIZE makes");
    says(&make(&crossed, &["--wrap", "0.5 mm"]), &["reversed parts turned: 1, near ("]);
    let whole = write(&dir, "whole.stl", &stl("egg", &egg));
    says(&make(&whole, &["--repair"]), &["  repair      none is needed"]);
    let plain = make(&whole, &[]).stdout;
    assert!(!plain.contains("repair") && !plain.contains("wrap"), "{plain}");
}

#[test]
fn sizes_that_wrap_nothing_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let from = write(&dir, "body.stl", &stl("box", &bricks(true)));
    let to = inside(&dir, "body.msh");
    let make = |more: &[&str]| {
        tissuebench(&[&["mesh", "make", &from, "--size", "2 mm", "--out", &to], more].concat())
    };
    assert_fails(&make(&["--wrap", "0 mm"]), 2, "above zero");
    assert_fails(&make(&["--wrap", "2"]), 2, "unit");
    assert_fails(&make(&["--wrap", "9 mm"]), 2, "is larger than the body: its smallest extent is 0.008 m");
    assert_fails(&make(&["--wrap", "1 um"]), 2, "lattice points, which is too many; give");
    assert_fails(&make(&["--wrap", "1 mm", "--repair"]), 2, "cannot be used with");
    let flat = write(&dir, "flat.stl", &stl("flat", &bricks(true)[..2]));
    let done = tissuebench(&["mesh", "make", &flat, "--wrap", "1 mm", "--size", "2 mm", "--out", &to]);
    assert_fails(&done, 2, "is larger than the body: its smallest extent is 0 m");
    let roof = write(&dir, "roof.stl", &stl("roof", &[bricks(true)[0], bricks(true)[4]]));
    let done = tissuebench(&["mesh", "make", &roof, "--wrap", "1 mm", "--size", "2 mm", "--out", &to]);
    assert_fails(&done, 2, "encloses nothing");
    assert_eq!(make(&[]).code, 0);
    for option in [&["--wrap", "1 mm"][..], &["--repair"]] {
        let done = tissuebench(
            &[&["mesh", "make", &to, "--size", "2 mm", "--out", &inside(&dir, "new.msh")], option].concat(),
        );
        assert_fails(&done, 2, &format!("{}: ", option[0]));
        assert_fails(&done, 2, "body.msh is not a surface; give a closed surface: STL");
        let done = tissuebench(
            &[&["init", "--file", &to, "--unit", "mm", "--out", &inside(&dir, "a.toml")], option].concat(),
        );
        assert_fails(&done, 2, "body.msh is not a surface; give a closed surface: STL");
    }
}

/// Scene of a patch test on the body of a file.
fn scene(path: &str, keys: &str) -> String {
    format!(
        r#"title = "A treated surface in an affine field"
body = {{ shape = "file", path = "{path}", unit = "mm", {keys} }}
material = {{ law = "linear", young = "20 kPa", poisson = 0.3 }}
support = [{{ on = "surface", move = "exact" }}]
reference = {{ exact = "affine" }}
procedure = {{ kind = "linear", linear_solver = "direct" }}
method = [
    {{ id = "tet4", family = "fem", element = "tet4", size = {{ spacing = "2 mm" }} }},
    {{ id = "cloud", nodes = 150, family = "efg", kernel = "cubic-spline", support_scale = 1.6, basis = "linear", essential = "nitsche", integration = {{ rule = "cell-smoothed", points = 1 }} }},
]
"#
    )
}

#[test]
fn all_methods_of_a_scene_have_the_treated_body() {
    let dir = tempfile::tempdir().unwrap();
    write(&dir, "lidless.stl", &stl("box", &bricks(false)));
    write(&dir, "hole.stl", &stl("egg", &egg([9.0, 8.0, 7.0])[1..]));
    let treated = [
        ("lidless.stl", "wrap = \"0.5 mm\"", "is wrapped: the wrap is up to 4.000 mm"),
        ("hole.stl", "repair = true", "is repaired: holes of up to "),
    ];
    for (file, keys, says) in treated {
        let done = tissuebench(&[
            "run",
            &write(&dir, "scene.toml", &scene(file, keys)),
            "--once",
            "--format",
            "json",
        ]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        let objects: Vec<Value> =
            done.stdout.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
        let passed = |o: &Value| o["metrics"]["l2"]["value"].as_f64().unwrap() < 1e-10;
        assert!(objects.len() == 2 && objects.iter().all(passed), "{file}: {}", done.stdout);
        let warned = |o: &Value| {
            let warnings = o["warnings"].as_array().unwrap().iter();
            warnings.map(|w| w["message"].as_str().unwrap()).filter(|m| m.contains(says)).count() == 1
        };
        assert!(objects.iter().all(warned), "{file}: {}", done.stdout);
    }
    let refused = |file: &str, keys: &str, says: &[&str]| {
        let done = tissuebench(&["run", &write(&dir, "scene.toml", &scene(file, keys))]);
        says.iter().for_each(|says| assert_fails(&done, 2, says));
    };
    refused("lidless.stl", "repair = true", &["'body.path'", "--wrap SIZE makes a closed surface"]);
    refused("lidless.stl", "repair = false", &["'body.path'", "wrap = \"SIZE\" in a scene's body"]);
    refused("hole.stl", "repair = false", &["'body.path'", "repair = true in a scene's body"]);
    refused("lidless.stl", "wrap = \"0 mm\"", &["'body.wrap'", "is not positive"]);
    refused("lidless.stl", "wrap = \"2\"", &["'body.wrap'", "unit"]);
    refused("lidless.stl", "wrap = \"9 mm\"", &["'body.wrap'", "is larger than the body"]);
    refused(
        "lidless.stl",
        "repair = true, wrap = \"1 mm\"",
        &["'body.wrap'", "can't be combined with repair"],
    );
    let made = inside(&dir, "made.msh");
    let from = inside(&dir, "lidless.stl");
    let done = tissuebench(&["mesh", "make", &from, "--wrap", "0.5 mm", "--size", "2 mm", "--out", &made]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    refused("made.msh", "wrap = \"1 mm\"", &["'body.wrap'", "is for surfaces"]);
    refused("made.msh", "repair = true", &["'body.repair'", "is for surfaces"]);
}

/// `init` writes the treatment into the scene.
#[test]
fn a_scene_of_a_wrapped_organ_is_written() {
    let dir = tempfile::tempdir().unwrap();
    let file = write(&dir, "organ.stl", &stl("organ", &below(egg([20.0, 15.0, 15.0]), 10.0)));
    let to = inside(&dir, "organ.toml");
    let init = |more: &[&str]| {
        tissuebench(&[&["init", "--file", &file, "--out", &to, "--methods", "tet4"], more].concat())
    };
    assert_fails(&init(&[]), 2, "wrap = \"SIZE\" in a scene's body");
    assert_fails(&init(&["--wrap", "1 mm"]), 2, "--unit");
    let done = init(&["--wrap", "1 mm", "--unit", "mm"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let text = std::fs::read_to_string(&to).unwrap();
    assert!(text.contains("unit = \"mm\"\nwrap = \"1 mm\"\n"), "{text}");
    assert_eq!(tissuebench(&["plan", &to]).code, 0);
}
