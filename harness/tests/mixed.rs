//! Hexahedra and wedges of one mesh file in one body: exactness, contact, pressure, dynamics, output, and
//! refusals.

mod common;

use common::{assert_fails, objects, tissuebench, write};
use serde_json::Value;
use tempfile::TempDir;

/// A mesh file of the geometry crate: two cubes with hexahedra on the left and wedges on the right, 2 x 1 x
/// 1.
fn file(name: &str) -> String {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../solvers/mesh-files/tests/files");
    format!("{folder}/{name}")
}

/// A scene of the two cubes, in cm.
fn scene(file: &str, rest: &str, methods: &[&str]) -> String {
    let method = |element: &&str| {
        format!(
            "[[method]]\nid = \"{element}\"\nfamily = \"fem\"\nelement = \"{element}\"\nsize = {{ file = '{file}', unit = \"cm\" }}\n"
        )
    };
    let methods: String = methods.iter().map(method).collect();
    format!(
        "title = \"Mixed\"\nbody = {{ shape = \"file\", path = '{file}', unit = \"cm\" }}\n{rest}\n{methods}"
    )
}

const PATCH: &str = "material = { law = \"linear\", young = \"20 kPa\", poisson = 0.3 }\n\
                     support = [{ on = \"surface\", move = \"exact\" }]\n";

fn run(dir: &TempDir, text: &str) -> Vec<Value> {
    let done = tissuebench(&["run", &write(dir, "scene.toml", text), "--once", "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    objects(&done.stdout)
}

fn metric(run: &Value, name: &str) -> f64 {
    run["metrics"][name]["value"].as_f64().unwrap_or_else(|| panic!("no {name} in {run}"))
}

#[test]
fn fields_of_the_cells_order_are_exact_from_every_format() {
    let dir = TempDir::new().unwrap();
    for format in ["2.2-text.msh", "4.1-binary.msh", "gmsh.inp", "meshio-zlib.vtu", "vtk-5.1-binary.vtk"] {
        let affine = format!("{PATCH}reference = {{ exact = \"affine\" }}\n");
        let text = scene(&file(&format!("mixed1-{format}")), &affine, &["mixed-linear", "mixed-quadratic"]);
        for of in run(&dir, &text) {
            assert!(metric(&of, "l2") < 1e-12 && metric(&of, "stress") < 1e-12, "{format}: {of}");
        }
        let quadratic = format!(
            "{PATCH}load = [{{ body = \"exact\" }}]\nreference = {{ exact = \"quadratic-patch\" }}\n"
        );
        let text = scene(&file(&format!("mixed2-{format}")), &quadratic, &["mixed-quadratic"]);
        for of in run(&dir, &text) {
            assert!(metric(&of, "l2") < 1e-11, "{format}: {of}");
        }
    }
}

/// Pressed between the held end and a plate, and loaded by a pressure: mixed cells agree with tetrahedra, in
/// statics and in explicit dynamics, and every state is written.
#[test]
fn mixed_cells_do_what_tetrahedra_do() {
    let dir = TempDir::new().unwrap();
    let rest = "material = { law = \"neo-hookean\", young = \"20 kPa\", poisson = 0.3, density = \"1000 kg/m^3\" }\n\
                support = [{ on = \"held\", fix = \"xyz\" }]\n\
                load = [{ on = \"pressed\", pressure = \"1 kPa\" }]\n";
    let steps = "procedure = { kind = \"static\", steps = 2 }\n";
    let text = scene(&file("mixed2-2.2-text.msh"), &format!("{rest}{steps}"), &["mixed-quadratic"]);
    let own = metric(&run(&dir, &text)[0], "max");
    let tets = dir.path().join("tets.msh");
    let made = tissuebench(&[
        "mesh",
        "convert",
        &file("mixed1-2.2-text.msh"),
        tets.to_str().unwrap(),
        "--element",
        "tet10",
    ]);
    assert_eq!(made.code, 0, "{}", made.stderr);
    let theirs =
        metric(&run(&dir, &scene(tets.to_str().unwrap(), &format!("{rest}{steps}"), &["tet10"]))[0], "max");
    assert!((own / theirs - 1.0).abs() < 0.02, "{own} for {theirs}");
    let out = dir.path().join("fields");
    let path = write(&dir, "scene.toml", &text);
    let fields = tissuebench(&["fields", &path, "--out", out.to_str().unwrap()]);
    assert_eq!(fields.code, 0, "{}", fields.stderr);
    // A plate and explicit dynamics, with linear cells.
    let plate = "tool = [{ name = \"plate\", shape = \"plate\", at = [\"20 mm\", \"5 mm\", \"5 mm\"], along = [-1, 0, 0], \
                 drive = { closure = \"2 mm\" }, penalty = \"0.5 MPa/mm\" }]\n";
    let held = rest.split_once("load").unwrap().0;
    let procedure = "procedure = { kind = \"static\", steps = 4 }\n";
    let text = scene(&file("mixed1-gmsh.inp"), &format!("{held}{plate}{procedure}"), &["mixed-linear"]);
    let force = metric(&run(&dir, &text)[0], "tool-force");
    assert!((0.15..0.35).contains(&force), "{force}");
    let procedure =
        "procedure = { kind = \"explicit\", over = \"0.12 s\", duration = \"0.12 s\", steps = 2 }\n";
    let text = scene(&file("mixed1-gmsh.inp"), &format!("{rest}{procedure}"), &["mixed-linear"]);
    let moved = metric(&run(&dir, &text)[0], "max");
    assert!((moved / own - 1.0).abs() < 0.1, "{moved} for {own}");
    // Row sums would give corners of quadratic cells a negative mass.
    let text = scene(&file("mixed2-gmsh.inp"), &format!("{rest}{procedure}"), &["mixed-quadratic"]);
    let moved = metric(&run(&dir, &text)[0], "max");
    assert!((moved / own - 1.0).abs() < 0.1, "{moved} for {own}");
}

#[test]
fn cells_of_another_kind_are_refused_with_a_way_out() {
    let dir = TempDir::new().unwrap();
    let affine = format!("{PATCH}reference = {{ exact = \"affine\" }}\n");
    let refused = |text: &str, says: &str| {
        assert_fails(&tissuebench(&["run", &write(&dir, "scene.toml", text)]), 2, says);
    };
    let mixed = |name: &str, element: &str| scene(&file(name), &affine, &[element]);
    refused(&mixed("mixed1-2.2-text.msh", "hex8"), "holds mixed cells, not hex8");
    refused(&mixed("mixed1-2.2-text.msh", "hex8"), "element = \"mixed-linear\"");
    refused(&mixed("mixed2-2.2-text.msh", "mixed-linear"), "holds quadratic cells, not mixed-linear");
    let of_file = mixed("mixed1-2.2-text.msh", "mixed-linear");
    let (head, _) = of_file.rsplit_once("size = ").unwrap();
    refused(&format!("{head}size = {{ level = 1 }}\n"), "makes cells of one kind, not mixed-linear");
    let reduced = mixed("mixed2-2.2-text.msh", "mixed-quadratic") + "reduced = true\n";
    refused(&reduced, "applies to hex8, hex20 or wedge15 only");
}
