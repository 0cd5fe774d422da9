//! Integration: volumes, the integration constraint, and refused backgrounds.

mod common;

use common::{jittered_box, on_mesh};
use geometry::generate::{kidney_mesh, raise_order};
use geometry::{CellKind, Facet, Mesh};
use shape::{Point3, Vector3, VolumeRows};
use tissuebench_efg::{
    Basis, CubicSpline, EfgError, Kernel, Smoothing, WendlandC2, WendlandC4, flux_rows, gauss_regions,
    gauss_rows, grid_rows, smoothed_regions, smoothed_rows, smoothed_trace, surface_rows,
};

const VOLUME: f64 = 0.04 * 0.03 * 0.03;

/// Returns `sum_q w grad_I` for every node, m^2.
fn integrated_gradients(volume: &VolumeRows, nodes: usize) -> Vec<Vector3> {
    let mut sums = vec![Vector3::zeros(); nodes];
    for q in 0..volume.weights().len() {
        for (&node, grad) in volume.row(q).0.iter().zip(volume.row(q).1) {
            sums[node as usize] += grad * volume.weights()[q];
        }
    }
    sums
}

/// Returns the largest violation of `sum w grad_I = sum_boundary w phi_I n` over nodes, relative to the
/// largest side.
fn constraint_violation(
    mls: &tissuebench_efg::Approximation,
    mesh: &Mesh,
    volume: &VolumeRows,
    face_points: usize,
) -> f64 {
    let (surface, _) = surface_rows(mls, mesh, &mesh.boundary(), face_points).unwrap();
    let inner = integrated_gradients(volume, mls.nodes().len());
    let mut outer = vec![Vector3::zeros(); inner.len()];
    for q in 0..surface.weights().len() {
        let (nodes, values) = surface.rows().row(q);
        for (&node, value) in nodes.iter().zip(values) {
            outer[node as usize] += surface.normals()[q] * (surface.weights()[q] * value);
        }
    }
    let largest = outer.iter().map(|v| v.norm()).fold(0.0, f64::max);
    inner.iter().zip(&outer).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) / largest
}

#[test]
fn smoothing_meets_the_integration_constraint_to_rounding() {
    for (mesh, dilatation) in [
        (jittered_box(CellKind::Tet4, 4), 1.2),
        (jittered_box(CellKind::Tet4, 4), 2.5),
        (kidney_mesh(CellKind::Tet4, 3).unwrap(), 1.6),
    ] {
        let mls = on_mesh(&mesh, dilatation, Kernel::CubicSpline(CubicSpline), Basis::Linear);
        for face_points in [1, 3, 6] {
            let (volume, _) = smoothed_rows(&mls, &mesh, Smoothing::Constant, face_points).unwrap();
            let violation = constraint_violation(&mls, &mesh, &volume, face_points);
            assert!(violation < 1e-14, "{face_points} points: {violation:e}");
        }
        // With different points on the boundary the constraint is violated, so the test above can fail.
        let (volume, _) = smoothed_rows(&mls, &mesh, Smoothing::Constant, 1).unwrap();
        assert!(constraint_violation(&mls, &mesh, &volume, 3) > 1e-4);
        // Plain Gauss points violate the constraint.
        let (volume, _) = gauss_rows(&mls, &mesh, 4).unwrap();
        assert!(constraint_violation(&mls, &mesh, &volume, 6) > 1e-5);
    }
}

#[test]
fn smoothed_gradients_reproduce_linear_fields_and_volumes_add_up() {
    let mesh = jittered_box(CellKind::Tet4, 4);
    for basis in Basis::ALL {
        let mls = on_mesh(&mesh, common::dilatation(basis), Kernel::WendlandC2(WendlandC2), basis);
        let (volume, info) = smoothed_rows(&mls, &mesh, Smoothing::Constant, 3).unwrap();
        assert_eq!(info.fallbacks(), 0);
        assert_eq!(volume.weights().len(), mesh.cell_count());
        assert_eq!(smoothed_regions(&mesh, Smoothing::Constant).len(), mesh.cell_count());
        assert!((volume.weights().iter().sum::<f64>() / VOLUME - 1.0).abs() < 1e-13);
        let (plain, _) = mls.point_rows(volume.points()).unwrap();
        for q in 0..mesh.cell_count() {
            let centroid = mesh.cell_points(q).map(|p| p.coords).sum::<Vector3>() / 4.0;
            assert!((volume.points()[q].coords - centroid).norm() < 1e-17);
            // Values are those at the centroid, with zeros for nodes that contribute only on the faces.
            let (nodes, values) = volume.rows().row(q);
            let nonzero = nodes.iter().zip(values).filter(|(_, v)| **v != 0.0);
            let at_centroid = plain.rows().row(q).0.iter().zip(plain.rows().row(q).1);
            assert!(nonzero.eq(at_centroid.filter(|(_, v)| **v != 0.0)), "cell {q}");
            let (nodes, grads) = volume.row(q);
            let mut slope = Vector3::zeros();
            for (&node, grad) in nodes.iter().zip(grads) {
                slope += grad * common::field(Basis::Linear, &mls.nodes()[node as usize]).0;
            }
            let exact = common::field(Basis::Linear, &volume.points()[q]).1;
            assert!((slope - exact).norm() < 1e-12, "cell {q}: {slope}");
            assert!(grads.iter().sum::<Vector3>().norm() * 0.0075 < 1e-13);
        }
    }
}

