//! Every generator with every cell kind: closed volumes, outward faces, named groups, curved nodes on the
//! surface.

use std::f64::consts::PI;

use tissuebench_geometry::generate::{
    Drawn, GenerateError, Jitter, ShellExtent, ball_mesh, box_mesh, cylinder_mesh, half_kidney_mesh,
    kidney_mesh, raise_order, sphere_shell_mesh, tets_on_nodes, to_tets,
};
use tissuebench_geometry::shapes::{Kidney, Shape};
use tissuebench_geometry::{CellKind, Facet, Mesh, Point3, Vector3, quality};

fn unit_box(kind: CellKind, cells: [usize; 3], jitter: Option<Jitter>) -> Mesh {
    let min = Point3::new(-0.1, 0.2, 0.3);
    let max = Point3::new(0.9, 0.7, 0.6);
    box_mesh(kind, min, max, cells, [1.0; 3], jitter).unwrap()
}

/// Small meshes of every generator, with the exact volume last.
fn bodies(kind: CellKind) -> Vec<(&'static str, Mesh, f64)> {
    let shell = |extent| sphere_shell_mesh(kind, 0.5, 1.0, [3, 2], 2.0, extent).unwrap();
    let shell_volume = 4.0 / 3.0 * PI * (1.0 - 0.125);
    vec![
        ("box", unit_box(kind, [3, 2, 2], Some(Jitter { fraction: 0.2, seed: 3 })), 0.15),
        ("ball", ball_mesh(kind, 2.0, 4).unwrap(), 4.0 / 3.0 * PI * 8.0),
        ("ball, odd", ball_mesh(kind, 2.0, 3).unwrap(), 4.0 / 3.0 * PI * 8.0),
        ("cylinder", cylinder_mesh(kind, 0.5, 1.0, [4, 6], 1.5).unwrap(), PI * 0.25),
        ("shell", shell(ShellExtent::Whole), shell_volume),
        ("octant", shell(ShellExtent::Octant), shell_volume / 8.0),
        ("kidney", kidney_mesh(kind, 4).unwrap(), 4.0 / 3.0 * PI * 1e-5),
        ("half kidney", half_kidney_mesh(kind, 2, Drawn::Strongly).unwrap(), 2.0 / 3.0 * PI * 1e-5),
        ("half kidney, odd", half_kidney_mesh(kind, 3, Drawn::Strongly).unwrap(), 2.0 / 3.0 * PI * 1e-5),
        ("half kidney, mildly", half_kidney_mesh(kind, 2, Drawn::Mildly).unwrap(), 2.0 / 3.0 * PI * 1e-5),
    ]
}

/// Area vector of the corner polygon of a facet.
fn area_vector(mesh: &Mesh, facet: Facet) -> Vector3 {
    let corners: Vec<Point3> = mesh.facet_corners(facet).map(|n| mesh.points()[n as usize]).collect();
    (2..corners.len()).map(|i| 0.5 * (corners[i - 1] - corners[0]).cross(&(corners[i] - corners[0]))).sum()
}

#[test]
fn volumes_are_right_and_converge_with_the_order_of_the_cells() {
    for kind in CellKind::ALL {
        for (name, mesh, volume) in bodies(kind) {
            let quality = quality::check(&mesh).unwrap_or_else(|e| panic!("{name} {}: {e}", kind.name()));
            let error = (quality.volume / volume - 1.0).abs();
            // At this size, facets inscribed in a sphere lose up to a quarter of the volume, and parabolas 2
            // %.
            let most = if name == "box" {
                1e-13
            } else if kind.order() == 1 {
                0.25
            } else {
                0.02
            };
            assert!(error < most, "{name} {}: volume error {error}", kind.name());
            assert_eq!(mesh.uniform_kind(), Some(kind));
            // Cells graded towards a jaw are intentionally flat: 3.07 and 2.13 degrees for n = 2 and 3.
            let flattest = if name.starts_with("half kidney") { 2.0 } else { 5.0 };
            assert!(quality.min_dihedral.value > flattest, "{name} {}: {quality:?}", kind.name());
        }
        let orders = |mesh: &dyn Fn(usize) -> Mesh, exact: f64| {
            let error = |n| 1.0 - quality::check(&mesh(n)).unwrap().volume / exact;
            (error(4) / error(8)).abs().log2()
        };
        let expected = if kind.order() == 1 { 1.9 } else { 3.5 };
        let ball = orders(&|n| ball_mesh(kind, 1.0, n).unwrap(), 4.0 / 3.0 * PI);
        assert!(ball > expected, "ball {}: order {ball}", kind.name());
        let cylinder = orders(&|n| cylinder_mesh(kind, 1.0, 1.0, [n, 1], 1.0).unwrap(), PI);
        assert!(cylinder > expected, "cylinder {}: order {cylinder}", kind.name());
        let kidney = orders(&|n| kidney_mesh(kind, n).unwrap(), 4.0 / 3.0 * PI * 1e-5);
        assert!(kidney > expected, "kidney {}: order {kidney}", kind.name());
    }
}

