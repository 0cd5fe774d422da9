//! Census of at least sixty valid and sixty malformed mesh files. All valid files are read with the right
//! content, and all malformed files are rejected with the place of the error.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use geometry::{CellKind, Mesh, quality};
use tissuebench_mesh_files::{self as files, Format, GmshVersion};

/// Smallest number of files of either class.
const LEAST: usize = 60;

/// Nodes and cells of the two cubes that `files/make.py` writes in every format.
const MADE: [(CellKind, usize, usize); 4] = [
    (CellKind::Tet4, 43, 88),
    (CellKind::Tet10, 213, 88),
    (CellKind::Hex8, 45, 16),
    (CellKind::Hex20, 141, 16),
];

/// Files of one cell kind.
fn made(kind: CellKind) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files");
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let of_kind = |file: &PathBuf| name(file).starts_with(&format!("{}-", kind.name()));
    let mut files: Vec<PathBuf> = files.filter(of_kind).collect();
    files.sort();
    files
}

fn name(file: &Path) -> String {
    file.file_name().unwrap().to_string_lossy().into()
}

fn assert_two_cubes(mesh: &Mesh, (kind, nodes, cells): (CellKind, usize, usize), name: &str) {
    assert_eq!(mesh.uniform_kind(), Some(kind), "{name}");
    assert_eq!((mesh.points().len(), mesh.cell_count()), (nodes, cells), "{name}");
    let quality = quality::check(mesh).unwrap_or_else(|bad| panic!("{name}: {bad}"));
    assert!((quality.volume - 2.0).abs() < 1e-12, "{name}: {}", quality.volume);
}

#[test]
fn valid_files_are_read_as_what_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let mut count = 0;
    for known in MADE {
        let files = made(known.0);
        for file in &files {
            let mesh = files::read(file, 1.0).unwrap_or_else(|bad| panic!("{bad}"));
            assert_two_cubes(&mesh, known, &name(file));
        }
        let mesh = files::read(&files[0], 1.0).unwrap();
        let four = Format::Gmsh(GmshVersion::FourOne);
        let ours = [
            ("2.msh", Format::Gmsh(GmshVersion::Two)),
            ("4.msh", four),
            ("a.inp", Format::Abaqus),
            ("a.vtu", Format::Vtu),
        ];
        for (name, format) in ours {
            let file = folder.path().join(name);
            files::write_as(&mesh, &file, 1.0, format).unwrap();
            assert_two_cubes(&files::read(&file, 1.0).unwrap_or_else(|bad| panic!("{bad}")), known, name);
        }
        count += files.len() + ours.len();
    }
    assert!(count >= LEAST, "{count} valid files");
}

