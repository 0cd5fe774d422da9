//! Small deviations from a format that programs write and the readers accept.

use std::path::Path;

use geometry::{Mesh, quality};
use tissuebench_mesh_files::{read_bytes, read_surface_bytes};

fn mesh(text: impl AsRef<[u8]>, name: &str) -> Mesh {
    read_bytes(text.as_ref(), Path::new(name), 1.0).unwrap_or_else(|bad| panic!("{bad}")).0
}

fn volume(mesh: &Mesh) -> f64 {
    quality::volumes(mesh).iter().sum()
}

fn refused(text: &str, name: &str) -> String {
    read_bytes(text.as_bytes(), Path::new(name), 1.0).map(|_| ()).unwrap_err().to_string()
}

const CORNER: &str = "v 0 0 0\nv 30 0 0\nv 0 30 0\nv 0 0 10\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

#[test]
fn zeros_behind_a_text_are_no_part_of_it() {
    for end in ["\0", "\0\0\0\n", "\n\0 \0"] {
        let text = format!("{CORNER}{end}");
        let surface = read_surface_bytes(text.as_bytes(), Path::new("a.obj"), 1.0).unwrap();
        assert!((surface.volume() - 1500.0).abs() < 1e-9, "{end:?}");
        let text = format!("{}{end}", tet_msh());
        assert_eq!(mesh(text, "a.msh").cell_count(), 1, "{end:?}");
    }
    // Zero bytes in the middle of a text are rejected.
    let text = CORNER.replace("f 1 3 2", "f 1\0 3 2");
    assert!(read_surface_bytes(text.as_bytes(), Path::new("a.obj"), 1.0).is_err());
}

/// Facets of a box as STL, with the end keywords of some programs.
fn stl(end_solid: &str, end_facet: &str, end_loop: &str) -> String {
    let corners = [[0, 0, 0], [20, 0, 0], [0, 10, 0], [0, 0, 10]];
    let facet = |t: [usize; 3]| {
        let [a, b, c] = t.map(|k| corners[k].map(|x| x.to_string()).join(" "));
        format!(
            "facet normal 0 0 0\nouter loop\nvertex {a}\nvertex {b}\nvertex {c}\n{end_loop}\n{end_facet}\n"
        )
    };
    let facets = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]].map(facet).concat();
    format!("solid organ\n{facets}{end_solid}\n")
}

#[test]
fn the_end_of_a_solid_may_be_two_words() {
    for text in [
        stl("end solid organ", "endfacet", "endloop"),
        stl("End Solid", "end facet", "end loop"),
        stl("endsolid organ", "endfacet", "endloop"),
    ] {
        let surface = read_surface_bytes(text.as_bytes(), Path::new("a.stl"), 1.0).unwrap();
        assert_eq!(surface.triangles().len(), 4);
        assert_eq!(surface.groups().names(), ["organ"]);
    }
    let text = stl("end", "endfacet", "endloop");
    let bad = read_surface_bytes(text.as_bytes(), Path::new("a.stl"), 1.0).map(|_| ()).unwrap_err();
    assert!(bad.to_string().contains("expected facet or endsolid, found 'end'"), "{bad}");
}

fn tet_msh() -> String {
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n\
     $Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n"
        .into()
}

const TET_41: &str = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 4 1 4\n3 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n\
                      $EndNodes\n$Elements\n1 1 1 1\n3 1 4 1\n1 1 2 3 4\n$EndElements\n";
const TET_1: &str =
    "$NOD\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$ENDNOD\n$ELM\n1\n1 4 1 1 4 1 2 3 4\n$ENDELM\n";

#[test]
fn sections_may_stand_before_the_first_of_a_mesh() {
    let comments = "$Comments\nmade by hand\n$EndComments\n";
    for text in [tet_msh().as_str(), TET_41, TET_1] {
        for before in [comments.to_string(), comments.repeat(2), String::new()] {
            let mesh = mesh(before + text, "a.msh");
            assert!((volume(&mesh) - 1.0 / 6.0).abs() < 1e-15);
        }
    }
    assert!(refused("$Comments\nno end\n", "a.msh").contains("expected $MeshFormat, found '$Comments'"));
    assert!(refused(comments, "a.msh").contains("expected $MeshFormat"));
    // Line numbers count all lines.
    let wrong = format!("{comments}{}", tet_msh().replace("1 0 0 0", "1 0 x 0"));
    assert!(refused(&wrong, "a.msh").contains("a.msh:9: "), "{}", refused(&wrong, "a.msh"));
}

