//! Mesh files of other programs, round trips between formats, and malformed decks.

mod common;

use std::path::{Path, PathBuf};

use common::assert_refused;
use geometry::generate::{box_mesh, kidney_mesh};
use geometry::{CellKind, Mesh, Point3, quality};
use tissuebench_mesh_files as files;

/// Files of one cell kind written by `make.py` in the same folder.
fn made(kind: CellKind) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files");
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files
        .retain(|file| file.file_name().unwrap().to_string_lossy().starts_with(&format!("{}-", kind.name())));
    files.sort();
    files
}

fn sizes(mesh: &Mesh, names: [&str; 2]) -> [Option<usize>; 2] {
    names.map(|name| mesh.group(name).map(<[_]>::len))
}

/// Two adjacent cubes: two halves with equal numbers of cells, 2 m^3 in total, constrained at one end and
/// loaded at the other.
#[test]
fn files_of_other_programs_hold_two_cubes() {
    for kind in CellKind::ALL {
        let files = made(kind);
        let encodings = if [CellKind::Tet10, CellKind::Hex8].contains(&kind) { 9 } else { 0 };
        assert_eq!(files.len(), 14 + encodings, "{files:?}");
        let first = files::read(&files[0], 1.0).unwrap();
        for file in &files {
            let mesh = files::read(file, 1.0).unwrap_or_else(|bad| panic!("{bad}"));
            let name = file.display();
            assert_eq!(mesh.uniform_kind(), Some(kind), "{name}");
            assert_eq!(
                (mesh.points().len(), mesh.cell_count()),
                (first.points().len(), first.cell_count()),
                "{name}"
            );
            let quality = quality::check(&mesh).unwrap_or_else(|bad| panic!("{name}: {bad}"));
            assert!((quality.volume - 2.0).abs() < 1e-12, "{name}: {}", quality.volume);
            // The other files written by meshio have no groups.
            if ["meshio.inp", "4.0-binary"].iter().any(|by| name.to_string().contains(by)) {
                assert_eq!(mesh.region_names(), ["body"], "{name}");
                continue;
            }
            let (left, right, ends) = match file.extension().unwrap().to_str() {
                Some("inp") => ("left_half", "right", ["held", "pressed"]),
                Some("vtu" | "vtk") => ("region-11", "region-12", ["surface-21", "surface-22"]),
                _ => ("left half", "right", ["held", "pressed"]),
            };
            let mut names = mesh.region_names().to_vec();
            names.sort();
            assert_eq!(names, [left, right], "{name}");
            let of_left = names_of(&mesh).filter(|name| *name == left).count();
            assert_eq!(2 * of_left, mesh.cell_count(), "{name}");
            let faces = if kind.corner_count() == 4 { 8 } else { 4 };
            assert_eq!(sizes(&mesh, ends), [Some(faces); 2], "{name}");
            let held = mesh.group(ends[0]).unwrap();
            let at_end =
                |&facet| mesh.facet_nodes(facet).all(|node| mesh.points()[node as usize].x.abs() < 1e-12);
            assert!(held.iter().all(at_end), "{name}");
        }
    }
}

fn names_of(mesh: &Mesh) -> impl Iterator<Item = &str> {
    (0..mesh.cell_count()).map(|cell| mesh.region_names()[mesh.region(cell) as usize].as_str())
}

#[test]
fn round_trips_keep_every_bit() {
    let folder = tempfile::tempdir().unwrap();
    for kind in CellKind::ALL {
        let mesh = kidney_mesh(kind, 2).unwrap();
        let count = mesh.cell_count();
        // The first cell is in the second region, whose name is also the default for cells without a region.
        let regions = (0..count).map(|c| u16::from(c % 3 != 1)).collect();
        let mesh = mesh.with_regions(regions, vec!["inner medulla".into(), "body".into()]);
        let some = mesh.boundary()[..7].to_vec();
        let mesh = mesh.with_group("a few faces", some).unwrap();
        let mut back = mesh.clone();
        for name in ["round.msh", "round.vtu", "round.inp", "again.msh"] {
            let file = folder.path().join(name);
            files::write(&back, &file, 1.0).unwrap();
            back = files::read(&file, 1.0).unwrap();
        }
        assert!(back == mesh, "{}: {:?}", kind.name(), back.region_names());
    }
    let bad = files::write(&kidney_mesh(CellKind::Tet4, 2).unwrap(), Path::new("mesh.vtp"), 1.0).unwrap_err();
    assert!(bad.to_string().contains("mesh.vtp: meshes are written as .msh"), "{bad}");
}