#[test]
fn boundaries_are_closed_and_point_outwards() {
    for kind in CellKind::ALL {
        for (name, mesh, _) in bodies(kind) {
            let boundary = mesh.boundary();
            let total: Vector3 = boundary.iter().map(|&f| area_vector(&mesh, f)).sum();
            assert!(total.norm() < 1e-12, "{name} {}: open by {total}", kind.name());
            // Divergence theorem: the flux of x/3 is the volume, which is positive only if the faces point
            // outwards.
            let flux: f64 = (boundary.iter())
                .map(|&f| {
                    let n = mesh.facet_nodes(f).next().unwrap();
                    mesh.points()[n as usize].coords.dot(&area_vector(&mesh, f)) / 3.0
                })
                .sum();
            assert!(flux > 0.0, "{name} {}", kind.name());
            // Every boundary facet is in a group, and groups contain only boundary facets.
            let mut grouped: Vec<Facet> =
                mesh.group_names().flat_map(|g| mesh.group(g).unwrap().to_vec()).collect();
            grouped.sort_unstable();
            assert_eq!(grouped, boundary, "{name} {}", kind.name());
            // In a conforming mesh the interior faces match in pairs, so their number is even.
            let faces: usize = (0..mesh.cell_count()).map(|c| mesh.kind(c).faces().len()).sum();
            assert_eq!((faces - boundary.len()) % 2, 0);
        }
    }
}

#[test]
fn box_groups_lie_in_their_planes_and_counts_are_exact() {
    for kind in CellKind::ALL {
        let mesh = unit_box(kind, [3, 2, 4], None);
        assert_eq!(mesh.cell_count(), 24 * kind.entry().cell.per_cube);
        for (name, axis, value, cells) in [
            ("x-min", 0, -0.1, 8),
            ("x-max", 0, 0.9, 8),
            ("y-min", 1, 0.2, 12),
            ("y-max", 1, 0.7, 12),
            ("z-min", 2, 0.3, 6),
            ("z-max", 2, 0.6, 6),
        ] {
            let facets = mesh.group(name).unwrap();
            // A diagonal normal to the axis divides the faces of a cube.
            let each = 1 + kind.entry().cell.diagonals[2 - axis];
            assert_eq!(facets.len(), cells * each, "{name} {}", kind.name());
            for node in mesh.facet_group_nodes(facets) {
                assert!((mesh.points()[node as usize][axis] - value).abs() < 1e-15, "{name}");
            }
        }
    }
    let count = |kind| unit_box(kind, [2, 2, 10], None).points().len();
    assert_eq!(CellKind::ALL.map(count), [99, 525, 99, 99 + 66 + 66 + 90, 99, 99 + 66 + 66 + 90 + 44]);
}

#[test]
fn grading_gives_the_asked_ratio_and_jitter_keeps_the_boundary() {
    let min = Point3::origin();
    let max = Point3::new(1.0, 1.0, 1.0);
    let mesh = box_mesh(CellKind::Hex8, min, max, [5, 1, 1], [4.0, 1.0, 1.0], None).unwrap();
    let x: Vec<f64> = mesh.points()[..6].iter().map(|p| p.x).collect();
    assert!(((x[5] - x[4]) / (x[1] - x[0]) - 4.0).abs() < 1e-12, "{x:?}");
    assert!(
        ((x[2] - x[1]) * (x[4] - x[3]) / (x[3] - x[2]).powi(2) - 1.0).abs() < 1e-12,
        "not geometric: {x:?}"
    );

    let jitter = Some(Jitter { fraction: 0.25, seed: 7 });
    for kind in CellKind::ALL {
        let (plain, moved) = (unit_box(kind, [4, 4, 4], None), unit_box(kind, [4, 4, 4], jitter));
        assert_eq!(moved, unit_box(kind, [4, 4, 4], jitter), "not reproducible");
        let other = unit_box(kind, [4, 4, 4], Some(Jitter { fraction: 0.25, seed: 8 }));
        assert_ne!(moved, other, "the seed is ignored");
        let boundary = plain.facet_group_nodes(&plain.boundary());
        let steps = Vector3::new(0.25, 0.125, 0.075) * 0.25;
        let mut largest = [0.0; 3];
        for (n, (p, q)) in plain.points().iter().zip(moved.points()).enumerate() {
            let shift = q - p;
            if boundary.binary_search(&(n as u32)).is_ok() {
                assert_eq!(p, q);
            }
            for d in 0..3 {
                assert!(shift[d].abs() <= steps[d] + 1e-15);
                largest[d] = f64::max(largest[d], shift[d].abs() / steps[d]);
            }
        }
        assert!(largest.iter().all(|&l| l > 0.7), "jitter weaker than asked: {largest:?}");
        // Straight edges remain straight.
        for cell in 0..moved.cell_count() {
            let list = moved.cell(cell);
            for (e, &[a, b]) in kind.edges().iter().enumerate().take(if kind.order() == 2 { 12 } else { 0 }) {
                let middle = moved.points()[list[kind.corner_count() + e] as usize];
                let (a, b) = (moved.points()[list[a] as usize], moved.points()[list[b] as usize]);
                assert!((middle - nalgebra::center(&a, &b)).norm() < 1e-15);
            }
        }
    }
}

