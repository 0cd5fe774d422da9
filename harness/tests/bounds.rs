//! Strict bounds in linear elasticity.

mod common;

use common::{Done, assert_fails, number, objects, tissuebench, write, written_out};
use serde_json::Value;
use tempfile::TempDir;

/// A quarter of a block between bonded plates, 0.1 of its height pressed, with the truth between its bounds.
fn block(poisson: f64, methods: &str) -> String {
    format!(
        r#"title = "A bonded block"
body = {{ shape = "box", size = ["1 m", "1 m", "1 m"] }}
material = {{ law = "linear", young = "1 Pa", poisson = {poisson} }}
support = [
    {{ on = "z-min", fix = "xyz" }},
    {{ on = "x-min", fix = "x" }},
    {{ on = "y-min", fix = "y" }},
    {{ on = "z-max", move = {{ x = "0 m", y = "0 m", z = "-0.1 m" }} }},
]
{methods}
"#
    )
}

fn of(id: &str, element: &str, cells: usize) -> String {
    format!(
        "[[method]]\nid = \"{id}\"\nfamily = \"fem\"\nelement = \"{element}\"\nsize = {{ cells = [{cells}, {cells}, {cells}] }}\n"
    )
}

/// Output of `bound --format json`, and of the process.
fn bound(dir: &TempDir, scene: &str, args: &[&str]) -> (Value, Done) {
    let path = write(dir, "scene.toml", scene);
    let done = tissuebench(&[&["bound", path.as_str(), "--format", "json"], args].concat());
    (serde_json::from_str(&done.stdout).unwrap_or_else(|_| panic!("{}", done.stderr)), done)
}

/// Bounds of a result whose name begins with `name`.
#[track_caller]
fn ends(found: &Value, name: &str) -> [f64; 2] {
    let all = found["bounds"].as_array().unwrap();
    let of = all.iter().find(|of| of["result"].as_str().unwrap().starts_with(name));
    let of = of.unwrap_or_else(|| panic!("no {name} in {found}"));
    ["lower", "upper"].map(|key| of[key].as_f64().unwrap())
}

/// The force of fine graded meshes lies inside.
#[test]
fn bounds_enclose_the_force_and_close_without_locking() {
    let dir = tempfile::tempdir().unwrap();
    for (poisson, truth, widest) in [(0.3, 0.1139, 0.006), (0.495, 0.1687, 0.04), (0.4999, 0.1733, 0.05)] {
        let mut widths = Vec::new();
        for cells in [2, 4] {
            let (found, _) = bound(&dir, &block(poisson, &of("tet4", "tet4", cells)), &[]);
            let [lower, upper] = ends(&found, "force");
            assert!(lower < truth && truth < upper, "{poisson} {cells}: {lower} {upper}");
            let energy = ends(&found, "strain energy");
            assert!((lower - 20.0 * energy[0]).abs() + (upper - 20.0 * energy[1]).abs() < 1e-12);
            widths.push((upper - lower) / (upper + lower));
            assert_eq!(found["answers"][0]["can_be_true"], false, "linear tetrahedra are too stiff: {found}");
        }
        assert!(widths[1] < 0.5 * widths[0] && widths[1] <= widest, "{poisson}: {widths:?}");
    }
}

#[test]
fn a_linear_stress_is_enclosed_to_rounding() {
    let dir = tempfile::tempdir().unwrap();
    let scene = written_out("bounded-bending.toml");
    let exact = 20e3 * (0.02 * 0.04f64.powi(3) / 12.0) * 0.5 * 0.5 * 0.08 / 2.0;
    for poisson in ["0", "0.3", "0.495", "0.4999"] {
        let (found, done) =
            bound(&dir, &scene.replace("poisson = 0.3", &format!("poisson = {poisson}")), &[]);
        let [lower, upper] = ends(&found, "strain energy");
        assert!(lower <= exact && exact <= upper, "{poisson}: {lower:e} {exact:e} {upper:e}");
        assert!(upper - lower < 1e-6 * exact, "{poisson}: {lower:e} {upper:e}");
        assert_eq!((done.code, &found["answers"][0]["can_be_true"]), (0, &Value::Bool(true)));
    }
}

/// A stretched bar that is also pulled sideways: displacements and loads in one scene.
#[test]
fn parts_of_motion_and_load_add_up() {
    let dir = tempfile::tempdir().unwrap();
    let scene = block(0.3, &of("tet4", "tet4", 3)).replace("fix = \"xyz\"", "fix = \"z\"");
    let scene = scene.replace("x = \"0 m\", y = \"0 m\", ", "").replace(
        "[[method]]",
        "load = [{ on = \"x-max\", traction = [\"0.2 Pa\", \"0 Pa\", \"0 Pa\"] }]\n[[method]]",
    );
    // Stress (0.2, 0, s) Pa with the strain (s - 0.3 * 0.2) / E = -0.1 along z.
    let s = -0.1 + 0.3 * 0.2;
    let exact = (0.2 * (0.2 - 0.3 * s) + s * -0.1) / 2.0;
    let (found, _) = bound(&dir, &scene, &[]);
    let [lower, upper] = ends(&found, "strain energy");
    assert!(lower <= exact && exact <= upper && upper - lower < 1e-4 * exact, "{lower} {exact} {upper}");
    assert_eq!(found["bounds"].as_array().unwrap().len(), 1, "a force has no bounds of its own: {found}");
}