/// Smoothed gradients are the cell means of the exact gradients, as found with many Gauss points in the cell
/// and on its faces.
#[test]
fn smoothed_gradients_are_cell_means() {
    let mesh = jittered_box(CellKind::Tet4, 3);
    let mls = on_mesh(&mesh, 2.5, Kernel::WendlandC4(WendlandC4), Basis::Linear);
    let (smoothed, _) = smoothed_rows(&mls, &mesh, Smoothing::Constant, 12).unwrap();
    let (fine, _) = gauss_rows(&mls, &mesh, 24).unwrap();
    for cell in [0, 50, 100] {
        let mut mean = vec![Vector3::zeros(); mls.nodes().len()];
        for q in 24 * cell..24 * (cell + 1) {
            for (&node, grad) in fine.row(q).0.iter().zip(fine.row(q).1) {
                mean[node as usize] += grad * (fine.weights()[q] / smoothed.weights()[cell]);
            }
        }
        let largest = mean.iter().map(|g| g.norm()).fold(0.0, f64::max);
        for (&node, grad) in smoothed.row(cell).0.iter().zip(smoothed.row(cell).1) {
            mean[node as usize] -= grad;
        }
        let off = mean.iter().map(|g| g.norm()).fold(0.0, f64::max) / largest;
        assert!(off < 2e-3, "cell {cell}: {off}");
    }
}

#[test]
fn gauss_weights_add_up_and_regions_follow_cells() {
    for (kind, counts) in [(CellKind::Tet4, [1, 4, 11, 14]), (CellKind::Hex8, [1, 8, 27, 64])] {
        let mesh = jittered_box(kind, 3);
        let split = (0..mesh.cell_count()).map(|c| u16::from(c % 3 == 0)).collect();
        let mesh = mesh.with_regions(split, vec!["a".into(), "b".into()]);
        let mls = on_mesh(&mesh, 1.6, Kernel::CubicSpline(CubicSpline), Basis::Linear);
        for points in counts {
            if kind == CellKind::Tet4 && geometry::quadrature::tet(points).is_none() {
                let refused = gauss_rows(&mls, &mesh, points).unwrap_err();
                assert!(matches!(refused, EfgError::NoRule { .. }), "{refused}");
                continue;
            }
            let (volume, info) = gauss_rows(&mls, &mesh, points).unwrap();
            assert_eq!(info.points, points * mesh.cell_count());
            assert!((volume.weights().iter().sum::<f64>() / VOLUME - 1.0).abs() < 1e-13);
            let centre =
                volume.points().iter().zip(volume.weights()).map(|(p, w)| p.coords * *w).sum::<Vector3>();
            assert!((centre / VOLUME - Vector3::new(0.02, 0.015, 0.015)).norm() < 1e-14);
            let regions = gauss_regions(&mesh, points);
            assert_eq!(regions.len(), info.points);
            assert!(regions.iter().enumerate().all(|(q, r)| *r == u16::from((q / points) % 3 == 0)));
        }
    }
}

