//! Error indicator of gradients: zero if recovery is exact, largest where gradients change most.

mod common;

use common::{jittered_box, on_mesh};
use geometry::CellKind;
use shape::{Point3, Vector3};
use tissuebench_efg::{Basis, CubicSpline, Kernel, gauss_rows, gradient_error};

fn errors(field: impl Fn(&Point3) -> Vector3, basis: Basis, dilatation: f64) -> (Vec<f64>, Vec<Point3>) {
    let mesh = jittered_box(CellKind::Tet4, 5);
    let mls = on_mesh(&mesh, dilatation, Kernel::CubicSpline(CubicSpline), basis);
    let (volume, _) = gauss_rows(&mls, &mesh, 4).unwrap();
    let u: Vec<Vector3> = mls.nodes().iter().map(field).collect();
    (gradient_error(&volume, &u, mls.nodes()), mls.nodes().to_vec())
}

#[test]
fn gradients_that_are_linear_are_recovered() {
    // A quadratic basis reproduces the gradients of a quadratic field, of order 1, exactly.
    let field = |p: &Point3| Vector3::new(20.0 * p.x * p.y, 10.0 * p.z * p.z, -15.0 * p.x * p.x);
    let (error, _) = errors(field, Basis::Quadratic, 2.2);
    assert!(error.iter().all(|e| *e < 1e-10), "{error:?}");
}

#[test]
fn the_error_is_largest_at_the_concentration() {
    // A bump with a width of 4 mm at a corner of the box.
    let field = |p: &Point3| Vector3::x() * 1e-3 * (-p.coords.norm_squared() / 4e-3f64.powi(2)).exp();
    let (error, nodes) = errors(field, Basis::Linear, 1.6);
    let worst = (0..nodes.len()).max_by(|&a, &b| error[a].total_cmp(&error[b])).unwrap();
    assert!(nodes[worst].coords.norm() < 0.01, "{}", nodes[worst]);
    // Gradients extend over one support, fits over a second, and their blend over a third: 45 mm in total,
    // but with small values at that distance.
    let far =
        (0..nodes.len()).filter(|&n| nodes[n].coords.norm() > 0.03).map(|n| error[n]).fold(0.0, f64::max);
    assert!(far < 1e-2 * error[worst], "{far:e} of {:e}", error[worst]);
}
