//! Gmsh files: round trips, the kidney, Gmsh's node order, and malformed files of every kind.

use std::path::Path;

use geometry::generate::{box_mesh, kidney_mesh};
use geometry::{CellKind, Mesh, Point3, quality};
use proptest::prelude::*;
use tissuebench_mesh_files::{self as files, FileError, Problem};

const NAME: &str = "some/file.msh";

fn parse(text: &str) -> Result<Mesh, FileError> {
    files::read_bytes(text.as_bytes(), Path::new(NAME), 0.001).map(|(mesh, _)| mesh)
}

#[test]
fn the_kidney_reads_as_described() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/scenes/kidney/kidney-1331.msh");
    let mesh = files::read(&file, 0.001).unwrap();
    assert_eq!((mesh.points().len(), mesh.cell_count()), (1331, 6190));
    assert_eq!(mesh.uniform_kind(), Some(CellKind::Tet4));
    assert_eq!(mesh.region_names(), ["kidney"]);
    assert_eq!(mesh.group_names().collect::<Vec<_>>(), ["surface"]);
    assert_eq!(mesh.group("surface").unwrap(), mesh.boundary());
    assert_eq!(mesh.points()[0], Point3::new(0.0, 0.0, 0.015));
    let quality = quality::check(&mesh).unwrap();
    let exact = 4.0 / 3.0 * std::f64::consts::PI * 1e-5;
    let loss = 1.0 - quality.volume / exact;
    // Flat triangles inscribed in a curved surface lose a little volume and never gain any.
    assert!((0.001..0.04).contains(&loss), "volume {} m^3, loss {loss}", quality.volume);
}

#[test]
fn meshes_survive_a_round_trip() {
    let folder = tempfile::tempdir().unwrap();
    for kind in CellKind::ALL {
        let file = folder.path().join(format!("{}.msh", kind.name()));
        let mesh = kidney_mesh(kind, 2).unwrap();
        let count = mesh.cell_count();
        let regions = (0..count).map(|c| u16::from(c > count / 2)).collect();
        let mesh = mesh.with_regions(regions, vec!["cortex".into(), "inner medulla".into()]);
        files::write(&mesh, &file, 1.0).unwrap();
        assert_eq!(files::read(&file, 1.0).unwrap(), mesh, "{}", kind.name());
        files::write(&mesh, &file, 0.001).unwrap();
        let scaled = files::read(&file, 0.001).unwrap();
        for (p, q) in mesh.points().iter().zip(scaled.points()) {
            assert!((p - q).norm() < 1e-17);
        }
    }
}

/// Gmsh's own edge lists (reference manual, node ordering), independent of the tables in the reader.
#[test]
fn quadratic_nodes_are_put_where_gmsh_means_them() {
    let tet_edges = [[0, 1], [1, 2], [2, 0], [3, 0], [3, 2], [3, 1]];
    let hex_edges =
        [[0, 1], [0, 3], [0, 4], [1, 2], [1, 5], [2, 3], [2, 6], [3, 7], [4, 5], [4, 7], [5, 6], [6, 7]];
    let tet = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]];
    let hex = [
        [0., 0., 0.],
        [1., 0., 0.],
        [1., 1., 0.],
        [0., 1., 0.],
        [0., 0., 1.],
        [1., 0., 1.],
        [1., 1., 1.],
        [0., 1., 1.],
    ];
    type Case<'a> = (u64, CellKind, &'a [[f64; 3]], &'a [[usize; 2]]);
    let wedge = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.], [1., 0., 1.], [0., 1., 1.]];
    let wedge_edges = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 4], [2, 5], [3, 4], [3, 5], [4, 5]];
    let cases: [Case; 3] = [
        (11, CellKind::Tet10, &tet, &tet_edges),
        (17, CellKind::Hex20, &hex, &hex_edges),
        (18, CellKind::Wedge15, &wedge, &wedge_edges),
    ];
    for (number, kind, corners, edges) in cases {
        let mut points = corners.to_vec();
        points.extend(
            edges
                .iter()
                .map(|&[a, b]| std::array::from_fn::<_, 3, _>(|d| 0.5 * (corners[a][d] + corners[b][d]))),
        );
        let nodes: String = points
            .iter()
            .enumerate()
            .map(|(i, p)| format!("{} {} {} {}\n", i + 1, p[0], p[1], p[2]))
            .collect();
        let list: String = (1..=points.len()).map(|n| format!(" {n}")).collect();
        let text = format!(
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n{nodes}$EndNodes\n$Elements\n1\n1 {number} 0{list}\n$EndElements",
            points.len()
        );
        let mesh = parse(&text).unwrap();
        let at = mesh.cell_points(0).copied().collect::<Vec<_>>();
        for (e, &[a, b]) in kind.edges().iter().enumerate() {
            let middle = nalgebra::center(&at[a], &at[b]);
            assert!((at[kind.corner_count() + e] - middle).norm() < 1e-18, "{} edge {e}", kind.name());
        }
        assert_eq!(mesh.region_names(), ["body"]);
        quality::check(&mesh).unwrap();
    }
}

