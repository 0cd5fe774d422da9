//! Files that commands write and read: folders of results, mesh files.

mod common;

use common::{BLOCK, assert_fails, inside, tissuebench, write};

/// [`BLOCK`] by two methods.
fn two_methods() -> String {
    let second = "{ id = \"hex8\", family = \"fem\", element = \"hex8\", size = { cells = [2, 2, 1] } }]";
    BLOCK.replacen("} }]\n", &format!("}} }}, {second}\n"), 1)
}

#[test]
fn a_folder_that_takes_no_results_is_refused_before_anything_runs() {
    let dir = tempfile::tempdir().unwrap();
    let scene = write(&dir, "block.toml", BLOCK);
    let study = write(&dir, "study.toml", "title = \"One\"\n[[run]]\nscene = \"block.toml\"\n");
    let file = write(&dir, "afile", "");
    let below = inside(&dir, "afile/results");
    for (out, says) in
        [(&file, "afile: is a file; give a folder"), (&below, "give a folder that can be written")]
    {
        for (verb, input) in [("run", &scene), ("verify", &study)] {
            let done = tissuebench(&[verb, input, "--out", out]);
            assert_fails(&done, 2, says);
            assert!(done.stdout.is_empty(), "{}", done.stdout);
        }
    }
    let points = write(&dir, "two.msh", MESH);
    let made =
        tissuebench(&["reference", &scene, "--points", &points, "--out", &inside(&dir, "no/such.json")]);
    assert_fails(&made, 2, "give a file that can be written");
    assert!(made.stdout.is_empty());
}

#[test]
fn a_run_says_what_it_replaces() {
    let dir = tempfile::tempdir().unwrap();
    let scene = write(&dir, "block.toml", &two_methods());
    let out = inside(&dir, "out");
    let first = tissuebench(&["run", &scene, "--out", &out]);
    assert!(first.code == 0 && !first.stderr.contains("replaces"), "{}", first.stderr);
    assert!(first.stderr.contains(&format!("open {out}/report/report.html")), "{}", first.stderr);
    let second = tissuebench(&["run", &scene, "--method", "tet4", "--out", &out]);
    assert!(
        second.stderr.contains(&format!("{out}: replaces the results of 2 methods")),
        "{}",
        second.stderr
    );
    let third = tissuebench(&["run", &scene, "--out", &out]);
    assert!(third.stderr.contains("replaces the results of 1 method\n"), "{}", third.stderr);
}

#[test]
fn a_baseline_that_is_not_there_is_bad_input() {
    let dir = tempfile::tempdir().unwrap();
    let scene = write(&dir, "block.toml", BLOCK);
    let out = inside(&dir, "out");
    assert_eq!(tissuebench(&["run", &scene, "--out", &out]).code, 0);
    let folder = inside(&dir, "accepted");
    let done = tissuebench(&["baseline", &out, "--accepted", &folder, "--check"]);
    assert_fails(&done, 2, "accepted does not exist; `--accept` creates it");
    assert_eq!(tissuebench(&["baseline", &out, "--accepted", &folder, "--accept"]).code, 0);
    assert_eq!(tissuebench(&["baseline", &out, "--accepted", &folder, "--check"]).code, 0);
}

/// Two tetrahedra with a common face, in millimetres, without a named surface.
const MESH: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 40 0 0\n3 0 40 0\n4 0 0 20\n\
    5 40 40 20\n$EndNodes\n$Elements\n2\n7 4 2 0 1 1 2 3 4\n8 4 2 0 1 2 3 4 5\n$EndElements\n";

#[test]
fn a_mesh_file_is_described_in_its_own_unit() {
    let dir = tempfile::tempdir().unwrap();
    let done = tissuebench(&["mesh", "info", &write(&dir, "two.msh", MESH)]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let rows: Vec<&str> = done.stdout.lines().skip(1).collect();
    assert_eq!(
        rows,
        [
            "  cells       2 tet4",
            "  regions     body: 2 cells, 16.000 cm^3",
            "  surfaces    none (select with where)",
            "  extent      x = 0 to 40.000, y = 0 to 40.000, z = 0 to 20.000 mm",
            "  unit        mm: 40.000 mm long, a plausible length for an organ",
            "  volume      16.000 cm^3; cells of 5.333 to 10.667 cm^3",
            "  angles      35.3 to 109.5 degrees between two faces of a cell",
            "  aspect             1     1.5       2       3       5      10  and more (a regular cell has 1)",
            "                     1       1       0       0       0       0",
            "  worst       aspect 1.86, angles 35.3 to 90.0, line 14, element 7",
            "              aspect 1.41, angles 48.2 to 109.5, line 15, element 8",
        ]
    );
    let object = tissuebench(&["mesh", "info", "--format", "json", "--unit", "m", &inside(&dir, "two.msh")]);
    let object: serde_json::Value = serde_json::from_str(&object.stdout).unwrap();
    assert_eq!(object["kinds"]["tet4"], 2, "{object}");
    assert_eq!(object["unit_guess"], "mm", "{object}");
    assert_eq!(object["worst"][0]["element"], 7, "{object}");
    assert!((object["volume_m3"].as_f64().unwrap() - 16e3).abs() < 1e-8, "{object}");
}

#[test]
fn inverted_cells_are_counted_and_the_rest_of_the_mesh_is_described() {
    let dir = tempfile::tempdir().unwrap();
    let one = MESH.replace("1 2 3 4\n", "1 3 2 4\n");
    for (text, says) in [
        (one.clone(), "1 of 2 cells is inverted (line 14, element 7)"),
        (one.replace("2 3 4 5\n", "3 2 4 5\n"), "all 2 cells are inverted (first: line 14, element 7)"),
    ] {
        let done = tissuebench(&["mesh", "info", &write(&dir, "bad.msh", &text)]);
        assert_fails(&done, 2, says);
        assert!(done.stdout.contains("extent      x = 0 to 40.000"), "{}", done.stdout);
    }
}

#[test]
fn a_mesh_is_not_converted_onto_itself() {
    let dir = tempfile::tempdir().unwrap();
    let (from, to) = (write(&dir, "two.msh", MESH), inside(&dir, "ten.msh"));
    assert_fails(
        &tissuebench(&["mesh", "convert", &from, &from, "--element", "tet10"]),
        2,
        "give another name",
    );
    assert_eq!(std::fs::read_to_string(&from).unwrap(), MESH);
    assert_eq!(tissuebench(&["mesh", "convert", &from, &to, "--element", "tet10"]).code, 0);
}

#[test]
fn a_version_of_gmsh_is_chosen_for_its_files_alone() {
    let dir = tempfile::tempdir().unwrap();
    let from = write(&dir, "two.msh", MESH);
    let to = inside(&dir, "new.msh");
    let vtu = inside(&dir, "new.vtu");
    for (version, head) in [("4.1", "$MeshFormat\n4.1 0 8\n"), ("2.2", "$MeshFormat\n2.2 0 8\n")] {
        assert_eq!(tissuebench(&["mesh", "convert", &from, &to, "--version", version]).code, 0);
        assert!(std::fs::read_to_string(&to).unwrap().starts_with(head), "{version}");
        assert_eq!(tissuebench(&["mesh", "info", &to]).code, 0);
    }
    let convert =
        |to: &str, version: &str| tissuebench(&["mesh", "convert", &from, to, "--version", version]);
    assert_fails(
        &convert(&vtu, "4.1"),
        2,
        "new.vtu: --version applies to Gmsh's format only; write a .msh file",
    );
    assert_fails(&convert(&to, "3.0"), 2, "versions 2.2 and 4.1 are written");
}
