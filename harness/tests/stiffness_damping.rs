//! Damping in proportion to the stiffness, in both kinds of dynamics.

mod common;

use common::{assert_fails, number, solved, tissuebench, write};
use serde_json::Value;

fn bar(material: &str, method: &str, procedure: &str) -> String {
    format!(
        r#"title = "A bar that rings"
body = {{ shape = "box", size = ["100 mm", "10 mm", "10 mm"] }}
material = {{ {material}, density = "1000 kg/m^3" }}
support = [{{ on = "x-min", fix = "xyz" }}]
load = [{{ on = "x-max", traction = ["20 Pa", "0 Pa", "0 Pa"] }}]
procedure = {{ {procedure}, over = "0 s", duration = "500 ms", steps = 240 }}
output = {{ probes = [["100 mm", "5 mm", "5 mm"]] }}
[[method]]
id = "method"
family = "fem"
{method}
"#
    )
}

const ELASTIC: &str = "law = \"neo-hookean\", young = \"20 kPa\", poisson = 0";
const HEX8: &str = "element = \"hex8\"\nsize = { cells = [12, 1, 1] }";
const IMPLICIT: &str = "kind = \"implicit-dynamic\", spectral_radius = 1";
const EXPLICIT: &str = "kind = \"explicit\"";

#[track_caller]
fn run(method: &str, procedure: &str) -> Value {
    solved(&tempfile::tempdir().unwrap(), &bar(ELASTIC, method, procedure))
}

#[test]
fn the_damping_ratio_is_rayleighs() {
    let omega = std::f64::consts::PI / 0.2 * 20f64.sqrt();
    for kind in [IMPLICIT, EXPLICIT] {
        for (mass, stiffness) in [(0.0, 1e-3), (4.0, 1e-3), (0.0, 3e-3)] {
            let damping = format!("{kind}, damping = \"{mass} /s\", stiffness_damping = \"{stiffness} s\"");
            let object = run(HEX8, &damping);
            let expected = mass / (2.0 * omega) + stiffness * omega / 2.0;
            let ratio = number(&object, "damping-ratio");
            assert!((ratio / expected - 1.0).abs() < 0.01, "{damping}: {ratio} {expected}");
            assert!(
                number(&object, "energy-drift").abs() < 0.01,
                "{damping}: {}",
                number(&object, "energy-drift")
            );
        }
    }
}

#[test]
fn a_pressure_field_is_damped_like_other_elements() {
    let damping = format!("{IMPLICIT}, stiffness_damping = \"1 ms\"");
    let ratio = |method: &str| number(&run(method, &damping), "damping-ratio");
    let plain = ratio("element = \"hex20\"\nsize = { cells = [6, 1, 1] }");
    let mixed = ratio("element = \"hex20\"\ndilation = \"mixed\"\nsize = { cells = [6, 1, 1] }");
    assert!((mixed / plain - 1.0).abs() < 0.01, "{mixed} {plain}");
}

#[test]
fn stiffness_damping_shortens_the_critical_step() {
    let step = |damping: &str| number(&run(HEX8, &format!("{EXPLICIT}, {damping}")), "critical-step");
    let free = step("damping = \"0 /s\"");
    let damped = step("stiffness_damping = \"3 ms\"");
    // With the largest frequency w = 2 / dt: 4 / (g + sqrt(g^2 + 4 w^2)), g = 3 ms w^2. The safety of the estimate
    // is in both.
    let omega = 0.95 * 2.0 / free;
    let gamma = 3e-3 * omega * omega;
    let expected = 0.95 * 4.0 / (gamma + (gamma * gamma + 4.0 * omega * omega).sqrt());
    assert!((damped / expected - 1.0).abs() < 0.02 && damped < 0.5 * free, "{damped} {expected} {free}");
}

#[test]
fn damping_that_cannot_be_said_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let refused = |material: &str, procedure: &str, says: &str| {
        let text = bar(material, HEX8, procedure);
        assert_fails(&tissuebench(&["run", &write(&dir, "scene.toml", &text)]), 2, says);
    };
    let negative = format!("{IMPLICIT}, stiffness_damping = \"-1 ms\"");
    refused(ELASTIC, &negative, "key 'procedure.stiffness_damping': '-1 ms' is negative");
    let still = "kind = \"implicit-dynamic\", inertia = false, stiffness_damping = \"1 ms\"";
    refused(ELASTIC, still, "is of a motion, and inertia = false has none");
    let relaxing = format!("{ELASTIC}, prony = [{{ g = 0.4, tau = \"0.3 s\" }}]");
    let damped = format!("{IMPLICIT}, stiffness_damping = \"1 ms\"");
    refused(&relaxing, &damped, "changes the internal forces by itself");
}