const CUBE: &str = "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n";

#[test]
fn a_text_may_be_in_latin_1() {
    let mut deck = b"*HEADING\nMod\xe8le du rein, 37 \xb0C\n".to_vec();
    deck.extend(CUBE.as_bytes());
    deck.extend(b"*ELEMENT, TYPE=C3D8, ELSET=h\xe9patique\n1,1,2,3,4,5,6,7,8\n");
    assert_eq!(mesh(deck, "a.inp").region_names(), ["h\u{e9}patique"]);
    let mut comment = b"# Z\xfcrich\n".to_vec();
    comment.extend(CORNER.as_bytes());
    assert_eq!(read_surface_bytes(&comment, Path::new("a.obj"), 1.0).unwrap().triangles().len(), 4);
    let mut ply = b"ply\nformat ascii 1.0\ncomment M\xfcller\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                   element face 4\nproperty list uchar int vertex_indices\nend_header\n"
        .to_vec();
    ply.extend(b"0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");
    assert_eq!(read_surface_bytes(&ply, Path::new("a.ply"), 1.0).unwrap().triangles().len(), 4);
}

/// Such elements list up to three nodes of their own after the corners, which no other element uses.
#[test]
fn elements_with_incompatible_modes_may_list_nodes_inside() {
    let inner = "9,.5,.5,0\n10,.5,.5,1\n11,.5,0,.5\n";
    for nodes in ["9,10", "9", "9,10,11"] {
        let deck = format!("{CUBE}{inner}*ELEMENT, TYPE=C3D8I, ELSET=E\n1,1,2,3,4,5,6,7,8,{nodes}\n");
        let mesh = mesh(deck, "a.inp");
        assert_eq!((mesh.cell_count(), mesh.points().len()), (1, 8), "{nodes}");
    }
    let deck = |kind: &str, nodes: &str| {
        format!("{CUBE}{inner}*ELEMENT, TYPE={kind}, ELSET=E\n1,1,2,3,4,5,6,7,8{nodes}\n")
    };
    assert!(refused(&deck("C3D8", ",9,10"), "a.inp").contains("has 11 numbers on its line instead of 9"));
    assert!(refused(&deck("C3D8I", ""), "a.inp").contains("node 9 (and 2 others) belongs to no element"));
    // CalculiX takes the first eight of a C3D8, and passes over nodes without elements.
    for nodes in ["", ",9,10", ",9,10,11"] {
        let mesh = mesh(deck("C3D8", nodes) + "*STEP\n*STATIC\n*END STEP\n", "a.inp");
        assert_eq!((mesh.cell_count(), mesh.points().len()), (1, 8), "{nodes}");
    }
}

/// A quarter of a tube with the radii 1 and 2, with straight edges between the four corners of each end.
#[test]
fn nodes_may_be_in_cylindrical_coordinates() {
    let deck = |system: &str| {
        format!(
            "*NODE{system}\n1,1,0,0\n2,2,0,0\n3,2,90,0\n4,1,90,0\n5,1,0,1\n6,2,0,1\n7,2,90,1\n8,1,90,1\n\
             *ELEMENT, TYPE=C3D8, ELSET=E\n1,1,2,3,4,5,6,7,8\n"
        )
    };
    let tube = mesh(deck(", SYSTEM=C"), "a.inp");
    assert!((volume(&tube) - 1.5).abs() < 1e-12, "{}", volume(&tube));
    assert!((volume(&mesh(deck(", SYSTEM=R"), "a.inp")) - 90.0).abs() < 1e-12);
    let bad = refused(&deck(", SYSTEM=S"), "a.inp");
    assert!(bad.contains("a.inp:1: *NODE, SYSTEM=S is not supported; write the nodes"), "{bad}");
}
