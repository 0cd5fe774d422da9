//! Node smoothing: means over the quarters around each vertex, points with a single region, and traces that
//! bound the stress on the surface.

mod common;

use common::{field, jittered_box, on_mesh};
use geometry::{CellKind, Mesh};
use shape::{Point3, Vector3};
use tissuebench_efg::{
    Basis, CubicSpline, EfgError, Kernel, Smoothing, WendlandC2, node_smoothed_regions, node_smoothed_rows,
    node_smoothed_trace, smoothed_rows, surface_rows,
};

const VOLUME: f64 = 0.04 * 0.03 * 0.03;

/// Returns the gradients at a point, one for each node of the cloud.
fn dense(volume: &shape::VolumeRows, point: usize, nodes: usize) -> Vec<Vector3> {
    let mut all = vec![Vector3::zeros(); nodes];
    volume.row(point).0.iter().zip(volume.row(point).1).for_each(|(&n, g)| all[n as usize] = *g);
    all
}

#[test]
fn points_are_the_vertices_and_gradients_the_means_of_the_cells_around() {
    let mesh = jittered_box(CellKind::Tet4, 3);
    // A separate cloud, coarser than the background: vertices need not be nodes.
    let mls = on_mesh(&jittered_box(CellKind::Tet4, 2), 1.6, Kernel::CubicSpline(CubicSpline), Basis::Linear);
    let nodes = mls.nodes().len();
    let (cells, _) = smoothed_rows(&mls, &mesh, Smoothing::Constant, 3).unwrap();
    let (volume, info) = node_smoothed_rows(&mls, &mesh, 0.0, 3).unwrap();
    assert_eq!(volume.points(), mesh.points());
    assert_eq!(info.fallbacks(), 0);
    assert!((volume.weights().iter().sum::<f64>() / VOLUME - 1.0).abs() < 1e-13);
    let (at_vertices, _) = mls.point_rows(mesh.points()).unwrap();
    for vertex in 0..mesh.points().len() {
        let around: Vec<usize> =
            (0..mesh.cell_count()).filter(|&c| mesh.cell(c).contains(&(vertex as u32))).collect();
        let quarters: f64 = around.iter().map(|&c| cells.weights()[c] / 4.0).sum();
        assert!((volume.weights()[vertex] / quarters - 1.0).abs() < 1e-14);
        let mut mean = dense(&volume, vertex, nodes);
        for &c in &around {
            let share = cells.weights()[c] / 4.0 / quarters;
            dense(&cells, c, nodes).iter().zip(&mut mean).for_each(|(g, m)| *m -= g * share);
        }
        assert!(mean.iter().all(|m| m.norm() * 0.01 < 1e-13), "vertex {vertex}");
        let nonzero = |(nodes, values): (&[u32], &[f64])| -> Vec<(u32, f64)> {
            nodes.iter().copied().zip(values.iter().copied()).filter(|(_, v)| *v != 0.0).collect()
        };
        assert_eq!(nonzero(volume.rows().row(vertex)), nonzero(at_vertices.rows().row(vertex)));
        let slope: Vector3 = (volume.row(vertex).0.iter().zip(volume.row(vertex).1))
            .map(|(&n, g)| g * field(Basis::Linear, &mls.nodes()[n as usize]).0)
            .sum();
        assert!((slope - field(Basis::Linear, &Point3::origin()).1).norm() < 1e-12);
    }
}

#[test]
fn stabilisation_gives_the_cells_their_share() {
    let mesh = jittered_box(CellKind::Tet4, 3);
    let mls = on_mesh(&mesh, 1.6, Kernel::WendlandC2(WendlandC2), Basis::Linear);
    let (cells, _) = smoothed_rows(&mls, &mesh, Smoothing::Constant, 1).unwrap();
    let (plain, _) = node_smoothed_rows(&mls, &mesh, 0.0, 1).unwrap();
    let (both, _) = node_smoothed_rows(&mls, &mesh, 0.25, 1).unwrap();
    let count = mesh.cell_count();
    assert_eq!(both.weights().len(), count + mesh.points().len());
    for q in 0..both.weights().len() {
        let (whole, row, share) = if q < count { (&cells, q, 0.25) } else { (&plain, q - count, 0.75) };
        assert_eq!(both.weights()[q], share * whole.weights()[row]);
        assert_eq!(both.points()[q], whole.points()[row]);
        assert!(both.row(q) == whole.row(row) && both.rows().row(q) == whole.rows().row(row), "point {q}");
    }
    assert!((both.weights().iter().sum::<f64>() / VOLUME - 1.0).abs() < 1e-13);
}

/// The box, with its half x > 20 mm as a separate region.
fn halves() -> Mesh {
    let mesh = jittered_box(CellKind::Tet4, 3);
    let right = |c| mesh.cell_points(c).map(|p| p.x).sum::<f64>() / 4.0 > 0.02;
    let regions = (0..mesh.cell_count()).map(|c| u16::from(right(c))).collect();
    mesh.with_regions(regions, vec!["left".into(), "right".into()])
}