fn deck(text: &str) -> Result<Mesh, String> {
    common::read("deck.inp", text)
}

const DECK: &str = "*heading
 a block, *not a keyword
** a comment
*Node, NSET=\"All Nodes\"
1, 0.0, 0.0, 0.0
 2, 1.D0 , 0., 0.
3, 0, 1.0d+0, 0
4, 0, 0, 1
5, 1., 1., 1.
*ELEMENT,
TYPE=C3D4, ELSET=Two
11, 1, 2,
3, 4
12, 2, 3, 4,5
*ELEMENT, TYPE=S3, ELSET=skin
13, 1,3,2
*Elset, elset=second
 12
*ELSET, ELSET=both, GENERATE
11, 12, 1
*NSET, NSET=bottom
1, 2, 3
*SURFACE, NAME=\"slanted face\", TYPE=ELEMENT
SECOND, s3
*MATERIAL, NAME=tissue
*ELASTIC
20e3, 0.45
*STEP
*NODE
not read any more
";

#[test]
fn decks_are_read_as_people_write_them() {
    for text in [DECK.to_string(), DECK.replace('\n', "\r\n")] {
        let mesh = deck(&text).unwrap();
        assert_eq!((mesh.points().len(), mesh.cell_count()), (5, 2));
        assert_eq!(mesh.points()[1], Point3::new(1.0, 0.0, 0.0));
        assert_eq!(names_of(&mesh).collect::<Vec<_>>(), ["both", "second"]);
        let groups: Vec<(&str, usize)> =
            mesh.group_names().map(|name| (name, mesh.group(name).unwrap().len())).collect();
        assert_eq!(groups, [("All Nodes", 6), ("bottom", 1), ("skin", 1), ("slanted face", 1)]);
        assert_eq!(mesh.group("bottom"), mesh.group("skin"));
        let slanted = mesh.group("slanted face").unwrap()[0];
        let mut nodes: Vec<u32> = mesh.facet_nodes(slanted).collect();
        nodes.sort_unstable();
        // S3 of the deck's element with nodes 2 3 4 5 is the face of its second, fourth and third node.
        assert_eq!(nodes, [2, 3, 4]);
    }
    let sections = DECK.replace("*MATERIAL", "*SOLID SECTION, ELSET=Two, MATERIAL=tissue\n*MATERIAL");
    assert_eq!(deck(&sections).unwrap().region_names(), ["Two"]);
}

/// A part placed twice: the second instance is rotated by a right angle about the z axis, then shifted by 3
/// along x.
#[test]
fn parts_are_placed_and_turned() {
    let text = "*PART, NAME=corner
*NODE
1, 0, 0, 0
2, 1, 0, 0
3, 0, 2, 0
4, 0, 0, 1
*ELEMENT, TYPE=C3D4, ELSET=solid
1, 1, 2, 3, 4
*END PART
*ASSEMBLY, NAME=all
*INSTANCE, NAME=a, PART=corner
*END INSTANCE
*INSTANCE, NAME=b, PART=Corner
 3, 0, 0
 3, 0, 0, 3, 0, 1, 90
*END INSTANCE
*NSET, NSET=held, INSTANCE=a
1, 2
*NSET, NSET=held, INSTANCE=B, GENERATE
1, 3
*NSET, NSET=both
HELD, a.3
*ELSET, ELSET=_top_S1, INTERNAL, INSTANCE=b
solid
*SURFACE, NAME=top, TYPE=ELEMENT
_top_S1, S1
b.1, S2
*END ASSEMBLY
";
    let mesh = deck(text).unwrap();
    assert_eq!((mesh.points().len(), mesh.cell_count()), (8, 2));
    let wanted = [[3.0, 0.0, 0.0], [3.0, 1.0, 0.0], [1.0, 0.0, 0.0], [3.0, 0.0, 1.0]];
    for (x, wanted) in mesh.points()[4..].iter().zip(wanted) {
        assert!((x - Point3::from(wanted)).norm() < 1e-15, "{x}");
    }
    assert!((quality::check(&mesh).unwrap().volume - 2.0 / 3.0).abs() < 1e-15);
    let nodes = |name: &str| mesh.facet_group_nodes(mesh.group(name).unwrap());
    assert_eq!((nodes("held"), nodes("both")), (vec![4, 5, 6], vec![0, 1, 2, 4, 5, 6]));
    assert_eq!(nodes("top"), [4, 5, 6, 7]);
    assert_eq!(mesh.group("top").map(<[_]>::len), Some(2));
    let changes = [
        ("INSTANCE=a\n1, 2", "INSTANCE=c\n1, 2", 17, "node set 'held' names instance c"),
        ("INSTANCE=a\n1, 2", "INSTANCE=a\n1, 9", 18, "node set 'held' names node 9"),
        ("\n1, 3\n", "\n1, 5\n", 20, "node set 'held' names node 5"),
        ("HELD, a.3", "HELD, c.3", 22, "node set 'both' names set c.3"),
        ("INSTANCE=b\nsolid", "INSTANCE=b\nfluid", 24, "element set '_top_S1' names set fluid"),
        ("_top_S1, S1", "_top_S1, S7", 26, "expected a face that the elements have, such as S1, found 'S7'"),
        ("b.1, S2", "b.2, S2", 27, "surface 'top' names element 2"),
    ];
    assert_refused("deck.inp", text, changes.map(at_line));
}