/// An edit of the lines of a file (`None` if it does not apply) and the expected message.
type Edit = (fn(&mut Vec<String>) -> Option<()>, &'static str);

/// Index of the first line that begins with `start`.
fn at(lines: &[String], start: &str) -> Option<usize> {
    lines.iter().position(|line| line.starts_with(start))
}

/// Replaces a word of a line.
fn word(line: &mut String, nth: usize, to: &str) -> Option<()> {
    let mut words: Vec<String> = line.split_whitespace().map(String::from).collect();
    *words.get_mut(nth)? = to.into();
    *line = words.join(" ");
    Some(())
}

/// Replaces a word in the line before the mark; the last word if `nth` is `None`.
fn before(lines: &mut [String], mark: &str, nth: Option<usize>, to: &str) -> Option<()> {
    let line = lines.get_mut(at(lines, mark)?.checked_sub(1)?)?;
    let last = line.split_whitespace().count().checked_sub(1)?;
    word(line, nth.unwrap_or(last), to)
}

/// Increments a number of a line by one.
fn raised(line: &mut String, nth: usize) -> Option<()> {
    let number: usize = line.split_whitespace().nth(nth)?.parse().ok()?;
    word(line, nth, &(number + 1).to_string())
}

/// Edits of version 2.2 in text.
const TEXT_2: [Edit; 10] = [
    (|l| before(l, "$EndNodes", Some(1), "nan"), "has a coordinate that is not finite"),
    (|l| before(l, "$EndNodes", Some(3), "-1e999"), "has a coordinate that is not finite"),
    (|l| before(l, "$EndNodes", Some(0), "1"), "node 1 occurs a second time"),
    (|l| before(l, "$EndNodes", Some(3), ""), "expected a coordinate, found 'the end of the line'"),
    (|l| at(l, "$Nodes").and_then(|n| raised(&mut l[n + 1], 0)), "expected a node number, found '$EndNodes'"),
    (|l| before(l, "$EndElements", None, "999999"), "names node 999999, which the file does not have"),
    (|l| before(l, "$EndElements", Some(0), "1"), "element 1 occurs a second time"),
    (|l| before(l, "$EndElements", Some(1), "7"), "has type 7"),
    (
        |l| {
            let (start, end) = (at(l, "$Elements")?, at(l, "$EndElements")?);
            raised(&mut l[start + 1], 0)?;
            l.insert(end, l[end - 1].clone());
            word(&mut l[end], 0, "999999")
        },
        "element 999999 has the same nodes as element",
    ),
    (|l| at(l, "$EndElements").map(|end| l.truncate(end)), "the file ends before $EndElements"),
];

/// Edits of versions 4.0 and 4.1 in text.
const TEXT_4: [Edit; 8] = [
    (|l| word(&mut l[1], 0, "4.2"), "supported Gmsh formats: 1, 2.2, 4.0 and 4.1"),
    (|l| before(l, "$EndElements", None, "999999"), "names node 999999, which the file does not have"),
    (|l| before(l, "$EndElements", Some(0), "1"), "element 1 occurs a second time"),
    (
        |l| {
            let (head, place) = (at(l, "$Elements")? + 2, usize::from(!l[1].starts_with("4.1")));
            word(&mut l[head], place, "1")
        },
        "a block of an entity of dimension 1 has elements of type",
    ),
    (|l| at(l, "$Elements").and_then(|n| raised(&mut l[n + 1], 1)), "the section says that it has"),
    (
        |l| at(l, "$Nodes").and_then(|n| raised(&mut l[n + 1], 2)),
        "the section says that its nodes are numbered 2 to",
    ),
    (
        |l| at(l, "$Elements").and_then(|n| raised(&mut l[n + 1], 3)),
        "the section says that its elements are numbered 1 to",
    ),
    (
        |l| {
            // The first block contains one node.
            let (first, older) = (at(l, "$Nodes")? + 3, !l[1].starts_with("4.1"));
            if older { word(&mut l[first], 1, "nan") } else { word(&mut l[first + 1], 0, "nan") }
        },
        "has a coordinate that is not finite",
    ),
];

const DECK: [Edit; 6] = [
    (
        |l| at(l, "*NODE").map(|n| l[n].push('S')),
        "*NODES is not a keyword of Abaqus or CalculiX; did you mean *NODE?",
    ),
    (|l| at(l, "*NODE").and_then(|n| word(&mut l[n + 1], 1, "nan,")), "expected a coordinate, found 'nan'"),
    (
        |l| at(l, "*NODE").and_then(|n| word(&mut l[n + 1], 1, "1d999,")),
        "node 1 has a coordinate that is not finite",
    ),
    (|l| at(l, "*NODE").and_then(|n| word(&mut l[n + 2], 0, "1,")), "node 1 occurs a second time"),
    (
        |l| {
            let line = l.iter().position(|line| line.starts_with("*ELEMENT") && line.contains("C3D"))?;
            l[line] = l[line].replace("C3D", "C3D1");
            Some(())
        },
        "C3D4, C3D10, C3D8, C3D20, C3D6, C3D15",
    ),
    (
        |l| {
            l.push("*NSET,".into());
            Some(())
        },
        "the file ends before the rest of a keyword line",
    ),
];

const GRID: [Edit; 5] = [
    (|l| at(l, "CELL_TYPES").and_then(|n| word(&mut l[n + 1], 0, "99")), "element 0 has type 99"),
    (|l| at(l, "POINTS").and_then(|n| word(&mut l[n + 1], 4, "nan")), "has a coordinate that is not finite"),
    (|l| at(l, "POINTS").and_then(|n| word(&mut l[n + 1], 4, "x")), "expected a number, found 'x'"),
    (
        |l| at(l, "POINTS").and_then(|n| word(&mut l[n], 1, "4000000000")),
        "too many numbers for the size of the file",
    ),
    (|l| word(&mut l[3], 1, "POLYDATA"), "expected UNSTRUCTURED_GRID"),
];

const XML: [Edit; 3] = [
    (
        |l| {
            let line = l.iter_mut().find(|line| line.contains("NumberOfPoints=\""))?;
            *line = line.replacen("NumberOfPoints=\"", "NumberOfPoints=\"1", 1);
            Some(())
        },
        "the array has length",
    ),
    (
        |l| {
            let line = l.iter_mut().find(|line| line.contains("UnstructuredGrid"))?;
            *line = line.replacen("UnstructuredGrid", "PolyData", 1);
            Some(())
        },
        "is a surface, not a mesh",
    ),
    (|l| at_end(l).map(|end| l.truncate(end)), ""),
];

/// Index of the middle line.
fn at_end(lines: &[String]) -> Option<usize> {
    (lines.len() > 10).then_some(lines.len() / 2)
}

fn edits(name: &str) -> &'static [Edit] {
    match name {
        _ if name.contains("2.2-text") => &TEXT_2,
        _ if name.contains("4.0-text.msh") || name.contains("4.1-text.msh") => &TEXT_4,
        _ if name.ends_with(".inp") => &DECK,
        _ if name.contains("-text.vtk") => &GRID,
        _ if name.contains("-text.vtu") => &XML,
        _ => &[],
    }
}

