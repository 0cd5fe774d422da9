//! Conforming integration rules against their definition: Gauss's theorem over every cell and over the whole
//! body, for jittered cells, in other units and far from the origin.

mod common;

use common::{dilatation, jittered_box, on_mesh};
use geometry::{CellKind, Facet, Mesh};
use shape::{Point3, SurfaceRows, Vector3, VolumeRows};
use tissuebench_efg::{
    Approximation, Basis, CubicSpline, Kernel, Smoothing, WendlandC2, node_smoothed_rows, smoothed_rows,
    surface_rows,
};

/// The box of the other tests, the same box in millimetres, and the same box a metre away.
fn boxes() -> impl Iterator<Item = (&'static str, Mesh)> {
    let places = [("in metres", 1.0, 0.0), ("in millimetres", 1e3, 0.0), ("a metre away", 1.0, 1.0)];
    places.into_iter().map(|(name, scale, shift)| {
        let mesh = jittered_box(CellKind::Tet4, 3);
        (name, mesh.moved(|p| p * scale + Vector3::repeat(shift)).unwrap())
    })
}

/// Returns `sum_s w phi_I n q(x)` for every node.
fn outflow(surface: &SurfaceRows, nodes: usize, q: impl Fn(&Point3) -> f64) -> Vec<Vector3> {
    let mut sums = vec![Vector3::zeros(); nodes];
    for (s, x) in surface.points().iter().enumerate() {
        let flow = surface.normals()[s] * (surface.weights()[s] * q(x));
        let (nodes, values) = surface.rows().row(s);
        nodes.iter().zip(values).for_each(|(&n, v)| sums[n as usize] += flow * *v);
    }
    sums
}

/// Adds `w (grad~_I q + phi_I grad q)` at a point.
fn add(sums: &mut [Vector3], volume: &VolumeRows, point: usize, q: f64, slope: Vector3) {
    let (nodes, grads) = volume.row(point);
    let values = volume.rows().row(point).1;
    for ((&n, grad), value) in nodes.iter().zip(grads).zip(values) {
        sums[n as usize] += (grad * q + slope * *value) * volume.weights()[point];
    }
}

/// Returns the largest difference over nodes, relative to the largest entry of `outer`.
fn violation(inner: &[Vector3], outer: &[Vector3]) -> f64 {
    let largest = outer.iter().map(|v| v.norm()).fold(0.0, f64::max);
    inner.iter().zip(outer).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) / largest
}

/// Checks the four conditions that define consistent integration of second order, per cell, node and
/// direction: `sum_g w (phi_I,a q + phi_I q,a) = integral_faces phi_I q n_a` for q in {1, x, y, z}, in either
/// basis.
#[test]
fn linear_smoothing_meets_all_four_conditions_in_every_cell() {
    for (place, mesh) in boxes() {
        for basis in Basis::ALL {
            let mls = on_mesh(&mesh, dilatation(basis), Kernel::CubicSpline(CubicSpline), basis);
            let (volume, info) = smoothed_rows(&mls, &mesh, Smoothing::Linear, 6).unwrap();
            assert_eq!(info.fallbacks(), 0);
            let nodes = mls.nodes().len();
            let mut worst = 0.0f64;
            for cell in 0..mesh.cell_count() {
                let faces: [Facet; 4] = std::array::from_fn(|f| Facet { cell: cell as u32, face: f as u8 });
                let (surface, _) = surface_rows(&mls, &mesh, &faces, 6).unwrap();
                let origin = volume.points()[4 * cell];
                for axis in 0..4 {
                    let q = |x: &Point3| if axis == 3 { 1.0 } else { (x - origin)[axis] };
                    let slope = if axis == 3 { Vector3::zeros() } else { Vector3::ith(axis, 1.0) };
                    let mut inner = vec![Vector3::zeros(); nodes];
                    for g in 4 * cell..4 * (cell + 1) {
                        add(&mut inner, &volume, g, q(&volume.points()[g]), slope);
                    }
                    worst = worst.max(violation(&inner, &outflow(&surface, nodes, q)));
                }
            }
            // Positions a metre away are rounded by 1e-16 m; a cell is 1e-2 m wide.
            let bound = if place == "a metre away" { 1e-12 } else { 1e-14 };
            assert!(worst < bound, "{place}, {}: {worst:e}", basis.name());
        }
    }
}

