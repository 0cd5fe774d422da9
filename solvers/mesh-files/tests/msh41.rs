//! Gmsh 4.1 as written: files are read back, and have the blocks that other programs expect.

use std::path::Path;

use geometry::generate::{box_mesh, kidney_mesh};
use geometry::{CellKind, Mesh, Point3};
use tissuebench_mesh_files::{self as files, Format, GmshVersion};

const FOUR: Format = Format::Gmsh(GmshVersion::FourOne);

/// Alternating regions, and facets in one group, in two groups and in none.
fn named(mesh: Mesh) -> Mesh {
    let regions = (0..mesh.cell_count()).map(|cell| u16::from(cell % 3 != 1)).collect();
    let boundary = mesh.boundary();
    let mesh = mesh.with_regions(regions, vec!["inner medulla".into(), "body".into()]);
    let groups = [("held", &boundary[..7]), ("seen", &boundary[4..9]), ("touched", &boundary[6..8])];
    groups
        .into_iter()
        .fold(mesh, |mesh, (name, facets)| mesh.with_group(name, facets.to_vec()).expect("faces of the mesh"))
}

fn written(mesh: &Mesh, name: &str) -> (Mesh, Vec<u8>) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join(name);
    let format = if name.ends_with(".msh") { FOUR } else { Format::of(&file).unwrap() };
    files::write_as(mesh, &file, 1.0, format).unwrap();
    (files::read(&file, 1.0).unwrap_or_else(|bad| panic!("{bad}")), std::fs::read(&file).unwrap())
}

#[test]
fn round_trips_keep_every_bit_in_every_format() {
    for kind in CellKind::ALL {
        let mesh = named(kidney_mesh(kind, 2).unwrap());
        let mut back = mesh.clone();
        for name in ["a.msh", "b.vtu", "c.inp", "d.msh"] {
            back = written(&back, name).0;
            let groups: Vec<&str> = back.group_names().collect();
            assert_eq!(groups, ["held", "seen", "surface", "touched"], "{}: {name}", kind.name());
        }
        assert!(back == mesh, "{}: {:?}", kind.name(), back.region_names());
    }
}

/// Tetrahedra next to a hexahedron: each block has elements of one type.
#[test]
fn mixed_meshes_come_back() {
    let cube = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
    let mut points: Vec<Point3> = cube.iter().map(|p| Point3::from(p.map(f64::from))).collect();
    points.extend([[0.1, 0.2, -1.0], [1.0 / 3.0, 7e-300, 2.0]].map(Point3::from));
    let cells = [
        (CellKind::Tet4, vec![0, 2, 1, 8]),
        (CellKind::Hex8, (0..8).collect()),
        (CellKind::Tet4, vec![4, 5, 6, 9]),
    ];
    let mesh = Mesh::new(points, &cells).unwrap();
    let mesh = mesh.with_regions(vec![1, 0, 1], vec!["hex".into(), "tets".into()]);
    let all = mesh.boundary();
    let mesh =
        mesh.with_group("outside", all.clone()).unwrap().with_group("a part", all[..5].to_vec()).unwrap();
    let (back, text) = written(&mesh, "mixed.msh");
    assert_eq!(back, mesh);
    let text = String::from_utf8(text).unwrap();
    // Other programs write all digits.
    let long = text.replace("7e-300", &format!("{:.300}", 7e-300));
    assert!(long.len() > text.len() + 290);
    assert_eq!(files::read_bytes(long.as_bytes(), Path::new("long.msh"), 1.0).unwrap().0, mesh);
    // Two sets of groups, each with two types of faces, and three runs of cells.
    let entities = text.split("$Entities\n").nth(1).unwrap();
    assert!(entities.starts_with("0 0 2 2\n"), "{entities}");
    let elements: Vec<&str> = text.split("$Elements\n").nth(1).unwrap().lines().collect();
    let heads: Vec<&&str> =
        elements.iter().filter(|line| line.split(' ').count() == 4 && !line.contains('$')).collect();
    assert_eq!(heads[0], &"7 17 1 17", "{heads:?}");
    assert!(heads.contains(&&"3 1 5 1") && heads.contains(&&"3 2 4 1"), "{heads:?}");
}

/// Entities have the bounding box of their nodes, in the file's unit, and their physical tags.
#[test]
fn entities_have_their_boxes_and_tags() {
    let mesh = box_mesh(
        CellKind::Hex8,
        Point3::origin(),
        Point3::new(0.003, 0.002, 0.001),
        [3, 2, 1],
        [1.0; 3],
        None,
    );
    let mesh = mesh.unwrap();
    let low =
        |facet: &&geometry::Facet| mesh.facet_nodes(**facet).all(|n| mesh.points()[n as usize].x == 0.0);
    let held: Vec<_> = mesh.boundary().iter().filter(low).copied().collect();
    assert_eq!(held.len(), 2);
    let names: Vec<String> = mesh.group_names().map(String::from).collect();
    let mut mesh = mesh.clone();
    for name in names {
        mesh = mesh.with_group(&name, Vec::new()).unwrap();
    }
    let mesh = mesh.with_group("held", held.clone()).unwrap().with_group("held too", held).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("box.msh");
    files::write_as(&mesh, &file, 0.001, FOUR).unwrap();
    let text = std::fs::read_to_string(&file).unwrap();
    let tag = |name: &str| {
        let line = text.lines().find(|line| line.ends_with(&format!("\"{name}\""))).unwrap();
        line.split(' ').nth(1).unwrap().to_string()
    };
    let surface = format!("1 0 0 0 0 2 1 2 {} {} 0", tag("held"), tag("held too"));
    let entities = text.split("$Entities\n").nth(1).unwrap();
    let lines: Vec<&str> = entities.lines().take(3).collect();
    assert_eq!(lines, ["0 0 1 1", &surface, "1 0 0 0 3 2 1 1 1 0"]);
    assert!(files::read(&file, 0.001).unwrap().group("held too").is_some());
}

#[test]
fn a_name_that_gmsh_cannot_hold_is_refused() {
    let mesh = kidney_mesh(CellKind::Tet4, 2).unwrap().with_group("a \"b\"", vec![]).unwrap();
    let bad = files::write_as(&mesh, Path::new("never.msh"), 1.0, FOUR).unwrap_err().to_string();
    assert!(bad.contains("never.msh: the name") && bad.contains("quotation mark"), "{bad}");
    assert_eq!(Format::of(Path::new("a.MSH")).unwrap(), Format::Gmsh(GmshVersion::Two));
}