#[test]
fn curved_nodes_lie_on_their_surfaces() {
    for kind in CellKind::ALL {
        let on = |mesh: &Mesh, group: &str, radius: &dyn Fn(&Point3) -> f64, exact: f64| {
            let facets = mesh.group(group).unwrap();
            assert!(!facets.is_empty(), "{group} is empty");
            for n in mesh.facet_group_nodes(facets) {
                let r = radius(&mesh.points()[n as usize]);
                assert!((r - exact).abs() < 1e-15, "{group} {}: {r} for {exact}", kind.name());
            }
        };
        let norm = |p: &Point3| p.coords.norm();
        on(&ball_mesh(kind, 0.7, 3).unwrap(), "surface", &norm, 0.7);
        let octant = sphere_shell_mesh(kind, 0.5, 0.9, [2, 2], 1.0, ShellExtent::Octant).unwrap();
        on(&octant, "inner", &norm, 0.5);
        on(&octant, "outer", &norm, 0.9);
        for (axis, name) in ["x-min", "y-min", "z-min"].into_iter().enumerate() {
            on(&octant, name, &|p| p[axis], 0.0);
        }
        on(&cylinder_mesh(kind, 0.3, 1.0, [3, 2], 1.0).unwrap(), "side", &|p| p.x.hypot(p.y), 0.3);
        on(&cylinder_mesh(kind, 0.3, 0.8, [3, 2], 1.0).unwrap(), "top", &|p| p.z, 0.8);
        on(&kidney_mesh(kind, 3).unwrap(), "surface", &|p| Kidney.level(p), 0.0);
    }
}

#[test]
fn tetrahedra_on_the_nodes_of_quadratic_cells_keep_the_numbers() {
    let linear = unit_box(CellKind::Hex8, [3, 2, 1], None);
    let quadratic = raise_order(&linear);
    let (few, all) = (to_tets(&linear), tets_on_nodes(&quadratic));
    assert_eq!(all.points(), quadratic.points());
    assert_eq!(all.cell_count(), few.cell_count());
    // Corners come first in a mesh whose order was raised.
    assert!((0..all.cell_count()).all(|cell| all.cell(cell) == few.cell(cell)));
}

#[test]
fn conversion_keeps_volume_regions_and_groups() {
    let hexes = unit_box(CellKind::Hex8, [2, 2, 2], None)
        .with_regions(vec![0, 0, 0, 0, 1, 1, 1, 1], vec!["low".into(), "high".into()]);
    let tets = raise_order(&to_tets(&hexes));
    assert_eq!(tets.cell_count(), 48);
    for cell in 0..48 {
        let middle = tets.cell_points(cell).take(4).map(|p| p.coords).sum::<Vector3>() / 4.0;
        assert_eq!(tets.region(cell), u16::from(middle.z > 0.45), "cell {cell}");
    }
    assert_eq!(tets.region_names(), hexes.region_names());
    let back = to_tets(&tets);
    assert_eq!(back.points(), hexes.points(), "mid-edge nodes are dropped again");
    assert_eq!(back.group("x-max").unwrap().len(), 8);
    assert_eq!(raise_order(&tets), tets, "quadratic cells stay as they are");
    // A mixed mesh: one hexahedron next to a tetrahedron that becomes tet10; a shared edge has one mid-edge
    // node.
    let points = [
        [0., 0., 0.],
        [1., 0., 0.],
        [1., 1., 0.],
        [0., 1., 0.],
        [0., 0., 1.],
        [1., 0., 1.],
        [1., 1., 1.],
        [0., 1., 1.],
        [2., 0., 0.],
    ];
    let points = points.iter().map(|p| Point3::new(p[0], p[1], p[2])).collect();
    let mixed =
        Mesh::new(points, &[(CellKind::Hex8, (0..8).collect()), (CellKind::Tet4, vec![1, 8, 2, 5])]).unwrap();
    let raised = raise_order(&mixed);
    assert_eq!(raised.points().len(), 9 + 12 + 6 - 2, "edges 1-2 and 1-5 are shared");
    assert_eq!(raised.uniform_kind(), None);
}

