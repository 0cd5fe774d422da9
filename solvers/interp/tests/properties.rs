//! Properties common to all schemes.

use geometry::generate::{Jitter, box_mesh};
use geometry::{CellKind, Mesh};
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;
use proptest::test_runner::FileFailurePersistence;
use shape::{Point3, PointRows};
use tissuebench_interp::{
    Barycentric, InverseDistance, MlsLinear, MlsModified, MlsQuadratic, Radial, Scheme, Shepard, TransferInfo,
};

/// A box of 40 x 30 x 20 mm with 6 x 5 x 4 cells of 6 tetrahedra and jittered inner nodes: 210 nodes.
fn mesh() -> Mesh {
    let jitter = Some(Jitter { fraction: 0.2, seed: 7 });
    let (low, high) = (Point3::origin(), Point3::new(0.04, 0.03, 0.02));
    box_mesh(CellKind::Tet4, low, high, [6, 5, 4], [1.0; 3], jitter).unwrap()
}

/// Returns every scheme of the catalogue, and some with other parameters.
fn schemes() -> Vec<Scheme> {
    let mut all = Scheme::all().collect::<Vec<_>>();
    all.extend([
        Scheme::InverseDistance(InverseDistance { neighbours: 8, power: 1.0 }),
        Scheme::InverseDistance(InverseDistance { neighbours: 210, power: 3.5 }),
        Scheme::Shepard(Shepard { support_scale: 1.2 }),
        Scheme::MlsLinear(MlsLinear { support_scale: 2.5 }),
        Scheme::MlsQuadratic(MlsQuadratic { support_scale: 2.0 }),
        Scheme::Radial(Radial::Multiquadric { shape: 0.5 }),
        Scheme::Radial(Radial::Gaussian { shape: 0.8, polynomial: false }),
        Scheme::Radial(Radial::WendlandC2 { support: 2.0, polynomial: false }),
        Scheme::Radial(Radial::WendlandC2 { support: 3.0, polynomial: true }),
    ]);
    all
}

fn rows(scheme: Scheme, mesh: &Mesh, targets: &[Point3]) -> (PointRows, TransferInfo) {
    scheme.rows(mesh.points(), Some(mesh), targets).unwrap_or_else(|error| panic!("{scheme:?}: {error}"))
}

/// Returns the largest error of a transferred field, relative to its largest value at the targets.
fn error(scheme: Scheme, mesh: &Mesh, targets: &[Point3], field: impl Fn(&Point3) -> Vector3<f64>) -> f64 {
    let nodal: Vec<_> = mesh.points().iter().map(&field).collect();
    let (rows, _) = rows(scheme, mesh, targets);
    let exact: Vec<_> = targets.iter().map(&field).collect();
    let largest = exact.iter().map(|u| u.norm()).fold(0.0, f64::max);
    rows.rows().apply(&nodal).iter().zip(&exact).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) / largest
}

fn quadratic(x: &Point3) -> Vector3<f64> {
    // Pure bending with a curvature of 0.5 per metre, and a twist.
    Vector3::new(0.5 * x.x * x.y, -0.25 * (x.x * x.x + 0.3 * (x.y * x.y - x.z * x.z)), 0.7 * x.z * x.x)
}

fn config() -> ProptestConfig {
    let beside = Box::new(FileFailurePersistence::WithSource("proptest-regressions"));
    ProptestConfig { failure_persistence: Some(beside), ..ProptestConfig::with_cases(32) }
}

