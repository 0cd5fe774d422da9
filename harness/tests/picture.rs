//! What runs leave for the pictures: tools where they stand, and the pressure of a section as each method has it.

mod common;

use common::{PRESSED, inside, packed, tissuebench, write};
use serde_json::Value;

fn floats(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
}

/// A block between plates is stretched alike everywhere, its sides free: true stress `F l / (A J)` along z and none across, so
/// that `p = F l / (3 A J)` in every cell of every method, whatever its dilation is.
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
        // The plates close by 2 and 1 mm, less what they sink in.
        let height = 20e-3 - 3e-3 + 2.0 * number("penetration");
        // The force per undeformed area of 40 x 40 mm, times l / J.
        let expected = number("tool-force") / 1.6e-3 * (height / 20e-3) / number("smallest-j") / 3.0;
        // The cloud's sides are held by penalty at 1e4 E / h.
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
        // Contact points of both plates: each in its place, as deep as the plates sink in.
        let end = field["body"]["states"].as_array().unwrap().last().unwrap();
        let touching = packed(&end["touching"]);
        assert!(touching.len() >= 8, "{id}");
        for point in touching.chunks_exact(4) {
            let depth = f64::from(point[3]);
            assert!((depth / number("penetration") - 1.0).abs() < 1e-3, "{id}: {depth}");
        }
        assert!((end["deepest_node"].as_f64().unwrap() / number("penetration") - 1.0).abs() < 1e-3, "{id}");
        // Every point of the surface is off from the reference, none by more than the largest error.
        let body = &field["body"];
        let off = packed(&body["off"]);
        assert_eq!(packed(&body["points"]).len(), 3 * off.len(), "{id}");
        let most = f64::from(off.iter().copied().fold(0.0, f32::max));
        assert!(most <= number("max-error") * (1.0 + 1e-6) + 1e-12, "{id}: {most}");
        // The stress is uniform: recovered at every point of the surface and inside it is that of the cells.
        let inner = body["inside"]["states"].as_array().unwrap().last().unwrap();
        for at in [end, inner] {
            for p in packed(&at["values"][0]) {
                assert!((f64::from(p) / expected - 1.0).abs() < tolerance.max(1e-5), "{id}: {p} {expected}");
            }
        }
        assert_eq!(packed(&inner["values"][0]).len(), packed(&body["inside"]["points"]).len() / 3, "{id}");
        // The nodes of the cloud, and of no other.
        let nodes = if id == "efg" { run["nodes"].as_u64().unwrap() as usize } else { 0 };
        assert_eq!(packed(&field["body"]["cloud"]).len(), 3 * nodes, "{id}");
        // The whole deformed height is cut.
        assert!((span.1 - span.0 - height).abs() < 1e-3 * height, "{id}: {span:?} {height}");
        // The faces of both plates, where they stand at the end.
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