/// One tetrahedron with every section that a file may contain; the last line has no line break.
const GOOD: &str = "$MeshFormat
2.2 0 8
$EndMeshFormat
$Comments
anything
$EndComments
$PhysicalNames
2
2 7 \"outer face\"
3 9 \"soft tissue\"
$EndPhysicalNames
$Nodes
5
10 0 0 0
20 1e1 0 0
30 0 10.0 0
99 5 5 5
40 0 0 10
$EndNodes
$Elements
4
1 15 2 0 1 99
2 1 2 0 1 10 20
3 2 2 7 1 10 30 20
4 4 3 9 1 0 10 20 30 40
$EndElements";

#[test]
fn a_small_file_with_all_its_parts() {
    for text in
        [GOOD.to_string(), GOOD.replace('\n', "\r\n"), format!("\n{GOOD}\n\n"), GOOD.replace('\n', "\n\n")]
    {
        let mesh = parse(&text).unwrap();
        assert_eq!(mesh.points().len(), 4, "node 99 belongs to no solid");
        assert_eq!(mesh.points()[3], Point3::new(0.0, 0.0, 0.01));
        assert_eq!(mesh.region_names(), ["soft tissue"]);
        let face = mesh.group("outer face").unwrap();
        assert_eq!((face.len(), face[0].face), (1, 0));
    }
    let unnamed = parse(&GOOD.replace("2 7 \"outer", "2 8 \"outer").replace("3 9 \"s", "3 1 \"s")).unwrap();
    assert_eq!(unnamed.region_names(), ["region-9"]);
    assert!(unnamed.group("surface-7").is_some());
}

