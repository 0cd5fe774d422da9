//! Surface files: accepted files, and errors with their place.

mod common;

use std::path::Path;

use common::assert_refused_by;
use geometry::Surface;
use proptest::prelude::*;
use tissuebench_mesh_files as files;

/// A tetrahedron with a volume of 1/6.
const CORNERS: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
const FACES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];

fn read(name: &str, bytes: &[u8]) -> Result<Surface, String> {
    files::read_surface_bytes(bytes, Path::new(name), 1.0).map_err(|bad| bad.to_string())
}

fn stl_text(faces: &[[usize; 3]]) -> String {
    let mut text = String::from("solid tet\n");
    for face in faces {
        text += "facet normal 0 0 0\n outer loop\n";
        for corner in face.map(|i| CORNERS[i]) {
            text += &format!("  vertex {} {} {}\n", corner[0], corner[1], corner[2]);
        }
        text += " endloop\nendfacet\n";
    }
    text + "endsolid tet\n"
}

fn stl_binary(faces: &[[usize; 3]], head: &[u8]) -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes[..head.len()].copy_from_slice(head);
    bytes.extend((faces.len() as u32).to_le_bytes());
    for face in faces {
        bytes.extend([0u8; 12]);
        for corner in face.map(|i| CORNERS[i]) {
            bytes.extend(corner.iter().flat_map(|&x| (x as f32).to_le_bytes()));
        }
        bytes.extend([0, 0]);
    }
    bytes
}

fn obj(faces: &str) -> String {
    let corners: String = CORNERS.iter().map(|p| format!("v {} {} {}\n", p[0], p[1], p[2])).collect();
    format!("# a tetrahedron\nmtllib some.mtl\no tet\n{corners}vn 0 0 1\ns off\n{faces}")
}

const OBJ_FACES: &str = "f 1 3 2\nf 1//1 2//1 4//1\nf -3 -2 -1\nf 1/1/1 4/1/1 \\\n 3/1/1\n";

fn ply_text(header: &str, faces: &str) -> String {
    let corners: String = CORNERS.iter().map(|p| format!("{} {} {} 7\n", p[0], p[1], p[2])).collect();
    format!("ply\nformat ascii 1.0\ncomment by hand\n{header}end_header\n{corners}{faces}")
}

const PLY_HEADER: &str = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n\
    element face 4\nproperty list uchar int vertex_indices\n";
const PLY_FACES: &str = "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";

fn ply_binary(big: bool) -> Vec<u8> {
    let order = if big { "big" } else { "little" };
    let mut bytes = format!(
        "ply\r\nformat binary_{order}_endian 1.0\r\nelement vertex 4\r\nproperty double x\r\nproperty double y\r\nproperty double z\r\n\
         element face 4\r\nproperty uchar flags\r\nproperty list ushort uint vertex_index\r\nend_header\r\n"
    )
    .into_bytes();
    let mut put = |of: &[u8]| {
        let mut of = of.to_vec();
        if big {
            of.reverse();
        }
        bytes.extend(of);
    };
    CORNERS.iter().flatten().for_each(|x| put(&x.to_le_bytes()));
    for face in FACES {
        put(&[9u8]);
        put(&3u16.to_le_bytes());
        face.iter().for_each(|&i| put(&(i as u32).to_le_bytes()));
    }
    bytes
}

