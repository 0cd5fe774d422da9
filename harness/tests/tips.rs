//! Tools that press on tips and edges of the body.

mod common;

use std::collections::HashMap;

use common::blocks::{Blocks, even};
use common::{objects, tissuebench, write};
use serde_json::Value;

/// A pyramid of 16 x 16 mm, 16 mm high: four tetrahedra, each divided into eight, `times` times.
fn pyramid(times: usize) -> String {
    let mut points: Vec<[f64; 3]> = vec![
        [-8.0, -8.0, 0.0],
        [8.0, -8.0, 0.0],
        [8.0, 8.0, 0.0],
        [-8.0, 8.0, 0.0],
        [0.0, 0.0, 16.0],
        [0.0; 3],
    ];
    let mut cells: Vec<[usize; 4]> = (0..4).map(|k| [k, (k + 1) % 4, 5, 4]).collect();
    for _ in 0..times {
        let mut middles = HashMap::new();
        let divided = cells.iter().flat_map(|&[a, b, c, d]| {
            let mut middle = |a: usize, b: usize| {
                *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                    points.push(std::array::from_fn(|x| 0.5 * (points[a][x] + points[b][x])));
                    points.len() - 1
                })
            };
            let [ab, ac, ad] = [b, c, d].map(|end| middle(a, end));
            let [bc, bd, cd] = [middle(b, c), middle(b, d), middle(c, d)];
            let corners = [[a, ab, ac, ad], [b, bc, ab, bd], [c, ac, bc, cd], [d, bd, ad, cd]];
            let inner = [[ab, ac, ad, bd], [ab, bc, ac, bd], [ac, cd, ad, bd], [ac, bc, cd, bd]];
            corners.into_iter().chain(inner).collect::<Vec<_>>()
        });
        cells = divided.collect();
    }
    for cell in &mut cells {
        let edge =
            |k: usize| -> [f64; 3] { std::array::from_fn(|x| points[cell[k]][x] - points[cell[0]][x]) };
        let ([a, b, c], [d, e, f], [g, h, i]) = (edge(1), edge(2), edge(3));
        if a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g) < 0.0 {
            cell.swap(1, 2);
        }
    }
    let nodes = points.iter().enumerate().map(|(n, [x, y, z])| format!("{} {x} {y} {z}\n", n + 1));
    let lines = cells.iter().enumerate().map(|(n, cell)| {
        let [a, b, c, d] = cell.map(|node| node + 1);
        format!("{} 4 2 1 1 {a} {b} {c} {d}\n", n + 1)
    });
    format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n{}$EndNodes\n$Elements\n{}\n{}$EndElements\n",
        points.len(),
        nodes.collect::<String>(),
        cells.len(),
        lines.collect::<String>()
    )
}

/// Removes cells in which a node occurs twice.
fn without_flat_cells(mesh: &str) -> String {
    let (head, elements) = mesh.split_once("$Elements\n").unwrap();
    let distinct = |line: &&str| {
        let mut nodes: Vec<&str> = line.split(' ').skip(5).collect();
        nodes.sort_unstable();
        nodes.windows(2).all(|two| two[0] != two[1])
    };
    let kept: Vec<&str> = elements.lines().skip(1).filter(|l| !l.starts_with('$')).filter(distinct).collect();
    format!("{head}$Elements\n{}\n{}\n$EndElements\n", kept.len(), kept.join("\n"))
}

/// A roof: a block tapered to a ridge.
fn roof(cells: usize) -> String {
    let even = even(1.0, cells);
    let places =
        |[x, y, z]: [f64; 3], _: [f64; 3]| [(x - 0.5) * 16.0 * (1.0 - z), 16.0 * (y - 0.5), 12.0 * z];
    without_flat_cells(
        &Blocks { lines: [&even, &even, &even], keeps: &|_| true, places: &places, surfaces: &[] }.gmsh(),
    )
}

const PLATE: &str = r#"shape = "plate""#;
const BALL: &str = r#"shape = "sphere", radius = "8 mm""#;

