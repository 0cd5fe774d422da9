//! Free vibrations from scene files.

mod common;

use common::{assert_fails, tissuebench, write};
use serde_json::Value;

const BOX: &str = r#"title = "A box"
body = { shape = "box", size = ["40 mm", "30 mm", "20 mm"] }
material = { law = "linear", young = "20 kPa", poisson = 0.3, density = "1000 kg/m^3" }
procedure = { kind = "modes", modes = 8 }
method = [
    { id = "hex8", family = "fem", element = "hex8", size = { level = 1 }, mass = "consistent" },
    { id = "hex8-lumped", family = "fem", element = "hex8", size = { level = 1 }, mass = "lumped" },
    { id = "hex8-transformed", family = "fem", element = "hex8", size = { level = 1 }, mass = "transformed" },
    { id = "efg", family = "efg", size = { level = 1 }, kernel = "cubic-spline", support_scale = 1.6, basis = "linear", integration = { rule = "gauss", points = 4 }, essential = "nitsche", mass = "transformed" },
]
"#;

const ROLLERS: &str = r#"support = [{ on = ["x-min", "x-max"], fix = "x" }, { on = ["y-min", "y-max"], fix = "y" }, { on = ["z-min", "z-max"], fix = "z" }]
reference = { exact = "roller-box", length = "40 mm", depth = "30 mm", width = "20 mm", density = "1000 kg/m^3" }
"#;

