//! The same body in other units, far from the origin, and on difficult clouds: the result is the same, or the
//! scene is refused with a clear message.

mod common;

use common::{assert_fails, tissuebench, write};
use serde_json::Value;

const METHODS: &str = r#"method = [
    { id = "tet4-nodal", family = "fem", element = "tet4", dilation = "nodal-mean", size = { cells = [4, 4, 2] } },
    { id = "hex20", family = "fem", element = "hex20", size = { cells = [4, 4, 2] } },
    { id = "uniform", family = "efg", nodes = 90, cloud = "uniform", seed = 3, kernel = "cubic-spline", support_scale = 1.6, basis = "linear", integration = { rule = "gauss", points = 4 }, essential = "penalty" },
    { id = "smoothed", family = "efg", size = { cells = [4, 4, 2] }, jitter = { fraction = 0.45, seed = 2 }, kernel = "wendland-c2", support_scale = 1.6, basis = "linear", integration = { rule = "cell-smoothed", points = 1 }, essential = "nitsche" },
    { id = "quadratic", family = "efg", size = { cells = [4, 4, 2] }, kernel = "quartic-spline", neighbours = 30, factor = 1.3, basis = "quadratic", integration = { rule = "gauss", points = 4 }, essential = "multipliers" },
]
"#;

/// A block of 2 x 2 x 1 lengths under a pressure of a twentieth of its modulus. `corner` is the position of a
/// corner in lengths.
fn block(length: f64, unit: &str, corner: f64) -> String {
    let at = |v: [f64; 3]| {
        let c = v.map(|v| format!("\"{:?} {unit}\"", (corner + v) * length));
        format!("[{}, {}, {}]", c[0], c[1], c[2])
    };
    format!(
        "title = \"A block\"\nbody = {{ shape = \"box\", min = {}, max = {} }}\n\
         material = {{ law = \"linear\", young = \"20 kPa\", poisson = 0.45 }}\n\
         support = [{{ on = \"z-min\", fix = \"xyz\" }}]\nload = [{{ on = \"z-max\", pressure = \"1 kPa\" }}]\n{METHODS}",
        at([0.0, 0.0, 0.0]),
        at([2.0, 2.0, 1.0])
    )
}

