//! Hexahedra with one point, mean gradients and hourglass control.
//!
//! ```text
//! Source      Flanagan & Belytschko, Int. J. Numer. Meth. Engng 17 (1981) 679-706; Joldes, Wittek & Miller,
//!             Commun. Numer. Meth. Engng 24 (2008) 1315-1323.
//! Must hold   b_a V = dV/dx_a; affine fields of distorted cells are exact to 1e-12; a free cell has six modes
//!             without energy, and eighteen without hourglass control; an hourglass pattern of a cube has the
//!             energy of its stiffness, and a rotation none.
//! ```

mod common;

use common::*;
use fem::{FemError, SurfaceRule, VolumeRule};
use geometry::generate::box_mesh;
use geometry::{CellKind, Mesh, quality};
use nalgebra::DMatrix;
use shape::{FixedDof, HOURGLASS, HourglassModulus, Matrix3, Point3, Vector3, VolumeRows};
use statics::{LinearBody, LinearProblem, Load};

const COEFFICIENT: f64 = 0.05;

fn uniform_rows(mesh: &Mesh, coefficient: f64) -> Result<VolumeRows, FemError> {
    fem::uniform_rows(mesh, coefficient, HourglassModulus::PWave)
}

fn cube(edge: f64) -> Mesh {
    let max = Point3::new(edge, edge, edge);
    box_mesh(CellKind::Hex8, Point3::origin(), max, [1; 3], [1.0; 3], None).unwrap()
}

/// A single distorted cell.
fn distorted() -> Mesh {
    let shift = |x: &Point3| Point3::new(x.x + 0.3 * x.y * x.z, x.y - 0.2 * x.x * x.z, x.z + 0.4 * x.x * x.y);
    cube(1.0).moved(shift).unwrap()
}

#[test]
fn gradients_are_those_of_the_exact_volume() {
    let mesh = distorted();
    let rows = uniform_rows(&mesh, COEFFICIENT).unwrap();
    let fine = fem::volume_rows(&mesh, &VolumeRule::FINE).unwrap();
    let volume = |mesh: &Mesh| quality::volumes(mesh)[0];
    assert!((rows.weights()[0] - volume(&mesh)).abs() < 1e-14);
    assert!((fine.weights().iter().sum::<f64>() - volume(&mesh)).abs() < 1e-14);
    let (nodes, grads) = rows.row(0);
    // The volume is a polynomial of degree one in each coordinate of a node, so differences are exact.
    for (&node, grad) in nodes.iter().zip(grads) {
        for axis in 0..3 {
            let moved = |by: f64| {
                let mut points = mesh.points().to_vec();
                points[node as usize][axis] += by;
                volume(&Mesh::new(points, &[(CellKind::Hex8, mesh.cell(0).to_vec())]).unwrap())
            };
            let slope = (moved(0.05) - moved(-0.05)) / 0.1;
            assert!((slope - grad[axis] * rows.weights()[0]).abs() < 1e-14, "node {node}, axis {axis}");
        }
    }
}

/// Returns the errors of displacement, stress and strain energy of an affine field.
fn patch(mesh: &Mesh, rows: &VolumeRows, poisson: f64, by_traction: bool) -> [f64; 3] {
    let materials = [tissue(poisson)];
    let body =
        LinearBody { nodes: mesh.points(), volume: rows, materials: &materials, region: &[], dilation: None };
    let sigma = materials[0].stress(&gradient());
    let surface = fem::surface_rows(mesh, &mesh.boundary(), &SurfaceRule::STANDARD).unwrap();
    let (mut fixed, mut loads) = (six_holds(mesh, affine), Vec::new());
    if by_traction {
        loads.push(Load::Traction {
            surface: &surface,
            values: surface.normals().iter().map(|n| sigma * n).collect(),
        });
    } else {
        let all = mesh.facet_group_nodes(&mesh.boundary());
        let value = |node: u32, axis: u8| affine(&mesh.points()[node as usize])[usize::from(axis)];
        let hold = |node: u32| (0..3).map(move |axis| FixedDof { node, axis, value: value(node, axis) });
        fixed = all.into_iter().flat_map(hold).collect();
    }
    let problem = LinearProblem { body, loads: &loads, fixed: &fixed, constraints: &[], weak: &[] };
    let u = statics::assemble(&problem).unwrap().factor().unwrap().solve(1.0).unwrap().u;
    let exact: Vec<Vector3> = mesh.points().iter().map(affine).collect();
    let energy = rows.weights().iter().sum::<f64>() * materials[0].energy_density(&gradient());
    [
        relative_error(&u, &exact),
        stress_error(&statics::body_stress(&body, &u).unwrap(), &sigma),
        (statics::strain_energy(&body, &u).unwrap() / energy - 1.0).abs(),
    ]
}

