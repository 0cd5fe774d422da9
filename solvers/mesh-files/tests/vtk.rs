//! Legacy VTK files and Gmsh files of version 1, as written by programs and malformed.

mod common;

use common::assert_refused;
use geometry::Mesh;

fn read(content: impl AsRef<[u8]>) -> Result<Mesh, String> {
    common::read("m", content)
}

/// Two tetrahedra and a face, with arrays of every kind in addition to the regions.
const GRID: &str = "# vtk DataFile Version 2.0
two cells
ASCII
DATASET UNSTRUCTURED_GRID
FIELD FieldData 1
TIME 1 1 double
0.5
POINTS 5 float
0 0 0 1 0 0 0 1 0
0 0 1 1 1 1
CELLS 3 14
4 0 1 2 3
4 1 2 3 4
3 0 2 1
CELL_TYPES 3
10 10 5
CELL_DATA 3
SCALARS temperature double
LOOKUP_TABLE default
1.5 2.5 3.5
VECTORS flow float
1 0 0 0 1 0 0 0 1
FIELD more 2
material 1 3 int
7 8 9
stress 2 3 double
1 2 3 4 5 6
POINT_DATA 5
SCALARS height float 1
LOOKUP_TABLE heights
0 1 2 3 4
LOOKUP_TABLE heights 2
0 0 0 1 1 1 1 1
";

#[test]
fn grids_are_read_with_their_regions() {
    let mesh = read(GRID).unwrap();
    assert_eq!((mesh.points().len(), mesh.cell_count()), (5, 2));
    assert_eq!(mesh.region_names(), ["region-7", "region-8"]);
    assert_eq!(mesh.group("surface-9").map(<[_]>::len), Some(1));
    let spaced = GRID.replace("POINTS", "points").replace('\n', "\r\n");
    assert!(read(spaced).unwrap() == mesh);
}

/// An XML grid in text: two tetrahedra with these cell arrays.
fn vtu(arrays: &str) -> String {
    format!(
        "<VTKFile type=\"UnstructuredGrid\">
<UnstructuredGrid><Piece NumberOfPoints=\"5\" NumberOfCells=\"2\">
<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\">0 0 0 1 0 0 0 1 0 0 0 1 1 1 1</DataArray></Points>
<Cells><DataArray type=\"Int64\" Name=\"connectivity\">0 1 2 3 1 2 3 4</DataArray>
<DataArray type=\"Int64\" Name=\"offsets\">4 8</DataArray>
<DataArray type=\"UInt8\" Name=\"types\">10 10</DataArray></Cells>
<CellData>
{arrays}
</CellData></Piece></UnstructuredGrid></VTKFile>
"
    )
}

fn array(name: &str, kind: &str, values: &str) -> String {
    format!("<DataArray type=\"{kind}\" Name=\"{name}\">{values}</DataArray>")
}

#[test]
fn regions_are_numbered_by_whole_numbers_of_any_type() {
    for name in ["material", "Material", "MaterialIDs", "MaterialIds", "region", "gmsh:physical"] {
        for (kind, values) in [("Int32", "3 4"), ("Float64", "3.0 4e0")] {
            let mesh = read(vtu(&array(name, kind, values))).unwrap();
            assert_eq!(mesh.region_names(), ["region-3", "region-4"], "{name} {kind}");
        }
        for (value, shown) in [("4.25", "4.25"), ("nan", "NaN"), ("1e300", "1000")] {
            let bad = read(vtu(&array(name, "Float64", &format!("3 {value}")))).unwrap_err();
            assert!(bad.starts_with(&format!("m:8: cell 1 has the value {shown}")), "{bad}");
            assert!(bad.contains(&format!("in the array '{name}', which numbers regions")), "{bad}");
        }
    }
    let bad = read(vtu(&array("surface", "Float64", "1 0.5"))).unwrap_err();
    assert!(bad.starts_with("m:8: cell 1 has the value 0.5 in the array 'surface'"), "{bad}");
    // Arrays with other names are ignored.
    let mesh = read(vtu(&array("stiffness", "Float64", "1.5 2.5"))).unwrap();
    assert_eq!(mesh.region_names(), ["body"]);
    let older = GRID.replace("material 1 3 int\n7 8 9", "material 1 3 double\n7 8.5 9");
    let bad = read(&older).unwrap_err();
    assert!(bad.starts_with("m:24: cell 1 has the value 8.5 in the array 'material'"), "{bad}");
    let whole = read(older.replace("8.5", "8.0")).unwrap();
    assert_eq!(whole.region_names(), ["region-7", "region-8"]);
}