#[test]
fn bad_parameters_are_named() {
    let corner = Point3::new(1.0, 1.0, 1.0);
    let make = |cells, grading, fraction| {
        let jitter = Some(Jitter { fraction, seed: 1 });
        box_mesh(CellKind::Tet4, Point3::origin(), corner, cells, grading, jitter).unwrap_err()
    };
    assert!(make([0, 1, 1], [1.0; 3], 0.1).to_string().contains("cells along x is 0"));
    assert!(make([1, 1, 1 << 21], [1.0; 3], 0.1).to_string().contains("along z is 2097152"));
    assert!(make([1 << 20; 3], [1.0; 3], 0.1).to_string().contains("in all"));
    assert!(make([2; 3], [1.0, -1.0, 1.0], 0.1).to_string().contains("grading is -1"));
    assert!(make([2; 3], [1.0; 3], 0.5).to_string().contains("jitter fraction is 0.5"));
    assert!(make([2; 3], [1.0; 3], f64::NAN).to_string().contains("NaN"));
    let flat = box_mesh(CellKind::Tet4, corner, corner, [1; 3], [1.0; 3], None).unwrap_err();
    assert!(matches!(flat, GenerateError::Value { .. }));
    assert!(matches!(make([6; 3], [1.0; 3], 0.49), GenerateError::Inverted(_)));
    assert!(kidney_mesh(CellKind::Hex8, 0).is_err());
    assert!(ball_mesh(CellKind::Hex8, -1.0, 2).is_err());
    assert!(cylinder_mesh(CellKind::Hex8, 1.0, f64::INFINITY, [1, 1], 1.0).is_err());
    assert!(sphere_shell_mesh(CellKind::Hex8, 1.0, 0.5, [1, 1], 1.0, ShellExtent::Whole).is_err());
}

#[test]
fn the_coarsest_meshes_are_sound() {
    for kind in CellKind::ALL {
        for n in 1..=5 {
            if (kind, n) == (CellKind::Tet10, 1) {
                assert!(matches!(kidney_mesh(kind, n), Err(GenerateError::Inverted(_))));
                continue;
            }
            let meshes = [
                ball_mesh(kind, 1.0, n).unwrap(),
                kidney_mesh(kind, n).unwrap(),
                cylinder_mesh(kind, 1.0, 1.0, [n, n], 1.0).unwrap(),
                sphere_shell_mesh(kind, 0.5, 1.0, [n, n], 1.0, ShellExtent::Octant).unwrap(),
                sphere_shell_mesh(kind, 0.5, 1.0, [n + 1, n], 1.0, ShellExtent::Whole).unwrap(),
            ];
            for (i, mesh) in meshes.iter().enumerate() {
                quality::check(mesh).unwrap_or_else(|e| panic!("{} n = {n}, mesh {i}: {e}", kind.name()));
            }
        }
    }
}

#[test]
fn surface_cells_are_of_like_size() {
    let areas = |mesh: &Mesh, group: &str| {
        let areas = mesh.group(group).unwrap().iter().map(|&f| area_vector(mesh, f).norm());
        areas.fold((f64::INFINITY, 0.0f64), |(low, high), a| (low.min(a), high.max(a)))
    };
    // The ratio is 1.4 for equal angles, and 4 for the central projection.
    let shell = sphere_shell_mesh(CellKind::Hex8, 0.5, 1.0, [16, 1], 1.0, ShellExtent::Whole).unwrap();
    let ball = ball_mesh(CellKind::Hex8, 1.0, 16).unwrap();
    for (mesh, group) in [(&shell, "inner"), (&shell, "outer"), (&ball, "surface")] {
        let (low, high) = areas(mesh, group);
        assert!(high / low < 1.5, "{group}: {low} to {high}");
    }
}
