//! Clouds on bodies with gaps: slits, narrow bridges, and thin parts that the cells omit.

mod common;

use common::blocks::{Blocks, Named, even};
use common::{assert_fails, objects, tissuebench, write};

/// A block of 30 x 8 x 16 mm pulled apart at its ends. It is cut in the middle from its top down to `tip`
/// (mm) with this `width`, along a curve that deviates by `bend` from the middle plane.
fn slit(cells: usize, tip: f64, width: f64, bend: f64) -> String {
    let curve = |z: f64| bend * (std::f64::consts::PI * z / 16.0).sin();
    let places = |[x, y, z]: [f64; 3], middle: [f64; 3]| {
        let apart = if (x - 15.0).abs() < 1e-9 && z > tip { 0.5 * width } else { 0.0 };
        let apart = if middle[0] > 15.0 { apart } else { -apart };
        [x + apart + curve(z) * (1.0 - (x - 15.0).abs() / 15.0), y, z]
    };
    let surfaces: [Named; 3] =
        [("bottom", &|p| p[2] < 1e-9), ("left", &|p| p[0] < 1e-9), ("right", &|p| p[0] > 30.0 - 1e-9)];
    let lines = [&even(30.0, 5 * cells)[..], &even(8.0, cells + 1), &even(16.0, 3 * cells)];
    Blocks { lines, keeps: &|_| true, places: &places, surfaces: &surfaces }.gmsh()
}

const CLOUD: &str = r#"family = "efg", kernel = "cubic-spline""#;