type Rule = fn(&Approximation, &Mesh, usize) -> VolumeRows;

const RULES: [(&str, Rule); 4] = [
    ("constant", |mls, mesh, points| smoothed_rows(mls, mesh, Smoothing::Constant, points).unwrap().0),
    ("linear", |mls, mesh, points| smoothed_rows(mls, mesh, Smoothing::Linear, points).unwrap().0),
    ("nodal", |mls, mesh, points| node_smoothed_rows(mls, mesh, 0.0, points).unwrap().0),
    ("nodal, stabilised", |mls, mesh, points| node_smoothed_rows(mls, mesh, 0.05, points).unwrap().0),
];

/// Returns the difference between `sum_q w grad~_I` and `integral_surface phi_I n`, which linear patch tests
/// require to be equal.
fn imbalance(mls: &Approximation, mesh: &Mesh, volume: &VolumeRows, face_points: usize) -> f64 {
    let nodes = mls.nodes().len();
    let mut inner = vec![Vector3::zeros(); nodes];
    (0..volume.weights().len()).for_each(|q| add(&mut inner, volume, q, 1.0, Vector3::zeros()));
    let (surface, _) = surface_rows(mls, mesh, &mesh.boundary(), face_points).unwrap();
    violation(&inner, &outflow(&surface, nodes, |_| 1.0))
}

#[test]
fn every_conforming_rule_meets_the_constraint_over_the_whole_body() {
    for (place, mesh) in boxes() {
        for (basis, name, rule) in
            Basis::ALL.into_iter().flat_map(|b| RULES.map(|(name, rule)| (b, name, rule)))
        {
            let mls = on_mesh(&mesh, dilatation(basis), Kernel::WendlandC2(WendlandC2), basis);
            let volume = rule(&mls, &mesh, 6);
            let off = imbalance(&mls, &mesh, &volume, 6);
            assert!(off < 1e-13, "{place}, {name}, {}: {off:e}", basis.name());
            // Different points on the boundary violate the constraint.
            assert!(imbalance(&mls, &mesh, &volume, 3) > 1e-4, "{place}, {name}");
        }
    }
}

/// Coupled finite elements change the values at face points, which still serve both sides.
#[test]
fn clouds_coupled_to_finite_elements_meet_it_too() {
    for (place, mesh) in boxes() {
        let constrained = mesh.facet_group_nodes(mesh.group("x-min").unwrap());
        let mls = on_mesh(&mesh, 2.0, Kernel::WendlandC2(WendlandC2), Basis::Linear)
            .coupled(&mesh, &constrained)
            .unwrap();
        for (name, rule) in RULES {
            let volume = rule(&mls, &mesh, 6);
            let off = imbalance(&mls, &mesh, &volume, 6);
            assert!(off < 1e-13, "{place}, {name}: {off:e}");
        }
    }
}

/// The same body in other units and elsewhere has the same weights and gradients except for the unit.
#[test]
fn units_and_origin_do_not_matter() {
    let all: Vec<(&str, Mesh)> = boxes().collect();
    for (name, rule) in RULES {
        let rows = |mesh: &Mesh| {
            let mls = on_mesh(mesh, 1.6, Kernel::CubicSpline(CubicSpline), Basis::Linear);
            rule(&mls, mesh, 6)
        };
        let first = rows(&all[0].1);
        for (place, mesh) in &all[1..] {
            let scale: f64 = if *place == "in millimetres" { 1e3 } else { 1.0 };
            let other = rows(mesh);
            for q in 0..first.weights().len() {
                let weight = other.weights()[q] / scale.powi(3);
                assert!((weight / first.weights()[q] - 1.0).abs() < 1e-12, "{name} {place}: {weight:e}");
                // By rounding, the boundary of a support may pass on the other side of a point. Values are
                // therefore compared, not lists.
                let mut dense = vec![Vector3::zeros(); 80];
                first.row(q).0.iter().zip(first.row(q).1).for_each(|(&n, g)| dense[n as usize] += g);
                other.row(q).0.iter().zip(other.row(q).1).for_each(|(&n, g)| dense[n as usize] -= g * scale);
                let off = dense.iter().map(|g| g.norm()).fold(0.0, f64::max);
                assert!(off * 0.01 < 1e-11, "{name} {place}: {off:e}");
            }
        }
    }
}