/// Runs a body that is fixed at its base under a tool, which moves down from the height `at` (mm); returns
/// the JSON objects.
fn run(
    mesh: &str,
    tool: &str,
    at: f64,
    closure: &str,
    procedure: &str,
    methods: &[(&str, &str)],
) -> Vec<Value> {
    let dir = tempfile::tempdir().unwrap();
    let path = write(&dir, "tip.msh", mesh);
    let method =
        |(id, rest): &(&str, &str)| format!(r#"{{ id = "{id}", {rest}, size = {{ file = "{path}" }} }}"#);
    let methods: Vec<String> = methods.iter().map(method).collect();
    let scene = format!(
        r#"title = "A tool on a tip"
body = {{ shape = "file", path = "{path}", unit = "mm" }}
material = {{ law = "neo-hookean", young = "20 kPa", poisson = 0.4, density = "1000 kg/m^3" }}
support = [{{ where = "z <= 0.001 mm", fix = "xyz" }}]
procedure = {{ {procedure} }}
tool = [{{ name = "tool", {tool}, at = ["0 mm", "0 mm", "{at} mm"], along = [0, 0, -1], drive = {{ closure = "{closure}" }}, penalty = "0.5 MPa/mm" }}]
method = [{}]
"#,
        methods.join(", ")
    );
    let done = tissuebench(&["run", &write(&dir, "tip.toml", &scene), "--format", "json"]);
    assert_eq!(done.code, 0, "{tool}, {closure}: {}", done.stderr);
    objects(&done.stdout)
}

fn value(object: &Value, metric: &str) -> f64 {
    object["metrics"][metric]["value"].as_f64().unwrap_or_else(|| panic!("no {metric} in {object}"))
}

const TET10: (&str, &str) = ("tet10", r#"family = "fem", element = "tet10""#);
const STATIC: &str = r#"kind = "static", steps = 4"#;

#[test]
fn a_tip_carries_in_every_procedure_and_a_finer_mesh_agrees() {
    let mut of_tools = Vec::new();
    for (tool, at) in [(PLATE, 16.0), (BALL, 24.0)] {
        let forces = [1, 2].map(|times| {
            let done = run(&pyramid(times), tool, at, "3 mm", STATIC, &[TET10]);
            value(&done[0], "tool-force")
        });
        assert!(forces[1] > 1e-2 && (forces[0] / forces[1] - 1.0).abs() < 0.2, "{tool}: {forces:?}");
        of_tools.push(forces[0]);
    }
    let implicit = r#"kind = "implicit-dynamic", duration = "10 s", steps = 4, inertia = false"#;
    let slow = value(&run(&pyramid(1), PLATE, 16.0, "3 mm", implicit, &[TET10])[0], "tool-force");
    assert!((slow / of_tools[0] - 1.0).abs() < 1e-2, "{slow} {of_tools:?}");
    let explicit = r#"kind = "explicit", duration = "0.2 s", steps = 4"#;
    let tet4 = ("tet4", r#"family = "fem", element = "tet4""#);
    let [still, moving] = [STATIC, explicit].map(|way| {
        let done = run(&pyramid(1), PLATE, 16.0, "3 mm", way, &[tet4]);
        value(&done[0], "tool-force")
    });
    assert!((moving / still - 1.0).abs() < 0.1, "{moving} {still}");
}

/// A tip of four cells carries the plate, but is too stiff. The run warns of this with a position.
#[test]
fn a_tip_of_few_cells_carries_with_a_warning() {
    let [coarse, fine] =
        [0, 2].map(|times| run(&pyramid(times), PLATE, 16.0, "3 mm", STATIC, &[TET10]).remove(0));
    let told = |run: &Value| {
        let warnings = run["warnings"].as_array().unwrap().clone();
        let few = warnings.iter().find(|w| w["code"] == "few-cells").map(|w| w["message"].to_string());
        few.is_some_and(|message| message.contains("cells across") && message.contains(" mm"))
    };
    let forces = [&coarse, &fine].map(|run| value(run, "tool-force"));
    assert!(forces[0] > 1.2 * forces[1], "{forces:?}");
    assert!(told(&coarse), "{coarse}");
}

#[test]
fn small_closures_and_clouds_and_edges_carry_too() {
    let cloud = r#"family = "efg", kernel = "cubic-spline", support_scale = 1.6, basis = "linear", integration = { rule = "gauss", points = 4 }, essential = "penalty""#;
    let methods = [TET10, ("tet4", r#"family = "fem", element = "tet4""#), ("cloud", cloud)];
    for (name, mesh, at) in [("tip", pyramid(1), 16.0), ("ridge", roof(2), 12.0)] {
        for closure in ["0.05 mm", "0.5 mm"] {
            for (tool, at) in [(PLATE, at), (BALL, at + 8.0)] {
                for done in run(&mesh, tool, at, closure, STATIC, &methods) {
                    let (force, held) = (value(&done, "tool-force"), value(&done, "reaction-z"));
                    assert!(
                        force > 0.0 && (held / force - 1.0).abs() < 1e-5,
                        "{name}, {tool}, {closure}: {force} {held}"
                    );
                }
            }
        }
    }
}
