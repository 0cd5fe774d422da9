//! Data for the pictures: tools at their positions, and each method's pressure in a section.

mod common;

use common::{PRESSED, inside, packed, tissuebench, write};
use serde_json::Value;

fn floats(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
}

/// A block between plates with free sides has a uniform state: the true stress is `F l / (A J)` along z and
/// zero laterally, so `p = F l / (3 A J)` in every cell of every method, whatever its treatment of the
/// dilation.
#[test]
fn a_section_between_plates_has_the_pressure_of_the_force() {
    let dir = tempfile::tempdir().unwrap();
    let out = inside(&dir, "out");
    let scene = format!("{PRESSED}reference = {{ method = \"hex8\" }}\n");
    let done = tissuebench(&["run", &write(&dir, "pressed.toml", &scene), "--format", "json", "--out", &out]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let mut seen = 0;
    for line in done.stdout.lines() {
        let run: Value = serde_json::from_str(line).unwrap();
        let id = run["method"].as_str().unwrap();
        let text = std::fs::read_to_string(format!("{out}/fields/pressed--{id}.json")).unwrap();
        let field: Value = serde_json::from_str(&text).unwrap();
        let number = |name: &str| run["metrics"][name]["value"].as_f64().unwrap();
        // The plates move by 2 and 1 mm, minus their penetration.
        let height = 20e-3 - 3e-3 + 2.0 * number("penetration");
        // The expected pressure is the force per undeformed area of 40 x 40 mm, times l / J, over 3.
        let expected = number("tool-force") / 1.6e-3 * (height / 20e-3) / number("smallest-j") / 3.0;
        // The cloud's sides are constrained by a penalty of 1e4 E / h.
        let tolerance = if id == "efg" { 2e-3 } else { 1e-6 };
        let cells = field["section"]["cells"].as_array().unwrap();
        assert!(!cells.is_empty(), "{id}");
        let mut span = (f64::MAX, f64::MIN);
        for cell in cells {
            let p = cell["pressure"].as_f64().unwrap();
            assert!((p / expected - 1.0).abs() < tolerance, "{id}: {p} {expected}");
            for corner in cell["corners"].as_array().unwrap() {
                let z = floats(corner)[2];
                span = (span.0.min(z), span.1.max(z));
            }
        }
        // The contact points of both plates have the right position and penetration.
        let end = field["body"]["states"].as_array().unwrap().last().unwrap();
        let touching = packed(&end["touching"]);
        assert!(touching.len() >= 8, "{id}");
        for point in touching.chunks_exact(4) {
            let depth = f64::from(point[3]);
            assert!((depth / number("penetration") - 1.0).abs() < 1e-3, "{id}: {depth}");
        }
        assert!((end["deepest_node"].as_f64().unwrap() / number("penetration") - 1.0).abs() < 1e-3, "{id}");
        // Every surface point differs from the reference, by at most the largest error.
        let body = &field["body"];
        let off = packed(&body["off"]);
        assert_eq!(packed(&body["points"]).len(), 3 * off.len(), "{id}");
        let most = f64::from(off.iter().copied().fold(0.0, f32::max));
        assert!(most <= number("max-error") * (1.0 + 1e-6) + 1e-12, "{id}: {most}");
        // The stress is uniform: recovered values at all points on the surface and inside equal those of the
        // cells.
        let inner = body["inside"]["states"].as_array().unwrap().last().unwrap();
        for at in [end, inner] {
            for p in packed(&at["values"][0]) {
                assert!((f64::from(p) / expected - 1.0).abs() < tolerance.max(1e-5), "{id}: {p} {expected}");
            }
        }
        assert_eq!(packed(&inner["values"][0]).len(), packed(&body["inside"]["points"]).len() / 3, "{id}");
        // Only the cloud has its nodes in the data.
        let nodes = if id == "efg" { run["nodes"].as_u64().unwrap() as usize } else { 0 };
        assert_eq!(packed(&field["body"]["cloud"]).len(), 3 * nodes, "{id}");
        // The section covers the whole deformed height.
        assert!((span.1 - span.0 - height).abs() < 1e-3 * height, "{id}: {span:?} {height}");
        // The faces of both plates are at their final positions.
        let face = |k: usize, pick: fn(f64, f64) -> f64, start: f64| {
            let points = field["tools"][k]["points"].as_array().unwrap();
            points.iter().map(|p| floats(p)[2]).fold(start, pick)
        };
        let (upper, lower) = (face(0, f64::min, f64::MAX), face(1, f64::max, f64::MIN));
        assert!((upper - lower - 17e-3).abs() < 1e-12, "{id}: {upper} {lower}");
        seen += 1;
    }
    assert_eq!(seen, 5);
}