prop_compose! {
    fn inside()(x in 0.0..0.04, y in 0.0..0.03, z in 0.0..0.02) -> Point3 { Point3::new(x, y, z) }
}
prop_compose! {
    fn affine()(h in prop::array::uniform9(-1.0..1.0f64), c in prop::array::uniform3(-0.01..0.01f64))
        -> (Matrix3<f64>, Vector3<f64>) { (Matrix3::from_row_slice(&h), Vector3::from(c)) }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn rows_sum_to_one(targets in prop::collection::vec(inside(), 1..12)) {
        let mesh = mesh();
        for scheme in schemes() {
            let (rows, _) = rows(scheme, &mesh, &targets);
            prop_assert_eq!(rows.points(), &targets[..]);
            for row in 0..targets.len() {
                let sum: f64 = rows.rows().row(row).1.iter().sum();
                let exact = (sum - 1.0).abs() < 1e-12;
                prop_assert_eq!(exact, scheme.exact_degree().is_some(), "{:?}: {}", scheme, sum);
            }
        }
    }

    #[test]
    fn polynomials_up_to_the_promised_degree_are_exact(
        targets in prop::collection::vec(inside(), 12..24),
        (h, c) in affine(),
    ) {
        let mesh = mesh();
        for scheme in schemes() {
            // The tolerance is 1e-12 relative to the field; the worst conditioned scheme has the quadratic
            // basis, 1e3 times rounding.
            let constant = error(scheme, &mesh, &targets, |_| Vector3::new(3.0, -2.0, 1.0));
            let promised = scheme.exact_degree();
            prop_assert_eq!(constant < 1e-12, promised.is_some(), "{:?}: constant {:e}", scheme, constant);
            let linear = error(scheme, &mesh, &targets, |x| h * x.coords + c);
            let bent = error(scheme, &mesh, &targets, quadratic);
            // Fields of a higher degree are not exact, so the stated degree is not too low.
            prop_assert_eq!(linear < 1e-12, promised >= Some(1), "{:?}: linear {:e}", scheme, linear);
            prop_assert_eq!(bent < 1e-11, promised >= Some(2), "{:?}: quadratic {:e}", scheme, bent);
        }
    }

    #[test]
    fn nodes_do_not_feel_the_unit_or_the_origin(targets in prop::collection::vec(inside(), 1..8)) {
        let mesh = mesh();
        // Millimetres, and an origin 200 mm away.
        let moved = |x: &Point3| Point3::from(1e3 * x.coords + Vector3::new(200.0, -100.0, 50.0));
        let mesh_moved = mesh.moved(moved).unwrap();
        let targets_moved: Vec<_> = targets.iter().map(moved).collect();
        for scheme in schemes() {
            let here = dense(&rows(scheme, &mesh, &targets).0);
            let there = dense(&rows(scheme, &mesh_moved, &targets_moved).0);
            let gap = here.iter().zip(&there).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            prop_assert!(gap < 1e-9, "{:?}: {:e}", scheme, gap);
        }
    }

    #[test]
    fn promises_hold_in_any_unit_and_anywhere(
        targets in prop::collection::vec(inside(), 4..8),
        (h, c) in affine(),
        unit in -6..=1i32,
        shift in prop::array::uniform3(-100.0..100.0f64),
        seed in 0..1000u64,
    ) {
        // A body of 1e-6 to 10 m with jittered inner nodes, at a distance of up to 100 times its size from
        // the origin.
        let scale = 10f64.powi(unit);
        let jitter = Some(Jitter { fraction: 0.2, seed });
        let high = Point3::new(1.0, 0.75, 0.5);
        let unit_box = box_mesh(CellKind::Tet4, Point3::origin(), high, [5, 4, 3], [1.0; 3], jitter).unwrap();
        let moved = |x: &Point3| Point3::from((x.coords + Vector3::from(shift)) * scale);
        let mesh = unit_box.moved(moved).unwrap();
        let targets: Vec<_> = targets.iter().map(|x| moved(&Point3::from(x.coords * 25.0))).collect();
        for scheme in schemes().into_iter().filter(|s| *s != Scheme::InverseDistance(InverseDistance { neighbours: 210, power: 3.5 })) {
            let origin = Vector3::from(shift) * scale;
            let field = |x: &Point3| h * (x.coords - origin) / scale + c;
            let linear = error(scheme, &mesh, &targets, field);
            // At this distance coordinates are accurate to 2e-14 of the size.
            prop_assert_eq!(linear < 1e-11, scheme.exact_degree() >= Some(1), "{:?}: {:e}", scheme, linear);
        }
    }

    #[test]
    fn nodes_may_come_in_any_order(
        targets in prop::collection::vec(inside(), 1..8),
        stride in prop::sample::select(vec![11usize, 13, 47, 101, 209]),
    ) {
        let mesh = mesh();
        let n = mesh.points().len();
        // Strides without a common divisor with the 210 nodes visit each node once.
        let order: Vec<usize> = (0..n).map(|i| i * stride % n).collect();
        let shuffled: Vec<Point3> = order.iter().map(|&i| mesh.points()[i]).collect();
        for scheme in schemes().into_iter().filter(|s| *s != Scheme::Barycentric(Barycentric)) {
            let here = dense(&rows(scheme, &mesh, &targets).0);
            let there = dense(&scheme.rows(&shuffled, None, &targets).unwrap().0);
            for row in 0..targets.len() {
                for (column, &node) in order.iter().enumerate() {
                    let gap = (here[row * n + node] - there[row * n + column]).abs();
                    prop_assert!(gap < 1e-10, "{:?}: node {} by {:e}", scheme, node, gap);
                }
            }
        }
    }
}

