//! Files of the body at every recorded state, which ParaView opens.

mod common;

use std::collections::BTreeMap;
use std::fs;
use std::io::Read as _;
use std::path::Path;
use std::process::Command;

use common::{tissuebench, write};
use tempfile::TempDir;

/// Reads a `.vtu` file of this program: numbers by the names of their arrays.
fn arrays(file: &Path) -> BTreeMap<String, Vec<f64>> {
    let bytes = fs::read(file).unwrap();
    let mark = b"<AppendedData encoding=\"raw\">\n_";
    let start = bytes.windows(mark.len()).position(|w| w == mark).unwrap() + mark.len();
    let head = String::from_utf8_lossy(&bytes[..start]).into_owned();
    let attribute = |tag: &str, name: &str| {
        let from = tag.find(&format!(" {name}=\"")).map(|at| at + name.len() + 3);
        from.map(|from| tag[from..].split('"').next().unwrap().to_string())
    };
    let mut found = BTreeMap::new();
    for tag in head.split("<DataArray").skip(1).filter(|tag| tag.contains("format=\"appended\"")) {
        let offset: usize = attribute(tag, "offset").unwrap().parse().unwrap();
        let data = unpacked(&bytes[start + offset..]);
        let numbers = match attribute(tag, "type").unwrap().as_str() {
            "Float64" => data.chunks(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect(),
            "Int32" => data.chunks(4).map(|b| f64::from(i32::from_le_bytes(b.try_into().unwrap()))).collect(),
            _ => continue,
        };
        found.insert(attribute(tag, "Name").unwrap(), numbers);
    }
    found
}

fn unpacked(bytes: &[u8]) -> Vec<u8> {
    let word = |k: usize| u64::from_le_bytes(bytes[8 * k..8 * k + 8].try_into().unwrap()) as usize;
    let blocks = word(0);
    let mut at = 8 * (3 + blocks);
    let mut out = Vec::new();
    for block in 0..blocks {
        let end = at + word(3 + block);
        flate2::read::ZlibDecoder::new(&bytes[at..end]).read_to_end(&mut out).unwrap();
        at = end;
    }
    out
}

/// Reads the series of a method: time, part and file of each entry.
fn series(folder: &Path, method: &str) -> Vec<(f64, String, String)> {
    let text = fs::read_to_string(folder.join(format!("{method}.pvd"))).unwrap();
    let value = |line: &str, name: &str| {
        line.split(&format!(" {name}=\"")).nth(1).unwrap().split('"').next().unwrap().to_string()
    };
    let entries = text.lines().filter(|line| line.starts_with("<DataSet"));
    entries.map(|l| (value(l, "timestep").parse().unwrap(), value(l, "part"), value(l, "file"))).collect()
}

#[track_caller]
fn fields(dir: &TempDir, text: &str) {
    let out = dir.path().join("out");
    let done = tissuebench(&["fields", &write(dir, "scene.toml", text), "--out", out.to_str().unwrap()]);
    assert_eq!(done.code, 0, "{}", done.stderr);
}

/// A bar under tension, free to contract laterally: `u = (1 kPa / 20 kPa) (-nu x, -nu y, z)` and a uniaxial
/// stress.
const BAR: &str = r#"
title = "A bar"
body = { shape = "box", size = ["10 mm", "10 mm", "20 mm"] }
material = { law = "linear", young = "20 kPa", poisson = 0.25 }
support = [{ on = "x-min", fix = "x" }, { on = "y-min", fix = "y" }, { on = "z-min", fix = "z" }]
load = [{ on = "z-max", traction = ["0 Pa", "0 Pa", "1 kPa"] }]
method = [
    { id = "tet4", family = "fem", element = "tet4", size = { cells = [2, 2, 4] } },
    { id = "tet4-nodal", family = "fem", element = "tet4", dilation = "nodal-mean", size = { cells = [2, 2, 4] } },
    { id = "tet10", family = "fem", element = "tet10", size = { cells = [2, 2, 4] } },
    { id = "hex20", family = "fem", element = "hex20", size = { cells = [2, 2, 4] } },
    { id = "efg-node", family = "efg", size = { nodes = 90 }, kernel = "cubic-spline", basis = "linear", support_scale = 1.6, essential = "multipliers", integration = { rule = "cell-smoothed", points = 1 } },
]
"#;

#[test]
fn a_bar_has_its_displacement_stress_and_volume() {
    let dir = TempDir::new().unwrap();
    fields(&dir, BAR);
    let out = dir.path().join("out");
    for method in ["tet4", "tet4-nodal", "tet10", "hex20", "efg-node"] {
        assert_eq!(series(&out, method), [(1.0, "0".into(), format!("{method}/body-0001.vtu"))]);
        let found = arrays(&out.join(method).join("body-0001.vtu"));
        let (points, moved) = (&found["Points"], &found["displacement"]);
        assert_eq!(points.len(), moved.len());
        let strain = 1e3 / 20e3;
        for (x, u) in points.chunks(3).zip(moved.chunks(3)) {
            let expected = [-0.25 * strain * x[0], -0.25 * strain * x[1], strain * x[2]];
            let off = u.iter().zip(expected).map(|(u, e)| (u - e).abs()).fold(0.0, f64::max);
            assert!(off < 1e-9 * 1e-3, "{method} {x:?}: {u:?}");
        }
        let cells = found["region"].len();
        assert_eq!(found["stress"].len(), 6 * cells);
        for stress in found["stress"].chunks(6) {
            let off = stress.iter().zip([0.0, 0.0, 1e3, 0.0, 0.0, 0.0]).map(|(s, e)| (s - e).abs());
            assert!(off.fold(0.0, f64::max) < 1e-4, "{method}: {stress:?}");
        }
        for (name, value) in [("pressure", -1e3 / 3.0), ("von_mises", 1e3), ("det_f", 1.05 * 0.9875 * 0.9875)]
        {
            assert_eq!(found[name].len(), cells);
            assert!(found[name].iter().all(|v| (v / value - 1.0).abs() < 1e-7), "{method} {name}");
        }
    }
}

const UNDER_A_BALL: &str = r#"
title = "A block under a ball"
body = { shape = "box", size = ["40 mm", "40 mm", "20 mm"] }
material = { law = "neo-hookean", young = "20 kPa", poisson = 0.45 }
support = [{ on = "z-min", fix = "xyz" }]
tool = [{ name = "ball", shape = "sphere", radius = "8 mm", at = ["20 mm", "20 mm", "28 mm"], along = [0, 0, -1], drive = { closure = "3 mm" }, penalty = "0.5 MPa/mm" }]
procedure = { kind = "static", steps = 3 }
method = [{ id = "hex20", family = "fem", element = "hex20", size = { cells = [4, 4, 2] } }]
"#;

#[test]
fn every_step_has_the_body_and_its_tools() {
    let dir = TempDir::new().unwrap();
    fields(&dir, UNDER_A_BALL);
    let out = dir.path().join("out");
    let all = series(&out, "hex20");
    let times: Vec<f64> = all.iter().map(|entry| entry.0).collect();
    assert_eq!(times, [1.0 / 3.0, 1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0, 1.0, 1.0]);
    for (k, (time, part, file)) in all.iter().enumerate() {
        let found = arrays(&out.join(file));
        let moved = found["displacement"].chunks(3).map(|u| u[2]).fold(0.0, f64::min);
        if k % 2 == 0 {
            assert_eq!(part, "0");
            // The surface follows the ball, though not closely between nodes.
            assert!((0.8..=1.2).contains(&(-moved / (3e-3 * time))), "{moved} at {time}");
            assert!(found["pressure"].iter().fold(0.0f64, |m, p| m.max(*p)) > 100.0);
        } else {
            assert_eq!(part, "1");
            assert!((moved + 3e-3 * time).abs() < 1e-15, "{moved}");
            let far = found["Points"].chunks(3).map(|p| {
                ((p[0] - 0.02).powi(2) + (p[1] - 0.02).powi(2) + (p[2] - 0.028).powi(2)).sqrt() - 8e-3
            });
            assert!(far.map(f64::abs).fold(0.0, f64::max) < 1e-12);
        }
    }
    // A series with fewer steps removes the files of the longer series.
    fields(&dir, &UNDER_A_BALL.replace("steps = 3", "steps = 2"));
    assert_eq!(series(&out, "hex20").len(), 4);
    assert_eq!(fs::read_dir(out.join("hex20")).unwrap().count(), 4);
}

#[test]
fn modes_are_a_series_and_results_have_volumes() {
    let dir = TempDir::new().unwrap();
    let modes = r#"
title = "A free block"
body = { shape = "box", size = ["20 mm", "10 mm", "10 mm"] }
material = { law = "linear", young = "20 kPa", poisson = 0.3, density = "1000 kg/m^3" }
support = [{ on = "x-min", fix = "xyz" }]
procedure = { kind = "modes", modes = 3 }
method = [{ id = "hex8", family = "fem", element = "hex8", size = { cells = [4, 2, 2] }, mass = "consistent" }]
"#;
    let scene = write(&dir, "scene.toml", modes);
    let out = dir.path().join("results");
    let done = tissuebench(&["run", &scene, "--out", out.to_str().unwrap()]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let volumes = out.join("volumes");
    assert_eq!(series(&volumes, "hex8").iter().map(|entry| entry.0).collect::<Vec<_>>(), [1.0, 2.0, 3.0]);
    let found = arrays(&volumes.join("hex8/body-0002.vtu"));
    assert!(!found.contains_key("stress") && found["displacement"].iter().any(|u| *u != 0.0));
}

/// Other programs read the same values. The test needs a Python with vtk and meshio (`TISSUEBENCH_PYTHON`
/// names another Python).
#[test]
fn vtk_and_meshio_open_the_files() {
    let python = std::env::var("TISSUEBENCH_PYTHON").unwrap_or_else(|_| "python3".into());
    let has = Command::new(&python).args(["-c", "import vtk, meshio"]).output();
    if !has.is_ok_and(|done| done.status.success()) {
        return common::skipped("vtk", &format!("{python} has no vtk and meshio"));
    }
    let dir = TempDir::new().unwrap();
    fields(&dir, UNDER_A_BALL);
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fields.py");
    let done = Command::new(python).arg(script).arg(dir.path().join("out/hex20.pvd")).output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
}

/// A deck of two bricks whose numbers are not those of the mesh, held at one end.
const BRICKS: &str = "*NODE
101, 0, 0, 0\n102, 1, 0, 0\n103, 1, 1, 0\n104, 0, 1, 0\n105, 0, 0, 1\n106, 1, 0, 1\n107, 1, 1, 1\n108, 0, 1, 1
12, 2, 1, 1\n11, 2, 0, 1\n10, 2, 1, 0\n9, 2, 0, 0
*ELEMENT, TYPE=C3D8, ELSET=ALL
70, 101, 102, 103, 104, 105, 106, 107, 108\n8, 102, 9, 10, 103, 106, 11, 12, 107
*NSET, NSET=FIX\n101, 104, 105, 108
*MATERIAL, NAME=RUBBER\n*ELASTIC\n1000., .3
*SOLID SECTION, ELSET=ALL, MATERIAL=RUBBER
*BOUNDARY\nFIX, 1, 3
*STEP\n*STATIC
*CLOAD\n12, 1, 4.\n9, 3, -2.
*END STEP
";

/// Rows of a table by their numbers.
fn table(file: &Path) -> BTreeMap<u64, Vec<f64>> {
    let text = fs::read_to_string(file).unwrap();
    let row = |line: &str| {
        let mut words = line.split(',');
        let number = words.next().unwrap().parse().unwrap();
        (number, words.map(|word| word.parse().unwrap()).collect())
    };
    text.lines().skip(1).map(row).collect()
}

#[test]
fn results_go_back_by_the_numbers_of_a_model() {
    let dir = TempDir::new().unwrap();
    let deck = write(&dir, "bricks.inp", BRICKS);
    let out = dir.path().join("out");
    let fields =
        |like: &str| tissuebench(&["fields", &deck, "--like", like, "--out", &out.display().to_string()]);
    let done = fields(&deck);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let nodes = table(&out.join("hex8-nodes.csv"));
    assert_eq!(
        nodes.keys().copied().collect::<Vec<_>>(),
        [9, 10, 11, 12, 101, 102, 103, 104, 105, 106, 107, 108]
    );
    assert_eq!(nodes[&9][..3], [2.0, 0.0, 0.0]);
    // The reactions carry both forces, and act where the body is held.
    let reaction = |axis: usize| nodes.values().map(|row| row[6 + axis]).sum::<f64>();
    assert!((reaction(0) + 4.0).abs() < 1e-12 && (reaction(2) - 2.0).abs() < 1e-12, "{nodes:?}");
    assert!(nodes.iter().all(|(number, row)| row[6..] == [0.0; 3] || [101, 104, 105, 108].contains(number)));
    let elements = table(&out.join("hex8-elements.csv"));
    assert_eq!(elements.keys().copied().collect::<Vec<_>>(), [8, 70]);
    // The mean of a section of 1 m^2 carries the force along x.
    assert!(elements.values().all(|row| (row[0] - 4.0).abs() < 1e-9), "{elements:?}");
    let (_, _, file) = series(&out, "hex8").pop().unwrap();
    let arrays = arrays(&out.join(file));
    assert_eq!(arrays["element"], [70.0, 8.0]);
    let at = arrays["node"].iter().position(|number| *number == 12.0).unwrap();
    assert_eq!(arrays["displacement"][3 * at..3 * at + 3], nodes[&12][3..6]);
    let other = write(
        &dir,
        "other.inp",
        &BRICKS.replace("8, 102, 9, 10, 103, 106, 11, 12, 107", "8, 9, 10, 103, 102, 11, 12, 107, 106"),
    );
    let refused = fields(&other);
    assert!(
        refused.code == 2
            && refused.stderr.contains("other.inp: its 2 cells on 12 nodes are not the 2 cells"),
        "{}",
        refused.stderr
    );
    assert!(refused.stderr.contains("size = { file ="), "{}", refused.stderr);
}
