//! Volume, surface and flux rows: exact integrals, reproduction and Gauss's theorem on every mesh of a list.

mod common;

use common::{affine, all, ball, jittered, middles, mixed};
use geometry::quadrature::{TET_RULES, TRI_RULES};
use geometry::{CellKind, FaceKind, Facet, Matrix3, Mesh, Point3, Vector3, generate};
use proptest::prelude::*;
use shape::RowSource as _;
use tissuebench_fem::{
    Elements, FemError, SurfaceRule, VolumeRule, cell_of_point, element_dilation, flux_rows, regions,
    surface_rows, volume_rows,
};

const RULES: [VolumeRule; 2] = [VolumeRule::STANDARD, VolumeRule::FINE];

fn size(mesh: &Mesh) -> f64 {
    mesh.points().iter().map(|p| p.coords.norm()).fold(0.0, f64::max)
}

/// A quadratic field and its gradient.
fn field(p: &Point3) -> Vector3 {
    let (x, y, z) = (p.x, p.y, p.z);
    Vector3::new(x * x - 2.0 * y * z + z, 0.5 * y * y + x * z - 3.0, z * z - x * y + 2.0 * x)
}

fn field_gradient(p: &Point3) -> Matrix3 {
    let (x, y, z) = (p.x, p.y, p.z);
    Matrix3::new(2.0 * x, -2.0 * z, -2.0 * y + 1.0, z, y, x, -y + 2.0, -x, 2.0 * z)
}

/// Positions are reproduced, and the gradient of the position is the unit matrix: linear completeness.
fn check_linear(name: &str, mesh: &Mesh, rule: &VolumeRule) {
    let volume = volume_rows(mesh, rule).unwrap();
    let x: Vec<Vector3> = mesh.points().iter().map(|p| p.coords).collect();
    let far = size(mesh);
    for (found, p) in volume.rows().apply(&x).iter().zip(volume.points()) {
        assert!((found - p.coords).norm() < 1e-14 * far, "{name}: {found} for {p}");
    }
    // The error of gradients is eps |x| / h: the meshes have cells of 1/30 and more of their distance from
    // the origin.
    for h in volume.at().displacement_gradients(&x) {
        assert!((h - Matrix3::identity()).norm() < 1e-12, "{name}: {h}");
    }
}

#[test]
fn linear_fields_are_held_on_every_mesh() {
    for (name, mesh) in all() {
        for rule in &RULES {
            check_linear(&name, &mesh, rule);
        }
    }
}

#[test]
fn quadratic_fields_are_held_by_quadratic_cells_with_affine_maps() {
    for (mesh, holds) in [
        (affine(CellKind::Tet10), true),
        (jittered(CellKind::Tet10, 3), true),
        (affine(CellKind::Hex20), true),
        (affine(CellKind::Tet4), false),
        (affine(CellKind::Hex8), false),
        (jittered(CellKind::Hex20, 3), false),
    ] {
        let volume = volume_rows(&mesh, &VolumeRule::FINE).unwrap();
        let u: Vec<Vector3> = mesh.points().iter().map(field).collect();
        let worst = (volume.at().displacement_gradients(&u).iter().zip(volume.points()))
            .map(|(h, p)| (h - field_gradient(p)).norm())
            .fold(0.0, f64::max);
        // The field's gradient is about 10.
        assert_eq!(worst < 1e-11, holds, "{:?}: {worst:e}", mesh.kind(0));
    }
}

#[test]
fn volumes_sum_to_the_body() {
    for kind in CellKind::ALL {
        for rule in &RULES {
            let sum: f64 = volume_rows(&jittered(kind, 5), rule).unwrap().weights().iter().sum();
            assert!((sum - 2.0).abs() < 1e-13, "{kind:?} box: {sum}");
            let sum: f64 = volume_rows(&affine(kind), rule).unwrap().weights().iter().sum();
            // det of the map [[1, .3, 0], [0, .7, -.2], [.1, 0, 2]] = 1.4 - 0.006.
            assert!((sum - 1.394).abs() < 1e-13, "{kind:?} affine: {sum}");
        }
    }
}