fn metrics(text: &str) -> Vec<Value> {
    let dir = tempfile::tempdir().unwrap();
    let scene = write(&dir, "box.toml", text);
    let done = tissuebench(&["run", &scene, "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    done.stdout.lines().map(|line| serde_json::from_str::<Value>(line).unwrap()).collect()
}

fn metric(run: &Value, name: &str) -> f64 {
    run["metrics"][name]["value"].as_f64().unwrap_or_else(|| panic!("{name} of {run}"))
}

#[test]
fn a_free_box_has_six_rigid_modes_and_its_mass() {
    let runs = metrics(BOX);
    assert_eq!(runs.len(), 4);
    for run in &runs {
        assert_eq!((metric(run, "rigid-modes"), metric(run, "massless")), (6.0, 0.0));
        assert!((metric(run, "mass") - 0.024).abs() < 1e-12 && metric(run, "residual") < 1e-9);
        assert!(run["metrics"]["slow-modes"].is_null(), "nothing exact to be slower than");
    }
    // Nodal parameters of elements are displacements.
    assert_eq!(metric(&runs[1], "critical-step"), metric(&runs[2], "critical-step"));
    assert!(metric(&runs[0], "critical-step") < metric(&runs[1], "critical-step"));
}

/// A body of steel in mm, N, s and t, read as SI units, vibrates at 1e10 Hz: the decomposition must not take
/// its eigenvalues, of 1e-20, for rounding.
#[test]
fn frequencies_scale_with_stiffness_and_density() {
    let stiff = BOX.replace("20 kPa", "210 GPa").replace("1000 kg/m^3", "7.8e-9 kg/m^3");
    let factor = (210e9 / 20e3 * 1000.0 / 7.8e-9_f64).sqrt();
    let modes = |run: &Value| -> Vec<f64> {
        let all = run["modes"].as_array().unwrap().iter();
        all.map(|mode| mode["frequency"]["value"].as_f64().unwrap()).collect()
    };
    // The first six modes of a free box are rigid, with frequencies of rounding.
    for (soft, stiff) in metrics(BOX).iter().zip(&metrics(&stiff)) {
        assert!(metric(stiff, "residual") < 1e-9, "{stiff}");
        for (soft, stiff) in modes(soft).iter().zip(modes(stiff)).skip(6) {
            assert!((stiff / (soft * factor) - 1.0).abs() < 1e-9, "{soft} {stiff}");
        }
    }
}

/// Two points in each direction integrate the mass of a brick exactly; those of a reduced hex20 leave motions
/// without mass, which have no frequency.
#[test]
fn a_mass_at_the_points_of_the_forces_may_be_singular() {
    let method = |element: &str, mass: &str| {
        format!(
            "    {{ id = \"{mass}\", family = \"fem\", element = {element}, size = {{ level = 1 }}, mass = \"{mass}\" }},\n"
        )
    };
    let (before, _) = BOX.split_once("method = [").unwrap();
    let both = |element: &str| {
        let methods = method(element, "consistent") + &method(element, "at-points");
        metrics(&format!("{ROLLERS}{before}method = [\n{methods}]\n"))
    };
    let bricks = both("\"hex8\"");
    let ratio = |run| metric(run, "frequency-ratio");
    assert!((ratio(&bricks[0]) - ratio(&bricks[1])).abs() < 1e-12);
    let reduced = both("\"hex20\", reduced = true");
    assert!(metric(&reduced[0], "massless") == 0.0 && metric(&reduced[1], "massless") > 0.0);
    assert!((ratio(&reduced[1]) - 1.0).abs() < 0.01, "{}", ratio(&reduced[1]));
}

/// Linear elements give frequencies above the exact frequencies with a consistent mass, and below them with a
/// lumped mass. On equal hexahedra the discrete modes are sines with either mass, so that the two frequencies
/// differ by the factor `sqrt(9 / ((2 + cos ah) (2 + cos bh)))`, a = pi / 4h, b = pi / 3h.
#[test]
fn a_box_on_rollers_vibrates_as_known() {
    let runs = metrics(&format!("{BOX}{ROLLERS}"));
    for run in &runs {
        assert_eq!((metric(run, "rigid-modes"), metric(run, "slow-modes")), (0.0, 0.0));
        assert!(metric(run, "mode-overlap") > 0.97, "{run}");
    }
    let ratios: Vec<f64> = runs.iter().map(|r| metric(r, "frequency-ratio")).collect();
    assert!(ratios[0] > 1.0 && ratios[1] < 1.0, "{ratios:?}");
    let [a, b] = [4.0, 3.0].map(|n: f64| 2.0 + (std::f64::consts::PI / n).cos());
    assert!((ratios[0] / ratios[1] / (9.0 / (a * b)).sqrt() - 1.0).abs() < 1e-9, "{ratios:?}");
}

#[test]
fn a_reference_that_knows_no_vibrations_is_refused_at_its_key() {
    let dir = tempfile::tempdir().unwrap();
    let scene = write(&dir, "box.toml", &format!("{BOX}reference = {{ exact = \"rigid\" }}\n"));
    assert_fails(
        &tissuebench(&["run", &scene]),
        2,
        "'reference.exact': 'rigid' is not available for vibrations",
    );
}

/// With more unknowns than a dense decomposition takes, block Lanczos finds the lowest modes.
#[test]
fn the_lowest_modes_of_a_large_body_are_found_alone() {
    let large = |text: &str| {
        let hex8 =
            text.lines().filter(|line| !line.contains("id = \"hex8-") && !line.contains("id = \"efg\""));
        let text = hex8.map(|line| format!("{line}\n")).collect::<String>();
        metrics(&text.replace("{ level = 1 }", "{ cells = [16, 12, 8] }").replace("modes = 8", "modes = 20"))
            .remove(0)
    };
    let rollers = large(&format!("{BOX}{ROLLERS}"));
    assert!(rollers["dofs"].as_f64().unwrap() > 4000.0, "{rollers}");
    assert!(metric(&rollers, "spectrum-error") < 0.03 && metric(&rollers, "residual") < 1e-6, "{rollers}");
    assert!(metric(&rollers, "mode-overlap") > 0.99 && metric(&rollers, "slow-modes") == 0.0);
    assert!(metric(&rollers, "frequency-ratio") > 1.0);
    assert_eq!(rollers["linear_solver"], "block-lanczos");
    // These metrics need all modes.
    assert!(rollers["metrics"]["massless"].is_null() && rollers["metrics"]["critical-step"].is_null());
    assert_eq!(metric(&large(BOX), "rigid-modes"), 6.0);
}

/// The first bending mode of the cantilever has 4.38 Hz (quadratic hexahedra). Alternating parameters of wide
/// supports move a lumped mass without displacement, and means over nodes do not see alternating strain.
#[test]
fn modes_that_integration_or_lumped_mass_does_not_see_are_warned_about() {
    let cloud = |id: &str, scale: f64, rule: &str, mass: &str| {
        format!(
            r#"{{ id = "{id}", family = "efg", size = {{ cells = [12, 3, 3] }}, kernel = "cubic-spline", support_scale = {scale}, basis = "linear", integration = {{ {rule} }}, essential = "nitsche", mass = "{mass}" }}"#
        )
    };
    let gauss = "rule = \"gauss\", points = 4";
    let means = "rule = \"node-smoothed\", stabilisation";
    let methods = [
        r#"{ id = "hex8", family = "fem", element = "hex8", size = { cells = [8, 2, 2] }, mass = "lumped" }"#
            .into(),
        cloud("lumped", 1.6, gauss, "lumped"),
        cloud("consistent", 2.6, gauss, "consistent"),
        cloud("wide-lumped", 2.6, gauss, "lumped"),
        cloud("means-lumped", 1.6, &format!("{means} = 0"), "lumped"),
        cloud("stabilised-lumped", 1.6, &format!("{means} = 0.1"), "lumped"),
    ];
    let runs = metrics(&format!(
        r#"title = "A cantilever"
body = {{ shape = "box", size = ["40 mm", "10 mm", "10 mm"] }}
material = {{ law = "linear", young = "20 kPa", poisson = 0.3, density = "1000 kg/m^3" }}
support = [{{ on = "x-min", fix = "xyz" }}]
procedure = {{ kind = "modes", modes = 4 }}
method = [{}]
"#,
        methods.join(", ")
    ));
    for run in &runs {
        let first = run["modes"][0]["frequency"]["value"].as_f64().unwrap();
        let warnings = run["warnings"].as_array().unwrap();
        let unseen = warnings.iter().find(|w| w["code"] == "zero-energy-modes");
        assert_eq!(unseen.is_some(), (first / 4.38 - 1.0).abs() > 0.2, "{first} Hz, {run}");
        let Some(unseen) = unseen else { continue };
        assert!(first < 2.0 && unseen["value"].as_f64().unwrap() >= 4.0, "{run}");
        assert!(unseen["message"].as_str().unwrap().contains(&format!("{first:.4} Hz")), "{unseen}");
    }
}
