//! Too few neighbours, duplicate nodes, and nodes in one plane: counted fallbacks or errors.

mod common;

use common::{field, jittered_box, on_mesh};
use geometry::{CellKind, cloud_from_mesh};
use shape::{Point3, Vector3};
use tissuebench_efg::{Approximation, Basis, CubicSpline, EfgError, Kernel, QuarticSpline, Support};

fn linear_error(mls: &Approximation, points: &[Point3]) -> (f64, tissuebench_efg::MlsInfo) {
    let (rows, info) = mls.grad_rows(points).unwrap();
    let mut worst = 0.0f64;
    for (q, x) in points.iter().enumerate() {
        let (mut u, mut g) = (0.0, Vector3::zeros());
        for ((&n, v), grad) in rows.row(q).0.iter().zip(rows.rows().row(q).1).zip(rows.row(q).1) {
            let value = field(Basis::Linear, &mls.nodes()[n as usize]).0;
            u += v * value;
            g += grad * value;
        }
        let (exact, slope) = field(Basis::Linear, x);
        worst = worst.max((u - exact).abs() / 0.04).max((g - slope).norm());
    }
    (worst, info)
}

#[test]
fn small_supports_are_enlarged_and_counted() {
    let mesh = jittered_box(CellKind::Tet4, 3);
    let points = [Point3::new(0.011, 0.013, 0.017), Point3::new(0.02, 0.02, 0.011)];
    for basis in Basis::ALL {
        let mls = on_mesh(&mesh, 0.5, Kernel::CubicSpline(CubicSpline), basis);
        let (error, info) = linear_error(&mls, &points);
        assert_eq!(info.enlarged, 2, "{info:?}");
        assert!(error < 1e-11 && info.neighbours_min >= 2 * basis.terms(), "{error} {info:?}");
    }
    // At a sound support scale no fallback is counted.
    assert_eq!(
        on_mesh(&mesh, 2.2, Kernel::CubicSpline(CubicSpline), Basis::Quadratic)
            .point_rows(&points)
            .unwrap()
            .1
            .fallbacks(),
        0
    );
}

#[test]
fn far_from_the_cloud_is_an_error_with_numbers() {
    let mesh = jittered_box(CellKind::Tet4, 3);
    let far = Point3::new(0.3, 0.0, 0.0);
    for basis in Basis::ALL {
        let mls = on_mesh(&mesh, 1.6, Kernel::CubicSpline(CubicSpline), basis);
        match mls.point_rows(&[Point3::new(0.01, 0.01, 0.01), far]) {
            Err(EfgError::TooFewNeighbours { point, found: 0, needed, enlargement }) => {
                assert_eq!((point, needed, enlargement), (far, basis.terms(), 3.0));
            }
            other => panic!("{other:?}"),
        }
        let nan = Point3::new(f64::NAN, 0.0, 0.0);
        assert!(mls.point_rows(&[nan]).is_err());
    }
}

/// Two planes of nodes determine the linear basis, but not the quadratic basis (no second difference across).
#[test]
fn two_planes_regularise_the_quadratic_block() {
    let nodes: Vec<Point3> = (0..72)
        .map(|i| Point3::new((i % 6) as f64 * 0.005, (i / 6 % 6) as f64 * 0.005, (i / 36) as f64 * 0.005))
        .collect();
    let mls =
        Approximation::new(nodes, vec![0.013; 72], Kernel::QuarticSpline(QuarticSpline), Basis::Quadratic)
            .unwrap();
    let points = [Point3::new(0.0121, 0.0133, 0.0022)];
    let (error, info) = linear_error(&mls, &points);
    assert_eq!((info.regularised, info.reduced), (1, 0), "{info:?}");
    assert!(error < 1e-8, "{error}"); // the linear part stays exact; a condition number of 1e7 costs digits
}

