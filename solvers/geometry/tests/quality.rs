//! Quality measures of shapes with known values, and the index of the worst element.

use tissuebench_geometry::generate::{box_mesh, raise_order};
use tissuebench_geometry::{CellKind, Mesh, Point3, quality};

fn regular_tetrahedron() -> Vec<Point3> {
    [[1., 1., 1.], [1., -1., -1.], [-1., 1., -1.], [-1., -1., 1.]].into_iter().map(Point3::from).collect()
}

fn cube(kind: CellKind, cells: usize) -> Mesh {
    box_mesh(kind, Point3::origin(), Point3::new(2.0, 2.0, 2.0), [cells; 3], [1.0; 3], None).unwrap()
}

#[test]
fn regular_shapes_have_the_textbook_values() {
    let tet = Mesh::new(regular_tetrahedron(), &[(CellKind::Tet4, vec![0, 2, 1, 3])]).unwrap();
    for mesh in [tet.clone(), raise_order(&tet)] {
        let q = quality::check(&mesh).unwrap();
        assert!((q.volume - 8.0 / 3.0).abs() < 1e-14, "{q:?}");
        assert!((q.min_det_j.value - 16.0).abs() < 1e-13);
        assert!((q.max_aspect.value - 1.0).abs() < 1e-14);
        let dihedral = (1.0f64 / 3.0).acos().to_degrees();
        assert!(
            (q.min_dihedral.value - dihedral).abs() < 1e-10
                && (q.max_dihedral.value - dihedral).abs() < 1e-10
        );
    }
    for kind in [CellKind::Hex8, CellKind::Hex20] {
        let q = quality::check(&cube(kind, 2)).unwrap();
        assert!((q.volume - 8.0).abs() < 1e-13 && (q.min_volume.value - 1.0).abs() < 1e-14);
        assert!((q.min_det_j.value - 0.125).abs() < 1e-15 && (q.min_det_ratio.value - 1.0).abs() < 1e-13);
        assert!((q.max_aspect.value - 1.0).abs() < 1e-14);
        assert!((q.min_dihedral.value - 90.0).abs() < 1e-10 && (q.max_dihedral.value - 90.0).abs() < 1e-10);
    }
    // Kuhn tetrahedra have angles of 45, 60 and 90 degrees.
    let q = quality::check(&cube(CellKind::Tet4, 2)).unwrap();
    assert!((q.min_dihedral.value - 45.0).abs() < 1e-10 && (q.max_dihedral.value - 90.0).abs() < 1e-10);
    assert_eq!(quality::volumes(&cube(CellKind::Tet10, 1)).len(), 6);
}

#[test]
fn the_worst_element_is_named() {
    for kind in CellKind::ALL {
        let mesh = cube(kind, 3);
        let bad = 11;
        // The mirrored order makes the volume of a cell negative.
        let cells: Vec<(CellKind, Vec<u32>)> = (0..mesh.cell_count())
            .map(|c| {
                let nodes = mesh.cell(c).to_vec();
                let mirrored = || kind.mirrored().iter().map(|&node| nodes[node]).collect();
                (kind, if c == bad { mirrored() } else { nodes })
            })
            .collect();
        let spoiled = Mesh::new(mesh.points().to_vec(), &cells).unwrap();
        let error = quality::check(&spoiled).unwrap_err();
        assert_eq!(quality::check_inversion(&spoiled), Err(error), "{}", kind.name());
        assert_eq!(quality::check_inversion(&mesh), Ok(()), "{}", kind.name());
        assert_eq!(error.element, bad, "{}", kind.name());
        assert_eq!((error.inverted, error.cells), (1, mesh.cell_count()));
        assert!(error.det_j <= 0.0 && error.to_string().contains("element 11 is inverted"));
    }
    // After one node is displaced, the slimmest and the smallest cell contain it.
    let mesh = cube(CellKind::Hex8, 3);
    let node = 21u32;
    let target = mesh.points()[node as usize];
    let moved =
        mesh.moved(|p| if *p == target { p + nalgebra::Vector3::new(0.3, 0.2, 0.1) } else { *p }).unwrap();
    let q = quality::check(&moved).unwrap();
    for extreme in [q.min_volume, q.min_det_j, q.min_det_ratio, q.min_dihedral, q.max_dihedral, q.max_aspect]
    {
        assert!(moved.cell(extreme.element).contains(&node), "{extreme:?}");
    }
    assert!((q.volume - 8.0).abs() < 1e-12, "moving an inner node keeps the total");
    assert!((quality::volumes(&moved).iter().sum::<f64>() - q.volume).abs() < 1e-12);
}

#[test]
fn a_flat_cell_counts_as_inverted() {
    let points = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0.3, 0.3, 1e-17]].into_iter().map(Point3::from);
    let flat = Mesh::new(points.collect(), &[(CellKind::Tet4, vec![0, 1, 2, 3])]).unwrap();
    assert_eq!(quality::check(&flat).unwrap_err().element, 0);
}