/// Quadratic elements, followed by clouds of each kind on the same cells.
fn methods(mesh: &str) -> String {
    let size = format!(r#"size = {{ file = "{mesh}" }}"#);
    let linear = |id: &str, scale: f64, rest: &str| {
        format!(r#"{{ id = "{id}", {CLOUD}, {size}, support_scale = {scale}, basis = "linear", {rest} }}"#)
    };
    [
        format!(r#"{{ id = "tet10", family = "fem", element = "tet10", {size} }}"#),
        linear("gauss", 1.6, r#"integration = { rule = "gauss", points = 4 }, essential = "penalty""#),
        linear("near", 1.2, r#"integration = { rule = "cell-smoothed" }, essential = "penalty", dilation = "nodal-near""#),
        linear("coupled", 1.6, r#"integration = { rule = "cell-smoothed" }, essential = "coupling""#),
        linear("nodal", 1.4, r#"integration = { rule = "node-smoothed", stabilisation = 0.1 }, essential = "nitsche""#),
        linear("ellipsoid", 1.6, r#"integration = { rule = "gauss", points = 4 }, essential = "penalty", neighbourhood = "ellipsoid""#),
        format!(
            r#"{{ id = "entropy", family = "efg", {size}, basis = "maximum-entropy", gamma = 1.8, integration = {{ rule = "gauss", points = 4 }}, essential = "penalty" }}"#
        ),
        format!(
            r#"{{ id = "own", {CLOUD}, nodes = 240, cloud = "uniform", seed = 1, background = {{ file = "{mesh}" }}, support_scale = 1.6, basis = "linear", integration = {{ rule = "gauss", points = 4 }}, essential = "penalty" }}"#
        ),
    ]
    .join(",\n")
}

/// A scene without methods.
fn head(path: &str) -> String {
    format!(
        r#"title = "A block with a slit"
body = {{ shape = "file", path = "{path}", unit = "mm" }}
material = {{ law = "linear", young = "20 kPa", poisson = 0.3 }}
support = [{{ on = "bottom", fix = "xyz" }}]
load = [{{ on = "left", traction = ["-100 Pa", "0 Pa", "0 Pa"] }}, {{ on = "right", traction = ["100 Pa", "0 Pa", "0 Pa"] }}]
"#
    )
}

/// Id, strain energy (J), and warnings with their values of a method.
type Solved = (String, f64, Vec<(String, f64)>);

/// Strain energy (J) of each method, and its warnings that doubt the energy, with their values.
fn energies(mesh: &str) -> Vec<Solved> {
    let dir = tempfile::tempdir().unwrap();
    let path = write(&dir, "slit.msh", mesh);
    let scene = format!("{}method = [{}]\n", head(&path), methods(&path));
    let done = tissuebench(&["run", &write(&dir, "slit.toml", &scene), "--once", "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let energy = |object: &serde_json::Value| {
        let energy = object["metrics"]["strain-energy"]["value"].as_f64().unwrap();
        let named =
            |w: &serde_json::Value| (w["code"].as_str().unwrap().to_string(), w["value"].as_f64().unwrap());
        let doubts = object["warnings"].as_array().unwrap().iter().map(named);
        let doubts =
            doubts.filter(|(code, _)| ["stress-jump", "few-cells", "hourglassing"].contains(&&**code));
        (object["method"].as_str().unwrap().to_string(), energy, doubts.collect())
    };
    objects(&done.stdout).iter().map(energy).collect()
}

/// If the faces of the slit stick together, clouds have 30 to 45 % of the energy of quadratic elements on the
/// same cells.
#[test]
fn clouds_open_slits_as_elements_do() {
    for (tip, width, bend) in [(-1.0, 0.3, 0.0), (5.4, 0.3, 0.0), (5.4, 0.6, 3.0)] {
        let all = energies(&slit(2, tip, width, bend));
        let (_, exact, _) = &all[0];
        assert_eq!(all.len(), 8);
        for (method, energy, doubts) in &all[1..] {
            let off = energy / exact - 1.0;
            // Separated halves bend far from any gap, and 240 nodes are few: one of 120 alone has 0.11 to
            // 0.15.
            let bound = if method == "own" && tip < 0.0 { 0.18 } else { 0.1 };
            assert!(off.abs() < bound || !doubts.is_empty(), "{tip} {width} {bend}, {method}: {off}");
            // Means over nodes are soft in bending, with or without a gap, and smooth the stress.
            let hourglassing = doubts.iter().find(|(code, _)| code == "hourglassing");
            assert_eq!(hourglassing.is_some(), method == "nodal", "{tip} {width} {bend}, {method}");
            assert!(hourglassing.is_none_or(|(_, most)| off < *most), "{off} {hourglassing:?}");
        }
        assert!(all[0].2.is_empty(), "{:?}", all[0]);
    }
}

/// On half the spacing all clouds on the nodes of the cells are within a tenth, with or without a warning.
#[test]
fn finer_clouds_open_slits_as_elements_do() {
    let all = energies(&slit(4, 5.4, 0.3, 0.0));
    let (_, exact, _) = &all[0];
    for (method, energy, _) in all[1..].iter().filter(|(method, ..)| method != "own") {
        let off = energy / exact - 1.0;
        assert!(off.abs() < 0.1, "{method}: {off}");
    }
}

/// Probes beside the slit, 0.6 mm from its middle plane, are nearer to nodes across the slit than to most of
/// their own side. The two sides move apart by a fifth of a millimetre.
#[test]
fn schemes_that_take_values_from_across_a_slit_are_warned_about() {
    let dir = tempfile::tempdir().unwrap();
    let gauss = r#"basis = "linear", integration = { rule = "gauss", points = 4 }, essential = "penalty""#;
    let warning = |method: &str, tip: f64, schemes: &[&str]| {
        let path = write(&dir, "slit.msh", &slit(2, tip, 0.3, 0.0));
        let method = match method {
            "cloud" => format!("{CLOUD}, support_scale = 1.6, {gauss}"),
            element => format!(r#"family = "fem", element = "{element}""#),
        };
        let probes: Vec<String> = (0..6)
            .flat_map(|k| [14.4, 15.6].map(|x| format!(r#"["{x} mm", "4 mm", "{} mm"]"#, 10 + k)))
            .collect();
        let schemes: Vec<String> =
            schemes.iter().map(|name| format!(r#"{{ to = "probes", scheme = "{name}" }}"#)).collect();
        let scene = format!(
            r#"{}method = [{{ id = "one", {method}, size = {{ file = "{path}" }} }}]
output = {{ probes = [{}], transfer = [{}] }}
"#,
            head(&path),
            probes.join(", "),
            schemes.join(", ")
        );
        let done = tissuebench(&["run", &write(&dir, "slit.toml", &scene), "--once", "--format", "json"]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        let run = objects(&done.stdout).remove(0);
        let warnings = run["warnings"].as_array().unwrap();
        warnings.iter().find(|w| w["code"] == "gap-bridged").cloned()
    };
    for method in ["cloud", "tet4", "tet10"] {
        let found = warning(method, 5.4, &["shepard", "barycentric", "mls-linear"]).expect(method);
        let message = found["message"].as_str().unwrap();
        let bridging = message.contains("of 12 targets") && message.contains("(shepard, mls-linear)");
        assert!(bridging, "{method}: {message}");
        assert!(found["value"].as_f64().unwrap() > 0.1, "{method}: {found}");
        assert!(warning(method, 5.4, &["barycentric"]).is_none(), "{method}");
        assert!(warning(method, 99.0, &["shepard", "mls-linear"]).is_none(), "{method}: no slit");
    }
}

/// A block with a rod on its top.
fn rod() -> String {
    let lines = [&[0.0, 4.5, 9.25, 10.75, 15.5, 20.0][..], &[0.0, 4.5, 9.25, 10.75, 15.5, 20.0]];
    let up: Vec<f64> = (0..=16).map(|k| 2.5 * f64::from(k)).collect();
    let slim = |x: f64| (x - 10.0).abs() < 0.5;
    let keeps = |[x, y, z]: [f64; 3]| z < 20.0 || slim(x) && slim(y);
    let surfaces: [Named; 1] = [("bottom", &|p| p[2] < 1e-9)];
    Blocks { lines: [lines[0], lines[1], &up], keeps: &keeps, places: &|p, _| p, surfaces: &surfaces }.gmsh()
}

#[test]
fn nodes_that_the_cells_leave_out_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let path = write(&dir, "rod.msh", &rod());
    let scene = |nodes: &str| {
        let text = format!(
            r#"title = "A block with a rod on it"
body = {{ shape = "file", path = "{path}", unit = "mm" }}
material = {{ law = "linear", young = "20 kPa", poisson = 0.3 }}
support = [{{ where = "z <= 0.01 mm", fix = "xyz" }}]
load = [{{ body = ["0 N/m^3", "0 N/m^3", "-9810 N/m^3"] }}]
method = [{{ id = "cloud", {CLOUD}, {nodes}, support_scale = 1.6, basis = "linear", integration = {{ rule = "gauss", points = 4 }}, essential = "penalty" }}]
"#
        );
        tissuebench(&["run", &write(&dir, "rod.toml", &text)])
    };
    let lost = scene(r#"nodes = 200, cloud = "uniform", seed = 1, background = { spacing = "5 mm" }"#);
    assert_fails(&lost, 3, "has no cells around");
    assert!(lost.stderr.contains("background"), "{}", lost.stderr);
    let kept =
        scene(&format!(r#"nodes = 200, cloud = "uniform", seed = 1, background = {{ file = "{path}" }}"#));
    assert_eq!(kept.code, 0, "{}", kept.stderr);
    let own = scene(&format!(r#"size = {{ file = "{path}" }}"#));
    assert_eq!(own.code, 0, "{}", own.stderr);
}
