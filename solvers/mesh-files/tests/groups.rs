//! Cells in several groups, parts of a file that are not in its mesh, and cells whose nodes are in another
//! order.

use std::path::Path;

use geometry::generate::{raise_order, to_tets, turned};
use geometry::{CellKind, Mesh, generate, quality};
use tissuebench_mesh_files::{self as files, Format, GmshVersion, Kind, read_bytes};

fn read(text: &str, name: &str) -> Result<Mesh, String> {
    read_bytes(text.as_bytes(), Path::new(name), 1.0).map(|(mesh, _)| mesh).map_err(|bad| bad.to_string())
}

/// Parts of a file with this text that are not in its mesh.
fn left_out(text: &str, name: &str) -> Vec<files::LeftOut> {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join(name);
    std::fs::write(&file, text).unwrap();
    files::left_out(&file)
}

const HEAD: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n3 1 \"cortex\"\n3 2 \"medulla\"\n3 3 \"kidney\"\n\
                    $EndPhysicalNames\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n$EndNodes\n";

fn twice(second: &str) -> String {
    format!(
        "{HEAD}$Elements\n4\n1 4 2 1 1 1 2 3 4\n2 4 2 3 1 1 2 3 4\n3 4 2 2 2 2 3 4 5\n4 4 2 {second} 2 2 3 4 5\n$EndElements\n"
    )
}

const ENTITIES: &str = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n3 1 \"cortex\"\n3 2 \"medulla\"\n3 3 \"kidney\"\n\
                        $EndPhysicalNames\n$Entities\n0 0 0 2\n1 0 0 0 1 1 1 2 1 3 0\n2 0 0 0 1 1 1 2 2 3 0\n$EndEntities\n\
                        $Nodes\n1 5 1 5\n3 1 0 5\n1\n2\n3\n4\n5\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n$EndNodes\n\
                        $Elements\n2 2 1 2\n3 1 4 1\n1 1 2 3 4\n3 2 4 1\n2 2 3 4 5\n$EndElements\n";

const SETS: &str = "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n5,1,1,1\n*ELEMENT, TYPE=C3D4, ELSET=kidney\n1,1,2,3,4\n2,2,3,4,5\n\
                    *ELSET, ELSET=cortex\n1\n*ELSET, ELSET=medulla\n2\n*SOLID SECTION, ELSET=cortex, MATERIAL=A\n\
                    *SOLID SECTION, ELSET=medulla, MATERIAL=B\n";

#[test]
fn a_cell_may_be_in_several_groups() {
    let dir = tempfile::tempdir().unwrap();
    for (name, text) in [("a.msh", twice("3")), ("b.msh", ENTITIES.into()), ("c.inp", SETS.into())] {
        let mesh = read(&text, name).unwrap();
        assert_eq!(
            (mesh.cell_count(), mesh.region_names()),
            (2, &["cortex".into(), "medulla".into()][..]),
            "{name}"
        );
        let groups: Vec<(&str, &[u32])> = mesh.cell_groups().collect();
        assert_eq!(groups, [("kidney", &[0, 1][..])], "{name}");
        assert!(mesh.is_in(0, "cortex") && !mesh.is_in(1, "cortex") && mesh.is_in(1, "kidney"));
        // Written and read again, in every format and with other cell kinds.
        for (file, format) in [
            ("2.msh", Format::Gmsh(GmshVersion::Two)),
            ("4.msh", Format::Gmsh(GmshVersion::FourOne)),
            ("a.inp", Format::Abaqus),
            ("a.vtu", Format::Vtu),
        ] {
            let file = dir.path().join(file);
            files::write_as(&mesh, &file, 1.0, format).unwrap();
            assert!(files::read(&file, 1.0).unwrap() == mesh, "{name}: {}", file.display());
        }
        assert!(raise_order(&mesh).is_in(1, "kidney") && to_tets(&raise_order(&mesh)).is_in(1, "kidney"));
    }
    // A cell that occurs twice in one group is an error.
    let bad = read(&twice("2"), "a.msh").unwrap_err();
    assert!(bad.contains("element 4 has the same nodes as element 3"), "{bad}");
}

/// A deck with its own model: every part that is not in the mesh is reported with its line, first the cards
/// that join parts.
#[test]
fn what_a_deck_has_beside_its_mesh_is_named() {
    let deck = format!(
        "*HEADING\na model\n{SETS}*MATERIAL, NAME=A\n*ELASTIC\n1., .3\n*TIE, NAME=T\nA, B\n*STEP, NLGEOM\n*STATIC\n.1, 1.\n*BOUNDARY\n\
         1, 1, 3\n*NODE FILE\nU\n*END STEP\n"
    );
    let found = left_out(&deck, "a.inp");
    let of = |kind| {
        found.iter().filter(|part| part.kind == kind).map(|part| part.what.as_str()).collect::<Vec<_>>()
    };
    assert_eq!(of(Kind::Joins), ["*TIE, NAME=T"]);
    assert_eq!(of(Kind::Model), ["*MATERIAL, NAME=A", "*ELASTIC", "*STEP", "*STATIC", "*BOUNDARY"]);
    assert_eq!(files::summary(&found)[0], "*TIE, NAME=T (line 21)");
    assert_eq!(left_out(SETS, "a.inp"), []);
    for joint in ["*EQUATION\n2\n1,1,1.,2,1,-1.\n", "*MPC\nTIE, 1, 2\n", "*RIGID BODY, NSET=N, REF NODE=1\n"]
    {
        assert!(
            left_out(&format!("{SETS}{joint}"), "a.inp").iter().any(|part| part.kind == Kind::Joins),
            "{joint}"
        );
    }
}