#[test]
fn curved_cells_come_near_the_ball_and_straight_ones_do_not() {
    let exact =
        (4.0 / 3.0 * std::f64::consts::PI * 0.02_f64.powi(3), 4.0 * std::f64::consts::PI * 0.02_f64.powi(2));
    for kind in CellKind::ALL {
        let mesh = ball(kind);
        let volume: f64 = volume_rows(&mesh, &VolumeRule::FINE).unwrap().weights().iter().sum();
        let surface = surface_rows(&mesh, &mesh.boundary(), &SurfaceRule::FINE).unwrap();
        let area: f64 = surface.weights().iter().sum();
        let (dv, da) = ((volume / exact.0 - 1.0).abs(), (area / exact.1 - 1.0).abs());
        let tolerance = if kind.order() == 2 { 4e-3 } else { 0.15 };
        assert!(dv < tolerance && da < tolerance, "{kind:?}: {dv:e} {da:e}");
        assert!(kind.order() == 2 || dv > 0.02, "{kind:?}: {dv:e}");
        // Normals are close to the radius vector.
        for (n, p) in surface.normals().iter().zip(surface.points()) {
            let cosine = n.dot(&p.coords.normalize());
            assert!(cosine > if kind.order() == 2 { 0.98 } else { 0.8 }, "{kind:?}: {cosine}");
        }
    }
}

/// `sum w grad N_I = sum w N_I n` over the boundary, node by node, which is the condition for passing a patch
/// test.
#[test]
fn gauss_theorem_holds_for_every_node() {
    for ((name, mesh), rule) in
        all().iter().flat_map(|on| [(on, VolumeRule::STANDARD), (on, VolumeRule::FINE)])
    {
        let volume = volume_rows(mesh, &rule).unwrap();
        let mut sums = vec![Vector3::zeros(); mesh.points().len()];
        for q in 0..volume.weights().len() {
            let (nodes, grads) = volume.row(q);
            for (&node, g) in nodes.iter().zip(grads) {
                sums[node as usize] += volume.weights()[q] * g;
            }
        }
        let largest = sums.iter().map(|s| s.amax()).fold(0.0, f64::max);
        let surface = surface_rows(mesh, &mesh.boundary(), &SurfaceRule::FINE).unwrap();
        for q in 0..surface.weights().len() {
            let (nodes, values) = surface.rows().row(q);
            for (&node, n) in nodes.iter().zip(values) {
                sums[node as usize] -= surface.weights()[q] * n * surface.normals()[q];
            }
        }
        for (node, sum) in sums.iter().enumerate() {
            assert!(sum.amax() < 1e-12 * largest, "{name} node {node}: {:e} of {largest:e}", sum.amax());
        }
    }
}

#[test]
fn normals_point_outwards() {
    for kind in CellKind::ALL {
        let mesh = jittered(kind, 11);
        let facets: Vec<Facet> = (0..mesh.cell_count() as u32)
            .flat_map(|cell| (0..kind.faces().len() as u8).map(move |face| Facet { cell, face }))
            .collect();
        let surface = surface_rows(&mesh, &facets, &SurfaceRule::STANDARD).unwrap();
        let points =
            |&facet: &Facet| std::iter::repeat_n(facet, SurfaceRule::STANDARD.points(mesh.facet_kind(facet)));
        for (facet, n) in facets.iter().flat_map(points).zip(surface.normals()) {
            let (face, cell) = middles(&mesh, facet);
            assert!(n.dot(&(face - cell)) > 0.0, "{kind:?} facet {facet:?}");
        }
    }
}

#[test]
fn flux_rows_agree_with_surface_rows_and_hold_linear_fields() {
    for (name, mesh) in all() {
        let facets = mesh.boundary();
        let surface = surface_rows(&mesh, &facets, &SurfaceRule::STANDARD).unwrap();
        let flux = flux_rows(&mesh, &facets, &SurfaceRule::STANDARD).unwrap();
        assert_eq!(surface.weights(), flux.weights(), "{name}");
        assert_eq!(surface.normals(), flux.normals(), "{name}");
        let far = size(&mesh);
        let field: Vec<Vector3> =
            mesh.points().iter().map(|p| Vector3::new(p.x * p.y, p.z * p.z, p.x - p.y) * far).collect();
        let (a, b) = (surface.rows().apply(&field), flux.at().rows().apply(&field));
        for q in 0..a.len() {
            assert!((surface.points()[q] - flux.points()[q]).norm() < 1e-14 * far, "{name}");
            assert!((a[q] - b[q]).norm() < 1e-13 * far.powi(2).max(far.powi(3)), "{name}: {} {}", a[q], b[q]);
        }
        let x: Vec<Vector3> = mesh.points().iter().map(|p| p.coords).collect();
        for h in flux.at().displacement_gradients(&x) {
            assert!((h - Matrix3::identity()).norm() < 1e-12, "{name}: {h}");
        }
    }
}

