//! Supports do not extend across gaps of the body.

mod common;

use std::ops::Range;

use common::{field, on_mesh};
use geometry::generate::{ball_mesh, box_mesh, cylinder_mesh, kidney_mesh};
use geometry::{CellKind, Mesh, cloud_from_mesh};
use shape::{Point3, PointRows, Vector3, VolumeRows};
use tissuebench_efg::{
    Approximation, Basis, CubicSpline, Kernel, Smoothing, Support, gauss_rows, node_smoothed_rows,
    smoothed_rows, surface_rows,
};

const KERNEL: Kernel = Kernel::CubicSpline(CubicSpline);
const HALF: f64 = 0.02;

/// A block of 40 x 10 x 20 mm with a slit in the middle, from the top down to `tip`, bent by `bend`; lengths
/// in metres.
fn slit(tip: f64, width: f64, bend: f64) -> Mesh {
    let top = Point3::new(2.0 * HALF, 0.01, 0.02);
    let plain = box_mesh(CellKind::Tet4, Point3::origin(), top, [12, 3, 6], [1.0; 3], None).unwrap();
    let mut points = plain.points().to_vec();
    let mut other: Vec<u32> = (0..points.len() as u32).collect();
    for node in 0..plain.points().len() {
        let p = points[node];
        if (p.x - HALF).abs() < 1e-9 && p.z > tip + 1e-9 {
            other[node] = points.len() as u32;
            points.push(p + Vector3::new(0.5 * width, 0.0, 0.0));
            points[node].x -= 0.5 * width;
        }
    }
    for p in &mut points {
        p.x += bend * (1.0 - (p.x - HALF).abs() / HALF) * (std::f64::consts::PI * p.z / 0.02).sin();
    }
    let cell = |cell: usize| {
        let right = plain.cell_points(cell).map(|p| p.x).sum::<f64>() > 4.0 * HALF;
        let nodes = plain.cell(cell).iter().map(|&n| if right { other[n as usize] } else { n }).collect();
        (CellKind::Tet4, nodes)
    };
    Mesh::new(points, &(0..plain.cell_count()).map(cell).collect::<Vec<_>>()).unwrap()
}

/// Constructor of shape functions over the nodes of a mesh.
type Functions = fn(&Mesh) -> Approximation;

fn linear(mesh: &Mesh) -> Approximation {
    on_mesh(mesh, 1.6, KERNEL, Basis::Linear)
}

const ALL: [(&str, Basis, Functions); 5] = [
    ("linear", Basis::Linear, linear),
    ("quadratic", Basis::Quadratic, |mesh| on_mesh(mesh, 2.4, KERNEL, Basis::Quadratic)),
    ("ellipsoids", Basis::Linear, |mesh| {
        let supports = Support::Dilatation { factor: 1.8 }.ellipsoids(mesh).unwrap();
        Approximation::stretched(mesh.points().to_vec(), supports, KERNEL, Basis::Linear).unwrap()
    }),
    ("entropy", Basis::Linear, |mesh| {
        Approximation::maximum_entropy(mesh.points().to_vec(), &cloud_from_mesh(mesh).spacing, 1.8).unwrap()
    }),
    ("small supports", Basis::Linear, |mesh| on_mesh(mesh, 1.05, KERNEL, Basis::Linear)),
];

/// Whether a cell is on the left side of the slit.
fn is_left(mesh: &Mesh, cell: usize, middle: f64) -> bool {
    mesh.cell_points(cell).map(|p| p.x).sum::<f64>() < 4.0 * middle
}

#[test]
fn each_piece_has_its_own_linear_field() {
    for (name, _, functions) in ALL {
        for width in [0.0, 5e-4] {
            let mesh = slit(-1.0, width, 0.0);
            let middle = HALF;
            let mls = functions(&mesh).within(&mesh).unwrap();
            let left = |node: usize| {
                (0..mesh.cell_count())
                    .any(|c| mesh.cell(c).contains(&(node as u32)) && is_left(&mesh, c, middle))
            };
            let of = |left: bool, p: &Point3| if left { 3.0 * p.x - p.z } else { 1.0 - 2.0 * p.y };
            let at_nodes: Vec<f64> =
                (0..mesh.points().len()).map(|n| of(left(n), &mesh.points()[n])).collect();
            let (rows, _) = gauss_rows(&mls, &mesh, 4).unwrap();
            let worst = (0..rows.weights().len()).map(|q| {
                let (nodes, values) = rows.rows().row(q);
                let found: f64 = nodes.iter().zip(values).map(|(&n, v)| v * at_nodes[n as usize]).sum();
                (found - of(is_left(&mesh, q / 4, middle), &rows.points()[q])).abs()
            });
            let worst = worst.fold(0.0, f64::max);
            assert!(worst < 1e-9, "{name}, {width} m: {worst:e}");
        }
    }
}

