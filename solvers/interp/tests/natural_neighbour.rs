//! Natural neighbour interpolation, compared with volumes counted on a grid, and in degenerate geometries.

use geometry::{Kidney, cloud};
use nalgebra::{Rotation3, Vector3};
use shape::{Point3, PointRows};
use tissuebench_interp::{InterpError, TransferInfo, natural_neighbour};

fn lattice(n: usize) -> Vec<Point3> {
    let at = |i: usize| Point3::new((i % n) as f64, (i / n % n) as f64, (i / n / n) as f64) * 1e-3;
    (0..n * n * n).map(at).collect()
}

fn scattered(n: usize, shift: f64) -> Vec<Point3> {
    let part = |t: f64| t.abs().fract();
    (0..n)
        .map(|i| {
            let t = i as f64 + shift;
            Point3::new(part(t * 0.754_877_67), part(t * 0.569_840_29), part(t * t * 0.317_8)) * 1e-2
        })
        .collect()
}

/// Returns full rows, one after another.
fn dense(table: &PointRows) -> Vec<Vec<f64>> {
    let rows = table.rows();
    let row = |q: usize| {
        let mut full = vec![0.0; rows.node_count()];
        rows.row(q).0.iter().zip(rows.row(q).1).for_each(|(&node, value)| full[node as usize] += value);
        full
    };
    (0..rows.len()).map(row).collect()
}