#[test]
fn broken_files_name_the_line() {
    // (text to replace, replacement, line of the error, words of the message)
    let cases = [
        ("$MeshFormat", "$Mesh", 1, "expected $MeshFormat"),
        ("2.2 0 8", "3.0 0 8", 2, "supported Gmsh formats: 1, 2.2, 4.0 and 4.1"),
        ("2.2 0 8", "2.2 7 8", 2, "supported Gmsh formats: 1, 2.2, 4.0 and 4.1"),
        ("$EndMeshFormat", "$EndFormat", 3, "expected $EndMeshFormat, found '$EndFormat'"),
        ("$EndComments", "$EndComment", 27, "file ends before the end of a section"),
        ("$Comments", "Comments", 4, "expected the start of a section, found 'Comments'"),
        ("2\n2 7", "two\n2 7", 8, "expected the number of physical names, found 'two'"),
        ("\"outer face\"", "outer", 9, "expected a name in quotes, found 'outer'"),
        ("\"outer face\"", "\"", 9, "expected a name in quotes"),
        ("3 9 \"soft", "2 7 \"soft", 10, "physical tag 7 occurs a second time"),
        ("2 7 \"outer", "2 x \"outer", 9, "expected the tag of a physical name, found 'x'"),
        ("5\n10 0", "-5\n10 0", 13, "expected the number of nodes, found '-5'"),
        ("5\n10 0", "6\n10 0", 19, "expected a node number, found '$EndNodes'"),
        ("5\n10 0", "4\n10 0", 18, "expected $EndNodes, found '40 0 0 10'"),
        ("5\n10 0", "99999999999999999999\n10 0", 13, "expected the number of nodes"),
        ("20 1e1 0 0", "20 1,5 0 0", 15, "expected a coordinate, found '1,5'"),
        ("20 1e1 0 0", "20 1e1 0", 15, "expected a coordinate, found 'the end of the line'"),
        ("20 1e1 0 0", "20 1e1 0 0 0", 15, "expected the end of the line, found '0'"),
        ("20 1e1 0 0", "20 nan 0 0", 15, "node 20 has a coordinate that is not finite"),
        ("20 1e1 0 0", "20 1e999 0 0", 15, "node 20 has a coordinate that is not finite"),
        ("20 1e1 0 0", "10 1e1 0 0", 15, "node 10 occurs a second time"),
        ("$EndNodes\n", "$EndNodes\n$Nodes\n0\n$EndNodes\n", 20, "section $Nodes occurs a second time"),
        ("4\n1 15", "5\n1 15", 26, "expected an element number, found '$EndElements'"),
        ("4\n1 15", "3\n1 15", 25, "expected $EndElements"),
        (
            "4 4 3 9 1 0 10 20 30 40",
            "4 4 3 9 1 0 10 20 30",
            25,
            "element 4 of type 4 has 9 numbers on its line instead of 10",
        ),
        ("4 4 3 9 1 0 10 20 30 40", "4 4 3 9 1 0 10 20 30 40 50", 25, "11 numbers"),
        ("4 4 3 9 1 0 10 20 30 40", "4 4 18446744073709551615 9", 25, "instead of 18446744073709551615"),
        (
            "4 4 3 9 1 0 10 20 30 40",
            "4 4 3 9 1 0 10 20 30 41",
            25,
            "element 4 names node 41, which the file does not have",
        ),
        ("4 4 3 9 1 0 10 20 30 40", "4 4 3 9 1 0 10 20 30 30", 25, "element 4 names node 30 twice"),
        ("4 4 3 9 1 0 10 20 30 40", "4 4 3 nine 1 0 10 20 30 40", 25, "expected a tag, found 'nine'"),
        ("4 4 3 9 1 0 10 20 30 40", "4 7 3 9 1 0 10 20 30 40", 25, "element 4 has type 7"),
        ("4 4 3 9 1 0 10 20 30 40", "3 4 3 9 1 0 10 20 30 40", 25, "element 3 occurs a second time"),
        ("4 4 3 9 1 0 10 20 30 40", "4 2 2 0 0 10 20 30", 26, "no solid elements"),
        ("3 2 2 7 1 10 30 20", "3 2 2 7 1 10 30 99", 24, "surface element 3 is not a face of any cell"),
        ("\n$EndElements", "", 26, "file ends before $EndElements"),
    ];
    for (from, to, line, words) in cases {
        assert!(GOOD.contains(from), "{from}");
        let message = parse(&GOOD.replacen(from, to, 1)).unwrap_err().to_string();
        let start = format!("{NAME}:{line}: ");
        assert!(message.starts_with(&start) && message.contains(words), "{from} -> {to}: {message}");
    }
    let cut = |at: &str| parse(&GOOD[..GOOD.find(at).unwrap()]).unwrap_err();
    for (at, section) in [("$Nodes", "$Nodes"), ("$Elements", "$Elements")] {
        let FileError::At { problem, .. } = cut(at) else { panic!() };
        assert_eq!(problem, Problem::Missing { section });
    }
    let nodes = GOOD.find("$Nodes").unwrap();
    let elements = GOOD.find("$Elements").unwrap();
    let swapped = format!("{}{}", &GOOD[..nodes], &GOOD[elements..]);
    assert!(parse(&swapped).unwrap_err().to_string().contains(":12: the file has no $Nodes section"));
    assert!(parse("").unwrap_err().to_string().contains(":1: no supported mesh format begins with ''"));
}