/// A change with the expected line and words of the message.
fn at_line<'a>((from, to, line, says): (&'a str, &'a str, u32, &str)) -> (&'a str, &'a str, String) {
    (from, to, format!("deck.inp:{line}: ...{says}"))
}

#[test]
fn broken_decks_name_the_line() {
    let cases = [
        ("*heading", "heading", 1, "no supported mesh format begins with 'heading'"),
        (
            "*Node, NSET",
            "*Nodes, NSET",
            4,
            "*NODES is not a keyword of Abaqus or CalculiX; did you mean *NODE?",
        ),
        ("1.D0", "1,D0", 6, "expected a coordinate, found 'D0'"),
        ("1.0d+0", "nan", 7, "expected a coordinate, found 'nan'"),
        ("1.0d+0", "1e999", 7, "node 3 has a coordinate that is not finite"),
        ("4, 0, 0, 1", "3, 0, 0, 1", 8, "node 3 occurs a second time"),
        ("4, 0, 0, 1", "-4, 0, 0, 1", 8, "expected a node number, found '-4'"),
        ("TYPE=C3D4", "TYPE=C3D5", 12, "element 11 has type C3D5; supported types: C3D4, C3D10"),
        ("TYPE=C3D4, ", "", 10, "expected TYPE, found '*ELEMENT'"),
        ("12, 2, 3, 4,5", "12, 2, 3, 4,5,6", 14, "element 12 of type C3D4 has 6 numbers"),
        ("12, 2, 3, 4,5", "12, 2, 3, 4,6", 14, "element 12 names node 6"),
        ("12, 2, 3, 4,5", "12, 2, 3, 4,4", 14, "element 12 names node 4 twice"),
        ("12, 2, 3, 4,5", "11, 2, 3, 4,5", 14, "element 11 occurs a second time"),
        ("12, 2, 3, 4,5", "12, 4, 3, 2, 1", 14, "element 12 has the same nodes as element 11 (line 12)"),
        ("\n 12\n", "\n 14\n", 18, "element set 'second' names element 14"),
        ("\n 12\n", "\n first\n", 18, "element set 'second' names set first"),
        ("11, 12, 1", "12, 11, 1", 20, "a last number not below the first"),
        ("11, 12, 1", "11, 12, 0", 20, "a step of 1 or more"),
        ("11, 12, 1", "1, 4000000000", 20, "too many numbers to generate: 3999999999"),
        ("SECOND, s3", "SECOND, s5", 24, "expected a face that the element has"),
        ("SECOND, s3", "SECOND, 3", 24, "expected the face of an element, such as S1, found '3'"),
        ("SECOND, s3", "third, s3", 24, "surface 'slanted face' names set third"),
        ("*MATERIAL", "*SOLID SECTION, ELSET=none\n*MATERIAL", 25, "'none' names set none"),
        ("*MATERIAL", "*NGEN\n*MATERIAL", 25, "*NGEN is not supported; write a deck that lists all nodes"),
        (
            "*MATERIAL",
            "*NSET, NSET=a, INPUT=b.txt\n*MATERIAL",
            25,
            "INPUT of *NSET is not supported; copy the lines",
        ),
        ("*MATERIAL", "*INCLUDE, INPUT=../other.inp\n*MATERIAL", 25, "lie in the folder of the deck"),
        ("*MATERIAL", "*INCLUDE, INPUT=/etc/passwd\n*MATERIAL", 25, "lie in the folder of the deck"),
        ("*MATERIAL", "*INCLUDE, INPUT=nothing.inp\n*MATERIAL", 25, "the file does not exist"),
        ("*MATERIAL", "*INSTANCE, NAME=a, PART=b\n*MATERIAL", 25, "names part b"),
        ("*MATERIAL", "*END PART\n*MATERIAL", 25, "expected *PART before *END PART"),
        ("*ELEMENT,\nTYPE=C3D4", "*ELEMENT,\n TYPE=T3D2", 1, "no solid elements"),
    ];
    assert_refused("deck.inp", DECK, cases.map(at_line));
}