#[test]
fn grids_fill_a_box_exactly_and_report_what_clipping_cost() {
    let mesh = jittered_box(CellKind::Tet4, 4);
    let mls = on_mesh(&mesh, 1.6, Kernel::CubicSpline(CubicSpline), Basis::Linear);
    let bounds = (Point3::origin(), Point3::new(0.04, 0.03, 0.03));
    let (volume, grid, _) = grid_rows(&mls, |_| true, bounds, 0.01, 2).unwrap();
    assert_eq!((grid.cells, grid.kept, grid.dropped), ([4, 3, 3], 288, 0));
    assert!((grid.volume / VOLUME - 1.0).abs() < 1e-13 && volume.weights().len() == 288);
    // A ball inside: the volume is correct only on average, and more accurate with finer cells.
    let centre = Point3::new(0.02, 0.015, 0.015);
    let inside = |p: &Point3| (p - centre).norm() < 0.014;
    let exact = 4.0 / 3.0 * std::f64::consts::PI * 0.014f64.powi(3);
    let error = |spacing: f64| {
        let (volume, grid, _) = grid_rows(&mls, inside, bounds, spacing, 2).unwrap();
        assert_eq!(grid.kept, volume.weights().len());
        assert!(grid.dropped > 0 && volume.points().iter().all(inside));
        assert_eq!(grid.volume, volume.weights().iter().sum::<f64>());
        (grid.volume / exact - 1.0).abs()
    };
    assert!(error(0.005) < 0.1 && error(0.00125) < 0.01);

    assert!(matches!(
        grid_rows(&mls, |_| false, bounds, 0.01, 2),
        Err(EfgError::EmptyGrid { points: 288, .. })
    ));
    assert!(matches!(grid_rows(&mls, |_| true, bounds, 1e-6, 2), Err(EfgError::HugeGrid { .. })));
    assert!(matches!(grid_rows(&mls, |_| true, bounds, f64::NAN, 2), Err(EfgError::BadParameter { .. })));
    assert!(matches!(grid_rows(&mls, |_| true, bounds, 0.01, 0), Err(EfgError::BadParameter { .. })));
}

#[test]
fn surfaces_have_their_area_and_outward_normals() {
    for (kind, face_points) in [(CellKind::Tet4, 3), (CellKind::Hex8, 4)] {
        let mesh = jittered_box(kind, 3);
        let mls = on_mesh(&mesh, 1.6, Kernel::CubicSpline(CubicSpline), Basis::Linear);
        for (name, normal, area) in
            [("x-max", Vector3::x(), 9e-4), ("y-min", -Vector3::y(), 1.2e-3), ("z-max", Vector3::z(), 1.2e-3)]
        {
            let facets = mesh.group(name).unwrap();
            let (surface, _) = surface_rows(&mls, &mesh, facets, face_points).unwrap();
            let (flux, _) = flux_rows(&mls, &mesh, facets, face_points).unwrap();
            assert!((surface.weights().iter().sum::<f64>() / area - 1.0).abs() < 1e-13, "{name}");
            assert!(surface.normals().iter().all(|n| (n - normal).norm() < 1e-13), "{name}");
            // Checks the positions of the points: both rules integrate squares exactly, here of x + 2 y + 4
            // z.
            let along = Vector3::new(1.0, 2.0, 4.0);
            let size = Vector3::new(0.04, 0.03, 0.03);
            let spread = along.component_mul(&size).component_mul(&(Vector3::repeat(1.0) - normal.abs()));
            let centre = (size + normal.component_mul(&size)) / 2.0;
            let mean = along.dot(&centre).powi(2) + spread.norm_squared() / 12.0;
            let found: f64 = surface
                .points()
                .iter()
                .zip(surface.weights())
                .map(|(p, w)| along.dot(&p.coords).powi(2) * w)
                .sum();
            assert!((found / (area * mean) - 1.0).abs() < 1e-12, "{name}");
            // Values are identical with and without gradients.
            assert_eq!(surface.rows(), flux.at().rows());
            assert_eq!((surface.points(), surface.weights()), (flux.points(), flux.weights()));
        }
    }
}

#[test]
fn backgrounds_it_cannot_use_are_refused() {
    let mesh = jittered_box(CellKind::Tet4, 3);
    let mls = on_mesh(&mesh, 1.6, Kernel::CubicSpline(CubicSpline), Basis::Linear);
    let curved = raise_order(&mesh);
    let hexes = jittered_box(CellKind::Hex8, 3);
    assert!(matches!(
        smoothed_rows(&mls, &hexes, Smoothing::Constant, 1),
        Err(EfgError::CellKind { cell: 0, .. })
    ));
    assert!(matches!(gauss_rows(&mls, &curved, 4), Err(EfgError::CellKind { kind: CellKind::Tet10, .. })));
    assert!(matches!(gauss_rows(&mls, &mesh, 5), Err(EfgError::NoRule { points: 5, .. })));
    assert!(matches!(gauss_rows(&mls, &hexes, 4), Err(EfgError::NoRule { points: 4, .. })));
    assert!(matches!(
        smoothed_rows(&mls, &mesh, Smoothing::Constant, 2),
        Err(EfgError::NoRule { points: 2, .. })
    ));
    let facet = [Facet { cell: 0, face: 0 }];
    assert!(matches!(surface_rows(&mls, &hexes, &facet, 3), Err(EfgError::NoRule { points: 3, .. })));
    // In the mirrored mesh every cell is inverted.
    let mirrored = mesh.moved(|p| Point3::new(0.04 - p.x, p.y, p.z)).unwrap();
    for refused in
        [gauss_rows(&mls, &mirrored, 4).err(), smoothed_rows(&mls, &mirrored, Smoothing::Constant, 1).err()]
    {
        assert!(
            matches!(refused, Some(EfgError::InvertedCell { cell: 0, det_j }) if det_j < 0.0),
            "{refused:?}"
        );
    }
}