#[test]
fn affine_fields_of_distorted_cells_are_exact() {
    let mesh = jittered_box(CellKind::Hex8, 3);
    let rows = uniform_rows(&mesh, COEFFICIENT).unwrap();
    for poisson in [0.0, 0.3, 0.495] {
        for by_traction in [false, true] {
            let errors = patch(&mesh, &rows, poisson, by_traction);
            // Six constraints and 100 times the bulk stiffness: rounding times the condition of the system.
            let limit = if by_traction && poisson > 0.4 { 1e-11 } else { 1e-12 };
            assert!(errors.iter().all(|e| *e < limit), "{poisson} {by_traction}: {errors:?}");
        }
    }
    // A constant stress leaves no force inside if the weighted gradients of each inner node sum to zero. The
    // gradients at the centre of the cells leave more than a thousandth.
    let centre = VolumeRule::STANDARD.with(CellKind::Hex8, 1).unwrap();
    let centre = fem::volume_rows(&mesh, &centre).unwrap();
    let boundary = mesh.facet_group_nodes(&mesh.boundary());
    let left = |rows: &VolumeRows| {
        let mut sums = vec![(Vector3::zeros(), 0.0); mesh.points().len()];
        for (q, w) in rows.weights().iter().enumerate() {
            let (nodes, grads) = rows.row(q);
            for (&node, grad) in nodes.iter().zip(grads) {
                let sum = &mut sums[node as usize];
                *sum = (sum.0 + *w * grad, sum.1 + w * grad.norm());
            }
        }
        let inner = (0..sums.len()).filter(|node| !boundary.contains(&(*node as u32)));
        inner.map(|node| sums[node].0.norm() / sums[node].1).fold(0.0, f64::max)
    };
    let (found, of_centre) = (left(&rows), left(&centre));
    assert!(found < 1e-14 && of_centre > 1e-3, "{found:e} {of_centre:e}");
}

fn stiffness(mesh: &Mesh, rows: &VolumeRows, poisson: f64) -> DMatrix<f64> {
    let materials = [tissue(poisson)];
    let body =
        LinearBody { nodes: mesh.points(), volume: rows, materials: &materials, region: &[], dilation: None };
    let fixed = six_holds(mesh, |_| Vector3::zeros());
    let problem = LinearProblem { body, loads: &[], fixed: &fixed, constraints: &[], weak: &[] };
    let assembled = statics::assemble(&problem).unwrap();
    let n = mesh.points().len();
    let mut dense = DMatrix::zeros(3 * n, 3 * n);
    for i in 0..n {
        let (columns, blocks) = assembled.stiffness().row(i);
        for (&j, block) in columns.iter().zip(blocks) {
            let (i, j) = (3 * i, 3 * j as usize);
            dense.fixed_view_mut::<3, 3>(j, i).copy_from(&block.transpose());
            dense.fixed_view_mut::<3, 3>(i, j).copy_from(block);
        }
    }
    dense
}

