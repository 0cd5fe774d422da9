//! Wedges in mesh files: the orders of nodes of each format, both orders of VTK files, hexahedra and wedges
//! in one body.

use std::path::{Path, PathBuf};

use geometry::generate::{box_mesh, converted, is_convertible, raise_order};
use geometry::{CellKind, Mesh, Point3, quality};
use tissuebench_mesh_files as files;

/// A file written by `make.py`.
fn made(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files").join(name)
}

fn counts(mesh: &Mesh) -> Vec<(CellKind, usize)> {
    let count = |kind| (0..mesh.cell_count()).filter(|&cell| mesh.kind(cell) == kind).count();
    CellKind::ALL.map(|kind| (kind, count(kind))).into_iter().filter(|(_, count)| *count > 0).collect()
}

/// A .vtk file of one wedge, with its points in the order of the corners and mid-edges of `kind`.
fn vtk(kind: CellKind, order: &[usize]) -> String {
    let nodes = kind.entry().nodes;
    let points: String = nodes.iter().map(|[x, y, z]| format!("{x} {y} {z}\n")).collect();
    let list: Vec<String> = order.iter().map(usize::to_string).collect();
    let n = nodes.len();
    let list = list.join(" ");
    let number = kind.entry().files.vtk;
    format!(
        "# vtk DataFile Version 3.0\nwedge\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {n} double\n{points}CELLS 1 {}\n\
         {n} {list}\nCELL_TYPES 1\n{number}\n",
        n + 1
    )
}

/// VTK's documentation lets the normal of the first triangle of a wedge point away from the second. Gmsh and
/// others write the mirror image, as the numbering of VTK's quadratic wedge also is.
#[test]
fn wedges_of_either_order_are_read_from_vtk_files() {
    for kind in [CellKind::Wedge6, CellKind::Wedge15] {
        let own: Vec<usize> = (0..kind.node_count()).collect();
        for order in [own, kind.mirrored()] {
            let text = vtk(kind, &order);
            let (mesh, _) = files::read_bytes(text.as_bytes(), Path::new("wedge.vtk"), 1.0).unwrap();
            assert!((quality::check(&mesh).unwrap().volume - 1.0).abs() < 1e-14, "{kind:?} {order:?}");
        }
    }
}

#[test]
fn a_linear_wedge_is_written_as_vtk_describes_it() {
    let mesh =
        box_mesh(CellKind::Wedge6, Point3::origin(), Point3::new(1.0, 1.0, 1.0), [1; 3], [1.0; 3], None);
    let mesh = mesh.unwrap();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.vtu");
    files::write(&mesh, &file, 1.0).unwrap();
    assert_eq!(files::read(&file, 1.0).unwrap(), mesh);
    let order = CellKind::Wedge6.entry().files.vtk_order;
    let [a, b, c, d] = [0, 1, 2, 3].map(|k| mesh.points()[mesh.cell(0)[order[k]] as usize]);
    assert!((b - a).cross(&(c - a)).dot(&(d - a)) < 0.0);
}

/// Hexahedra on the left and wedges on the right, which share four quadrilaterals.
#[test]
fn hexahedra_and_wedges_of_a_file_are_one_body() {
    for (name, kinds) in [
        ("mixed1", [(CellKind::Hex8, 8), (CellKind::Wedge6, 16)]),
        ("mixed2", [(CellKind::Hex20, 8), (CellKind::Wedge15, 16)]),
    ] {
        let formats = [
            "2.2-text.msh",
            "4.1-binary.msh",
            "gmsh.inp",
            "meshio.inp",
            "meshio-zlib.vtu",
            "vtk-5.1-binary.vtk",
        ];
        for format in formats {
            let file = made(&format!("{name}-{format}"));
            let mesh = files::read(&file, 1.0).unwrap_or_else(|bad| panic!("{bad}"));
            assert_eq!((mesh.uniform_kind(), counts(&mesh)), (None, kinds.to_vec()), "{}", file.display());
            assert!((quality::check(&mesh).unwrap().volume - 2.0).abs() < 1e-12, "{}", file.display());
            // Nothing is open between the two boxes: ten sides of four quadrilaterals, of which two are of
            // eight triangles.
            assert_eq!(mesh.boundary().len(), 8 * 4 + 2 * 8, "{}", file.display());
            // Written and read again, it is the same in every format.
            let folder = tempfile::tempdir().unwrap();
            for name in ["a.msh", "a.inp", "a.vtu"] {
                let copy = folder.path().join(name);
                files::write(&mesh, &copy, 1.0).unwrap();
                let back = files::read(&copy, 1.0).unwrap();
                assert_eq!((counts(&back), back.points()), (counts(&mesh), mesh.points()), "{name}");
            }
        }
    }
}

#[test]
fn the_order_of_mixed_cells_is_raised_and_they_become_tetrahedra() {
    let linear = files::read(&made("mixed1-2.2-text.msh"), 1.0).unwrap();
    let quadratic = raise_order(&linear);
    assert_eq!(counts(&quadratic), [(CellKind::Hex20, 8), (CellKind::Wedge15, 16)]);
    assert_eq!(quadratic.boundary().len(), linear.boundary().len());
    for kind in [CellKind::Tet4, CellKind::Tet10] {
        let tets = converted(linear.clone(), kind).unwrap();
        assert_eq!(tets.cell_count(), 8 * 6 + 16 * 3);
        assert!((quality::check(&tets).unwrap().volume - 2.0).abs() < 1e-12);
        assert_eq!(tets.boundary().len(), 10 * 8, "open between the tetrahedra");
    }
    assert!(!is_convertible(&linear, CellKind::Hex8) && !is_convertible(&linear, CellKind::Wedge6));
}

/// Three hexahedra around an edge, each with other local axes. The first is cut along the edge; the others,
/// whose row around the edge does not cross it, are cut along this row.
#[test]
fn hexahedra_around_an_edge_become_wedges() {
    let at = |k: usize, z: f64| {
        let angle = std::f64::consts::TAU * k as f64 / 6.0;
        Point3::new(angle.cos(), angle.sin(), z)
    };
    let mut points: Vec<Point3> = (0..6).map(|k| at(k, 0.0)).chain((0..6).map(|k| at(k, 1.0))).collect();
    points.extend([Point3::origin(), Point3::new(0.0, 0.0, 1.0)]);
    // Local z is along the edge in one cell only.
    let hex = |k: u32| {
        let [a, b, c] = [2 * k, (2 * k + 1) % 6, (2 * k + 2) % 6];
        match k {
            0 => vec![a, b, c, 12, a + 6, b + 6, c + 6, 13],
            1 => vec![a, 12, 13, a + 6, b, c, c + 6, b + 6],
            _ => vec![12, 13, a + 6, a, c, c + 6, b + 6, b],
        }
    };
    let cells: Vec<(CellKind, Vec<u32>)> = (0..3).map(|k| (CellKind::Hex8, hex(k))).collect();
    let mesh = Mesh::new(points, &cells).unwrap();
    let volume = quality::check(&mesh).unwrap().volume;
    let wedges = converted(mesh, CellKind::Wedge6).unwrap();
    assert_eq!(wedges.cell_count(), 6);
    assert!((quality::check(&wedges).unwrap().volume - volume).abs() < 1e-14);
    assert_eq!(wedges.boundary().len(), (2 + 2 * 2) + (2 * 3 + 2 * 2));
}