#[test]
fn every_kind_of_surface_file_is_read() {
    let quads = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
    let two = stl_text(&FACES[..2]) + &stl_text(&FACES[2..]).to_uppercase();
    for (name, bytes) in [
        ("text.stl", stl_text(&FACES).into_bytes()),
        ("lines.stl", stl_text(&FACES).replace('\n', "\r\n\r\n").into_bytes()),
        ("two-solids.stl", two.into_bytes()),
        ("binary.stl", stl_binary(&FACES, b"a comment")),
        ("solid.stl", stl_binary(&FACES, b"solid and binary")),
        ("any.obj", obj(OBJ_FACES).into_bytes()),
        ("plain.obj", obj(quads).into_bytes()),
        ("text.ply", ply_text(PLY_HEADER, PLY_FACES).into_bytes()),
        ("little.ply", ply_binary(false)),
        ("big.ply", ply_binary(true)),
        ("wrong-suffix.msh", ply_binary(true)),
    ] {
        let surface = read(name, &bytes).unwrap_or_else(|bad| panic!("{bad}"));
        assert_eq!((surface.points().len(), surface.triangles().len()), (4, 4), "{name}");
        assert!((surface.volume() - 1.0 / 6.0).abs() < 1e-15, "{name}: {}", surface.volume());
        let mesh = files::read_bytes(&bytes, Path::new(name), 1.0).unwrap_err().to_string();
        assert!(mesh.contains("is a surface, not a mesh; `tissuebench mesh make`"), "{mesh}");
    }
    // Faces of four corners.
    let cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
        f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    let cube = read("cube.obj", cube.as_bytes()).unwrap();
    assert_eq!(cube.triangles().len(), 12);
    assert!((cube.volume() - 1.0).abs() < 1e-15 && (cube.area() - 6.0).abs() < 1e-15);
}

/// Asserts that a surface file is rejected after each of these changes, with the given words.
fn assert_refused<const N: usize>(name: &str, text: &str, changes: [(&str, &str, &str); N]) {
    assert_refused_by(|text| read(name, text.as_bytes()).err(), text, changes);
}

#[test]
fn every_broken_text_is_refused_with_its_place() {
    let stl = [
        ("vertex 0 1 0", "vertex 0 nan 0", "a.stl:2: triangle 1 has a coordinate"),
        ("vertex 0 1 0", "vertex 0 1", "a.stl:5: expected a coordinate, found 'the end of the line'"),
        ("vertex 0 1 0", "vertex 0 1 0 0", "a.stl:5: expected vertex and three"),
        (" endloop\n", "", "a.stl:7: expected endloop"),
        ("outer loop", "outer", "a.stl:3: expected outer loop"),
        ("facet normal", "face", "a.stl:2: expected facet or endsolid, found 'face"),
        ("endsolid tet\n", "", "the file ends before endsolid"),
        ("endsolid tet\n", "endsolid tet\nfacet\n", "a.stl:31: expected solid, found 'facet'"),
    ];
    assert_refused("a.stl", &stl_text(&FACES), stl);
    let obj_changes = [
        ("v 1 0 0", "v 1 0", "a.obj:5: expected a coordinate"),
        ("v 1 0 0", "v 1 inf 0", "a.obj:5: node 2 has a coordinate that is not finite"),
        ("f 1 3 2", "f 1 3 9", "a.obj:10: face 1 names corner 9, which the file does not have"),
        ("f 1 3 2", "f 0 3 2", "face 1 names corner 0"),
        ("-3 -2", "-5 -2", "a.obj:12: face 3 names corner -5"),
        ("f 1 3 2", "f 1 3", "a.obj:10: expected a face of three corners or more"),
        ("f 1 3 2", "f 1 x 2", "a.obj:10: expected the number of a corner, found 'x'"),
        ("s off", "wobble 3", "a.obj:9: expected v, f or another word of the format, found 'wobble 3'"),
        ("3/1/1\n", "3/1/1 \\\n", "the file ends before the rest of a line"),
    ];
    assert_refused("a.obj", &obj(OBJ_FACES), obj_changes);
    let ply = [
        ("end_header\n", "", "a.ply:11: expected a line of a PLY header"),
        ("format ascii", "format text", "expected format ascii"),
        ("format ascii 1.0\n", "", "no format section"),
        ("vertex 4", "vertex 4000000000", "a.ply:4: too many elements for the size of the file: 4000000000"),
        ("vertex 4", "vertex 5", "a.ply:"),
        ("vertex 4", "vertex 3", "a.ply:"),
        ("face 4", "face 5", "a.ply:20: the file ends before a value of an element"),
        ("face 4", "face 3", "a.ply:19: expected the end of the file, found '3'"),
        ("float z", "float w", "no vertex with x, y and z section"),
        ("int vertex_indices", "int corners", "no face with a list vertex_indices section"),
        ("float x", "real x", "a.ply:5: expected a type such as float or int"),
        ("3 0 2 1", "3 0 2 7", "a.ply:15: face 1 names corner 7"),
        ("3 0 2 1", "3 0 2 1.5", "face 1 names corner 1"),
        ("3 0 2 1", "2 0 2", "a.ply:15: expected a face of three corners or more, found '2'"),
        ("3 0 2 1", "-3 0 2 1", "expected the length of a list, found '-3'"),
        ("1 0 0 7", "1 nan 0 7", "node 1 has a coordinate that is not finite"),
    ];
    assert_refused("a.ply", &ply_text(PLY_HEADER, PLY_FACES), ply);
}