#[test]
fn every_rule_on_offer_integrates_and_others_are_refused() {
    let tets = affine(CellKind::Tet10);
    for (points, _) in TET_RULES {
        let rule = VolumeRule::STANDARD.with(CellKind::Tet10, points).unwrap();
        let volume = volume_rows(&tets, &rule).unwrap();
        assert_eq!(volume.weights().len(), points * tets.cell_count());
        assert!((volume.weights().iter().sum::<f64>() - 1.394).abs() < 1e-13);
    }
    for (points, _) in TRI_RULES {
        assert_eq!(SurfaceRule::FINE.with(FaceKind::Tri3, points).unwrap().points(FaceKind::Tri3), points);
    }
    assert_eq!(VolumeRule::FINE.with(CellKind::Hex8, 125).unwrap().points(CellKind::Hex8), 125);
    let message = VolumeRule::FINE.with(CellKind::Tet4, 5).unwrap_err().to_string();
    assert!(
        message.contains("there is no quadrature rule of 5 points for tet4; available: 1, 4, 8, 14"),
        "{message}"
    );
    let message = SurfaceRule::FINE.with(FaceKind::Quad8, 0).unwrap_err().to_string();
    assert!(message.contains("0 points per axis for quad8; available: 1 to 16"), "{message}");
    assert!(VolumeRule::FINE.with(CellKind::Hex20, 9).is_err());
}

#[test]
fn points_know_their_cell_their_region_and_their_group() {
    let mesh = mixed();
    for rule in &RULES {
        let volume = volume_rows(&mesh, rule).unwrap();
        let cells = cell_of_point(&mesh, rule);
        let regions = regions(&mesh, rule);
        let groups = element_dilation(&mesh, rule).unwrap();
        assert_eq!(cells.len(), volume.weights().len());
        assert_eq!(groups.point_count(), cells.len());
        assert_eq!(groups.len(), mesh.cell_count());
        for q in 0..cells.len() {
            assert_eq!(volume.row(q).0, mesh.cell(cells[q] as usize), "point {q}");
            assert_eq!(regions[q], mesh.region(cells[q] as usize), "point {q}");
            assert!(groups.group(cells[q] as usize).0.contains(&(q as u32)), "point {q}");
        }
    }
}

#[test]
fn inverted_and_flat_cells_are_named() {
    for kind in CellKind::ALL {
        let mesh = jittered(kind, 1);
        let bad = mesh.cell_count() - 2;
        let mut cells: Vec<(CellKind, Vec<u32>)> =
            (0..mesh.cell_count()).map(|c| (mesh.kind(c), mesh.cell(c).to_vec())).collect();
        cells[bad].1 = kind.mirrored().iter().map(|&node| mesh.cell(bad)[node]).collect();
        let spoiled = Mesh::new(mesh.points().to_vec(), &cells).unwrap();
        match volume_rows(&spoiled, &VolumeRule::STANDARD) {
            Err(FemError::InvertedElement { element, det_j }) => {
                assert!(element == bad && det_j < 0.0, "{kind:?}")
            }
            Err(other) => panic!("{kind:?}: {other}"),
            Ok(_) => panic!("{kind:?}: cell {bad} passed"),
        }
        let face = Facet { cell: bad as u32, face: 0 };
        assert!(matches!(
            flux_rows(&spoiled, &[face], &SurfaceRule::STANDARD),
            Err(FemError::InvertedElement { element, .. }) if element == bad
        ));
    }
    let flat: Vec<Point3> = (0..4).map(|i| Point3::new(i as f64, (i * i) as f64, 0.0)).collect();
    let mesh = Mesh::new(flat, &[(CellKind::Tet4, vec![0, 1, 2, 3])]).unwrap();
    assert_eq!(
        volume_rows(&mesh, &VolumeRule::STANDARD),
        Err(FemError::InvertedElement { element: 0, det_j: 0.0 })
    );
    let line: Vec<Point3> = (0..4).map(|i| Point3::new(i as f64, 0.0, 0.0)).collect();
    let mesh = Mesh::new(line, &[(CellKind::Tet4, vec![0, 1, 2, 3])]).unwrap();
    assert_eq!(
        surface_rows(&mesh, &[Facet { cell: 0, face: 2 }], &SurfaceRule::STANDARD),
        Err(FemError::FlatFacet { cell: 0, face: 2, area: 0.0 })
    );
}

