//! Active stress in explicit dynamics.

mod common;

use common::{number, solved};
use serde_json::Value;

fn run(method: &str, more: &str, procedure: &str) -> Value {
    let text = format!(
        r#"title = "A block of muscle, held at one end, with fibres askew"
body = {{ shape = "box", size = ["20 mm", "10 mm", "10 mm"] }}
support = [{{ on = "x-min", fix = "xyz" }}]
procedure = {{ {procedure} }}
[material]
law = "guccione"
c = "2 kPa"
bf = 8.0
bt = 2.0
bfs = 4.0
bulk = "100 kPa"
density = "1000 kg/m^3"
active = "4 kPa"
fibers = [0.8, 0.6, 0]
{more}
[output]
probes = [["20 mm", "10 mm", "10 mm"]]
[[method]]
id = "method"
family = "fem"
{method}
"#
    );
    solved(&tempfile::tempdir().unwrap(), &text)
}

const SLOW: &str = "kind = \"explicit\", duration = \"2 s\", steps = 4, damping = \"60 /s\"";

#[test]
fn a_slow_contraction_ends_at_the_static_answer_of_the_same_mesh() {
    let cells = "size = { cells = [4, 2, 2] }";
    for element in [
        "element = \"hex8\"",
        "element = \"hex8\"\ndilation = \"element-mean\"",
        "element = \"hex8\"\nreduced = true",
        "element = \"tet4\"\ndilation = \"nodal-mean\"",
    ] {
        let method = format!("{element}\n{cells}");
        let still = run(&method, "", "kind = \"static\", steps = 4");
        let moved = run(&method, "", SLOW);
        let probe = |of: &Value, axis: &str| number(of, &format!("probe-{axis}"));
        let far = probe(&still, "x").hypot(probe(&still, "y"));
        assert!(far > 2e-4, "{element}: {far}");
        for axis in ["x", "y", "z"] {
            let gap = probe(&moved, axis) - probe(&still, axis);
            assert!(gap.abs() < 2e-3 * far, "{element} {axis}: {gap} of {far}");
        }
        let [still, energy] = [&still, &moved].map(|of| number(of, "strain-energy"));
        assert!((energy / still - 1.0).abs() < 5e-3, "{element}: {energy} {still}");
        assert!(number(&moved, "energy-drift") < 1e-4, "{element}: {}", number(&moved, "energy-drift"));
    }
}

#[test]
fn a_twitch_swings_and_keeps_its_energy() {
    let curve = "active_curve = \"twitch\"\n[[curve]]\nname = \"twitch\"\ntime = [\"0 s\", \"10 ms\", \"30 ms\"]\nfactor = [0, 1, 0]";
    let swing = "kind = \"explicit\", duration = \"60 ms\", steps = 6";
    let object = run("element = \"hex8\"\nsize = { cells = [4, 2, 2] }", curve, swing);
    // The muscle is at rest again, and the body swings on with the energy of the activation.
    assert!(number(&object, "max") > 1e-3, "{}", number(&object, "max"));
    assert!(number(&object, "energy-drift") < 1e-3, "{}", number(&object, "energy-drift"));
}