const GRID: &str = "# vtk DataFile Version 3.0\ntwo cells\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n\
                    0 0 0 1 0 0 0 1 0 0 0 1 1 1 1\nCELLS 2 10\n4 0 1 2 3\n4 1 2 3 4\nCELL_TYPES 2\n10\n10\n";

#[test]
fn arrays_that_are_not_taken_are_named() {
    let with = |name: &str, values: &str| {
        format!("{GRID}CELL_DATA 2\nSCALARS {name} int 1\nLOOKUP_TABLE default\n{values}\n")
    };
    let mesh = read(&with("MaterialID", "1 2"), "a.vtk").unwrap();
    assert_eq!(mesh.region_names(), ["region-1", "region-2"]);
    assert_eq!(left_out(&with("MaterialID", "1 2"), "a.vtk"), []);
    let found = left_out(&with("tissue", "1 2"), "a.vtk");
    assert_eq!(files::summary(&found), ["array 'tissue' of cells, 1 to 2 (line 14)"]);
    assert_eq!(found[0].kind, Kind::Regions);
    // A constant number on all cells is not a region, and neither are numbers of points.
    assert_eq!(left_out(&with("tissue", "1 1"), "a.vtk")[0].kind, Kind::Values);
    let points = format!("{GRID}POINT_DATA 5\nVECTORS u double\n{}\n", "0 0 0 ".repeat(5));
    assert_eq!(files::summary(&left_out(&points, "a.vtk")), ["array 'u' of points (line 14)"]);
}

fn block(kind: CellKind) -> Mesh {
    let corner = geometry::Point3::new(2.0, 1.0, 1.0);
    generate::box_mesh(kind, geometry::Point3::origin(), corner, [2, 1, 1], [1.0; 3], None).unwrap()
}

fn vtk(mesh: &Mesh, kind: u8, order: impl Fn(&[u32]) -> Vec<u32>) -> String {
    let points: String = mesh.points().iter().map(|p| format!("{} {} {}\n", p.x, p.y, p.z)).collect();
    let cell = |cell| {
        let nodes: Vec<String> = order(mesh.cell(cell)).iter().map(u32::to_string).collect();
        format!("{} {}\n", nodes.len(), nodes.join(" "))
    };
    let cells: String = (0..mesh.cell_count()).map(cell).collect();
    let count = mesh.cell_count();
    let each = mesh.cell(0).len() + 1;
    let types = format!("{kind}\n").repeat(count);
    format!(
        "# vtk DataFile Version 3.0\nmiddles\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {} double\n{points}CELLS {count} {}\n{cells}\
         CELL_TYPES {count}\n{types}",
        mesh.points().len(),
        count * each
    )
}

#[test]
fn middle_nodes_in_another_order_are_put_in_their_places() {
    for (kind, number, swaps) in
        [(CellKind::Tet10, 24, vec![(8, 9)]), (CellKind::Hex20, 25, vec![(12, 16), (13, 17), (9, 11)])]
    {
        let mesh = block(kind);
        let plain = vtk(&mesh, number, <[u32]>::to_vec);
        let same = |text: &str| {
            let read = read(text, "a.vtk").unwrap();
            (0..mesh.cell_count()).all(|cell| read.cell(cell) == mesh.cell(cell))
        };
        assert!(same(&plain) && left_out(&plain, "a.vtk").is_empty());
        let other = vtk(&mesh, number, |nodes| {
            let mut nodes = nodes.to_vec();
            swaps.iter().for_each(|&(a, b)| nodes.swap(a, b));
            nodes
        });
        assert!(same(&other), "{kind:?}");
        let found = left_out(&other, "a.vtk");
        assert_eq!(found[0].kind, Kind::Changed);
        let count = mesh.cell_count();
        assert!(
            found[0].what.contains(&format!("mid-edge nodes of {count} {}", kind.name())),
            "{}",
            found[0]
        );
    }
}

#[test]
fn a_mirrored_mesh_is_turned() {
    for kind in CellKind::ALL {
        let mesh = block(kind);
        let mirrored = mesh.moved(|p| geometry::Point3::new(-p.x, p.y, p.z)).unwrap();
        let facets = mirrored
            .boundary()
            .into_iter()
            .filter(|&f| mirrored.facet_nodes(f).all(|n| mirrored.points()[n as usize].x == 0.0));
        let mirrored =
            mirrored.clone().with_group("end", facets.collect()).unwrap().with_cell_group("all", vec![0, 1]);
        let bad = quality::check(&mirrored).unwrap_err();
        assert_eq!(bad.inverted, bad.cells);
        let right = turned(&mirrored);
        assert!((quality::check(&right).unwrap().volume - 2.0).abs() < 1e-12, "{kind:?}");
        let end = right.group("end").unwrap();
        assert!(
            !end.is_empty()
                && end.iter().all(|&f| right.facet_nodes(f).all(|n| right.points()[n as usize].x == 0.0))
        );
        assert!(right.is_in(1, "all") && turned(&right) == mirrored);
    }
}