#[test]
fn a_vertex_between_regions_has_a_point_for_each() {
    let mesh = halves();
    let mls = on_mesh(&mesh, 1.6, Kernel::CubicSpline(CubicSpline), Basis::Linear);
    for stabilisation in [0.0, 0.1] {
        let (volume, _) = node_smoothed_rows(&mls, &mesh, stabilisation, 1).unwrap();
        let regions = node_smoothed_regions(&mesh, stabilisation);
        assert_eq!(regions.len(), volume.weights().len());
        // The 4 x 4 vertices of the separating plane.
        let cells = if stabilisation > 0.0 { mesh.cell_count() } else { 0 };
        assert_eq!(regions.len(), cells + mesh.points().len() + 16);
        let of = |region: u16| {
            let own = regions.iter().zip(volume.weights()).filter(|(r, _)| **r == region);
            own.map(|(_, w)| w).sum::<f64>()
        };
        for region in [0, 1] {
            let cells = (0..mesh.cell_count()).filter(|&c| mesh.region(c) == region);
            let (all, _) = smoothed_rows(&mls, &mesh, Smoothing::Constant, 1).unwrap();
            let exact: f64 = cells.map(|c| all.weights()[c]).sum();
            assert!((of(region) / exact - 1.0).abs() < 1e-13, "region {region}: {:e}", of(region));
        }
    }
}

/// Traces reproduce linear fields on the surface, and their lengths bound the surface integral by the volume
/// integral.
#[test]
fn traces_are_exact_and_bounded() {
    for (mesh, facets) in [jittered_box(CellKind::Tet4, 2), halves()].map(|mesh| {
        let facets = mesh.boundary();
        (mesh, facets)
    }) {
        let mls = on_mesh(&mesh, 1.6, Kernel::CubicSpline(CubicSpline), Basis::Linear);
        for (stabilisation, face_points) in [(0.0, 1), (0.0, 6), (0.3, 1), (0.3, 3)] {
            let (volume, _) = node_smoothed_rows(&mls, &mesh, stabilisation, face_points).unwrap();
            let (surface, _) = surface_rows(&mls, &mesh, &facets, face_points).unwrap();
            let trace = node_smoothed_trace(&mesh, &facets, stabilisation, face_points).unwrap();
            assert_eq!((trace.len(), trace.point_count()), (surface.weights().len(), volume.weights().len()));
            let at = |s: usize, f: &dyn Fn(usize) -> f64| {
                trace.row(s).0.iter().zip(trace.row(s).1).map(|(&q, c)| c * f(q as usize)).sum::<f64>()
            };
            for (s, x) in surface.points().iter().enumerate() {
                assert!((at(s, &|q| volume.points()[q].y) - x.y).abs() < 1e-16);
            }
            let bound = |f: &dyn Fn(usize) -> f64| {
                let on = |s| surface.weights()[s] * trace.lengths()[s] * at(s, f).powi(2);
                let on: f64 = (0..trace.len()).map(on).sum();
                let inside = |q| volume.weights()[q] * f(q).powi(2);
                on / (0..volume.weights().len()).map(inside).sum::<f64>()
            };
            for seed in 0..50u32 {
                // Arbitrary values at the volume's points, not only smooth fields.
                let f = |q: usize| f64::from((q as u32 * 7919 + seed * 104_729) % 1009) / 504.0 - 1.0;
                assert!(bound(&f) <= 1.0 + 1e-12, "{stabilisation} {face_points}: {:e}", bound(&f));
            }
            // The bound is sharp for values equal to the ratio of a point's tributary area to its weight.
            let mut worst = vec![0.0; volume.weights().len()];
            for s in 0..trace.len() {
                let (points, coefficients) = trace.row(s);
                for (&q, c) in points.iter().zip(coefficients) {
                    worst[q as usize] += c * surface.weights()[s] / volume.weights()[q as usize];
                }
            }
            let sharp = bound(&|q| worst[q]);
            assert!((sharp - 1.0).abs() < 1e-12, "{stabilisation} {face_points}: {sharp}");
        }
    }
}

#[test]
fn what_it_cannot_use_is_refused() {
    let mesh = jittered_box(CellKind::Tet4, 2);
    let mls = on_mesh(&mesh, 1.6, Kernel::CubicSpline(CubicSpline), Basis::Linear);
    for share in [-0.1, 1.0, f64::NAN] {
        let refused = node_smoothed_rows(&mls, &mesh, share, 1).unwrap_err();
        assert!(matches!(refused, EfgError::BadParameter { what: "stabilisation", .. }), "{refused}");
        assert!(node_smoothed_trace(&mesh, &mesh.boundary(), share, 1).is_err());
    }
    assert!(matches!(node_smoothed_rows(&mls, &mesh, 0.0, 2), Err(EfgError::NoRule { points: 2, .. })));
    let hexes = jittered_box(CellKind::Hex8, 2);
    assert!(matches!(node_smoothed_rows(&mls, &hexes, 0.0, 1), Err(EfgError::CellKind { cell: 0, .. })));
    assert!(matches!(
        node_smoothed_trace(&hexes, &hexes.boundary(), 0.0, 1),
        Err(EfgError::CellKind { cell: 0, .. })
    ));
    let mirrored = mesh.moved(|p| Point3::new(0.04 - p.x, p.y, p.z)).unwrap();
    assert!(matches!(node_smoothed_rows(&mls, &mirrored, 0.0, 1), Err(EfgError::InvertedCell { .. })));
}

#[test]
fn same_bits_at_any_thread_count() {
    let mesh = jittered_box(CellKind::Tet4, 4);
    let mls = on_mesh(&mesh, 1.6, Kernel::CubicSpline(CubicSpline), Basis::Linear);
    assert!(mesh.points().len() > 128, "several chunks");
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| node_smoothed_rows(&mls, &mesh, 0.05, 3).unwrap())
    };
    let one = run(1);
    assert!([2, 3, 5].into_iter().all(|threads| run(threads) == one));
}
