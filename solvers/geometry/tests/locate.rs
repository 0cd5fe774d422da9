//! Point location: barycentric coordinates reproduce a point inside the mesh, and the closest point for one
//! outside.

use tissuebench_geometry::generate::{Jitter, box_mesh, kidney_mesh};
use tissuebench_geometry::shapes::{Kidney, Shape};
use tissuebench_geometry::{
    CellKind, LocateError, Location, Mesh, Point3, Vector3, closest_on_triangle, locate,
};

fn unit_cube(kind: CellKind) -> Mesh {
    let jitter = Some(Jitter { fraction: 0.2, seed: 2 });
    box_mesh(kind, Point3::origin(), Point3::new(1.0, 1.0, 1.0), [4; 3], [1.0; 3], jitter).unwrap()
}

fn position(mesh: &Mesh, at: &Location) -> Point3 {
    let corners = mesh.cell_points(at.cell as usize).take(4);
    Point3::from(corners.zip(at.barycentric).map(|(p, l)| p.coords * l).sum::<Vector3>())
}

#[test]
fn inside_outside_and_on_the_border() {
    for kind in [CellKind::Tet4, CellKind::Tet10] {
        let mesh = unit_cube(kind);
        let grid: Vec<Point3> = (0..1000)
            .map(|i| {
                Point3::new((i % 10) as f64, (i / 10 % 10) as f64, (i / 100) as f64) * 0.2
                    - Vector3::repeat(0.4)
            })
            .collect();
        for (p, at) in grid.iter().zip(locate(&mesh, &grid).unwrap()) {
            let clamped = Point3::from(p.coords.map(|c| c.clamp(0.0, 1.0)));
            let distance = (p - clamped).norm();
            assert!((at.outside - distance).abs() < 1e-12, "{p}: {} for {distance}", at.outside);
            assert!((position(&mesh, &at) - clamped).norm() < 1e-12, "{p}");
            assert!((at.barycentric.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            assert!(at.barycentric.iter().all(|&l| l > -1e-9));
        }
        // Every node is in the mesh, in a cell that contains it.
        let nodes = &mesh.points()[..125];
        for (n, at) in locate(&mesh, nodes).unwrap().iter().enumerate() {
            assert_eq!(at.outside, 0.0);
            assert!((position(&mesh, at) - nodes[n]).norm() < 1e-14);
        }
    }
}

/// Points on shared faces are in the mesh, although rounding may put them outside both cells.
#[test]
fn nothing_falls_between_cells() {
    let mesh = kidney_mesh(CellKind::Tet4, 5).unwrap();
    let shares = [[0.2, 0.3, 0.5], [0.71, 0.18, 0.11], [0.5, 0.5, 0.0]];
    let mut points = Vec::new();
    for cell in 0..mesh.cell_count() {
        let at: Vec<Point3> = mesh.cell_points(cell).copied().collect();
        for face in CellKind::Tet4.faces() {
            for s in shares {
                points.push(Point3::from((0..3).map(|i| at[face[i]].coords * s[i]).sum::<Vector3>()));
            }
        }
    }
    for (p, at) in points.iter().zip(locate(&mesh, &points).unwrap()) {
        assert_eq!(at.outside, 0.0, "{p}");
    }
}

#[test]
fn the_lowest_cell_wins_and_curved_bodies_are_covered() {
    let mesh = unit_cube(CellKind::Tet4);
    let node = 62; // a node in the middle
    let lowest = (0..mesh.cell_count()).find(|&c| mesh.cell(c).contains(&node)).unwrap();
    assert_eq!(locate(&mesh, &[mesh.points()[62]]).unwrap()[0].cell as usize, lowest);

    let kidney = kidney_mesh(CellKind::Tet4, 6).unwrap();
    let centres: Vec<Point3> = (0..kidney.cell_count())
        .map(|c| Point3::from(kidney.cell_points(c).map(|p| p.coords).sum::<Vector3>() / 4.0))
        .collect();
    for (cell, at) in locate(&kidney, &centres).unwrap().iter().enumerate() {
        assert_eq!((at.cell as usize, at.outside), (cell, 0.0));
    }
    // Points of the exact surface lie outside the flat facets, by the sagitta.
    let mut state = 1u64;
    let mut unit = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let surface: Vec<Point3> = (0..200).map(|_| Kidney.surface_sample(&mut unit)).collect();
    let far = locate(&kidney, &surface).unwrap().iter().map(|l| l.outside).fold(0.0, f64::max);
    assert!(far > 1e-5 && far < 2e-3, "{far} m");
}

#[test]
fn what_cannot_be_located_is_named() {
    let mesh = unit_cube(CellKind::Hex8);
    let error = locate(&mesh, &[]).unwrap_err();
    assert_eq!(error, LocateError::NotTetrahedron { cell: 0, kind: CellKind::Hex8 });
    assert!(error.to_string().contains("cell 0 is a hex8"));
    let bad = [Point3::origin(), Point3::new(0.0, f64::INFINITY, 0.0)];
    assert_eq!(locate(&unit_cube(CellKind::Tet4), &bad), Err(LocateError::NotFinite { point: 1 }));
    let points = vec![[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [1., 1., 0.]];
    let points = points.into_iter().map(Point3::from).collect();
    let flat = Mesh::new(points, &[(CellKind::Tet4, vec![0, 1, 2, 3])]).unwrap();
    assert_eq!(locate(&flat, &[]), Err(LocateError::Flat { cell: 0, det_j: 0.0 }));
}

#[test]
fn the_closest_point_of_a_triangle_is_closest() {
    let corners = [Point3::new(0.0, 0.0, 0.0), Point3::new(1.0, 0.2, 0.1), Point3::new(0.3, 0.9, -0.2)];
    let [a, b, c] = corners;
    for i in 0..200 {
        let t = i as f64;
        let x = Point3::new((3.1 * t).sin(), (7.7 * t).cos(), (1.3 * t).sin()) * 2.0;
        let found = (closest_on_triangle(&x, &corners) - x).norm();
        // No point of a fine grid on the triangle is closer, and one is about as close.
        let n = 60;
        let grid = (0..=n).flat_map(|i| (0..=n - i).map(move |j| (i, j)));
        let best = grid
            .map(|(i, j)| a + (b - a) * (i as f64 / n as f64) + (c - a) * (j as f64 / n as f64))
            .map(|p| (p - x).norm())
            .fold(f64::INFINITY, f64::min);
        assert!(found <= best + 1e-12 && found > best - 0.02, "{i}: {found} {best}");
    }
}