/// Unused nodes are the remains of lost elements and are rejected; nodes of elements that are not cells are
/// used.
#[test]
fn nodes_without_elements_are_refused_or_left_out() {
    let with = |more: &str| {
        DECK.replace(", NSET=\"All Nodes\"", "").replace("5, 1., 1., 1.", &format!("5, 1., 1., 1.\n{more}"))
    };
    let lone = with("77, 2, 2, 2\n78, 3, 2, 2");
    // A deck with a step runs as it is elsewhere, so none of its elements is lost.
    assert_eq!(deck(&lone).unwrap().points().len(), 5);
    let (lone, _) = lone.split_once("*STEP").unwrap();
    let bad = deck(lone).unwrap_err();
    assert!(bad.starts_with("deck.inp:10: node 77 (and 1 others) belongs to no element"), "{bad}");
    for named in [
        "*NSET, NSET=reference\n77, 78",
        "*ELEMENT, TYPE=T3D2\n99, 77, 78",
        "*RIGID BODY, REF NODE=77\n*MPC\nBEAM, 78, 1",
    ] {
        let mesh = deck(&lone.replace("*MATERIAL", &format!("{named}\n*MATERIAL"))).unwrap();
        assert_eq!(mesh.points().len(), 5, "{named}");
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("deck.inp");
    std::fs::write(&file, lone).unwrap();
    assert_eq!(files::read_without_unused(&file, 1.0).unwrap().points().len(), 5);
}

/// The contents of blocks match the counts of their section.
#[test]
fn counts_of_blocks_are_those_of_their_section() {
    let file = made(CellKind::Tet4).into_iter().find(|f| f.ends_with("tet4-4.1-text.msh")).unwrap();
    let text = std::fs::read_to_string(&file).unwrap();
    let refused = |section: &str| {
        let head = text.split(&format!("{section}\n")).nth(1).unwrap().lines().next().unwrap();
        let words: Vec<&str> = head.split(' ').collect();
        let other =
            format!("{} {} {} {}", words[0], words[1].parse::<u64>().unwrap() + 1, words[2], words[3]);
        let spoiled = text.replacen(&format!("{section}\n{head}"), &format!("{section}\n{other}"), 1);
        files::read_bytes(spoiled.as_bytes(), &file, 1.0).unwrap_err().to_string()
    };
    for (section, what) in [("$Nodes", "nodes"), ("$Elements", "elements")] {
        let bad = refused(section);
        assert!(bad.contains("the section says that it has") && bad.contains(what), "{bad}");
    }
}

/// Some editors write a byte order mark at the beginning of a text.
#[test]
fn a_mark_of_the_encoding_is_no_part_of_a_file() {
    assert!(deck(&format!("\u{feff}{DECK}")).unwrap() == deck(DECK).unwrap());
}

#[test]
fn files_that_decks_include_are_read_and_named() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    let nodes = "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n";
    write("nodes.inp", nodes);
    write("deck.inp", "*INCLUDE, INPUT=nodes.inp\n*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n");
    let file = folder.path().join("deck.inp");
    assert_eq!(files::read(&file, 1.0).unwrap().cell_count(), 1);
    assert_eq!(files::included(&file), [folder.path().join("nodes.inp")]);
    write("nodes.inp", &nodes.replace("3, 0", "2, 0"));
    let bad = files::read(&file, 1.0).unwrap_err().to_string();
    assert!(bad.ends_with("deck.inp:1: in nodes.inp, line 4: node 2 occurs a second time"), "{bad}");
    write("deck.inp", "*INCLUDE, INPUT=deck.inp\n");
    let bad = files::read(&file, 1.0).unwrap_err().to_string();
    assert!(bad.contains("more than eight deep"), "{bad}");
}

/// Every file, truncated anywhere or with changed bytes, is read or rejected without a panic.
#[test]
fn cut_and_spoiled_files_are_refused() {
    for kind in [CellKind::Tet4, CellKind::Hex8] {
        for file in made(kind) {
            let bytes = std::fs::read(&file).unwrap();
            // Content after the elements is optional; a deck may end after any element.
            let end =
                |mark: &[u8]| bytes.windows(mark.len()).position(|w| w == mark).map(|at| at + mark.len());
            let whole = end(b"$EndElements").or(end(b"</Cells>")).unwrap_or(0);
            let mut at = 7;
            let mut seed = 1u64;
            while at < bytes.len() {
                let cut = files::read_bytes(&bytes[..at], &file, 1.0);
                assert!(at >= whole || cut.is_err(), "{}: {at}", file.display());
                let mut spoiled = bytes.clone();
                seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                spoiled[at] = (seed >> 33) as u8;
                let _ = files::read_bytes(&spoiled, &file, 1.0);
                at += 1 + bytes.len() / 300;
            }
        }
    }
}

