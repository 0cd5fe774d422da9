//! Values at probes: they use the law of the region and the method's projection, and probes outside the mesh
//! are marked.

mod common;

use common::{assert_fails, objects, tissuebench, write};
use serde_json::Value;

/// Mean stress (Pa), stress components xx and zz (Pa), and distance from the mesh (m) of the first probe.
struct Probed {
    mean: f64,
    stress: [f64; 2],
    outside: f64,
}

fn probed(object: &Value) -> Probed {
    assert_eq!(object["status"], "ok", "{object}");
    let probe = &object["probes"][0];
    let stress: Vec<f64> = probe["stress"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
    Probed {
        mean: stress[..3].iter().sum::<f64>() / 3.0,
        stress: [stress[0], stress[2]],
        outside: probe["outside"].as_f64().unwrap(),
    }
}

fn run(text: &str) -> Vec<Value> {
    let dir = tempfile::tempdir().unwrap();
    let done = tissuebench(&["run", &write(&dir, "scene.toml", text), "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    objects(&done.stdout)
}

/// In a bar of two layers under 4 kPa with nu = 0, the stress is the same in both layers, whatever their
/// stiffness.
#[test]
fn stress_is_that_of_the_law_at_the_place() {
    let text = r#"title = "Two layers"
body = { shape = "box", size = ["20 mm", "20 mm", "40 mm"] }
material = { law = "linear", young = "20 kPa", poisson = 0.0 }
region = [{ name = "upper", where = "z >= 20 mm", material = { law = "linear", young = "60 kPa", poisson = 0.0 } }]
support = [{ on = "z-min", fix = "xyz" }]
load = [{ on = "z-max", pressure = "4 kPa" }]
output = { probes = [["11 mm", "9 mm", "31 mm"]] }
method = [
    { id = "tet4", family = "fem", element = "tet4", size = { cells = [2, 2, 4] } },
    { id = "tet4-nodal", family = "fem", element = "tet4", dilation = "nodal-mean", size = { cells = [2, 2, 4] } },
    { id = "hex8-mean", family = "fem", element = "hex8", dilation = "element-mean", size = { cells = [2, 2, 4] } },
]
"#;
    for text in [text.to_string(), text.replace("output =", "procedure = { kind = \"static\" }\noutput =")] {
        for object in run(&text) {
            let [xx, zz] = probed(&object).stress;
            assert!((zz + 4e3).abs() < 1e-6 && xx.abs() < 1e-6, "{object}");
        }
    }
}

/// Lame's thick sphere has the mean stress `p a^3 / (b^3 - a^3)` = 285.7 Pa everywhere. At nu = 0.4999 the
/// stress from the plain displacement gradient is wrong by kilopascals. With the projection it is as accurate
/// as these meshes allow.
#[test]
fn stress_is_that_of_the_projection() {
    let text = r#"title = "Thick sphere"
body = { shape = "sphere-shell", inner = "10 mm", outer = "20 mm", octant = true }
material = { law = "linear", young = "20 kPa", poisson = 0.4999 }
support = [{ on = "x-min", fix = "x" }, { on = "y-min", fix = "y" }, { on = "z-min", fix = "z" }]
load = [{ on = "inner", pressure = "2 kPa" }]
output = { probes = [["8.3 mm", "8.7 mm", "9.1 mm"]] }
method = [
    { id = "hex8-mean", family = "fem", element = "hex8", dilation = "element-mean", size = { level = 3 } },
    { id = "tet10-p1", family = "fem", element = "tet10", dilation = "mixed", size = { level = 2 } },
]
"#;
    let (mixed, linear): (Vec<&str>, Vec<&str>) = text.lines().partition(|line| line.contains("mixed"));
    let linear = linear.join("\n");
    let in_steps = linear.split("method = [").next().unwrap();
    let in_steps = format!("{in_steps}procedure = {{ kind = \"static\" }}\nmethod = [{}]\n", mixed[0]);
    for object in run(&linear).into_iter().chain(run(&in_steps)) {
        let mean = probed(&object).mean;
        assert!((mean - 2e3 / 7.0).abs() < 15.0, "{object}");
    }
}

/// The trace of the stress of a thick sphere is `3 p a^3 / (b^3 - a^3)` = 428.6 Pa everywhere. Away from the
/// points of reduced integration, and of plain quadratic elements, the displacement gradient gives errors of
/// up to three times that value.
#[test]
fn stress_at_a_probe_is_recovered_from_the_points_of_the_method() {
    let text = |poisson: f64| {
        format!(
            r#"title = "Thick sphere"
body = {{ shape = "sphere-shell", inner = "10 mm", outer = "20 mm", octant = true }}
material = {{ law = "linear", young = "20 kPa", poisson = {poisson} }}
support = [{{ on = "x-min", fix = "x" }}, {{ on = "y-min", fix = "y" }}, {{ on = "z-min", fix = "z" }}]
load = [{{ on = "inner", pressure = "1 kPa" }}]
reference = {{ exact = "thick-sphere", inner = "10 mm", outer = "20 mm", inner_pressure = "1 kPa" }}
output = {{ probes = [["7 mm", "7.2 mm", "6.9 mm"], ["15 mm", "1 mm", "0.4 mm"], ["12 mm", "5 mm", "9 mm"]] }}
method = [
    {{ id = "hex20-reduced", family = "fem", element = "hex20", reduced = true, size = {{ level = 2 }} }},
    {{ id = "tet10", family = "fem", element = "tet10", size = {{ level = 2 }} }},
]
"#
        )
    };
    for (poisson, reduced, full) in [(0.49, 0.01, 0.1), (0.499, 0.01, 0.2)] {
        for (object, within) in run(&text(poisson)).iter().zip([reduced, full]) {
            for probe in object["probes"].as_array().unwrap() {
                let stress = probe["stress"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap());
                let trace: f64 = stress.take(3).sum();
                assert!((trace / (3e3 / 7.0) - 1.0).abs() < within, "{poisson}: {trace} Pa, {object}");
            }
            let pressure = object["metrics"]["pressure"]["value"].as_f64().unwrap();
            assert!(pressure < 1.1 * within, "{poisson}: {pressure}, {object}");
        }
    }
}

const BALL: &str = r#"title = "A ball"
body = { shape = "ball", radius = "20 mm" }
material = { law = "linear", young = "20 kPa", poisson = 0.3 }
support = [{ where = "z <= 0 mm", fix = "xyz" }]
load = [{ where = "z >= 10 mm", pressure = "1 kPa" }]
output = { probes = [["12 mm", "9 mm", "13.1 mm"]] }
method = [{ id = "tet4", family = "fem", element = "tet4", size = { level = 3 } }]
"#;

/// A point of the sphere lies outside the flat facets by at most h^2 / (8 R) = 0.6 mm for cells of 10 mm.
#[test]
fn a_probe_outside_the_cells_says_how_far() {
    let outside = probed(&run(BALL)[0]).outside;
    assert!(outside > 1e-6 && outside < 6e-4, "{outside}");
    let warning = &run(BALL)[0]["warnings"][0];
    assert_eq!((&warning["code"], warning["value"].as_f64()), (&"probe-outside".into(), Some(outside)));
    assert_eq!((&warning["where"], &warning["unit"]), (&"output.probes[0]".into(), &"m".into()));
    assert_eq!(probed(&run(&BALL.replace("13.1 mm", "3 mm"))[0]).outside, 0.0);
}

#[test]
fn a_probe_far_from_the_body_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let path = write(&dir, "far.toml", &BALL.replace("13.1 mm", "131 mm"));
    assert_fails(
        &tissuebench(&["run", &path]),
        2,
        "far.toml:6: key 'output.probes[0]': (12.0, 9.0, 131.0) mm",
    );
}
