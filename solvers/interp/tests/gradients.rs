//! Gradients of transferred fields: strain and stress at the targets.

use geometry::generate::{Jitter, box_mesh};
use geometry::{CellKind, Mesh};
use nalgebra::{Matrix3, Vector3};
use shape::{GradRows, Point3};
use tissuebench_interp::{InterpError, Radial, Scheme};

fn mesh() -> Mesh {
    let jitter = Some(Jitter { fraction: 0.2, seed: 7 });
    let (low, high) = (Point3::origin(), Point3::new(0.04, 0.03, 0.02));
    box_mesh(CellKind::Tet4, low, high, [6, 5, 4], [1.0; 3], jitter).unwrap()
}

fn targets(mesh: &Mesh) -> Vec<Point3> {
    let inner = |i: usize| {
        let part = |c: f64| (i as f64 * c + 0.1).fract();
        Point3::new(0.04 * part(0.754_877), 0.03 * part(0.569_84), 0.02 * part(0.317_8))
    };
    // Some targets are nodes, which are the centres of radial functions.
    (0..40).map(inner).chain(mesh.points().iter().copied().step_by(17)).collect()
}

fn bare() -> [Scheme; 2] {
    [
        Scheme::Radial(Radial::Gaussian { shape: 1.0, polynomial: false }),
        Scheme::Radial(Radial::WendlandC2 { support: 2.0, polynomial: false }),
    ]
}

/// Returns every scheme that has gradients, with its table.
fn tables(mesh: &Mesh, targets: &[Point3]) -> Vec<(Scheme, GradRows)> {
    let table = |scheme: Scheme| match scheme.grad_rows(mesh.points(), Some(mesh), targets) {
        Ok((rows, _)) => Some((scheme, rows)),
        Err(InterpError::NoGradient { scheme: name }) => {
            assert_eq!(name, scheme.name());
            None
        }
        Err(error) => panic!("{scheme:?}: {error}"),
    };
    Scheme::all().chain(bare()).filter_map(table).collect()
}

#[test]
fn schemes_without_gradients_say_so() {
    let mesh = mesh();
    let with: Vec<&str> = tables(&mesh, &targets(&mesh)).iter().map(|(scheme, _)| scheme.name()).collect();
    let without: Vec<&str> = Scheme::all().map(|s| s.name()).filter(|name| !with.contains(name)).collect();
    assert_eq!(without, ["nearest", "inverse-distance", "shepard", "natural-neighbour"]);
}

#[test]
fn values_are_those_of_the_plain_table() {
    let mesh = mesh();
    let targets = targets(&mesh);
    for (scheme, table) in tables(&mesh, &targets) {
        let (plain, _) = scheme.rows(mesh.points(), Some(&mesh), &targets).unwrap();
        let gap = plain.rows().values().iter().zip(table.rows().values()).map(|(a, b)| (a - b).abs());
        assert!(gap.fold(0.0, f64::max) < 1e-14, "{scheme:?}");
        assert_eq!(plain.rows().nodes(), table.rows().nodes());
    }
}

#[test]
fn linear_and_quadratic_fields_have_their_gradients() {
    let mesh = mesh();
    let targets = targets(&mesh);
    let h = Matrix3::new(0.1, -0.2, 0.05, 0.3, 0.02, -0.1, 0.07, 0.2, -0.15);
    let bent = |x: &Point3| Vector3::new(x.x * x.y, -0.5 * (x.x * x.x), x.z * x.y) * 20.0;
    let slope = |x: &Point3| Matrix3::new(x.y, x.x, 0.0, -x.x, 0.0, 0.0, 0.0, x.z, x.y) * 20.0;
    for (scheme, table) in tables(&mesh, &targets) {
        let error = |field: &dyn Fn(&Point3) -> Vector3<f64>, exact: &dyn Fn(&Point3) -> Matrix3<f64>| {
            let nodal: Vec<_> = mesh.points().iter().map(field).collect();
            let found = table.displacement_gradients(&nodal);
            found.iter().zip(&targets).map(|(g, x)| (g - exact(x)).norm()).fold(0.0, f64::max)
        };
        let constant = error(&|_| Vector3::new(0.01, -0.02, 0.03), &|_| Matrix3::zeros());
        let linear = error(&|x| h * x.coords, &|_| h);
        let quadratic = error(&bent, &slope);
        // Strain is accurate to ten digits: values have errors of 1e-15 of the displacement, divided by a
        // spacing of a sixth of the extent, and the worst conditioned systems amplify them by about 1e3.
        let promised = scheme.exact_degree();
        assert_eq!(constant < 1e-10, promised >= Some(0), "{scheme:?}: constant {constant:e}");
        assert_eq!(linear < 1e-10, promised >= Some(1), "{scheme:?}: linear {linear:e}");
        assert_eq!(quadratic < 1e-10, promised >= Some(2), "{scheme:?}: quadratic {quadratic:e}");
    }
}

#[test]
fn gradients_are_those_of_differences() {
    let mesh = mesh();
    // No target is on the border of a tetrahedron, at which barycentric gradients jump.
    let targets = &targets(&mesh)[..40];
    let field =
        |x: &Point3| Vector3::new((90.0 * x.x).sin(), (70.0 * x.y).cos(), (80.0 * (x.z + x.x)).sin()) * 1e-2;
    let nodal: Vec<_> = mesh.points().iter().map(field).collect();
    let step = 1e-7;
    for (scheme, table) in tables(&mesh, targets) {
        let found = table.displacement_gradients(&nodal);
        let at = |shift: Vector3<f64>| {
            let moved: Vec<Point3> = targets.iter().map(|x| x + shift).collect();
            scheme.rows(mesh.points(), Some(&mesh), &moved).unwrap().0.rows().apply(&nodal)
        };
        for axis in 0..3 {
            let mut shift = Vector3::zeros();
            shift[axis] = step;
            let (up, down) = (at(shift), at(-shift));
            for (row, (up, down)) in up.iter().zip(&down).enumerate() {
                let gap = ((up - down) / (2.0 * step) - found[row].column(axis)).norm();
                // Differences of a field of 1e-2 over 2e-7 have a rounding error of 1e-8, and an error of
                // 1e-9 from curvature.
                assert!(gap < 1e-6, "{scheme:?} at {}: {gap:e}", targets[row]);
            }
        }
    }
}
