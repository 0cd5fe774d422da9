//! Overlapping cells are rejected with both element numbers; adjacent cells of every kind are accepted.

use std::path::Path;

use geometry::generate::{box_mesh, kidney_mesh};
use geometry::{CellKind, Mesh, Point3, quality};
use tissuebench_mesh_files as files;

fn deck(nodes: &str, elements: &str) -> Result<Mesh, String> {
    let text = format!("*NODE\n{nodes}*ELEMENT, TYPE=C3D4\n{elements}");
    files::read_bytes(text.as_bytes(), Path::new("a.inp"), 1.0)
        .map(|(mesh, _)| mesh)
        .map_err(|bad| bad.to_string())
}

/// A face in the plane z = 0, with two corners above it and two below.
const NODES: &str =
    "1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n5, 0.3, 0.3, 2\n6, 0, 0, -1\n7, 0.2, 0.2, -3\n";

#[test]
fn tetrahedra_on_one_side_of_their_face_are_refused() {
    let nodes = |some: &[usize]| {
        some.iter().map(|&n| format!("{}\n", NODES.lines().nth(n - 1).unwrap())).collect::<String>()
    };
    let apart = deck(&nodes(&[1, 2, 3, 4, 6]), "21, 1, 2, 3, 4\n22, 1, 3, 2, 6\n").unwrap();
    assert!(quality::check(&apart).is_ok());
    let refused = "shares a face with element 21 (line 8) and lies on the same side of it: they overlap";
    for turned in ["1, 2, 3, 5", "2, 3, 1, 5", "3, 5, 1, 2"] {
        let bad = deck(&nodes(&[1, 2, 3, 4, 5]), &format!("21, 1, 2, 3, 4\n22, {turned}\n")).unwrap_err();
        assert!(bad.starts_with("a.inp:9: element 22 ") && bad.ends_with(refused), "{turned}: {bad}");
    }
    // Of three or four cells at a face, two are on the same side in any order; the message has the first such
    // pair.
    let three =
        deck(&nodes(&[1, 2, 3, 4, 5, 6]), "21, 1, 2, 3, 4\n22, 1, 3, 2, 6\n23, 1, 2, 3, 5\n").unwrap_err();
    assert!(three.contains("a.inp:11: element 23 shares a face with element 21 (line 9)"), "{three}");
    let four = deck(NODES, "30, 1, 3, 2, 6\n31, 1, 2, 3, 4\n32, 1, 3, 2, 7\n33, 1, 2, 3, 5\n").unwrap_err();
    assert!(four.contains("a.inp:12: element 32 shares a face with element 30 (line 10)"), "{four}");
}

/// An inverted cell has its own message, which counts all such cells.
#[test]
fn inverted_neighbours_do_not_overlap() {
    let mesh = deck(
        &NODES
            .lines()
            .take(4)
            .chain([NODES.lines().nth(5).unwrap()])
            .map(|line| format!("{line}\n"))
            .collect::<String>(),
        "1, 1, 2, 3, 4\n2, 1, 2, 3, 6\n",
    )
    .unwrap();
    let bad = quality::check(&mesh).unwrap_err();
    assert_eq!((bad.element, bad.inverted), (1, 1));
    // Flat cells do not overlap either: their corner is on neither side.
    let flat = deck(
        "1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n5, .3, .3, 0\n",
        "1, 1, 2, 3, 4\n2, 1, 2, 3, 5\n",
    )
    .unwrap();
    assert_eq!(quality::check(&flat).unwrap_err().inverted, 1);
}

#[test]
fn hexahedra_on_one_side_of_their_face_are_refused() {
    let square = |z: f64| [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| [x, y, z]);
    let rows = [0.0, 1.0, 2.0, -1.0].map(square).concat();
    let nodes: String =
        rows.iter().enumerate().map(|(n, [x, y, z])| format!("{}, {x}, {y}, {z}\n", n + 1)).collect();
    let read = |used: usize, elements: &str| {
        let nodes: String = nodes.lines().take(used).map(|line| format!("{line}\n")).collect();
        let text = format!("*NODE\n{nodes}*ELEMENT, TYPE=C3D8\n{elements}");
        files::read_bytes(text.as_bytes(), Path::new("a.inp"), 1.0)
            .map(|(mesh, _)| mesh)
            .map_err(|bad| bad.to_string())
    };
    assert!(read(12, "7, 1, 2, 3, 4, 5, 6, 7, 8\n8, 5, 6, 7, 8, 9, 10, 11, 12\n").is_ok());
    let bad = read(12, "7, 1, 2, 3, 4, 5, 6, 7, 8\n8, 2, 3, 4, 1, 10, 11, 12, 9\n").unwrap_err();
    assert!(bad.contains("a.inp:16: element 8 shares a face with element 7 (line 15)"), "{bad}");
}

/// Generated meshes, linear or curved, of every kind and in any order of cells, have no apparent overlaps.
#[test]
fn sound_meshes_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.msh");
    for kind in CellKind::ALL {
        let cube =
            box_mesh(kind, Point3::origin(), Point3::new(1.0, 2.0, 0.1), [5, 4, 3], [1.7, 1.0, 0.4], None)
                .unwrap();
        for mesh in [kidney_mesh(kind, 4).unwrap(), cube] {
            files::write(&mesh, &file, 1.0).unwrap();
            assert_eq!(files::read(&file, 1.0).unwrap().cell_count(), mesh.cell_count(), "{}", kind.name());
            let text = std::fs::read_to_string(&file).unwrap();
            let (head, cells) = text.split_once("$Elements\n").unwrap();
            let mut lines: Vec<&str> = cells.lines().filter(|line| line.contains(' ')).collect();
            lines.sort_by_key(|line| {
                line.bytes().fold(7u32, |sum, b| sum.wrapping_mul(31).wrapping_add(b.into()))
            });
            let shuffled = format!("{head}$Elements\n{}\n{}\n$EndElements\n", lines.len(), lines.join("\n"));
            let (back, _) =
                files::read_bytes(shuffled.as_bytes(), &file, 1.0).unwrap_or_else(|bad| panic!("{bad}"));
            assert_eq!(back.cell_count(), mesh.cell_count());
        }
    }
}

/// Twins have the same corners, in any order and orientation.
#[test]
fn cells_of_the_same_nodes_are_refused_in_any_order() {
    let some: String = NODES.lines().take(4).map(|line| format!("{line}\n")).collect();
    for turned in ["1, 2, 3, 4", "4, 3, 2, 1", "2, 1, 3, 4"] {
        let bad = deck(&some, &format!("5, 1, 2, 3, 4\n6, {turned}\n")).unwrap_err();
        assert!(
            bad.contains("a.inp:8: element 6 has the same nodes as element 5 (line 7)"),
            "{turned}: {bad}"
        );
    }
}