/// Largest displacement divided by the length, strain energy divided by its cube, and fallbacks, by method.
fn answers(scene: &str, length: f64) -> Vec<(String, [f64; 3])> {
    let dir = tempfile::tempdir().unwrap();
    let done = tissuebench(&["run", &write(&dir, "block.toml", scene), "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let object: Vec<Value> = done.stdout.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let value = |o: &Value, name: &str| o["metrics"][name]["value"].as_f64().unwrap_or(0.0);
    object
        .iter()
        .map(|o| {
            let numbers =
                [value(o, "max") / length, value(o, "strain-energy") / length.powi(3), value(o, "fallbacks")];
            (o["method"].as_str().unwrap().to_string(), numbers)
        })
        .collect()
}

#[test]
fn units_and_origin_do_not_matter() {
    let known = answers(&block(20.0, "mm", 0.0), 0.02);
    assert_eq!(known.len(), 5);
    // A cube of 1 um, a cube of 10 m, and the first cube at a distance of 1000 lengths, at which coordinates
    // have lost three digits.
    for (length, unit, corner, metres, tolerance) in [
        (1.0, "um", 0.0, 1e-6, 1e-9),
        (10.0, "m", 0.0, 10.0, 1e-9),
        (20.0, "mm", 1000.0, 0.02, 1e-6),
        (20.0, "mm", -1000.0, 0.02, 1e-6),
    ] {
        for ((name, here), (_, there)) in known.iter().zip(answers(&block(length, unit, corner), metres)) {
            for (a, b) in here.iter().zip(&there) {
                assert!(
                    (a - b).abs() <= tolerance * a.abs(),
                    "{name} in {unit} at {corner}: {here:?}, {there:?}"
                );
            }
        }
    }
}

/// A cube with an affine field prescribed on its whole boundary, by a smoothed cloud.
fn patch(cloud: &str) -> String {
    format!(
        r#"title = "A cube in an affine field"
body = {{ shape = "box", size = ["50 mm", "50 mm", "50 mm"] }}
material = {{ law = "linear", young = "20 kPa", poisson = 0.3 }}
support = [{{ on = "surface", move = "exact" }}]
reference = {{ exact = "affine" }}
method = [{{ id = "cloud", family = "efg", kernel = "cubic-spline", basis = "linear", integration = {{ rule = "cell-smoothed", points = 1 }}, essential = "nitsche", {cloud} }}]
"#
    )
}

#[test]
fn hard_clouds_keep_the_affine_field_or_say_that_they_may_not() {
    let dir = tempfile::tempdir().unwrap();
    // The affine field is exact to rounding on any cloud that has shape functions. If all nodes of a support
    // are nearly coplanar, gradients and their rounding errors are as large as the inverse thickness.
    // Ellipsoids that follow the cells are as accurate as balls over cubes.
    for (name, cloud, most) in [
        (
            "jitter",
            r#"support_scale = 1.6, size = { cells = [5, 5, 5] }, jitter = { fraction = 0.3, seed = 7 }"#,
            1e-11,
        ),
        (
            "graded",
            r#"neighbours = 12, factor = 1.5, size = { cells = [10, 4, 4], grading = [10, 1, 1] }"#,
            1e-11,
        ),
        ("flat", r#"neighbours = 20, factor = 1.5, size = { cells = [36, 2, 2] }"#, 1e-9),
        (
            "steep, adapted",
            r#"neighbourhood = "ellipsoid", neighbours = 12, factor = 1.5, size = { cells = [10, 4, 4], grading = [100, 1, 1] }"#,
            1e-12,
        ),
        (
            "flat, adapted",
            r#"neighbourhood = "ellipsoid", support_scale = 1.6, size = { cells = [40, 2, 2] }"#,
            1e-12,
        ),
        (
            "less flat, adapted",
            r#"neighbourhood = "ellipsoid", neighbours = 20, factor = 1.5, size = { cells = [24, 2, 2] }"#,
            1e-12,
        ),
    ] {
        let done = tissuebench(&["run", &write(&dir, "patch.toml", &patch(cloud)), "--format", "json"]);
        assert_eq!(done.code, 0, "{name}: {}", done.stderr);
        let object: Value = serde_json::from_str(&done.stdout).unwrap();
        let error = object["metrics"]["l2"]["value"].as_f64().unwrap();
        eprintln!("{name}: {error:e}, {}", object["metrics"]["fallbacks"]);
        assert!(error < most, "{name}: {error:e}");
        let stress = object["metrics"]["stress"]["value"].as_f64().unwrap();
        assert!(!cloud.contains("adapted") || stress < 1e-12, "{name}: {stress:e}");
    }
    // A support that is too small is enlarged at every point, and counted. A support that reaches no
    // neighbour is refused.
    let tight = patch(r#"neighbours = 4, factor = 1.01, size = { cells = [5, 5, 5] }"#);
    let done = tissuebench(&["run", &write(&dir, "patch.toml", &tight), "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let object: Value = serde_json::from_str(&done.stdout).unwrap();
    assert!(object["metrics"]["fallbacks-enlarged"]["value"].as_f64().unwrap() > 0.0, "{object}");
    // Spherical supports over flat cells of 50:1 and 12:1 have their neighbours in planes. The run warns of
    // few reliable digits, although only the last digits are wrong.
    for thin in [
        r#"neighbours = 12, factor = 1.5, size = { cells = [10, 4, 4], grading = [100, 1, 1] }"#,
        r#"neighbours = 20, factor = 1.5, size = { cells = [24, 2, 2] }"#,
    ] {
        let done = tissuebench(&["run", &write(&dir, "patch.toml", &patch(thin)), "--format", "json"]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        let object: Value = serde_json::from_str(&done.stdout).unwrap();
        assert!(object["metrics"]["l2"]["value"].as_f64().unwrap() < 1e-11, "{object}");
        assert_eq!(object["warnings"][0]["code"], "few-digits", "{object}");
    }
    // The nodes are those of a mesh, whose cells may become inverted.
    let wild =
        patch(r#"support_scale = 1.6, size = { cells = [5, 5, 5] }, jitter = { fraction = 0.45, seed = 7 }"#);
    let done = tissuebench(&["run", &write(&dir, "patch.toml", &wild)]);
    assert_fails(&done, 2, "key 'method[0].jitter.fraction': '0.45' gives a mesh in which element");
    let lost = patch(r#"support_scale = 0.6, size = { cells = [5, 5, 5] }"#);
    let done = tissuebench(&["run", &write(&dir, "patch.toml", &lost)]);
    assert_fails(&done, 2, "'0.6' is not a valid support scale; 1.2 to 3 is usual");
}