#[test]
fn a_free_body_has_six_modes_without_energy_and_eighteen_without_control() {
    let count = |mesh: &Mesh, coefficient: f64| {
        let rows = uniform_rows(mesh, coefficient).unwrap();
        let eigen = stiffness(mesh, &rows, 0.3).symmetric_eigenvalues();
        assert!(eigen.min() > -1e-13 * eigen.max(), "{}", eigen.min());
        eigen.iter().filter(|value| value.abs() < 1e-12 * eigen.max()).count()
    };
    let block = jittered_box(CellKind::Hex8, 2);
    for mesh in [cube(0.02), distorted(), block] {
        assert_eq!(count(&mesh, COEFFICIENT), 6);
    }
    assert_eq!((count(&cube(0.02), 0.0), count(&distorted(), 0.0)), (18, 18));
}

/// The stiffness against a pattern of length 1 is the coefficient times `V (lambda + 2 mu) sum |b|^2`, which
/// is at least the largest eigenvalue of the rest: three for a cube of edge h, `sum |b|^2 = 3 / (2 h^2)`.
#[test]
fn patterns_of_a_cube_have_their_energy_and_rotations_none() {
    let edge = 0.02;
    let mesh = cube(edge);
    let rows = uniform_rows(&mesh, COEFFICIENT).unwrap();
    let law = tissue(0.3);
    let modulus = law.lambda() + 2.0 * law.mu();
    let (nodes, size) = (mesh.cell(0), 1e-3);
    for base in HOURGLASS {
        for axis in 0..3 {
            let mut u = vec![Vector3::zeros(); 8];
            nodes.iter().zip(base).for_each(|(&node, sign)| u[node as usize][axis] = size * sign);
            // gamma . u = 8 size, and k = coefficient V (lambda + 2 mu) sum |b|^2 / 8.
            let k = COEFFICIENT * modulus * edge * 1.5 / 8.0;
            let expected = 0.5 * k * (8.0 * size).powi(2);
            let found = rows.hourglass_energy(|_| [law.lambda(), law.mu()], &u);
            assert!((found / expected - 1.0).abs() < 1e-13, "{found} {expected}");
            let shear = fem::uniform_rows(&mesh, COEFFICIENT, HourglassModulus::Shear).unwrap();
            let by_shear = shear.hourglass_energy(|_| [law.lambda(), law.mu()], &u);
            assert!((by_shear / expected - law.mu() / modulus).abs() < 1e-13);
            let materials = [law];
            let body = LinearBody {
                nodes: mesh.points(),
                volume: &rows,
                materials: &materials,
                region: &[],
                dilation: None,
            };
            let all = statics::strain_energy(&body, &u).unwrap();
            assert!((all / expected - 1.0).abs() < 1e-13, "the point sees a pattern: {all}");
        }
    }
    let largest = stiffness(&mesh, &uniform_rows(&mesh, 0.0).unwrap(), 0.3).symmetric_eigenvalues().max();
    assert!(largest <= modulus * edge * 1.5 && largest > 0.2 * modulus * edge * 1.5, "{largest}");
    // A turn by a quarter and a half, and a translation of a metre.
    let mesh = distorted();
    let rows = uniform_rows(&mesh, COEFFICIENT).unwrap();
    let turn = Matrix3::new(0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6);
    let turned: Vec<Vector3> =
        mesh.points().iter().map(|x| turn * x.coords - x.coords + Vector3::new(1.0, -2.0, 0.5)).collect();
    assert!(rows.hourglass_energy(|_| [law.lambda(), law.mu()], &turned) < 1e-28 * modulus);
}

#[test]
fn other_cells_and_coefficients_are_refused() {
    let tetrahedra = jittered_box(CellKind::Tet4, 1);
    let refused = uniform_rows(&tetrahedra, COEFFICIENT).unwrap_err().to_string();
    assert_eq!(
        refused,
        "there is no quadrature rule of 1 point with hourglass control for tet4; available: hex8"
    );
    assert!(uniform_rows(&cube(1.0), -0.1).is_err() && uniform_rows(&cube(1.0), f64::NAN).is_err());
}
