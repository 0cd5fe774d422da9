//! Clouds from files: they give the same result as the same nodes without a file, or a refusal with numbers.

mod common;

use common::{assert_fails, tissuebench, write};
use serde_json::Value;

/// Scene of a patch test with a cloud.
fn scene(cloud: &str) -> String {
    format!(
        r#"title = "A block in an affine field"
body = {{ shape = "box", size = ["30 mm", "20 mm", "20 mm"] }}
material = {{ law = "linear", young = "20 kPa", poisson = 0.3 }}
support = [{{ on = "surface", move = "exact" }}]
reference = {{ exact = "affine" }}
method = [{{ id = "cloud", family = "efg", kernel = "cubic-spline", support_scale = 1.6, basis = "linear", integration = {{ rule = "cell-smoothed", points = 1 }}, essential = "nitsche", {cloud} }}]
"#
    )
}

/// 4 x 3 x 3 nodes, in mm.
fn nodes() -> String {
    let at = |n: usize| format!("{},{},{}\n", 10 * (n / 9), 10 * (n / 3 % 3), 10 * (n % 3));
    (0..36).map(at).collect()
}

#[test]
fn a_file_of_nodes_is_a_cloud() {
    let dir = tempfile::tempdir().unwrap();
    write(&dir, "nodes.csv", &format!("x,y,z\n{}", nodes()));
    for cloud in [
        r#"nodes = 36, cloud = { file = "nodes.csv", unit = "mm" }"#,
        r#"cloud = { file = "nodes.csv", unit = "mm" }"#,
    ] {
        let done = tissuebench(&["run", &write(&dir, "scene.toml", &scene(cloud)), "--format", "json"]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        let object: Value = serde_json::from_str(&done.stdout).unwrap();
        assert!(object["metrics"]["l2"]["value"].as_f64().unwrap() < 1e-12, "{object}");
        assert_eq!(object["nodes"], 36, "{object}");
    }
}

/// Encodes an array of three columns in NumPy's format.
fn npy(rows: &[[f64; 3]]) -> Vec<u8> {
    let mut head = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, 3), }}", rows.len());
    while (10 + head.len() + 1) % 64 != 0 {
        head.push(' ');
    }
    head.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((head.len() as u16).to_le_bytes());
    bytes.extend(head.bytes());
    rows.iter().flatten().for_each(|x| bytes.extend(x.to_le_bytes()));
    bytes
}

#[test]
fn an_array_of_numpy_is_a_cloud() {
    let dir = tempfile::tempdir().unwrap();
    let mut rows: Vec<[f64; 3]> =
        (0..36).map(|n| [10 * (n / 9), 10 * (n / 3 % 3), 10 * (n % 3)].map(f64::from)).collect();
    let run = |rows: &[[f64; 3]], bytes: Option<&[u8]>| {
        let made = npy(rows);
        std::fs::write(dir.path().join("nodes.npy"), bytes.unwrap_or(&made)).unwrap();
        let text = scene(r#"cloud = { file = "nodes.npy", unit = "mm" }"#);
        tissuebench(&["run", &write(&dir, "scene.toml", &text), "--format", "json"])
    };
    let done = run(&rows, None);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let object: Value = serde_json::from_str(&done.stdout).unwrap();
    assert!(object["metrics"]["l2"]["value"].as_f64().unwrap() < 1e-12 && object["nodes"] == 36, "{object}");
    assert_fails(&run(&rows, Some(b"x,y,z")), 2, "nodes.npy is not a .npy file");
    assert_fails(&run(&[], None), 2, "has an array of shape [0, 3]");
    rows[7][1] = f64::NAN;
    assert_fails(&run(&rows, None), 2, "nodes.npy has NaN in row 7, column 1");
    rows[7] = rows[4];
    assert_fails(&run(&rows, None), 2, "has node 4 and node 7 in the same place");
}

#[test]
fn what_disagrees_is_refused_with_numbers() {
    let dir = tempfile::tempdir().unwrap();
    let refused = |cloud: &str, text: &str, said: &str| {
        write(&dir, "nodes.csv", text);
        let done = tissuebench(&["run", &write(&dir, "scene.toml", &scene(cloud))]);
        assert_fails(&done, 2, said);
    };
    let file = r#"cloud = { file = "nodes.csv", unit = "mm" }"#;
    let sound = nodes();
    refused(&format!("nodes = 35, {file}"), &sound, "nodes.csv, which has 36 nodes");
    refused(file, &format!("{sound}1,nan,2\n"), "nodes.csv:37: column 2 is nan, which is not finite");
    refused(file, &format!("{sound}1,2\n"), "nodes.csv:37: column 3 is missing");
    refused(file, &format!("{sound}10,-0,20\n"), "has line 12 and line 37 in the same place");
    refused(
        file,
        &format!("{sound}1,2,21\n0,25,0\n"),
        "has 2 of 38 nodes outside the body; the farthest, line 38, is 5.000e-3 m away",
    );
    refused(r#"cloud = { file = "nodes.csv", unit = "cm" }"#, &sound, "has 35 of 36 nodes outside the body");
    refused(r#"cloud = { file = "nodes.csv" }"#, &sound, "unit");
    refused(r#"cloud = { file = "none.csv", unit = "mm" }"#, &sound, "can't be found");
    refused(&format!("{file}, seed = 3"), &sound, "nodes that are given need none");
    refused(
        &format!("{file}, neighbourhood = \"ellipsoid\""),
        &sound,
        "the nodes of this cloud have no cells",
    );
}