fn dense(table: &PointRows) -> Vec<f64> {
    let rows = table.rows();
    let mut full = vec![0.0; rows.len() * rows.node_count()];
    for row in 0..rows.len() {
        let (nodes, values) = rows.row(row);
        for (&node, value) in nodes.iter().zip(values) {
            full[row * rows.node_count() + node as usize] += value;
        }
    }
    full
}

#[test]
fn targets_at_nodes_get_the_nodal_value_where_promised() {
    let mesh = mesh();
    for scheme in schemes() {
        let error = error(scheme, &mesh, mesh.points(), |x| {
            let x = x.coords * 200.0;
            Vector3::new(x.x.sin(), (x.y + x.z).cos(), x.z.sin() * x.x)
        });
        if scheme.interpolates() {
            // For radial bases: the condition of their dense system, about 1e4, times rounding.
            assert!(error < 1e-10, "{scheme:?}: {error:e}");
        } else {
            assert!(error > 1e-4, "{scheme:?}: {error:e}: it interpolates, but does not say so");
        }
    }
}

/// The error of modified least squares is that of the penalty of 1e-5 on second derivatives.
#[test]
fn modified_least_squares_are_almost_exact_for_quadratic_fields() {
    let mesh = mesh();
    let targets: Vec<Point3> = mesh.points().iter().map(|x| Point3::from(x.coords * 0.97)).collect();
    let of = |scheme: Scheme| error(scheme, &mesh, &targets, quadratic);
    let modified = of(Scheme::MlsModified(MlsModified { support_scale: 2.0 }));
    let linear = of(Scheme::MlsLinear(MlsLinear { support_scale: 2.0 }));
    assert!(modified < 1e-3 && modified > 1e-8, "{modified:e}");
    assert!(linear > 10.0 * modified, "{linear:e} {modified:e}");
}

#[test]
fn the_same_table_on_every_run() {
    let mesh = mesh();
    let targets: Vec<Point3> = mesh.points().iter().map(|x| Point3::from(x.coords * 0.97)).collect();
    for scheme in schemes() {
        assert_eq!(rows(scheme, &mesh, &targets), rows(scheme, &mesh, &targets), "{scheme:?}");
    }
}

#[test]
fn no_targets_make_an_empty_table() {
    let mesh = mesh();
    for scheme in schemes() {
        assert!(rows(scheme, &mesh, &[]).0.rows().is_empty(), "{scheme:?}");
    }
}

#[test]
fn names_are_unique_and_read_back() {
    for scheme in Scheme::all() {
        assert_eq!(Scheme::from_name(scheme.name()), Some(scheme));
    }
    assert_eq!(Scheme::from_name("kriging"), None);
}
