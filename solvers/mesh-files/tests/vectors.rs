//! Vectors of cells and nodes in VTK, Gmsh and FEBio files.

mod common;

use std::path::Path;

use common::assert_refused_by;
use geometry::Vector3;
use tissuebench_mesh_files::{Vectors, read_vectors_bytes};

fn read(content: impl AsRef<[u8]>, name: &str) -> Result<Vectors, String> {
    let found = read_vectors_bytes(content.as_ref(), Path::new("m"), 1.0, name);
    found.map(|(_, vectors)| vectors).map_err(|bad| bad.to_string())
}

/// Two tetrahedra, a face before them and a node that nothing but the face uses.
const GRID: &str = "# vtk DataFile Version 2.0
two cells
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 6 float
9 9 9
0 0 0 1 0 0 0 1 0
0 0 1 1 1 1
CELLS 3 14
3 0 2 1
4 1 2 3 4
4 2 3 4 5
CELL_TYPES 3
5 10 10
CELL_DATA 3
VECTORS flow float
9 9 9 1 0 0 0 1 0
FIELD more 2
my%20fibres 3 3 double
9 9 9 0 0 0 nan 0 1
stress 2 3 double
1 2 3 4 5 6
POINT_DATA 6
VECTORS twist double
9 9 9 1 0 0 2 0 0 3 0 0 4 0 0 5 0 0
SCALARS height float 1
LOOKUP_TABLE default
0 1 2 3 4 5
";

fn lengths(vectors: &Vectors) -> Vec<f64> {
    vectors.vectors.iter().map(|vector| vector.unwrap().norm()).collect()
}

#[test]
fn arrays_of_cells_and_nodes_belong_to_the_mesh() {
    let flow = read(GRID, "flow").unwrap();
    assert!(flow.of_cells);
    assert_eq!((flow.numbers, flow.vectors), (vec![1, 2], vec![Some(Vector3::x()), Some(Vector3::y())]));
    // The first node is not in the mesh.
    let twist = read(GRID, "twist").unwrap();
    assert!(!twist.of_cells);
    assert_eq!((lengths(&twist), twist.numbers), (vec![1.0, 2.0, 3.0, 4.0, 5.0], vec![1, 2, 3, 4, 5]));
    // Vectors that are no direction are left to the user.
    let fibres = read(GRID, "my fibres").unwrap().vectors;
    assert_eq!(fibres[0], Some(Vector3::zeros()));
    assert!(fibres[1].unwrap().x.is_nan());
}

#[test]
fn arrays_that_are_no_vectors_are_refused() {
    let refusal = |name: &str| read(GRID, name).unwrap_err();
    assert_eq!(
        refusal("fibers"),
        "m: has no array 'fibers'; its arrays of vectors are flow, my fibres, twist"
    );
    assert_eq!(refusal("stress"), "m:21: the array 'stress' has 2 components; a direction has three");
    assert_eq!(refusal("height"), "m:26: the array 'height' has 1 component; a direction has three");
    assert_refused_by(
        |text| read(text, "flow").err(),
        GRID,
        [
            ("VECTORS twist", "VECTORS flow", "m:24: the array 'flow' occurs a second time, of other items"),
            (
                "CELL_DATA 3\nVECTORS flow float\n9 9 9 ",
                "CELL_DATA 2\nVECTORS flow float\n",
                "the array has length 6 instead of 9",
            ),
            ("VECTORS flow float\n9 9 9", "VECTORS flow float\n9 x 9", "m:17: expected a number, found 'x'"),
        ],
    );
}

fn vtu(arrays: [&str; 2]) -> String {
    let piece = |array: &str| {
        format!(
            "<Piece NumberOfPoints=\"4\" NumberOfCells=\"1\">
<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\">0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points>
<Cells><DataArray type=\"Int64\" Name=\"connectivity\">0 1 2 3</DataArray>
<DataArray type=\"Int64\" Name=\"offsets\">4</DataArray><DataArray type=\"UInt8\" Name=\"types\">10</DataArray></Cells>
{array}
</Piece>"
        )
    };
    let pieces = arrays.map(piece);
    let second = pieces[1].replace("0 0 0 1 0 0 0 1 0 0 0 1", "5 0 0 6 0 0 5 1 0 5 0 1");
    format!(
        "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid>\n{}{second}\n</UnstructuredGrid></VTKFile>",
        pieces[0]
    )
}

const CELLS: [&str; 2] = [
    "<CellData><DataArray type=\"Float64\" Name=\"fibers\" NumberOfComponents=\"3\">1 0 0</DataArray></CellData>",
    "<CellData><DataArray type=\"Float32\" Name=\"fibers\" NumberOfComponents=\"3\">0 2 0</DataArray></CellData>",
];

#[test]
fn pieces_of_an_array_follow_each_other() {
    let found = read(vtu(CELLS), "fibers").unwrap();
    assert_eq!((lengths(&found), found.numbers), (vec![1.0, 2.0], vec![0, 1]));
    let nodes = CELLS.map(|array| array.replace("Cell", "Point").replace(" 0<", " 0 3 0 0 0 4 0 0 5 6<"));
    let found = read(vtu([&nodes[0], &nodes[1]]), "fibers").unwrap();
    assert_eq!(lengths(&found), [1.0, 3.0, 4.0, 61f64.sqrt(), 2.0, 3.0, 4.0, 61f64.sqrt()]);
    // A piece without the array has no vectors.
    let found = read(vtu([CELLS[0], ""]), "fibers").unwrap();
    assert_eq!(found.vectors, [Some(Vector3::x()), None]);
    let short = CELLS[1].replace(" 0<", "<");
    let refusal = read(vtu([CELLS[0], &short]), "fibers").unwrap_err();
    assert!(refusal.starts_with("m:11: the array has length 2 instead of 3"), "{refusal}");
    let odd = CELLS[1].replace("\"3\"", "\"many\"");
    let refusal = read(vtu([CELLS[0], &odd]), "fibers").unwrap_err();
    assert!(refusal.starts_with("m:11: expected a number of components, found 'many'"), "{refusal}");
}