/// Returns the largest difference between two tables.
fn gap(a: &PointRows, b: &PointRows) -> f64 {
    let pairs = dense(a).concat().into_iter().zip(dense(b).concat());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Returns the table, and checks that no target is outside and that there are no fallbacks.
fn sound(nodes: &[Point3], targets: &[Point3]) -> PointRows {
    let (rows, info) = natural_neighbour(nodes, targets).unwrap();
    assert_eq!(info, TransferInfo::default());
    rows
}

/// The volume that a point takes from each cell is the region closer to the point than to any node, divided
/// according to the nearest node. It is counted on a grid, without a mesh.
#[test]
fn coordinates_are_the_volumes_taken_from_voronoi_cells() {
    let nodes = scattered(60, 0.3);
    for target in [Point3::new(5e-3, 5.1e-3, 4.7e-3), Point3::new(3.4e-3, 6.2e-3, 5.5e-3)] {
        let row = &dense(&sound(&nodes, &[target]))[0];
        let n = 120;
        // The cells of both targets end within 5 mm.
        let step = 1e-2 / n as f64;
        let mut counted = vec![0.0; nodes.len()];
        for i in 0..n * n * n {
            let index = Vector3::new((i % n) as f64, (i / n % n) as f64, (i / n / n) as f64);
            let y = target + (index.add_scalar(0.5) * step).add_scalar(-5e-3);
            let nearest = nodes
                .iter()
                .map(|x| (x - y).norm_squared())
                .enumerate()
                .min_by(|a, b| a.1.total_cmp(&b.1))
                .unwrap();
            if (y - target).norm_squared() < nearest.1 {
                counted[nearest.0] += 1.0;
            }
        }
        let total: f64 = counted.iter().sum();
        assert!(total > 10_000.0, "{total}");
        for (node, (value, count)) in row.iter().zip(&counted).enumerate() {
            // A cell of 20 000 grid points is accurate to about 1e-3 because of its surface.
            assert!((value - count / total).abs() < 2e-3, "node {node}: {value} {}", count / total);
        }
    }
}

/// Symmetry: at the middle of an edge, a face and a cell of a lattice, all surrounding nodes lie on one
/// sphere.
#[test]
fn lattices_share_alike() {
    let nodes = lattice(4);
    let targets = [[1.5, 1.0, 2.0], [1.5, 1.5, 2.0], [1.5, 1.5, 1.5]].map(|x| Point3::from(x) * 1e-3);
    let rows = dense(&sound(&nodes, &targets));
    let nearest = |target: &Point3| {
        let squares: Vec<f64> = nodes.iter().map(|x| (x - target).norm_squared()).collect();
        let least = squares.iter().copied().fold(f64::INFINITY, f64::min);
        (0..nodes.len()).filter(move |&i| squares[i] < 1.01 * least).collect::<Vec<_>>()
    };
    for (row, target) in rows.iter().zip(&targets) {
        let close = nearest(target);
        let others: f64 = (0..nodes.len()).filter(|i| !close.contains(i)).map(|i| row[i].abs()).sum();
        for &node in &close {
            assert!((row[node] - row[close[0]]).abs() < 1e-13, "{target} {node}: {}", row[node]);
        }
        // In the middle of a cell no other node has a share; elsewhere surrounding nodes do.
        assert_eq!(others < 1e-13, close.len() == 8, "{target}: {others:e}");
    }
}

/// In a rotated lattice, rounding distinguishes the cospherical nodes, which form tetrahedra without volume.
#[test]
fn a_lattice_may_be_turned() {
    let nodes = lattice(5);
    // Targets on nodes, edges and faces and inside cells, on a lattice three times as fine, not on the hull.
    let inner = |i: usize| [i % 11, i / 11 % 11, i / 121].map(|k| (k + 1) as f64 / 3.0);
    let targets: Vec<Point3> = (0..1331).map(|i| Point3::from(inner(i)) * 1e-3).collect();
    let straight = sound(&nodes, &targets);
    for angles in [(0.3, 0.7, -0.4), (1.1, 0.2, 0.5)] {
        let turn = Rotation3::from_euler_angles(angles.0, angles.1, angles.2);
        let turned = |points: &[Point3]| points.iter().map(|p| turn * p).collect::<Vec<_>>();
        let rows = sound(&turned(&nodes), &turned(&targets));
        assert!(gap(&straight, &rows) < 1e-9, "{:e}", gap(&straight, &rows));
    }
}

/// The coordinates are the same on the hull and slightly to either side.
#[test]
fn coordinates_are_continuous_through_the_hull() {
    let nodes = lattice(4);
    let at =
        |z: f64| [Point3::new(1.3e-3, 1.6e-3, z), Point3::new(2e-3, 1.5e-3, z), Point3::new(0.0, 0.4e-3, z)];
    let (on, info) = natural_neighbour(&nodes, &at(0.0)).unwrap();
    assert_eq!(info, TransferInfo::default());
    for depth in [1e-12, 1e-10, 1e-8] {
        let (below, info) = natural_neighbour(&nodes, &at(depth)).unwrap();
        assert_eq!(info.outside, 0);
        let (beyond, info) = natural_neighbour(&nodes, &at(-depth)).unwrap();
        assert_eq!(info.outside, 3);
        let most = gap(&on, &below).max(gap(&on, &beyond));
        // The difference is proportional to the depth (the spacing is 1 mm), plus 1e-6 from moving the
        // targets inwards.
        assert!(most < 5e-6 + 10.0 * depth / 1e-3, "{depth:e}: {most:e}");
    }
    // Targets at the nodes of the hull.
    let (rows, info) = natural_neighbour(&nodes, &nodes).unwrap();
    assert_eq!(info, TransferInfo::default());
    assert!(rows.rows().values().iter().all(|&v| v == 1.0));
}

/// Half of the kidney's targets lie outside the hull of a cloud of 83 nodes, and linear fields are exact at
/// all of them.
#[test]
fn beyond_the_hull_linear_fields_go_on() {
    let nodes = cloud(&Kidney, 83, 1, &[]).unwrap().points;
    let targets = cloud(&Kidney, 1331, 2, &[]).unwrap().points;
    let (rows, info) = natural_neighbour(&nodes, &targets).unwrap();
    assert!((300..900).contains(&info.outside), "{info:?}");
    assert_eq!(info.fallbacks, 0);
    let field = |x: &Point3| Vector3::new(0.1 * x.x + 0.05 * x.y, 0.02 * x.z - 0.04, x.x - x.y + x.z);
    let nodal: Vec<_> = nodes.iter().map(field).collect();
    for (u, x) in rows.rows().apply(&nodal).iter().zip(&targets) {
        assert!((u - field(x)).norm() < 1e-13, "{x}: {:e}", (u - field(x)).norm());
    }
    let far = [Point3::new(0.3, 0.2, -0.4)];
    let (rows, info) = natural_neighbour(&nodes, &far).unwrap();
    assert_eq!(info.outside, 1);
    assert!((rows.rows().apply(&nodal)[0] - field(&far[0])).norm() < 1e-11);
    // Slopes across the hull are bounded: at a tenth of the extent beyond the hull, weights are at most 8.
    let beyond: Vec<Point3> = targets.iter().map(|x| Point3::from(x.coords * 1.1)).collect();
    let (rows, _) = natural_neighbour(&nodes, &beyond).unwrap();
    let largest = rows.rows().values().iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    assert!(largest < 10.0, "{largest}");
}

#[test]
fn almost_coincident_nodes_are_told_apart() {
    for distance in [1e-4, 1e-6, 1e-9, 1e-12, 1e-15] {
        let mut nodes = scattered(80, 0.3);
        nodes.push(nodes[17] + Vector3::new(0.6, -0.3, 0.5) * (1e-2 * distance));
        let targets: Vec<Point3> = scattered(40, 0.7)
            .iter()
            .map(|x| Point3::from(x.coords * 0.5).lerp(&Point3::new(5e-3, 5e-3, 5e-3), 0.5))
            .chain([nodes[17], nodes[80]])
            .collect();
        let (rows, info) = natural_neighbour(&nodes, &targets).unwrap();
        let field = |x: &Point3| 3.0 * x.coords;
        let carried = rows.rows().apply(&nodes.iter().map(field).collect::<Vec<_>>());
        for (u, x) in carried.iter().zip(&targets) {
            assert!((u - field(x)).norm() < 1e-15, "{distance:e} {x} {info:?}");
        }
        assert_eq!(info.fallbacks, 0, "{distance:e}");
    }
    let mut nodes = scattered(80, 0.3);
    nodes.push(nodes[17]);
    let error = natural_neighbour(&nodes, &nodes[..1]).unwrap_err();
    assert!(
        matches!(error, InterpError::CoincidentNodes { first: 17, second: 80, distance: 0.0, .. }),
        "{error}"
    );
}
