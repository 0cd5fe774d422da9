//! Layers with a stiffness ratio of 1:1000, from the groups of a mesh file and in explicit dynamics.

mod common;

use common::{objects, tissuebench, write};
use serde_json::Value;
use tempfile::TempDir;

/// Three layers of 8 x 8 x 6 mm along z, each a group, with hexahedra of 2 mm or six tetrahedra for each of
/// them.
fn mesh(tetrahedra: bool) -> String {
    const STEPS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
    const HEX: [[usize; 3]; 8] =
        [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
    let counts = [4, 4, 9];
    let node = |[i, j, k]: [usize; 3]| 1 + i + 5 * (j + 5 * k);
    let grid = |counts: [usize; 3]| {
        (0..counts.iter().product())
            .map(move |n: usize| [n % counts[0], n / counts[0] % counts[1], n / counts[0] / counts[1]])
    };
    let nodes: Vec<String> = grid(counts.map(|n| n + 1))
        .map(|at| format!("{} {} {} {}\n", node(at), 2 * at[0], 2 * at[1], 2 * at[2]))
        .collect();
    let mut cells = Vec::new();
    for at in grid(counts) {
        let layer = at[2] / 3 + 1;
        let corner = |by: [usize; 3]| node([0, 1, 2].map(|x| at[x] + by[x]));
        if !tetrahedra {
            cells.push((5, layer, HEX.map(corner).to_vec()));
            continue;
        }
        for steps in STEPS {
            let mut by = [0; 3];
            let mut cell = vec![corner(by)];
            for axis in steps {
                by[axis] += 1;
                cell.push(corner(by));
            }
            // Odd permutations are mirrored.
            if (steps[1] + 3 - steps[0]) % 3 == 2 {
                cell.swap(1, 2);
            }
            cells.push((4, layer, cell));
        }
    }
    let lines = cells.iter().enumerate().map(|(n, (kind, layer, cell))| {
        let cell: Vec<String> = cell.iter().map(usize::to_string).collect();
        format!("{} {kind} 2 {layer} {layer} {}\n", n + 1, cell.join(" "))
    });
    let names = "$PhysicalNames\n3\n3 1 \"fat\"\n3 2 \"capsule\"\n3 3 \"muscle\"\n$EndPhysicalNames\n";
    format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n{names}$Nodes\n{}\n{}$EndNodes\n$Elements\n{}\n{}$EndElements\n",
        nodes.len(),
        nodes.concat(),
        cells.len(),
        lines.collect::<String>()
    )
}

/// Layers compressed between rollers: the strain in each layer is uniform and follows from its modulus.
fn scene(law: &str, procedure: &str, load: &str, methods: &[String]) -> String {
    format!(
        r#"title = "Three layers of a mesh file"
body = {{ shape = "file", path = "tets.msh", unit = "mm" }}
material = {{ law = "{law}", young = "20 kPa", poisson = 0.45, density = "1000 kg/m^3" }}
region = [{{ name = "stiff", on = "capsule", material = {{ law = "{law}", young = "20 MPa", poisson = 0.3, density = "1000 kg/m^3" }} }},
          {{ name = "soft", on = "muscle", material = {{ law = "{law}", young = "5 kPa", poisson = 0.49, density = "1000 kg/m^3" }} }}]
support = [{{ where = "z <= 0 mm", fix = "z" }}, {{ where = "x <= 0 mm", fix = "x" }}, {{ where = "x >= 8 mm", fix = "x" }},
           {{ where = "y <= 0 mm", fix = "y" }}, {{ where = "y >= 8 mm", fix = "y" }}]
load = [{{ where = "z >= 18 mm", traction = ["0 Pa", "0 Pa", "{load}"] }}]
procedure = {{ {procedure} }}
method = [{}]
"#,
        methods.join(",\n")
    )
}

#[track_caller]
fn run(text: &str) -> Vec<Value> {
    let dir = TempDir::new().unwrap();
    write(&dir, "tets.msh", &mesh(true));
    write(&dir, "hexes.msh", &mesh(false));
    let done = tissuebench(&["run", &write(&dir, "scene.toml", text), "--once", "--format", "json"]);
    assert_eq!(done.code, 0, "{}\n{text}", done.stderr);
    objects(&done.stdout)
}

fn metric(run: &Value, name: &str) -> f64 {
    run["metrics"][name]["value"].as_f64().unwrap_or_else(|| panic!("no {name} in {run}"))
}

fn fem(element: &str, file: &str, dilation: &str) -> String {
    let id = format!("{element}-{dilation}");
    format!(
        r#"{{ id = "{id}", family = "fem", element = "{element}", dilation = "{dilation}", size = {{ file = "{file}.msh" }} }}"#
    )
}

/// Shortening of layers of 6 mm under a pressure (Pa), m, by the modulus without lateral strain.
fn shortening(pressure: f64) -> f64 {
    let confined =
        |young: f64, poisson: f64| young * (1.0 - poisson) / (1.0 + poisson) / (1.0 - 2.0 * poisson);
    let layers = [(20e3, 0.45), (20e6, 0.3), (5e3, 0.49)];
    layers.iter().map(|&(young, poisson)| 6e-3 * pressure / confined(young, poisson)).sum()
}

#[test]
fn no_mean_crosses_the_groups_of_a_file() {
    let cloud = |dilation: &str| {
        format!(
            r#"{{ id = "cloud-{dilation}", family = "efg", size = {{ file = "tets.msh" }}, kernel = "cubic-spline", basis = "linear", support_scale = 1.6, essential = "coupling", regions = "separate", dilation = "{dilation}", integration = {{ rule = "cell-smoothed", order = 2, points = 6 }} }}"#
        )
    };
    let mut methods = Vec::new();
    for dilation in ["nodal-mean", "nodal-near"] {
        methods.extend([fem("tet4", "tets", dilation), fem("hex8", "hexes", dilation), cloud(dilation)]);
    }
    let exact = shortening(1e3);
    for run in run(&scene("linear", "kind = \"linear\"", "-1000 Pa", &methods)) {
        let off = metric(&run, "max-z") / exact - 1.0;
        assert!(off.abs() < 1e-6, "off by {off:e}: {run}");
    }
}

/// Slowly loaded layers in explicit dynamics reach the static solution.
#[test]
fn explicit_dynamics_of_layers_ends_at_the_static_answer() {
    let both = |dilation| [fem("tet4", "tets", dilation), fem("hex8", "hexes", dilation)];
    let methods = ["nodal-mean", "nodal-near"].map(both).concat();
    let still = run(&scene("neo-hookean", "kind = \"static\", steps = 2", "-200 Pa", &methods));
    let explicit = "kind = \"explicit\", over = \"0.12 s\", duration = \"0.12 s\", steps = 2";
    let moving = run(&scene("neo-hookean", explicit, "-200 Pa", &methods));
    let of_law = metric(&still[0], "max-z");
    assert!((of_law / shortening(200.0) - 1.0).abs() < 0.05, "{of_law}");
    for (still, moving) in still.iter().zip(&moving) {
        let (end, start) = (metric(moving, "max-z"), metric(still, "max-z"));
        assert!((start / of_law - 1.0).abs() < 1e-6, "{start} {of_law}: {still}");
        assert!((end / start - 1.0).abs() < 0.02, "{end} {start}: {moving}");
    }
}
