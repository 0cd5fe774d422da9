//! Helpers of the cross-crate tests: a jittered box, an affine field and measures of error.

#![allow(dead_code)] // each test file uses only a part

use geometry::generate::{Jitter, box_mesh};
use geometry::{CellKind, Mesh};
use material::LinearElastic;
use shape::{Matrix3, Point3, Vector3};

/// Names of the facet groups of a box.
pub const SIDES: [&str; 6] = ["x-min", "x-max", "y-min", "y-max", "z-min", "z-max"];

/// A box of 40 x 30 x 20 mm away from the origin, with `n` cells along the shortest side and inner nodes
/// jittered by a fifth of the spacing.
pub fn jittered_box(kind: CellKind, n: usize) -> Mesh {
    let low = Point3::new(0.01, -0.02, 0.005);
    let jitter = Some(Jitter { fraction: 0.2, seed: 11 });
    let high = low + Vector3::new(0.04, 0.03, 0.02);
    box_mesh(kind, low, high, [2 * n, (3 * n).div_ceil(2), n], [1.0; 3], jitter).unwrap()
}

/// Soft tissue: E = 20 kPa.
pub fn tissue(poisson: f64) -> LinearElastic {
    LinearElastic::new(20e3, poisson).unwrap()
}

/// A full displacement gradient of about 5 %, rotation included.
pub fn gradient() -> Matrix3 {
    Matrix3::new(0.03, -0.02, 0.01, 0.025, -0.04, 0.015, -0.005, 0.02, 0.035)
}

/// The affine field of [`gradient`], with a translation of a few tenths of a millimetre, m.
pub fn affine(x: &Point3) -> Vector3 {
    gradient() * x.coords + Vector3::new(3e-4, -2e-4, 1e-4)
}

/// Returns the largest difference, relative to the largest exact value.
pub fn relative_error(found: &[Vector3], exact: &[Vector3]) -> f64 {
    assert_eq!(found.len(), exact.len());
    let largest = exact.iter().map(|u| u.norm()).fold(0.0, f64::max);
    found.iter().zip(exact).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) / largest
}

/// Returns the largest difference of stresses from a constant stress, relative to this stress.
pub fn stress_error(found: &[Matrix3], exact: &Matrix3) -> f64 {
    found.iter().map(|s| (s - exact).norm()).fold(0.0, f64::max) / exact.norm()
}

/// Constrains six parameters of a box to the values of a field, which suppresses exactly the rigid motions: a
/// corner along x, y, z, the next corner along x in y and z, and the next corner along y in z.
pub fn six_holds(mesh: &Mesh, field: impl Fn(&Point3) -> Vector3) -> Vec<shape::FixedDof> {
    let corner = |sides: [&str; 3]| {
        let on = |side: &str| mesh.facet_group_nodes(mesh.group(side).unwrap());
        let [a, b, c] = sides.map(on);
        *a.iter().find(|n| b.contains(n) && c.contains(n)).unwrap()
    };
    let hold = |node: u32, axis: u8| {
        let value = field(&mesh.points()[node as usize])[axis as usize];
        shape::FixedDof { node, axis, value }
    };
    let origin = corner(["x-min", "y-min", "z-min"]);
    let along_x = corner(["x-max", "y-min", "z-min"]);
    let along_y = corner(["x-min", "y-max", "z-min"]);
    vec![
        hold(origin, 0),
        hold(origin, 1),
        hold(origin, 2),
        hold(along_x, 1),
        hold(along_x, 2),
        hold(along_y, 2),
    ]
}