/// Two tetrahedra by version 2 in text, numbered from 7, with vectors of both and scalars of the nodes.
const GMSH: &str = "$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
5
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 1 1 1
$EndNodes
$Elements
2
7 4 2 0 1 1 2 3 4
8 4 2 0 1 2 3 4 5
$EndElements
$NodeData
1
\"height\"
1
0.0
3
0
1
1
5 2.5
$EndNodeData
$ElementData
1
\"fibers\"
1
0.0
3
0
3
2
8 0 1 0
7 1 0 0
$EndElementData
";

#[test]
fn gmsh_data_are_found_by_element_number() {
    let found = read(GMSH, "fibers").unwrap();
    assert_eq!((found.numbers, found.vectors), (vec![7, 8], vec![Some(Vector3::x()), Some(Vector3::y())]));
    let one = GMSH.replace("3\n2\n8 0 1 0\n", "3\n1\n");
    assert_eq!(read(one, "fibers").unwrap().vectors, [Some(Vector3::x()), None]);
    assert_eq!(
        read(GMSH, "height").unwrap_err(),
        "m:17: the array 'height' has 1 component; a direction has three"
    );
    assert_eq!(read(GMSH, "flow").unwrap_err(), "m: has no array 'flow'; its arrays of vectors are fibers");
    assert_refused_by(
        |text| read(text, "fibers").err(),
        GMSH,
        [
            ("8 0 1 0\n7", "7 0 1 0\n7", "m:28: a vector for element 7 occurs a second time"),
            ("\n2\n8 0", "\n900000\n8 0", "too many values: 900000"),
            ("8 0 1 0", "8 0 one 0", "m:37: expected a component, found 'one'"),
            ("7 1 0 0\n", "7 1 0\n", "m:39: expected a component, found '$EndElementData'"),
            ("\"height\"\n1", "\"height\"\none", "m:20: expected the real tags of an array, found 'one'"),
        ],
    );
}

#[test]
fn binary_gmsh_data_are_read() {
    let text = GMSH.split("$Nodes").next().unwrap();
    let mut file = text.replace("2.2 0 8\n", "2.2 1 8\n\u{1}\0\0\0\n").into_bytes();
    let ints = |list: &[i32]| list.iter().flat_map(|n| n.to_le_bytes()).collect::<Vec<u8>>();
    let reals = |list: &[f64]| list.iter().flat_map(|n| n.to_le_bytes()).collect::<Vec<u8>>();
    file.extend(b"$Nodes\n4\n");
    for (number, at) in
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].iter().enumerate()
    {
        file.extend(ints(&[number as i32 + 1]));
        file.extend(reals(at));
    }
    file.extend(b"\n$EndNodes\n$Elements\n1\n");
    file.extend(ints(&[4, 1, 2, 7, 0, 1, 1, 2, 3, 4]));
    file.extend(b"\n$EndElements\n$ElementData\n1\n\"fibers\"\n1\n0.0\n3\n0\n3\n1\n");
    file.extend(ints(&[7]));
    file.extend(reals(&[0.0, 0.5, 0.0]));
    file.extend(b"\n$EndElementData\n");
    assert_eq!(read(file, "fibers").unwrap().vectors, [Some(Vector3::new(0.0, 0.5, 0.0))]);
}

/// Two tetrahedra with fibres by their places in an element set.
const MODEL: &str = r#"<febio_spec version="4.0">
<Mesh>
<Nodes><node id="1">0,0,0</node><node id="2">1,0,0</node><node id="3">0,1,0</node><node id="4">0,0,1</node>
<node id="5">1,1,1</node></Nodes>
<Elements type="tet4" name="Wall"><elem id="7">1,2,3,4</elem><elem id="8">2,3,4,5</elem></Elements>
<ElementSet name="Turned">8,7</ElementSet>
</Mesh>
<MeshData>
<ElementData type="fiber" elem_set="Turned">
<e lid="1">1,0,0</e>
<e lid="2">0,0.6,0.8</e>
</ElementData>
</MeshData>
</febio_spec>
"#;

#[test]
fn fibres_of_a_model_belong_to_the_elements_of_their_set() {
    let of = |vectors: Vectors| {
        assert!(vectors.of_cells);
        vectors.numbers.into_iter().zip(vectors.vectors).collect::<Vec<_>>()
    };
    let second = Some(Vector3::new(0.0, 0.6, 0.8));
    assert_eq!(of(read(MODEL, "fiber").unwrap()), [(7, second), (8, Some(Vector3::x()))]);
    let own = MODEL.replace("elem_set=\"Turned\"", "elem_set=\"Wall\"");
    assert_eq!(of(read(own, "fiber").unwrap()), [(7, Some(Vector3::x())), (8, second)]);
    for (from, to, said) in [
        ("lid=\"2\"", "lid=\"3\"", "m:11: expected the place of an element in the set"),
        ("lid=\"2\"", "lid=\"0\"", "m:11: expected the place of an element in the set"),
        ("0,0.6,0.8", "0,0.6", "m:11: expected three components"),
        ("elem_set=\"Turned\"", "elem_set=\"Other\"", "m:9: expected an elem_set of the mesh"),
    ] {
        let bad = read(MODEL.replace(from, to), "fiber").unwrap_err();
        assert!(bad.contains(said), "{bad}");
    }
}