#[test]
fn facets_the_mesh_does_not_have_are_refused() {
    let mesh = jittered(CellKind::Tet4, 1);
    let cells = mesh.cell_count();
    for (cell, face) in [(cells as u32, 0), (0, 4)] {
        let facets = [Facet { cell, face }];
        let expected = FemError::NoSuchFacet { cell, face, cells };
        assert_eq!(surface_rows(&mesh, &facets, &SurfaceRule::FINE).unwrap_err(), expected);
        assert_eq!(flux_rows(&mesh, &facets, &SurfaceRule::FINE).unwrap_err(), expected);
    }
    assert!(surface_rows(&mesh, &[], &SurfaceRule::FINE).unwrap().weights().is_empty());
}

#[test]
fn bits_do_not_depend_on_the_number_of_threads() {
    // More cells than one task takes, so that several tasks are used.
    let mesh = geometry::generate::box_mesh(
        CellKind::Tet10,
        Point3::origin(),
        Point3::new(1.0, 1.0, 1.0),
        [8, 8, 8],
        [1.3, 1.0, 0.7],
        None,
    )
    .unwrap();
    let table = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| volume_rows(&mesh, &VolumeRule::STANDARD).unwrap())
    };
    let one = table(1);
    assert_eq!(one.rows().uniform_len(), Some(10));
    assert_eq!(one, table(2));
    assert_eq!(one, table(5));
}

#[test]
fn the_first_bad_cell_is_named_at_any_number_of_threads() {
    let mesh = jittered(CellKind::Tet4, 2);
    let mut cells: Vec<(CellKind, Vec<u32>)> = Vec::new();
    for copy in 0..40 {
        for c in 0..mesh.cell_count() {
            let mut nodes = mesh.cell(c).to_vec();
            if copy >= 9 {
                nodes.swap(0, 1);
            }
            cells.push((CellKind::Tet4, nodes));
        }
    }
    let spoiled = Mesh::new(mesh.points().to_vec(), &cells).unwrap();
    for threads in [1, 2, 4] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        match pool.install(|| volume_rows(&spoiled, &VolumeRule::STANDARD)) {
            Err(FemError::InvertedElement { element, .. }) => assert_eq!(element, 9 * mesh.cell_count()),
            other => panic!("{:?}", other.err()),
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn jittered_cells_hold_linear_fields_and_their_volume(seed in any::<u64>()) {
        for kind in CellKind::ALL {
            let mesh = jittered(kind, seed);
            check_linear(kind.name(), &mesh, &VolumeRule::STANDARD);
            let volume: f64 = volume_rows(&mesh, &VolumeRule::STANDARD).unwrap().weights().iter().sum();
            prop_assert!((volume - 2.0).abs() < 1e-13, "{kind:?}: {volume}");
            let surface = surface_rows(&mesh, &mesh.boundary(), &SurfaceRule::STANDARD).unwrap();
            let closed: Vector3 = surface.weights().iter().zip(surface.normals()).map(|(w, n)| *w * n).sum();
            prop_assert!(closed.norm() < 1e-13, "{kind:?}: {closed}");
        }
    }
}

/// The blocks of the finer quadrature are its rows, one after another.
#[test]
fn blocks_have_the_bits_of_the_whole_table() {
    let (low, high) = (Point3::origin(), Point3::new(1.0, 2.0, 3.0));
    // More cells than a block has.
    let mesh = generate::box_mesh(CellKind::Hex8, low, high, [21; 3], [1.5; 3], None).unwrap();
    let elements = Elements::new(std::sync::Arc::new(mesh), VolumeRule::STANDARD);
    let whole = elements.fine_volume().unwrap();
    let (mut blocks, mut weights, mut grads, mut nodes) = (0, Vec::new(), Vec::new(), Vec::new());
    let mut add = |rows: &shape::VolumeRows| {
        blocks += 1;
        weights.extend_from_slice(rows.weights());
        grads.extend_from_slice(rows.grads());
        nodes.extend_from_slice(rows.rows().nodes());
    };
    elements.fine_blocks(&mut add).unwrap();
    assert_eq!(blocks, 2);
    assert!(weights == whole.weights() && grads == whole.grads() && nodes == whole.rows().nodes());
}