#[test]
fn a_slit_parts_the_nodes_beside_it_and_not_those_around_its_end() {
    for (name, _, functions) in ALL {
        for bend in [0.0, 4e-3] {
            let mesh = slit(6.7e-3, 5e-4, bend);
            let middle = |z: f64| HALF + bend * (std::f64::consts::PI * z / 0.02).sin();
            let across = |mls: &Approximation, heights: Range<f64>| {
                let (rows, _) = gauss_rows(mls, &mesh, 1).unwrap();
                let mut most = 0.0f64;
                for (cell, x) in rows.points().iter().enumerate().filter(|(_, x)| heights.contains(&x.z)) {
                    let left = is_left(&mesh, cell, middle(x.z));
                    let (nodes, values) = rows.rows().row(cell);
                    let beyond = |&(&n, _): &(&u32, &f64)| {
                        let p = mesh.points()[n as usize];
                        (p.x < middle(p.z) - 1e-4) != left && (p.x - middle(p.z)).abs() > 1e-4
                    };
                    most = most.max(nodes.iter().zip(values).filter(beyond).map(|(_, v)| v.abs()).sum());
                }
                most
            };
            let glued = functions(&mesh);
            let cut = functions(&mesh).within(&mesh).unwrap();
            let above = 1.2e-2..2e-2;
            assert!(across(&glued, above.clone()) > 0.05, "{name}, {bend}");
            assert!(across(&cut, above.clone()) < 0.05, "{name}, {bend}: {}", across(&cut, above));
            let below = [&glued, &cut].map(|mls| across(mls, 0.0..3e-3));
            assert!(below[1] >= 0.5 * below[0], "{name}, {bend}: {below:?} below the end");
        }
    }
}

#[test]
fn fields_of_the_basis_are_reproduced_and_gradients_are_those_of_the_values() {
    let step = 1e-8;
    for (name, basis, functions) in ALL {
        let mesh = slit(6.7e-3, 5e-4, 3e-3);
        let mls = functions(&mesh).within(&mesh).unwrap();
        let (rows, info) = gauss_rows(&mls, &mesh, 4).unwrap();
        assert!(info.neighbours_min >= basis.terms(), "{name}");
        for q in 0..rows.weights().len() {
            let (nodes, values) = rows.rows().row(q);
            let grads = rows.at().row(q).1;
            let (mut value, mut grad) = (0.0, Vector3::zeros());
            for ((&n, v), g) in nodes.iter().zip(values).zip(grads) {
                let at = field(basis, &mesh.points()[n as usize]).0;
                (value, grad) = (value + v * at, grad + g * at);
            }
            let (exact, slope) = field(basis, &rows.points()[q]);
            assert!((value - exact).abs() < 1e-10 && (grad - slope).norm() < 1e-5, "{name} at {q}");
        }
        // Points around the end of the slit, at which detours are neither zero nor infinite.
        let near = |q: &usize| (rows.points()[*q] - Point3::new(HALF + 2.6e-3, 5e-3, 7.5e-3)).norm() < 4e-3;
        let some: Vec<usize> = (0..rows.weights().len()).filter(near).step_by(3).collect();
        assert!(some.len() > 20);
        for axis in 0..3 {
            let moved = |by: f64| -> PointRows {
                let by = Vector3::ith(axis, by);
                let points: Vec<Point3> = some.iter().map(|&q| rows.points()[q] + by).collect();
                mls.point_rows(&points).unwrap().0
            };
            let ahead = moved(step);
            let behind = moved(-step);
            for (k, &q) in some.iter().enumerate() {
                let (nodes, grads) = rows.at().row(q);
                let of = |rows: &PointRows, node: u32| {
                    let (nodes, values) = rows.rows().row(k);
                    nodes.binary_search(&node).map_or(0.0, |at| values[at])
                };
                for (&n, g) in nodes.iter().zip(grads).filter(|_| mls_is_smooth(name, basis)) {
                    let slope = (of(&ahead, n) - of(&behind, n)) / (2.0 * step);
                    // Diffuse derivatives keep the basis fixed. The error is a fraction of the largest
                    // gradient, 300 / m.
                    assert!((slope - g[axis]).abs() < 1.0, "{name} at {q}: {slope} {}", g[axis]);
                }
            }
        }
    }
}