/// A count beyond the size of the file allocates no memory: nodes of a binary file, or a set of a block.
#[test]
fn claims_beyond_the_size_are_refused() {
    let box_of =
        box_mesh(CellKind::Tet4, Point3::origin(), Point3::new(1.0, 1.0, 1.0), [1; 3], [1.0; 3], None);
    assert!(box_of.is_ok());
    let file = &made(CellKind::Tet4)[4];
    let bytes = std::fs::read(file).unwrap();
    assert!(file.ends_with("tet4-4.1-binary.msh"), "{}", file.display());
    let nodes = bytes.windows(7).position(|w| w == b"$Nodes\n").unwrap() + 7;
    let mut claimed = bytes.clone();
    claimed[nodes..nodes + 8].copy_from_slice(&u64::MAX.to_le_bytes());
    let bad = files::read_bytes(&claimed, file, 1.0).unwrap_err().to_string();
    assert!(bad.contains(&format!("byte {}: too many blocks of nodes: {}", nodes + 8, u64::MAX)), "{bad}");
}

/// Grids with appended data whose array descriptions contradict the data.
#[test]
fn broken_grids_name_the_place() {
    let text = std::fs::read_to_string(
        made(CellKind::Hex8).iter().find(|f| f.ends_with("hex8-vtk-text.vtu")).unwrap(),
    )
    .unwrap();
    let cases = [
        ("type=\"UnstructuredGrid\"", "type=\"PolyData\"", ":1: is a surface, not a mesh"),
        ("<Piece", "<Peace", "expected 'Peace' tag, not 'Piece'"),
        ("NumberOfPoints=\"45\"", "NumberOfPoints=\"46\"", "the array has length 135 instead of 138"),
        ("NumberOfPoints=\"45\"", "NumberOfPoints=\"18446744073709551615\"", "too many nodes"),
        ("NumberOfPoints=\"45\"", "NumberOfPoints=\"-1\"", "expected NumberOfPoints, found '-1'"),
        (
            "NumberOfCells=\"24\"",
            "NumberOfCells=\"4000000000\"",
            "the array has length 24 instead of 4000000000",
        ),
        ("Name=\"types\"", "Name=\"kinds\"", "the file has no types section"),
        ("<Cells>", "<Cell>", "expected 'Cell' tag"),
        (
            "NumberOfComponents=\"3\"",
            "NumberOfComponents=\"2\"",
            "expected points of 3 coordinates, found '2'",
        ),
        ("type=\"UInt8\" Name=\"types\"", "type=\"Bit\" Name=\"types\"", "expected a type of numbers"),
    ];
    assert_refused("grid.vtu", &text, cases);
    let bad = common::read("a.feb", "<febio_spec version=\"4.0\"></febio_spec>").unwrap_err();
    assert_eq!(bad, "a.feb:1: the file has no Mesh section");
    let bad = common::read("a.xml", "<model version=\"4.0\"></model>").unwrap_err();
    assert!(
        bad.starts_with("a.xml:1: no supported mesh format begins with '<model>'; supported: Gmsh .msh"),
        "{bad}"
    );
    let packed = |from: &str, to: &str| {
        let file = made(CellKind::Hex8).into_iter().find(|f| f.ends_with("hex8-vtk-raw-zlib.vtu")).unwrap();
        let bytes = std::fs::read(&file).unwrap();
        let at = bytes.windows(from.len()).position(|w| w == from.as_bytes()).unwrap();
        let spoiled = [&bytes[..at], to.as_bytes(), &bytes[at + from.len()..]].concat();
        files::read_bytes(&spoiled, &file, 1.0).unwrap_err().to_string()
    };
    let bad = packed("vtkZLibDataCompressor", "vtkLZMADataCompressor");
    assert!(bad.contains("vtkLZMADataCompressor is not supported; write the file with zlib, lz4"), "{bad}");
    let bad = packed("vtkZLibDataCompressor", "vtkLZ4DataCompressor");
    assert!(bad.contains("expected a block that unpacks to the stated length, found 'block 0'"), "{bad}");
}
