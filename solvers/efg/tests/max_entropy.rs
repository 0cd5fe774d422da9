//! Maximum-entropy functions: convexity, and refused points and parameters.

mod common;

use common::{field, jittered_box};
use geometry::{CellKind, Cloud, Mesh, cloud_from_mesh};
use proptest::prelude::*;
use shape::{GradRows, Point3, Vector3};
use tissuebench_efg::{Approximation, Basis, EfgError};

const SPACING: f64 = 0.0075;
const GAMMAS: [f64; 4] = [0.8, 1.2, 1.8, 4.0];

fn mesh() -> &'static Mesh {
    static MESH: std::sync::OnceLock<Mesh> = std::sync::OnceLock::new();
    MESH.get_or_init(|| jittered_box(CellKind::Tet4, 4))
}

fn functions(gamma: f64) -> Approximation {
    let Cloud { points, spacing, .. } = cloud_from_mesh(mesh());
    Approximation::maximum_entropy(points, &spacing, gamma).unwrap()
}

/// Checks that values are positive and sum to one, and that linear fields are reproduced to rounding with
/// their gradients. The tolerance of gradients is multiplied by `slack`, for points on faces.
fn check(rows: &GradRows, nodes: &[Point3], slack: f64) {
    for (q, x) in rows.points().iter().enumerate() {
        let (list, grads) = rows.row(q);
        let values = rows.rows().row(q).1;
        let (mut unity, mut drift, mut u, mut g) = (0.0, Vector3::zeros(), 0.0, Vector3::zeros());
        for ((&node, &p), grad) in list.iter().zip(values).zip(grads) {
            assert!(p >= 0.0, "{x}: {p:e}");
            unity += p;
            drift += grad;
            // The field minus its value at the point, which avoids cancellation.
            let v = field(Basis::Linear, &nodes[node as usize]).0 - field(Basis::Linear, x).0;
            u += p * v;
            g += grad * v;
        }
        assert!((unity - 1.0f64).abs() < 1e-14, "{x}: {unity}");
        assert!(u.abs() < 1e-12 * SPACING, "{x}: {u:e}");
        assert!(drift.norm() * SPACING < 1e-12 * slack, "{x}: drift {:e}", drift.norm() * SPACING);
        let slope = field(Basis::Linear, x).1;
        assert!((g - slope).norm() < 1e-12 * slack, "{x}: slope {:e}", (g - slope).norm());
    }
}

fn inside() -> impl Strategy<Value = Point3> {
    (0.001..0.039, 0.001..0.029, 0.001..0.029).prop_map(|(x, y, z)| Point3::new(x, y, z))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn positive_and_exact_on_linear_fields(x in inside()) {
        for gamma in GAMMAS {
            let functions = functions(gamma);
            let (rows, info) = functions.grad_rows(&[x]).unwrap();
            prop_assert!(info.fallbacks() == 0 && info.neighbours_min >= 4, "{:?}", info);
            check(&rows, functions.nodes(), 10.0);
        }
    }

    #[test]
    fn gradients_are_those_of_the_values(x in inside(), axis in 0usize..3) {
        for gamma in GAMMAS {
            let functions = functions(gamma);
            let h = 1e-3 * SPACING;
            // At the boundary of a support, the value of a node jumps by up to 1e-6; a difference across the
            // jump is not a derivative.
            let rim = |n: usize| ((functions.nodes()[n] - x).norm() - functions.radius(n)).abs() < 2.5 * h;
            if (0..functions.nodes().len()).any(rim) {
                continue;
            }
            let shifted = |t: f64| { let mut p = x; p[axis] += t * h; p };
            let points = [x, shifted(1.0), shifted(-1.0), shifted(2.0), shifted(-2.0)];
            let (rows, _) = functions.grad_rows(&points).unwrap();
            let list = rows.row(0).0;
            prop_assert!((1..5).all(|q| rows.row(q).0 == list));
            let at = |q: usize, k: usize| rows.rows().row(q).1[k];
            let largest = rows.row(0).1.iter().map(|g| g.norm()).fold(0.0, f64::max);
            for k in 0..list.len() {
                let difference = (8.0 * (at(1, k) - at(2, k)) - at(3, k) + at(4, k)) / (12.0 * h);
                let grad = rows.row(0).1[k][axis];
                prop_assert!((difference - grad).abs() < 1e-6 * largest, "gamma {}: {} or {}", gamma, grad, difference);
            }
        }
    }
}