/// Whether values along lines are differentiable, i.e. no point of the line needs a fallback.
fn mls_is_smooth(name: &str, basis: Basis) -> bool {
    basis == Basis::Linear && name != "small supports"
}

type Rule = fn(&Approximation, &Mesh) -> VolumeRows;

#[test]
fn conforming_rules_balance_over_a_body_with_a_slit() {
    let rules: [(&str, Rule); 4] = [
        ("constant", |mls, mesh| smoothed_rows(mls, mesh, Smoothing::Constant, 3).unwrap().0),
        ("linear", |mls, mesh| smoothed_rows(mls, mesh, Smoothing::Linear, 3).unwrap().0),
        ("nodal", |mls, mesh| node_smoothed_rows(mls, mesh, 0.0, 3).unwrap().0),
        ("nodal, stabilised", |mls, mesh| node_smoothed_rows(mls, mesh, 0.05, 3).unwrap().0),
    ];
    for width in [0.0, 5e-4] {
        let mesh = slit(6.7e-3, width, 0.0);
        let bottom = mesh.boundary().into_iter();
        let bottom = bottom.filter(|&f| mesh.facet_nodes(f).all(|n| mesh.points()[n as usize].z < 1e-9));
        let constrained = mesh.facet_group_nodes(&bottom.collect::<Vec<_>>());
        let cut = |functions: Functions| functions(&mesh).within(&mesh).unwrap();
        let coupled = cut(linear).coupled(&mesh, &constrained).unwrap();
        let plain = ALL.into_iter().map(|(name, _, functions)| (name, cut(functions)));
        for (kind, mls) in plain.chain([("coupled", coupled)]) {
            for (name, rule) in rules {
                let volume = rule(&mls, &mesh);
                let mut sums = vec![Vector3::zeros(); mls.nodes().len()];
                for (q, w) in volume.weights().iter().enumerate() {
                    let (nodes, grads) = volume.at().row(q);
                    nodes.iter().zip(grads).for_each(|(&n, g)| sums[n as usize] += g * *w);
                }
                let (surface, _) = surface_rows(&mls, &mesh, &mesh.boundary(), 3).unwrap();
                for (q, (w, normal)) in surface.weights().iter().zip(surface.normals()).enumerate() {
                    let (nodes, values) = surface.rows().row(q);
                    nodes.iter().zip(values).for_each(|(&n, v)| sums[n as usize] -= normal * (w * v));
                }
                let worst = sums.iter().map(|s| s.norm()).fold(0.0, f64::max);
                // Compared with areas of 1e-5 m^2 per node.
                assert!(worst < 1e-17, "{kind}, {name}, {width} m: {worst:e}");
            }
        }
    }
}

#[test]
fn bodies_without_gaps_keep_their_bits() {
    let corner = Point3::new(0.04, 0.03, 0.03);
    let tet4 = CellKind::Tet4;
    let bodies = [
        ("box", box_mesh(tet4, Point3::origin(), corner, [4, 3, 3], [1.0; 3], None).unwrap()),
        ("ball", ball_mesh(tet4, 0.02, 4).unwrap()),
        ("cylinder", cylinder_mesh(tet4, 0.01, 0.03, [3, 6], 1.0).unwrap()),
        ("kidney", kidney_mesh(tet4, 4).unwrap()),
    ];
    for (body, mesh) in &bodies {
        for (name, _, functions) in ALL {
            let plain = functions(mesh);
            let within = functions(mesh).within(mesh).unwrap();
            let rows = |mls: &Approximation| gauss_rows(mls, mesh, 1).map(|(rows, _)| rows);
            assert_eq!(rows(&plain), rows(&within), "{body}, {name}");
        }
    }
}