/// Second-order smoothing reproduces gradients of quadratic fields at all four points, for every kernel.
#[test]
fn linearly_smoothed_gradients_reproduce_quadratic_fields() {
    let mesh = jittered_box(CellKind::Tet4, 3);
    for kernel in Kernel::all() {
        let mls = on_mesh(&mesh, 2.2, kernel, Basis::Quadratic);
        let error = |face_points| {
            let (volume, info) = smoothed_rows(&mls, &mesh, Smoothing::Linear, face_points).unwrap();
            assert_eq!(info.fallbacks(), 0);
            assert_eq!(volume.weights().len(), smoothed_regions(&mesh, Smoothing::Linear).len());
            assert!((volume.weights().iter().sum::<f64>() / VOLUME - 1.0).abs() < 1e-13);
            let mut worst = 0.0f64;
            for (q, x) in volume.points().iter().enumerate() {
                let (nodes, grads) = volume.row(q);
                let slope: Vector3 = nodes
                    .iter()
                    .zip(grads)
                    .map(|(&n, g)| g * common::field(Basis::Quadratic, &mls.nodes()[n as usize]).0)
                    .sum();
                worst = worst.max((slope - common::field(Basis::Quadratic, x).1).norm());
            }
            worst
        };
        assert!(error(6) < 1e-11, "{}: {:e}", kernel.name(), error(6));
        // The rule with three points per face has degree 2, one less than needed.
        assert!(error(3) > 1e-4, "{}: {:e}", kernel.name(), error(3));
    }
}

/// Traces reproduce linear fields on the surface, and their lengths bound the surface integral by the volume
/// integral.
#[test]
fn traces_are_exact_and_bounded() {
    let mesh = jittered_box(CellKind::Tet4, 2);
    let mls = on_mesh(&mesh, 2.2, Kernel::CubicSpline(CubicSpline), Basis::Quadratic);
    let facets = mesh.boundary();
    let (surface, _) = surface_rows(&mls, &mesh, &facets, 6).unwrap();
    for smoothing in [Smoothing::Constant, Smoothing::Linear] {
        let (volume, _) = smoothed_rows(&mls, &mesh, smoothing, 6).unwrap();
        let trace = smoothed_trace(&mesh, &facets, smoothing, 6).unwrap();
        let at = |s: usize, f: &dyn Fn(usize) -> f64| {
            trace.row(s).0.iter().zip(trace.row(s).1).map(|(&q, c)| c * f(q as usize)).sum::<f64>()
        };
        let mut sharpest = 0.0f64;
        for seed in 0..50u32 {
            // Arbitrary values at the volume's points, not only smooth fields.
            let f = |q: usize| f64::from((q as u32 * 7919 + seed * 104_729) % 1009) / 504.0 - 1.0;
            for cell in facets.iter().map(|f| f.cell as usize) {
                let own = |s: &usize| facets[s / 6].cell as usize == cell;
                let on: f64 = (0..trace.len())
                    .filter(own)
                    .map(|s| surface.weights()[s] * trace.lengths()[s] * at(s, &f).powi(2))
                    .sum();
                let n = smoothing.points_per_cell();
                let inside: f64 =
                    (n * cell..n * (cell + 1)).map(|q| volume.weights()[q] * f(q).powi(2)).sum();
                assert!(on <= inside * (1.0 + 1e-12), "{smoothing:?}, cell {cell}: {on:e} {inside:e}");
                sharpest = sharpest.max(on / inside);
            }
        }
        assert!(sharpest > 0.8, "{smoothing:?}: the bound is {sharpest} of sharp");
        if smoothing == Smoothing::Linear {
            for (s, x) in surface.points().iter().enumerate() {
                assert!((at(s, &|q| volume.points()[q].y) - x.y).abs() < 1e-16);
            }
        }
    }
}
