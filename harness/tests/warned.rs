//! Warnings with numbers for results that are wrong because of the model or the mesh. A correct version of
//! the same scene gives no warning.

mod common;

use common::{assert_fails, inside, objects, tissuebench, write};
use serde_json::Value;
use tempfile::TempDir;

/// Runs a scene and returns its JSON objects.
#[track_caller]
fn run(text: &str) -> Vec<Value> {
    run_in(&tempfile::tempdir().unwrap(), text)
}

#[track_caller]
fn run_in(dir: &TempDir, text: &str) -> Vec<Value> {
    let done = tissuebench(&["run", &write(dir, "scene.toml", text), "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    objects(&done.stdout)
}

/// Value and scene key of a warning of the first run.
fn warned(runs: &[Value], code: &str) -> Option<(f64, String)> {
    let all = runs[0]["warnings"].as_array().unwrap();
    let found = all.iter().find(|w| w["code"] == code)?;
    Some((found["value"].as_f64().unwrap(), found["where"].as_str().unwrap().to_string()))
}

const UNDER_A_PLATE: &str = r#"title = "A block under a plate"
body = { shape = "box", size = ["30 mm", "30 mm", "30 mm"] }
material = { law = "neo-hookean", young = "10 kPa", poisson = 0.4, density = "1000 kg/m^3" }
support = [{ on = "z-min", fix = "xyz" }]
tool = [{ name = "plate", shape = "plate", at = ["0 mm", "0 mm", "31 mm"], along = [0, 0, -1], drive = { closure = "4 mm" }, penalty = "PENALTY MPa/mm" }]
procedure = { kind = "static", steps = 2 }
method = [{ id = "hex8", family = "fem", element = "hex8", dilation = "element-mean", size = { cells = [3, 3, 3] } }]
"#;

/// The relevant travel starts when the plate meets the block: 3 of 4 mm.
#[test]
fn a_penalty_that_lets_a_tool_sink_in_is_told() {
    let soft = run(&UNDER_A_PLATE.replace("PENALTY", "0.002"));
    let (part, key) = warned(&soft, "deep-penetration").unwrap_or_else(|| panic!("{soft:?}"));
    let deepest = soft[0]["metrics"]["penetration"]["value"].as_f64().unwrap();
    assert!((part - deepest / 3e-3).abs() < 1e-9 && part > 0.05, "{part} {deepest}");
    assert_eq!(key, "tool[0].penalty");
    assert!(warned(&run(&UNDER_A_PLATE.replace("PENALTY", "0.2")), "deep-penetration").is_none());
    let moving = "kind = \"explicit\", duration = \"20 ms\", steps = 4";
    let moving = |penalty| {
        run(&UNDER_A_PLATE.replace("PENALTY", penalty).replace("kind = \"static\", steps = 2", moving))
    };
    assert!(warned(&moving("0.002"), "deep-penetration").is_some());
    assert!(warned(&moving("1"), "deep-penetration").is_none());
}

/// For a body that rests on a tool by its weight, the penetration is compared with the body's size, not with
/// the travel of the tool.
#[test]
fn a_body_that_rests_on_a_floor_does_not_sink_into_it() {
    let floor = |penalty: &str| {
        run(&format!(
            r#"title = "A block on a floor"
body = {{ shape = "box", size = ["20 mm", "20 mm", "10 mm"] }}
material = {{ law = "neo-hookean", young = "200 kPa", poisson = 0.3, density = "1000 kg/m^3" }}
load = [{{ body = ["2000 N/m^3", "0 N/m^3", "-9810 N/m^3"] }}]
tool = [{{ name = "floor", shape = "plate", at = ["0 mm", "0 mm", "0 mm"], along = [0, 0, 1], drive = {{ closure = "0.0001 mm" }}, penalty = "{penalty} MPa/mm", friction = 0.3, stick = "0.05 MPa/mm" }}]
procedure = {{ kind = "implicit-dynamic", over = "0 s", duration = "0.2 s", steps = 100, iterations = 40 }}
method = [{{ id = "hex8", family = "fem", element = "hex8", size = {{ cells = [3, 3, 2] }} }}]
"#
        ))
    };
    let hard = floor("0.05");
    assert!(warned(&hard, "deep-penetration").is_none(), "{hard:?}");
    // The oscillation after the sudden weight has decayed long before the end.
    assert!(warned(&hard, "step-error").is_none(), "{hard:?}");
    assert!(hard[0]["warnings"].as_array().unwrap().is_empty(), "{hard:?}");
    assert!(warned(&floor("0.00005"), "deep-penetration").is_some());
}

/// Strains and forces of a rigidly moved body are rounding.
#[test]
fn rounding_of_a_body_that_moves_as_a_whole_is_nothing() {
    let moved = |rest: &str| {
        run(&format!(
            r#"title = "Moved as a whole"
body = {{ shape = "box", size = ["40 mm", "40 mm", "20 mm"] }}
material = {{ law = "neo-hookean", young = "20 kPa", poisson = 0.45, density = "1000 kg/m^3" }}
{rest}
output = {{ probes = [["10 mm", "20 mm", "20 mm"]] }}
method = [{{ id = "hex8", family = "fem", element = "hex8", size = {{ cells = [4, 4, 4] }} }}]
"#
        ))
    };
    // The supports differ at their common edge by rounding only.
    let meet = "support = [{ on = \"z-min\", move = [\"3.3 mm\", \"1.7 mm\", \"5.1 mm\"] }, { on = \"x-min\", move = [{ unit = \"mm\", of = \"3.3 + 1e-17 * y\" }, \"1.7 mm\", \"5.1 mm\"] }]";
    let shifted = moved(&format!("{meet}\nprocedure = {{ kind = \"static\", steps = 3 }}"));
    assert_eq!(shifted[0]["status"], "ok", "{shifted:?}");
    assert!((shifted[0]["metrics"]["max-z"]["value"].as_f64().unwrap() - 5.1e-3).abs() < 1e-15);
    let fallen = moved(
        "load = [{ body = [\"500 N/m^3\", \"0 N/m^3\", \"-9810 N/m^3\"] }]\nprocedure = { kind = \"explicit\", over = \"0 s\", duration = \"0.1 s\", steps = 5 }",
    );
    for runs in [shifted, fallen] {
        assert!(runs[0]["warnings"].as_array().unwrap().is_empty(), "{runs:?}");
    }
}

/// Symmetry planes prescribe a displacement of exactly zero; the exact solution has 1e-17 m there.
#[test]
fn an_exact_solution_that_is_rounding_on_a_plane_is_no_other_problem() {
    let dir = tempfile::tempdir().unwrap();
    let scene = |factor: &str| {
        format!(
            r#"title = "A thick sphere from a file"
body = {{ shape = "file", path = "octant.msh", unit = "mm" }}
material = {{ law = "linear", young = "20 kPa", poisson = 0.3 }}
support = [{{ on = "x-min", fix = "x" }}, {{ on = "y-min", fix = "y" }}, {{ on = "z-min", fix = "z" }}]
load = [{{ on = "inner", pressure = "{factor} Pa" }}]
reference = {{ exact = "thick-sphere", inner = "10 mm", outer = "20 mm", inner_pressure = "100 Pa" }}
method = [{{ id = "tet10", family = "fem", element = "tet10", size = {{ file = "octant.msh", unit = "mm" }} }}]
"#
        )
    };
    let mesh = geometry::generate::sphere_shell_mesh(
        geometry::CellKind::Tet10,
        10e-3,
        20e-3,
        [3, 3],
        1.0,
        geometry::generate::ShellExtent::Octant,
    );
    // Coordinates on the planes differ from zero by rounding, as in files of mesh generators.
    let mesh = mesh.unwrap().moved(|x| x.map(|c| if c == 0.0 { 3e-18 } else { c })).unwrap();
    mesh_files::write(&mesh, dir.path().join("octant.msh").as_path(), 1e-3).unwrap();
    assert!(warned(&run_in(&dir, &scene("100")), "exact-misfit").is_none());
    assert!(warned(&run_in(&dir, &scene("-100")), "exact-misfit").is_some());
}

fn shell(law: &str, pressure: &str) -> String {
    format!(
        r#"title = "A shell blown up"
body = {{ shape = "sphere-shell", inner = "8 mm", outer = "12 mm", octant = true }}
material = {{ law = "{law}", young = "20 kPa", poisson = 0.45 }}
support = [{{ on = "x-min", fix = "x" }}, {{ on = "y-min", fix = "y" }}, {{ on = "z-min", fix = "z" }}]
load = [{{ on = "inner", pressure = "{pressure}", dead = true }}]
procedure = {{ kind = "static", steps = 4 }}
method = [{{ id = "hex20", family = "fem", element = "hex20", size = {{ level = 1 }} }}]
"#
    )
}

/// At a stretch `s` the area of the wall grows by `s^2`. A cantilever rotates its faces and keeps their area.
#[test]
fn a_dead_pressure_on_a_wall_that_stretches_or_turns_is_told() {
    let blown = run(&shell("neo-hookean", "3 kPa"));
    let (change, key) = warned(&blown, "dead-pressure").unwrap_or_else(|| panic!("{blown:?}"));
    assert!(change > 0.1 && key == "load[0].pressure", "{change} {key}");
    assert!(warned(&run(&shell("neo-hookean", "0.5 kPa")), "dead-pressure").is_none());
    let bent = |load: &str| {
        run(&format!(
            r#"title = "A beam under pressure"
body = {{ shape = "box", size = ["40 mm", "4 mm", "4 mm"] }}
material = {{ law = "neo-hookean", young = "20 kPa", poisson = 0.3 }}
support = [{{ on = "x-min", fix = "xyz" }}]
load = [{{ on = "z-max", {load} }}]
procedure = {{ kind = "static", steps = 4 }}
method = [{{ id = "hex20", family = "fem", element = "hex20", size = {{ cells = [10, 2, 2] }} }}]
"#
        ))
    };
    assert!(warned(&bent("pressure = \"3 Pa\", dead = true"), "dead-pressure").is_some());
    assert!(warned(&bent("pressure = \"0.2 Pa\", dead = true"), "dead-pressure").is_none());
    assert!(warned(&bent("traction = [\"0 Pa\", \"0 Pa\", \"-3 Pa\"]"), "dead-pressure").is_none());
}

/// A column 20 times as long as wide, clamped at both ends, buckles at a strain of `pi^2 / 3 (w / L)^2` = 0.8
/// %. A block does not buckle.
#[test]
fn a_straight_path_of_a_column_beyond_its_critical_load_is_told() {
    let pressed = |height: u32, closure: &str| {
        run(&format!(
            r#"title = "A column"
body = {{ shape = "box", size = ["2 mm", "2 mm", "{height} mm"] }}
material = {{ law = "neo-hookean", young = "20 kPa", poisson = 0.3 }}
support = [{{ on = "z-min", fix = "xyz" }}, {{ on = "z-max", move = ["0 mm", "0 mm", "-{closure} mm"] }}]
procedure = {{ kind = "static", steps = 4 }}
method = [{{ id = "hex20", family = "fem", element = "hex20", size = {{ cells = [1, 1, {}] }} }}]
"#,
            (height / 2).min(16)
        ))
    };
    let column = pressed(40, "1.6");
    let (load, key) = warned(&column, "stability-lost").unwrap_or_else(|| panic!("{column:?}"));
    assert!((0.0..=0.5).contains(&load) && key == "procedure", "{load} {key}");
    assert!(warned(&pressed(40, "0.2"), "stability-lost").is_none());
    assert!(warned(&pressed(4, "0.4"), "stability-lost").is_none());
}

fn cantilever(law: &str, procedure: &str, shear: &str) -> String {
    format!(
        r#"title = "A slender cantilever"
body = {{ shape = "box", size = ["80 mm", "2 mm", "2 mm"] }}
material = {{ law = "{law}", young = "20 kPa", poisson = 0.3 }}
support = [{{ on = "x-min", fix = "xyz" }}]
load = [{{ on = "x-max", traction = ["0 Pa", "{shear} Pa", "0 Pa"] }}]
procedure = {{ {procedure} }}
method = [{{ id = "hex20", family = "fem", element = "hex20", size = {{ cells = [16, 1, 1] }} }}]
"#
    )
}

/// The slope at the end of a cantilever is `F L^2 / (2 E I)`: 0.96 rad for 2 Pa, at strains of 5 %.
#[test]
fn a_law_of_small_strain_that_turns_far_is_told() {
    let linear = "kind = \"linear\"";
    let far = run(&cantilever("linear", linear, "2"));
    let (turn, key) = warned(&far, "large-rotation").unwrap_or_else(|| panic!("{far:?}"));
    assert!((turn - 0.96).abs() < 0.05 && key == "material.law", "{turn} {key}");
    assert!(warned(&run(&cantilever("linear", linear, "0.2")), "large-rotation").is_none());
    let steps = "kind = \"static\", steps = 3";
    assert!(warned(&run(&cantilever("linear", steps, "2")), "large-rotation").is_some());
    assert!(warned(&run(&cantilever("neo-hookean", steps, "2")), "large-rotation").is_none());
}

/// A bar with one reduced cell across has modes without strain at its quadrature points. Full integration has
/// none, and a free body has six.
#[test]
fn modes_without_energy_are_told() {
    let bar = |support: &str, method: &str| {
        run(&format!(
            r#"title = "Modes of a bar"
body = {{ shape = "box", size = ["100 mm", "10 mm", "10 mm"] }}
material = {{ law = "linear", young = "20 kPa", poisson = 0.3, density = "1000 kg/m^3" }}
{support}
procedure = {{ kind = "modes", modes = 4 }}
method = [{{ id = "bar", family = "fem", element = "hex20", {method} size = {{ cells = [6, 1, 1] }}, mass = "consistent" }}]
"#
        ))
    };
    let clamped = "support = [{ on = \"x-min\", fix = \"xyz\" }]";
    let reduced = bar(clamped, "reduced = true,");
    let (excess, _) = warned(&reduced, "zero-energy-modes").unwrap_or_else(|| panic!("{reduced:?}"));
    assert!(excess >= 1.0 && excess == excess.trunc(), "{excess}");
    assert!(warned(&bar(clamped, ""), "zero-energy-modes").is_none());
    assert!(warned(&bar("", ""), "zero-energy-modes").is_none(), "rigid motions of a free bar");
}

/// In bending by its own weight, a beam of one cell over its height is wrong by half. In tension it is right.
#[test]
fn few_cells_across_what_bends_are_told() {
    let beam = |load: &str, method: &str| {
        run(&format!(
            r#"title = "A beam"
body = {{ shape = "box", size = ["60 mm", "6 mm", "6 mm"] }}
material = {{ law = "linear", young = "20 kPa", poisson = 0.3 }}
support = [{{ on = "x-min", fix = "xyz" }}]
load = [{{ {load} }}]
procedure = {{ kind = "linear" }}
method = [{{ id = "beam", {method} }}]
"#
        ))
    };
    let bent = "body = [\"0 N/m^3\", \"0 N/m^3\", \"-100 N/m^3\"]";
    let pulled = "body = [\"1000 N/m^3\", \"0 N/m^3\", \"0 N/m^3\"]";
    for (element, cells, few) in [
        ("hex8", "[20, 2, 2]", true),
        ("hex8", "[20, 4, 4]", false),
        ("tet4", "[12, 1, 1]", true),
        ("tet4", "[20, 3, 3]", true),
        ("tet4", "[40, 4, 4]", false),
        ("tet10", "[10, 2, 2]", false),
    ] {
        let method = format!("family = \"fem\", element = \"{element}\", size = {{ cells = {cells} }}");
        let runs = beam(bent, &method);
        let found = warned(&runs, "few-cells");
        assert_eq!(found.is_some(), few, "{method}: {runs:?}");
        assert!(found.is_none_or(|(cells, _)| cells < 3.1), "{method}: {runs:?}");
    }
    // Points of node smoothing lie on the surface, at which the count starts.
    let means = "family = \"efg\", kernel = \"cubic-spline\", support_scale = 1.4, basis = \"linear\", essential = \"nitsche\", \
                 integration = { rule = \"node-smoothed\", stabilisation = 0.3 }, size = { cells = [20, 2, 2] }";
    let runs = beam(bent, means);
    let (cells, _) = warned(&runs, "few-cells").unwrap_or_else(|| panic!("{runs:?}"));
    assert!((1.5..2.1).contains(&cells), "{cells}");
    let method = "family = \"fem\", element = \"hex8\", size = { cells = [20, 2, 2] }";
    assert!(warned(&beam(pulled, method), "few-cells").is_none());
}

/// Two blocks of 10 mm along x that touch without a common node. The wall between them is named from the
/// left.
fn blocks(apart: bool) -> String {
    let mut nodes = String::new();
    let planes: &[usize] = if apart { &[0, 10, 10, 20] } else { &[0, 10, 20] };
    for (plane, x) in planes.iter().enumerate() {
        for (corner, (y, z)) in [(0, 0), (10, 0), (10, 10), (0, 10)].into_iter().enumerate() {
            nodes += &format!("{} {x} {y} {z}\n", 4 * plane + corner + 1);
        }
    }
    let plane = |k: usize| (1..=4).map(|c| (4 * k + c).to_string()).collect::<Vec<_>>().join(" ");
    let second = if apart { 2 } else { 1 };
    // Each piece names the wall on its own side.
    let walls: String = (1..=second).map(|k| format!("{k} 3 2 3 1 {}\n", plane(k))).collect();
    let count = 4 * planes.len();
    format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n2 3 \"wall\"\n3 1 \"left\"\n3 2 \"right\"\n$EndPhysicalNames\n\
         $Nodes\n{count}\n{nodes}$EndNodes\n$Elements\n{}\n{walls}8 5 2 1 1 {} {}\n9 5 2 2 2 {} {}\n$EndElements\n",
        second + 2,
        plane(0),
        plane(1),
        plane(second),
        plane(second + 1),
    )
}

fn blocks_scene(join: &str, rest: &str) -> String {
    format!(
        r#"title = "Two blocks"
body = {{ shape = "file", path = "blocks.msh", unit = "mm"{join} }}
material = {{ law = "linear", young = "20 kPa", poisson = 0.0, density = "1000 kg/m^3" }}
support = [{{ where = "x == 0 mm", fix = "xyz" }}, {{ where = "x == 20 mm", fix = "yz" }}, {{ where = "x == 20 mm", fix = "x" }}]
{rest}
method = [{{ id = "hex8", family = "fem", element = "hex8", size = {{ file = "blocks.msh", unit = "mm" }} }}]
"#
    )
}

const SHEARED: &str =
    "load = [{ body = [\"0 N/m^3\", \"1000 N/m^3\", \"0 N/m^3\"] }]\nprocedure = { kind = \"linear\" }";

/// If both ends are fixed, the middle of two joined blocks of stiffness `G A / L` each moves by `rho L^2 / (2
/// G)`, 10 um of 20 mm. Separate blocks are not supported by each other.
#[test]
fn touching_pieces_without_common_nodes_are_told_and_joined() {
    let dir = tempfile::tempdir().unwrap();
    let file = write(&dir, "blocks.msh", &blocks(true));
    let apart = run_in(&dir, &blocks_scene("", SHEARED));
    let (pieces, key) = warned(&apart, "pieces-apart").unwrap_or_else(|| panic!("{apart:?}"));
    assert_eq!((pieces, key.as_str()), (2.0, "body"));
    assert!(apart[0].to_string().contains("1 faces coincide"), "{apart:?}");
    let modes = blocks_scene("", "procedure = { kind = \"modes\", modes = 1 }");
    let modes = run_in(&dir, &modes.replace("family = ", "mass = \"consistent\", family = "));
    assert!(warned(&modes, "pieces-apart").is_some(), "{modes:?}");
    let joined = run_in(&dir, &blocks_scene(", join = true", SHEARED));
    assert!(warned(&joined, "pieces-apart").is_none() && joined[0]["nodes"] == 12, "{joined:?}");
    // The wall that both pieces name is a single surface: u = 100 Pa L / (2 E).
    let pushed = "load = [{ on = \"wall\", traction = [\"100 Pa\", \"0 Pa\", \"0 Pa\"] }]";
    let pushed = run_in(&dir, &blocks_scene(", join = true", pushed));
    let moved = pushed[0]["metrics"]["max-x"]["value"].as_f64().unwrap();
    assert!((moved - 100.0 * 10e-3 / 40e3).abs() < 1e-9, "{moved}");
    let info = tissuebench(&["mesh", "info", &file, "--unit", "mm"]);
    assert!(info.stdout.contains("2 pieces that share no node, 1 coincident faces"), "{}", info.stdout);
    let out = inside(&dir, "joined.msh");
    let done = tissuebench(&["mesh", "convert", &file, &out, "--join"]);
    assert!(
        done.stdout.contains("12 nodes, 2 cells; 2 pieces joined at 1 faces"),
        "{} {}",
        done.stdout,
        done.stderr
    );
    assert!(!tissuebench(&["mesh", "info", &out, "--unit", "mm"]).stdout.contains("pieces"));
    assert_fails(
        &tissuebench(&["mesh", "convert", &out, &inside(&dir, "b.msh"), "--join"]),
        2,
        "found no coincident faces",
    );
}

/// A wall between two cells has no outer side. Loads along the normal are refused; a traction with its own
/// direction acts.
#[test]
fn pressure_on_a_wall_inside_the_body_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    write(&dir, "blocks.msh", &blocks(false));
    let scene =
        |load: &str| blocks_scene("", &format!("load = [{{ {load} }}]\nprocedure = {{ kind = \"linear\" }}"));
    for (load, says) in [
        ("on = \"wall\", pressure = \"100 Pa\"", "1 of the 1 faces of wall lie between two cells"),
        ("where = \"x == 10 mm\", pressure = \"100 Pa\"", "touches no outer face"),
    ] {
        let path = write(&dir, "scene.toml", &scene(load));
        for command in ["run", "plan"] {
            assert_fails(&tissuebench(&[command, &path]), 2, says);
        }
    }
    let pushed = run_in(&dir, &scene("on = \"wall\", traction = [\"100 Pa\", \"0 Pa\", \"0 Pa\"]"));
    // Two springs of E A / L in parallel: u = 100 Pa L / (2 E).
    let moved = pushed[0]["metrics"]["max-x"]["value"].as_f64().unwrap();
    assert!((moved - 100.0 * 10e-3 / 40e3).abs() < 1e-9, "{moved}");
}