/// The mean of the loaded end by polarised pairs is that of the energy, and the side of the bar moves by what
/// the exact solution says.
#[test]
fn means_have_bounds() {
    let dir = tempfile::tempdir().unwrap();
    let means = "output = { means = [{ on = \"x-max\" }, { on = \"y-max\" }, { on = \"z-max\" }] }\n";
    let scene = written_out("bounded-cantilever.toml");
    let (found, _) = bound(&dir, &scene, &["--method", "tet4"]);
    let [of_energy, of_pair] =
        ["mean of the loaded faces", "mean of x-max along z"].map(|name| ends(&found, name));
    assert!(of_pair[0] < -of_energy[0] && of_pair[1] > -of_energy[1], "{of_pair:?} {of_energy:?}");
    let width = |[lower, upper]: [f64; 2]| upper - lower;
    assert!(width(of_pair) < 1.1 * width(of_energy), "{of_pair:?} {of_energy:?}");

    let scene = block(0.3, &format!("{means}{}", of("tet4", "tet4", 3)));
    let scene = scene.replace("fix = \"xyz\"", "fix = \"z\"").replace("x = \"0 m\", y = \"0 m\", ", "");
    let (found, _) = bound(&dir, &scene, &[]);
    for (name, exact) in
        [("mean of x-max along x", 0.03), ("mean of y-max along x", 0.015), ("mean of z-max along z", -0.1)]
    {
        let [lower, upper] = ends(&found, name);
        assert!(lower <= exact && exact <= upper && upper - lower < 1e-4, "{name}: {lower} {upper}");
    }
}

#[test]
fn a_wrong_reference_is_refuted() {
    let dir = tempfile::tempdir().unwrap();
    let methods = of("tet4", "tet4", 4) + &of("hex20", "hex20", 8);
    for (id, code) in [("tet4", 1), ("hex20", 0)] {
        let scene = block(0.495, &format!("reference = {{ method = \"{id}\" }}\n{methods}"));
        let (found, done) = bound(&dir, &scene, &["--nodes", "125"]);
        assert_eq!(done.code, code, "{id}: {found}");
        assert_eq!(done.stderr.contains("lies outside the bounds"), code == 1, "{}", done.stderr);
    }
}

#[test]
fn a_run_has_its_bounds_among_its_metrics() {
    let dir = tempfile::tempdir().unwrap();
    let methods = of("tet4", "tet4", 2) + &of("hex8", "hex8", 2);
    let scene = block(0.3, &format!("output = {{ bounds = true }}\n{methods}"));
    let path = write(&dir, "scene.toml", &scene);
    let done = tissuebench(&["run", &path, "--once", "--format", "json"]);
    for run in objects(&done.stdout) {
        let (lower, upper) = (number(&run, "support-force-lower"), number(&run, "support-force-upper"));
        assert!((lower - 0.11176).abs() < 1e-5 && (upper - 0.11524).abs() < 1e-5, "{lower} {upper}");
        let excess = number(&run, "strain-energy") / number(&run, "strain-energy-upper") - 1.0;
        assert!(excess > 0.0 && (number(&run, "bounds-excess") - excess).abs() < 1e-12);
        assert!(run["warnings"].to_string().contains("outside-bounds"), "{}", run["warnings"]);
    }
}

#[test]
fn scenes_without_bounds_are_refused_with_the_reason() {
    let dir = tempfile::tempdir().unwrap();
    let scene = block(0.3, &of("tet4", "tet4", 2));
    let with = |text: &str| scene.replace("[[method]]", &format!("{text}\n[[method]]"));
    let moved = "z = \"-0.1 m\" }";
    for (scene, says) in [
        (
            with("procedure = { kind = \"static\", steps = 1 }"),
            "is for linear elasticity, not for a static procedure",
        ),
        (with("load = [{ body = [\"0 N/m^3\", \"0 N/m^3\", \"-1 N/m^3\"] }]"), "balances no body force"),
        (
            with("foundation = [{ on = \"x-max\", stiffness = \"1 Pa/m\" }]"),
            "is not available with a [[foundation]]",
        ),
        (
            ["x-min", "y-min", "z-min", "z-max"].iter().fold(
                scene.replace(
                    "shape = \"box\", size = [\"1 m\", \"1 m\", \"1 m\"]",
                    "shape = \"ball\", radius = \"1 m\"",
                ),
                |scene, side| scene.replace(&format!("on = \"{side}\""), "where = \"z <= 0 m\""),
            ),
            "fill exactly",
        ),
        (
            with("load = [{ on = \"x-max\", pressure = { of = \"z * z\", unit = \"Pa\" } }]"),
            "is not linear on each face: it differs by",
        ),
        (scene.replace(moved, "z = { of = \"-x * x\", unit = \"m\" } }"), "is not linear on each face"),
        (
            scene.replace(
                "{ on = \"x-min\", fix = \"x\" }",
                "{ where = \"x == 0 m and y <= 0.3 m\", fix = \"x\" }",
            ),
            "within faces of the mesh",
        ),
        (scene.replace(moved, "z = \"0 m\" }"), "no support moves and no load acts"),
    ] {
        let path = write(&dir, "scene.toml", &scene);
        assert_fails(&tissuebench(&["bound", &path]), 2, says);
    }
}