/// Whether a message has a line, byte, cell or node number.
fn has_place(message: &str) -> bool {
    let digit = |rest: &str| rest.starts_with(|c: char| c.is_ascii_digit());
    let marks = ["msh:", "inp:", "vtk:", "vtu:", " byte ", " cell ", " node "];
    marks.iter().any(|mark| message.match_indices(mark).any(|(at, _)| digit(&message[at + mark.len()..])))
}

#[test]
fn malformed_files_are_refused_with_their_place() {
    let (mut known, mut wrong) = (HashSet::new(), Vec::new());
    let mut refused = |file: &Path, bytes: Vec<u8>, says: &str| {
        match files::read_bytes(&bytes, file, 1.0) {
            Ok(_) => wrong.push(format!("{}: read, but {says}", name(file))),
            Err(bad) => {
                let bad = bad.to_string();
                if !(bad.contains(says) && has_place(&bad)) {
                    wrong.push(format!("{bad}\n  has no place or no: {says}"));
                }
            }
        }
        known.insert(bytes);
    };
    for file in MADE.iter().flat_map(|(kind, ..)| made(*kind)) {
        let bytes = std::fs::read(&file).unwrap();
        for (edit, says) in edits(&name(&file)) {
            let text = std::str::from_utf8(&bytes).unwrap();
            let mut lines: Vec<String> = text.lines().map(String::from).collect();
            if edit(&mut lines).is_some() {
                refused(&file, (lines.join("\n") + "\n").into_bytes(), says);
            }
        }
        if edits(&name(&file)).is_empty() {
            // Binary numbers: the file is truncated in the middle.
            refused(&file, bytes[..bytes.len() / 2].to_vec(), "");
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(known.len() >= LEAST, "{} malformed files", known.len());
}