/// Arrays of surface numbers as appended raw bytes; -1 of any signed type means no surface.
#[test]
fn raw_whole_numbers_keep_their_sign() {
    for (kind, size) in [("Int8", 1), ("Int16", 2), ("Int32", 4), ("Int64", 8)] {
        let read = |second: i64| {
            let array =
                format!("<DataArray type=\"{kind}\" Name=\"material\" format=\"appended\" offset=\"0\"/>");
            let text = vtu(&array).replace(
                "<VTKFile type=\"UnstructuredGrid\">",
                "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\" header_type=\"UInt32\">",
            );
            let (head, _) = text.split_once("</VTKFile>").unwrap();
            let number = |n: i64| n.to_le_bytes()[..size].to_vec();
            let bytes = [&(2 * size as u32).to_le_bytes()[..], &number(3), &number(second)].concat();
            let end = &b"</AppendedData></VTKFile>"[..];
            read([head.as_bytes(), b"<AppendedData encoding=\"raw\">_", &bytes, end].concat())
        };
        assert_eq!(read(100).unwrap().region_names(), ["region-3", "region-100"], "{kind}");
        let negative = read(-100);
        let says = negative.as_ref().map_or_else(Clone::clone, |mesh| format!("{:?}", mesh.region_names()));
        assert!(says.contains("-100"), "{kind}: {says}");
    }
}

#[test]
fn two_arrays_of_materials_have_to_agree() {
    let both =
        |ids: &str| vtu(&(array("material", "Float64", "3 4") + "\n" + &array("MaterialIds", "Int32", ids)));
    assert_eq!(read(both("3 4")).unwrap().region_names(), ["region-3", "region-4"]);
    let bad = read(both("3 5")).unwrap_err();
    let says =
        "cell 1 is in region 5 by the array 'MaterialIds' and in 4 by 'material': remove or rename one";
    assert!(bad.starts_with("m:") && bad.contains(says), "{bad}");
}