#[test]
fn one_plane_is_an_error() {
    let nodes: Vec<Point3> =
        (0..36).map(|i| Point3::new((i % 6) as f64 * 0.005, (i / 6) as f64 * 0.005, 0.001)).collect();
    for basis in Basis::ALL {
        let mls = Approximation::new(nodes.clone(), vec![0.013; 36], Kernel::CubicSpline(CubicSpline), basis)
            .unwrap();
        let error = mls.grad_rows(&[Point3::new(0.012, 0.013, 0.001)]).unwrap_err();
        assert!(matches!(error, EfgError::SingularMoment { found: 20.., .. }), "{error}");
        assert!(error.to_string().contains("one plane"), "{error}");
    }
}

/// Moving least squares tolerate duplicate nodes: the pair shares the value of the single node.
#[test]
fn a_duplicate_node_shares_its_value() {
    let mesh = jittered_box(CellKind::Tet4, 3);
    let cloud = cloud_from_mesh(&mesh);
    let mut nodes = cloud.points.clone();
    nodes.push(nodes[40]);
    let radii: Vec<f64> = cloud.spacing.iter().chain([&cloud.spacing[40]]).map(|h| 1.6 * h).collect();
    let mls =
        Approximation::new(nodes.clone(), radii, Kernel::CubicSpline(CubicSpline), Basis::Linear).unwrap();
    let (rows, info) = mls.point_rows(&[nodes[40] + Vector3::repeat(0.001)]).unwrap();
    assert_eq!(info.fallbacks(), 0);
    let (list, values) = rows.rows().row(0);
    let value = |n: usize| values[list.iter().position(|&k| k as usize == n).unwrap()];
    assert_eq!(value(40), value(nodes.len() - 1));
    assert!(value(40) > 0.0);
    // The k-th neighbour rule finds a distance of zero and reports it.
    let radii = Support::Neighbours { count: 1, factor: 1.5 }.radii(&nodes, &[]);
    assert_eq!(radii, Err(EfgError::BadRadius { node: 40, radius: 0.0 }));
}

#[test]
fn support_rules_give_what_they_say() {
    let nodes: Vec<Point3> = (0..12).map(|i| Point3::new((i * i) as f64, 0.0, 0.0)).collect();
    let radii = Support::Neighbours { count: 2, factor: 1.5 }.radii(&nodes, &[]).unwrap();
    // Node at 4: others at 1, 0, 9, ...: the second nearest is 4 away. Node at 0: 4 away.
    assert_eq!((radii[2], radii[0]), (6.0, 6.0));
    let spacing: Vec<f64> = (0..12).map(|i| 1.0 + i as f64).collect();
    assert_eq!(Support::Dilatation { factor: 2.0 }.radii(&nodes, &spacing).unwrap()[3], 8.0);
    assert!(matches!(
        Support::Dilatation { factor: 2.0 }.radii(&nodes, &spacing[1..]),
        Err(EfgError::Length { found: 11, expected: 12, .. })
    ));
    for bad in [
        Support::Dilatation { factor: 0.0 },
        Support::Dilatation { factor: f64::NAN },
        Support::Neighbours { count: 0, factor: 1.2 },
        Support::Neighbours { count: 12, factor: 1.2 },
    ] {
        assert!(bad.radii(&nodes, &spacing).is_err(), "{bad:?}");
    }
}

#[test]
fn bad_clouds_are_refused() {
    let nodes = vec![Point3::origin(); 8];
    let make = |n: usize, radii: Vec<f64>, basis| {
        Approximation::new(nodes[..n].to_vec(), radii, Kernel::CubicSpline(CubicSpline), basis).err()
    };
    assert_eq!(make(3, vec![1.0; 3], Basis::Linear), Some(EfgError::TooFewNodes { found: 3, needed: 4 }));
    assert_eq!(make(8, vec![1.0; 8], Basis::Quadratic), Some(EfgError::TooFewNodes { found: 8, needed: 10 }));
    assert!(matches!(make(8, vec![1.0; 7], Basis::Linear), Some(EfgError::Length { .. })));
    assert!(matches!(make(8, vec![f64::NAN; 8], Basis::Linear), Some(EfgError::BadRadius { node: 0, .. })));
    let mut bad = nodes.clone();
    bad[5].y = f64::INFINITY;
    let made = Approximation::new(bad, vec![1.0; 8], Kernel::CubicSpline(CubicSpline), Basis::Linear).err();
    assert_eq!(made, Some(EfgError::NotFinite { node: 5 }));
}
