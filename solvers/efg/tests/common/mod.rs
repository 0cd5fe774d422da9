//! Clouds and backgrounds shared by the tests.
#![allow(dead_code)] // each test file uses its own part

use geometry::generate::{Jitter, box_mesh};
use geometry::{CellKind, Cloud, Mesh, cloud_from_mesh};
use shape::{Point3, Vector3};
use tissuebench_efg::{Approximation, Basis, Kernel, Support};

/// A box of 40 x 30 x 30 mm with `n` cells along the short sides; the inner nodes of tet4 are jittered by a
/// fifth of the spacing.
pub fn jittered_box(kind: CellKind, n: usize) -> Mesh {
    let jitter = (kind == CellKind::Tet4).then_some(Jitter { fraction: 0.2, seed: 7 });
    let max = Point3::new(0.04, 0.03, 0.03);
    box_mesh(kind, Point3::origin(), max, [n + 1, n, n], [1.0; 3], jitter).unwrap()
}

/// Returns a support scale at which the basis is well determined everywhere.
pub fn dilatation(basis: Basis) -> f64 {
    match basis {
        Basis::Linear => 1.6,
        Basis::Quadratic => 2.2,
    }
}

pub fn on_cloud(cloud: &Cloud, factor: f64, kernel: Kernel, basis: Basis) -> Approximation {
    let radii = Support::Dilatation { factor }.radii(&cloud.points, &cloud.spacing).unwrap();
    Approximation::new(cloud.points.clone(), radii, kernel, basis).unwrap()
}

pub fn on_mesh(mesh: &Mesh, factor: f64, kernel: Kernel, basis: Basis) -> Approximation {
    on_cloud(&cloud_from_mesh(mesh), factor, kernel, basis)
}

/// A quadratic field (m) with coefficients of order one over the 40 mm box, and its gradient.
pub fn field(basis: Basis, p: &Point3) -> (f64, Vector3) {
    let (x, y, z) = (p.x, p.y, p.z);
    let bend = if basis == Basis::Quadratic { 20.0 } else { 0.0 };
    (
        0.01 + 0.7 * x - 0.4 * y + 0.3 * z + bend * (x * x - y * z + 0.5 * x * z),
        Vector3::new(0.7 + bend * (2.0 * x + 0.5 * z), -0.4 - bend * z, 0.3 + bend * (0.5 * x - y)),
    )
}

/// Every kernel with every basis.
pub fn members() -> impl Iterator<Item = (Kernel, Basis)> {
    Kernel::all().flat_map(|kernel| Basis::ALL.map(|basis| (kernel, basis)))
}
