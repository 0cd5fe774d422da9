//! Supports adapted to the cloud: an affine map of body and cloud leaves shape values unchanged.

mod common;

use common::{jittered_box, members};
use geometry::generate::box_mesh;
use geometry::{CellKind, Mesh};
use nalgebra::Matrix3;
use shape::{Point3, Vector3};
use tissuebench_efg::{Approximation, Basis, CubicSpline, EfgError, Kernel, Support};

/// Both rules, with supports of about the same width.
const RULES: [Support; 2] =
    [Support::Dilatation { factor: 2.2 }, Support::Neighbours { count: 24, factor: 1.5 }];

fn adapted(mesh: &Mesh, rule: Support, kernel: Kernel, basis: Basis) -> Approximation {
    Approximation::stretched(mesh.points().to_vec(), rule.ellipsoids(mesh).unwrap(), kernel, basis).unwrap()
}

fn mapped(mesh: &Mesh, map: &Matrix3<f64>) -> Mesh {
    mesh.moved(|p| Point3::from(map * p.coords)).unwrap()
}

/// Centroids of the cells, and the nodes.
fn probes(mesh: &Mesh) -> Vec<Point3> {
    let centroid = |cell| Point3::from(mesh.cell_points(cell).map(|p| p.coords).sum::<Vector3>() / 4.0);
    (0..mesh.cell_count()).map(centroid).chain(mesh.points().iter().copied()).collect()
}

#[test]
fn an_affine_map_of_body_and_cloud_leaves_the_shape_values_alone() {
    let mesh = jittered_box(CellKind::Tet4, 4);
    // Cells with an aspect of 10:1 along an axis, of 100:1, and sheared and rotated cells.
    let maps = [
        Matrix3::from_diagonal(&Vector3::new(10.0, 1.0, 1.0)),
        Matrix3::from_diagonal(&Vector3::new(1.0, 0.01, 1.0)),
        Matrix3::new(1.0, 8.0, -3.0, 0.0, 2.0, 0.5, 0.4, 0.0, 0.2),
    ];
    for (kernel, basis) in members() {
        for rule in RULES {
            let (here, info) = adapted(&mesh, rule, kernel, basis).grad_rows(&probes(&mesh)).unwrap();
            assert_eq!(info.fallbacks(), 0, "{} {}", kernel.name(), basis.name());
            for map in &maps {
                let there = mapped(&mesh, map);
                let (stretched, info) =
                    adapted(&there, rule, kernel, basis).grad_rows(&probes(&there)).unwrap();
                let label = format!("{} {} {rule:?} {map}", kernel.name(), basis.name());
                assert_eq!(info.fallbacks(), 0, "{label}");
                // Rounding of the moments, whose condition number flat cells square (quadratic basis: once
                // more).
                let tolerance = 1e-15 * info.condition_max.max(1e3);
                let back = map.transpose();
                let mut at_rim = 0;
                for q in 0..here.points().len() {
                    let ((nodes, values), (same, others)) = (here.rows().row(q), stretched.rows().row(q));
                    // By rounding, a node at the boundary of its support may drop out; its value is then as
                    // small as the tolerance.
                    let other = |node: &u32| same.binary_search(node).map_or(0.0, |k| others[k]);
                    for (node, value) in nodes.iter().zip(values) {
                        let off = (value - other(node)).abs();
                        assert!(off < tolerance, "{label}: {off:e} of {tolerance:e} at point {q}");
                    }
                    // The Gaussian's slope jumps there.
                    if nodes != same {
                        at_rim += 1;
                        continue;
                    }
                    for (grad, turned) in here.row(q).1.iter().zip(stretched.row(q).1) {
                        let off = (back * turned - grad).norm() * 0.0075;
                        assert!(off < 100.0 * tolerance, "{label}: gradient {off:e} at point {q}");
                    }
                }
                assert!(at_rim < here.points().len() / 20, "{label}: {at_rim}");
            }
        }
    }
}

#[test]
fn isotropic_cells_have_the_round_support() {
    // The edges of a regular tetrahedron have an isotropic moment, and so does any mesh of such cells.
    let corners = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
    let points = corners.map(|c| Point3::from(Vector3::from(c) * 1e-3)).to_vec();
    let mesh = Mesh::new(points, &[(CellKind::Tet4, vec![0, 1, 2, 3])]).unwrap();
    for factor in [1.2, 2.0] {
        let rule = Support::Dilatation { factor };
        for ellipsoid in rule.ellipsoids(&mesh).unwrap() {
            assert!((ellipsoid.radius() / (factor * 8f64.sqrt() * 1e-3) - 1.0).abs() < 1e-8);
        }
    }
}

#[test]
fn supports_of_flat_cells_hold_as_many_neighbours_as_those_of_cubes() {
    // Forty layers of 2 x 2 cells, with an aspect of 20:1. The neighbours within a ball lie in planes.
    let max = Point3::new(0.05, 0.05, 0.05);
    let box_of = |cells| box_mesh(CellKind::Tet4, Point3::origin(), max, cells, [1.0; 3], None).unwrap();
    let (flat, long) = (box_of([40, 2, 2]), box_of([4, 4, 4]));
    for rule in RULES {
        let neighbours = |mesh: &Mesh| {
            let (_, info) = adapted(mesh, rule, Kernel::CubicSpline(CubicSpline), Basis::Linear)
                .point_rows(&probes(mesh))
                .unwrap();
            assert_eq!(info.fallbacks(), 0);
            (info.neighbours_min, info.neighbours_max)
        };
        let ((few, most), (least, many)) = (neighbours(&flat), neighbours(&long));
        assert!(few >= least / 2 && most <= 2 * many, "{few} to {most}, of cubes {least} to {many}");
    }
}

#[test]
fn flat_cells_and_lone_nodes_are_refused() {
    let points = vec![
        Point3::origin(),
        Point3::new(1.0, 0.0, 0.0),
        Point3::new(0.0, 1.0, 0.0),
        Point3::new(0.4, 0.3, 1e-9),
        Point3::new(0.0, 0.0, 1.0),
    ];
    let rule = Support::Dilatation { factor: 2.0 };
    let flat = Mesh::new(points.clone(), &[(CellKind::Tet4, vec![0, 1, 2, 3])]).unwrap();
    assert_eq!(rule.ellipsoids(&flat), Err(EfgError::FlatCells { node: 0 }));
    let lone = Mesh::new(points, &[(CellKind::Tet4, vec![0, 1, 2, 4])]).unwrap();
    assert_eq!(rule.ellipsoids(&lone), Err(EfgError::FlatCells { node: 3 }));
}