/// A grid in big-endian binary.
fn binary() -> Vec<u8> {
    let mut bytes =
        b"# vtk DataFile Version 3.0\ntwo\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n".to_vec();
    let points = [0.0f64, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    bytes.extend(points.iter().flat_map(|x| x.to_be_bytes()));
    bytes.extend(b"\nMETADATA\nINFORMATION 0\n\nCELLS 1 5\n");
    bytes.extend([4i32, 0, 1, 2, 3].iter().flat_map(|x| x.to_be_bytes()));
    bytes.extend(b"\nCELL_TYPES 1\n");
    bytes.extend(10i32.to_be_bytes());
    bytes.extend(b"\nCELL_DATA 1\nSCALARS region short 1\nLOOKUP_TABLE default\n");
    bytes.extend((-3i16).to_be_bytes());
    bytes.extend(b"\n");
    bytes
}

#[test]
fn binary_grids_are_read() {
    let mesh = read(binary()).unwrap();
    assert_eq!((mesh.points()[3].z, mesh.region_names()), (1.0, &["region--3".to_string()][..]));
    let bad = read(&binary()[..170]).unwrap_err();
    assert!(bad.contains("too many numbers for the size of the file: 12"), "{bad}");
}

#[test]
fn broken_grids_are_refused_with_their_place() {
    let changes = [
        ("Version 2.0", "Version 9.9", "m:1: expected a version up to 5.1"),
        ("Version 2.0", "Version 2.0\nmore", "m:3: expected ASCII or BINARY, found 'two'"),
        ("ASCII", "TEXT", "m:3: expected ASCII or BINARY, found 'TEXT'"),
        (
            "UNSTRUCTURED_GRID",
            "POLYDATA",
            "m:4: expected UNSTRUCTURED_GRID (a mesh of cells), found 'POLYDATA'",
        ),
        ("POINTS 5 float", "POINTS 5 half", "m:8: expected a type of numbers"),
        ("POINTS 5", "POINTS 5000000000", "m:8: too many numbers for the size of the file: 15000000000"),
        ("POINTS 5", "POINTS many", "m:8: expected a number of values, found 'many'"),
        ("POINTS 5", "POINTS 6", "m:11: expected a number, found 'CELLS'"),
        ("POINTS 5", "POINTS 4", "expected a part of the format, such as POINTS or CELL_DATA, found '1'"),
        ("1 1 1", "1 nan 1", "m: node 4: node 4 has a coordinate that is not finite"),
        ("1 1 1", "1 x 1", "m:10: expected a number, found 'x'"),
        ("CELLS 3 14", "CELLS 3 13", "m: cell 2: the file ends before the points of the cell"),
        ("CELLS 3 14", "CELLS 2 14", "the array has length 10 instead of 14"),
        ("4 1 2 3 4", "4 1 2 3 5", "m: cell 1: element 1 names node 5"),
        ("4 1 2 3 4", "4 1 2 3 -4", "m: cell 1: expected node numbers of 0 or more"),
        ("4 1 2 3 4", "4 1 2 3 3", "m: cell 1: element 1 names node 3 twice"),
        ("4 1 2 3 4", "4 3 2 1 0", "m: cell 1: element 1 has the same nodes as element 0"),
        ("10 10 5", "10 10 7", "m: cell 2: element 2 has type 7"),
        ("10 10 5", "10 12 5", "m: cell 1: element 1 of type 12 has 4 numbers"),
        ("10 10 5", "10 10.5 5", "expected a whole number, found '10.5'"),
        ("10 10 5", "5 5 5", "m: cell 0: element 0 of type 5 has 4 numbers"),
        ("CELL_TYPES 3\n10 10 5\n", "", "no CELL_TYPES section"),
        ("CELL_DATA 3", "CELL_DATA 2", "m:20: expected a part of the format"),
        ("material 1 3", "material 1 2", "m:26: expected a number of values, found 'stress'"),
        ("0 0 0 1 1 1 1 1\n", "", "m:32: too many numbers for the size of the file: 8"),
        (
            "stress 2 3 double\n1 2 3 4 5 6",
            "stress 2 3 double\n1 2 3 4 5",
            "m:28: expected a number, found 'POINT_DATA'",
        ),
    ];
    assert_refused("m", GRID, changes);
    let apart = GRID.replace(
        "CELLS 3 14\n4 0 1 2 3\n4 1 2 3 4\n3 0 2 1",
        "CELLS 4 11\nOFFSETS vtktypeint64\n0 4 8 11\nCONNECTIVITY vtktypeint64\n0 1 2 3 1 2 3 4 0 2 1",
    );
    assert!(read(&apart).unwrap() == read(GRID).unwrap());
    for offsets in ["0 4 8 12", "1 4 8 11", "0 8 4 11"] {
        let bad = read(apart.replace("0 4 8 11", offsets)).unwrap_err();
        assert!(bad.contains("offsets that ascend from 0"), "{bad}");
    }
}

/// In the style of a liver mesh that comes with another simulator: no names, and a triangle on the boundary.
const FIRST: &str = "$NOD
5
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
9 1 1 1
$ENDNOD
$ELM
3
1 2 5 1 3 1 3 2
2 4 0 1 4 1 2 3 4
3 4 7 1 4 2 3 4 9
$ENDELM
";

#[test]
fn the_first_format_of_gmsh_is_read() {
    let mesh = read(FIRST).unwrap();
    assert_eq!((mesh.points().len(), mesh.cell_count()), (5, 2));
    assert_eq!(mesh.region_names(), ["body", "region-7"]);
    assert_eq!(mesh.group("surface-5").map(<[_]>::len), Some(1));
    let changes = [
        (
            "3 4 7 1 4 2 3 4 9",
            "3 4 7 1 4 2 3 4 8",
            "m:13: element 3 names node 8, which the file does not have",
        ),
        (
            "3 4 7 1 4 2 3 4 9",
            "3 4 7 1 4 2 3 4",
            "m:13: element 3 of type 4 has 8 numbers on its line instead of 9",
        ),
        ("3 4 7 1 4 2 3 4 9", "3 4 7 1 5 2 3 4 9", "m:13: element 3 of type 4 has 9 numbers"),
        ("3 4 7 1 4 2 3 4 9", "2 4 7 1 4 2 3 4 9", "m:13: element 2 occurs a second time"),
        ("3 4 7 1 4 2 3 4 9", "3 7 7 1 4 2 3 4 9", "m:13: element 3 has type 7"),
        ("9 1 1 1", "4 1 1 1", "m:7: node 4 occurs a second time"),
        ("9 1 1 1", "9 1 nan 1", "m:7: node 9 has a coordinate that is not finite"),
        ("$ENDNOD\n", "", "m:8: expected $ENDNOD, found '$ELM'"),
        ("$ENDELM\n", "", "the file ends before $ENDELM"),
        ("$ENDELM\n", "$ENDELM\n$MORE\n", "m:15: expected the end of the file, found '$MORE'"),
        ("5\n1 0", "many\n1 0", "m:2: expected the number of nodes, found 'many'"),
    ];
    assert_refused("m", FIRST, changes);
}