/// Returns a point of each face, edge and corner of the box.
fn boundary() -> Vec<Point3> {
    let along = |end: f64| [0.0, 0.37 * end, end];
    let mut points = Vec::new();
    for x in along(0.04) {
        for y in along(0.03) {
            for z in along(0.03) {
                points.push(Point3::new(x, y, z));
            }
        }
    }
    points.retain(|p| (0..3).any(|a| p[a] == 0.0 || p[a] == [0.04, 0.03, 0.03][a]));
    assert_eq!(points.len(), 26);
    points
}

/// On a face of the box inner nodes have zero weight; on an edge or corner only the nodes of the edge or
/// corner have weight.
#[test]
fn inner_nodes_vanish_on_faces() {
    // The rotated box has no exact coordinates.
    let turn = nalgebra::Rotation3::from_euler_angles(0.3, -0.7, 1.1);
    for (turn, slack) in [(nalgebra::Rotation3::identity(), 1e-15), (turn, 1e-11)] {
        for gamma in GAMMAS {
            let cloud = cloud_from_mesh(mesh());
            let nodes: Vec<Point3> = cloud.points.iter().map(|p| turn * p).collect();
            let functions = Approximation::maximum_entropy(nodes, &cloud.spacing, gamma).unwrap();
            let points: Vec<Point3> = boundary().iter().map(|p| turn * p).collect();
            let (rows, _) = functions.grad_rows(&points).unwrap();
            assert!(functions.point_rows(&points).unwrap().1.condition_max < 1e9);
            for (q, x) in boundary().iter().enumerate() {
                for (&node, &p) in rows.rows().row(q).0.iter().zip(rows.rows().row(q).1) {
                    let y = cloud.points[node as usize];
                    let on = |a: usize, end: f64| (x[a] == end) && (y[a] - end).abs() > 1e-12;
                    let off = (0..3).any(|a| on(a, 0.0) || on(a, [0.04, 0.03, 0.03][a]));
                    assert!(!off || p < slack, "gamma {gamma} at {x}: node {y} has {p:e}");
                }
            }
            // One-sided gradients of linear fields are accurate up to the condition number of J, 1e6.
            check(&rows, functions.nodes(), 1e6);
        }
    }
}

/// The value on a face is the limit of values close to the face.
#[test]
fn values_are_continuous_up_to_faces() {
    let functions = functions(1.8);
    for x in boundary() {
        let centre = Point3::new(0.02, 0.015, 0.015);
        let near = x + (centre - x) * 1e-7;
        let (rows, _) = functions.point_rows(&[x, near]).unwrap();
        let dense = |q: usize| {
            let mut all = vec![0.0; functions.nodes().len()];
            let (nodes, values) = rows.rows().row(q);
            nodes.iter().zip(values).for_each(|(&n, v)| all[n as usize] = *v);
            all
        };
        let gap = dense(0).iter().zip(dense(1)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(gap < 2e-6, "{x}: {gap:e}");
    }
}

#[test]
fn a_point_outside_the_hull_is_refused_by_name() {
    let functions = functions(1.8);
    for x in
        [Point3::new(-1e-4, 0.01, 0.01), Point3::new(0.041, 0.031, 0.02), Point3::new(0.02, 0.015, 0.0301)]
    {
        let refused = functions.grad_rows(&[Point3::new(0.02, 0.015, 0.015), x]).unwrap_err();
        let EfgError::OutsideHull { point, found, gap, .. } = &refused else { panic!("{refused}") };
        assert!(*point == x && *found > 4 && *gap > 9e-5 && *gap < 5e-3, "{refused}");
        assert!(refused.to_string().contains("outside the convex hull"), "{refused}");
    }
    // A point far from all nodes.
    let far = functions.point_rows(&[Point3::new(1.0, 1.0, 1.0)]).unwrap_err();
    assert!(matches!(far, EfgError::OutsideHull { found: 0, .. }), "{far}");
    for gamma in [0.0, -1.0, f64::NAN] {
        let refused = Approximation::maximum_entropy(functions.nodes().to_vec(), &[1e-3; 150], gamma).err();
        assert!(matches!(refused, Some(EfgError::BadParameter { what: "gamma", .. })), "{refused:?}");
    }
}

#[test]
fn same_bits_at_any_thread_count() {
    let functions = functions(1.8);
    let points: Vec<Point3> =
        mesh().points().iter().flat_map(|p| [*p, p + (Point3::new(0.02, 0.015, 0.015) - p) * 0.3]).collect();
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| functions.grad_rows(&points).unwrap())
    };
    let one = run(1);
    assert!(points.len() > 256, "several chunks");
    assert!(run(3) == one);
}