#[test]
fn every_broken_binary_is_refused_with_its_place() {
    let cut = |bytes: Vec<u8>| bytes[..bytes.len() - 1].to_vec();
    let mut nan = stl_binary(&FACES, b"");
    nan[84 + 50 + 12..84 + 50 + 16].copy_from_slice(&f32::NAN.to_le_bytes());
    let mut many = stl_binary(&FACES, b"");
    many[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    let stl = cut(stl_binary(&FACES, b""));
    let longer = [ply_binary(true), vec![1, 2, 3]].concat();
    for (name, bytes, says) in [
        ("a.stl", stl, "a.stl: byte 80: 4 triangles take 284 bytes, but the file has 283"),
        ("a.stl", many, "4294967295 triangles take 214748364834 bytes"),
        ("a.stl", nan, "a.stl: byte 134: triangle 2 has a coordinate that is not finite"),
        ("a.stl", stl_text(&FACES).as_bytes()[..150].to_vec(), "a.stl:12: the file ends before vertex"),
        ("a.stl", b"nonsense".to_vec(), "a comment of 80 bytes"),
        ("a.stl", b"solid nothing\nendsolid\n".to_vec(), "0 triangles enclose nothing"),
        ("a.ply", cut(ply_binary(false)), "the file ends before a value of an element"),
        ("a.ply", longer, "expected the end of the file, found '3 bytes more'"),
        ("a.off", b"OFF\n4 4 6\n".to_vec(), "a.off:3: the file ends before all corners"),
        ("a.obj", b"OFFSET\n4 4 6\n".to_vec(), "no supported mesh format begins with 'OFFSET'"),
    ] {
        let bad = read(name, &bytes).err().unwrap_or_else(|| panic!("read, but {says}"));
        assert!(bad.contains(says), "{bad}\n  has no: {says}");
    }
}

const OFF: &str =
    "OFF 4 4 6\n# corners\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3 255 0 0\n3 1 2 3\n3 0 3 2\n";
const MEDIT: &str = "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n\
    Triangles 4\n1 3 2 0\n1 2 4 5\n2 3 4 5\n1 4 3 6\nEnd\n";
const VTP: &str = r#"<VTKFile type="PolyData"><PolyData>
<Piece NumberOfPoints="4" NumberOfPolys="4">
<Points><DataArray type="Float32" NumberOfComponents="3">0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points>
<Polys><DataArray type="Int32" Name="connectivity">0 2 1 0 1 3 1 2 3 0 3 2</DataArray>
<DataArray type="Int32" Name="offsets">3 6 9 12</DataArray></Polys></Piece></PolyData></VTKFile>"#;

#[test]
fn off_medit_and_vtp_are_read_and_refused_with_their_place() {
    for (name, text) in [("a.off", OFF), ("a.mesh", MEDIT), ("a.vtp", VTP)] {
        let bad = read(name, text.as_bytes()).err();
        assert_eq!(bad, None, "{name}");
    }
    let surface = files::read_surface_bytes(MEDIT.as_bytes(), Path::new("a.mesh"), 1.0).unwrap();
    assert_eq!(surface.groups().names(), ["surface-5", "surface-6"]);
    assert_refused(
        "a.off",
        OFF,
        [
            ("0 1 0\n", "0 nan 0\n", "a.off:5: node 2 has a coordinate that is not finite"),
            ("3 0 1 3", "3 0 1 4", "a.off:8: face 2 names corner 4, which the file does not have"),
            ("3 1 2 3", "2 1 2", "a.off:9: expected a face of three corners or more, found '2 1 2'"),
            ("4 4 6", "4 5 6", "the file ends before all faces"),
            ("4 4 6", "4 x", "a.off:1: expected the number of faces, found 'x'"),
        ],
    );
    assert_refused(
        "a.mesh",
        MEDIT,
        [
            ("Dimension 3", "Dimension 2", "a.mesh:2: expected dimension 3, found '2'"),
            ("0 0 1 0", "0 0 inf 0", "a.mesh:8: node 4 has a coordinate that is not finite"),
            ("1 2 4 5", "1 2 0 5", "a.mesh:11: face 2 names corner 0, which the file does not have"),
            (
                "Triangles 4",
                "Tetrahedra 4",
                "a.mesh:9: Tetrahedra of a .mesh file is not supported; write the volume",
            ),
            ("Triangles 4", "Shells 4", "a.mesh:9: expected Vertices, Triangles or another keyword"),
            ("Triangles 4", "Triangles 5", "a.mesh:14: expected the number of a corner, found 'End'"),
        ],
    );
    assert_refused(
        "a.vtp",
        VTP,
        [
            ("0 1 3 ", "0 1 4 ", "face 2 names corner 4, which the file does not have"),
            ("3 6 9 12", "3 2 9 12", "a.vtp:5: expected ascending offsets, found 'others'"),
            ("NumberOfPoints=\"4\"", "NumberOfPoints=\"5\"", "the array has length 12 instead of 15"),
            (
                "NumberOfPoints=\"4\"",
                "NumberOfStrips=\"1\" NumberOfPoints=\"4\"",
                "a strip of triangles is not supported",
            ),
            ("offsets\"", "ends\"", "the file has no offsets section"),
        ],
    );
}

#[test]
fn surfaces_that_enclose_nothing_are_refused_with_triangle_and_place() {
    let of = |faces: &[[usize; 3]]| read("a.stl", stl_text(faces).as_bytes()).err().unwrap_or_default();
    let open = of(&[FACES[0], FACES[1], FACES[2], [0, 3, 3]]);
    assert!(open.starts_with("a.stl: 3 triangles enclose nothing"), "{open}");
    let turned = of(&[FACES[0], FACES[1], FACES[2], [0, 2, 3]]);
    assert!(
        turned.contains(
            "triangles 1 and 4 have opposite orientations along their common edge (0, 0, 0) to (0, 1, 0)"
        ),
        "{turned}"
    );
    let twice = of(&[FACES[0], FACES[1], FACES[2], FACES[3], FACES[3]]);
    assert!(twice.contains("triangles 1, 4, 5 meet at one edge"), "{twice}");
    let inverted = of(&FACES.map(|[a, b, c]| [a, c, b]));
    assert!(inverted.contains("inside out at triangle 1, (0.3333333, 0.3333333, 0)"), "{inverted}");
    assert!(inverted.contains("the volume is -1.666667e-1"), "{inverted}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Randomly changed bytes are read or rejected without a panic.
    #[test]
    fn changed_files_are_read_or_refused(kind in 0usize..4, places in prop::collection::vec((0usize..400, any::<u8>()), 1..6)) {
        let mut bytes = match kind {
            0 => stl_text(&FACES).into_bytes(),
            1 => stl_binary(&FACES, b""),
            2 => obj(OBJ_FACES).into_bytes(),
            _ => ply_binary(false),
        };
        for (at, byte) in places {
            let count = bytes.len();
            bytes[at % count] = byte;
        }
        if let Ok(surface) = read(["a.stl", "a.stl", "a.obj", "a.ply"][kind], &bytes) {
            prop_assert!(surface.volume().is_finite());
        }
    }
}