#[test]
fn files_units_and_names_that_cannot_be() {
    let missing = files::read(Path::new("no/such/file.msh"), 1.0).unwrap_err();
    assert!(missing.to_string().starts_with("no/such/file.msh: "), "{missing}");
    let folder = tempfile::tempdir().unwrap();
    let binary = folder.path().join("binary.msh");
    std::fs::write(&binary, [0xff, 0xfe, 0x00]).unwrap();
    assert!(
        files::read(&binary, 1.0).unwrap_err().to_string().contains("no supported mesh format begins with")
    );
    let mesh = box_mesh(CellKind::Tet4, Point3::origin(), Point3::new(1.0, 1.0, 1.0), [1; 3], [1.0; 3], None)
        .unwrap();
    let named = folder.path().join("named.msh");
    for unit in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            files::read_bytes(GOOD.as_bytes(), Path::new(NAME), unit),
            Err(FileError::Unit { .. })
        ));
        assert!(matches!(files::write(&mesh, &named, unit), Err(FileError::Unit { .. })));
    }
    let quoted = mesh.with_group("a \"b\"", vec![]).unwrap();
    assert!(files::write(&quoted, &named, 1.0).unwrap_err().to_string().contains("quotation mark"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    /// The reader returns a result for any text and never panics.
    #[test]
    fn mangled_text_never_panics(at in 0usize..460, cut in 0usize..40, insert in "[0-9a-z$\" \n.e+-]{0,12}") {
        let at = at.min(GOOD.len());
        let end = (at + cut).min(GOOD.len());
        let text = format!("{}{insert}{}", &GOOD[..at], &GOOD[end..]);
        if let Ok(mesh) = parse(&text) {
            prop_assert!(mesh.cell_count() > 0);
        }
    }
}

/// The meshes of the stress study: between two layers of cells lies a layer of flat tetrahedra with this
/// ratio of height to the edge of a cell, and with edges as long as all others.
#[test]
fn slivers_are_as_flat_as_their_files_say() {
    for flatness in [0.1, 0.01, 0.0001, 0.000001, 0.00000001] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/scenes/beam");
        let mesh = files::read(&folder.join(format!("slivers-{flatness}.msh")), 1.0).unwrap();
        let (mut slivers, mut whole) = (0, 0.0);
        for cell in 0..mesh.cell_count() {
            let x: Vec<_> = mesh.cell_points(cell).copied().collect();
            let volume = (x[1] - x[0]).cross(&(x[2] - x[0])).dot(&(x[3] - x[0])) / 6.0;
            let edges = (0..4).flat_map(|i| (0..i).map(move |j| (i, j))).map(|(i, j)| (x[i] - x[j]).norm());
            let (least, most) = edges.fold((f64::MAX, 0.0f64), |(l, m), e| (l.min(e), m.max(e)));
            assert!(least > 9.0 && most < 16.0, "edges of {least} to {most}");
            // Opposite edges of 10 sqrt(2) mm cross at right angles at this distance.
            let height = 6.0 * volume / 200.0;
            if (height / (10.0 * flatness) - 1.0).abs() < 1e-6 {
                slivers += 1;
            } else {
                assert!(height > 4.0, "another sliver, of {height}");
            }
            whole += volume;
        }
        assert_eq!((slivers, mesh.cell_count()), (32, 672));
        assert!((whole - 128e3).abs() < 1e-6 * 128e3);
    }
}
