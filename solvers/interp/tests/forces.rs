//! Forces transferred back by the transpose of a table.

use geometry::generate::{Jitter, box_mesh};
use geometry::{CellKind, Mesh};
use nalgebra::Vector3;
use shape::{Point3, Rows};
use tissuebench_interp::{InverseDistance, NaturalNeighbour, Radial, Scheme};

fn mesh() -> Mesh {
    let jitter = Some(Jitter { fraction: 0.2, seed: 7 });
    let (low, high) = (Point3::origin(), Point3::new(0.04, 0.03, 0.02));
    box_mesh(CellKind::Tet4, low, high, [6, 5, 4], [1.0; 3], jitter).unwrap()
}

/// Returns targets inside the box, and forces of 1 N in various directions.
fn forces() -> (Vec<Point3>, Vec<Vector3<f64>>) {
    let part = |t: f64| t.abs().fract();
    (0..200)
        .map(|i| {
            let t = i as f64 + 0.3;
            let x = Point3::new(
                0.04 * part(t * 0.754_877),
                0.03 * part(t * 0.569_840),
                0.02 * part(t * t * 0.317),
            );
            (x, Vector3::new((1.7 * t).sin(), 0.3 + (2.9 * t).cos(), (0.7 * t).sin()).normalize())
        })
        .unzip()
}

fn rows(scheme: Scheme, mesh: &Mesh, targets: &[Point3]) -> Rows {
    scheme.rows(mesh.points(), Some(mesh), targets).unwrap().0.rows().clone()
}

fn schemes() -> impl Iterator<Item = Scheme> {
    let bare = [
        Scheme::Radial(Radial::Gaussian { shape: 1.0, polynomial: false }),
        Scheme::Radial(Radial::WendlandC2 { support: 2.0, polynomial: false }),
    ];
    Scheme::all().chain(bare)
}

/// The force is preserved by schemes that reproduce constants, the moment by schemes that reproduce
/// rotations; other schemes lose them.
#[test]
fn force_and_moment_are_kept_as_promised() {
    let mesh = mesh();
    let (targets, forces) = forces();
    let moment = |points: &[Point3], forces: &[Vector3<f64>]| -> Vector3<f64> {
        points.iter().zip(forces).map(|(x, f)| x.coords.cross(f)).sum()
    };
    let force = forces.iter().sum::<Vector3<f64>>();
    let turn = moment(&targets, &forces);
    let arm = 0.05 * forces.len() as f64;
    for scheme in schemes() {
        let nodal = rows(scheme, &mesh, &targets).apply_transposed(&forces);
        let lost = (nodal.iter().sum::<Vector3<f64>>() - force).norm() / forces.len() as f64;
        let turned = (moment(mesh.points(), &nodal) - turn).norm() / arm;
        assert_eq!(lost < 1e-13, scheme.exact_degree() >= Some(0), "{scheme:?}: force {lost:e}");
        assert_eq!(turned < 1e-13, scheme.exact_degree() >= Some(1), "{scheme:?}: moment {turned:e}");
    }
}

/// The published scheme loses moment: the nodal forces of a pure couple have a different moment.
#[test]
fn inverse_distance_loses_moment() {
    let mesh = mesh();
    let targets = [Point3::new(0.011, 0.013, 0.012), Point3::new(0.013, 0.013, 0.012)];
    let forces = [Vector3::y(), -Vector3::y()];
    let lost = |scheme: Scheme| {
        let nodal = rows(scheme, &mesh, &targets).apply_transposed(&forces);
        let moment: Vector3<f64> = mesh.points().iter().zip(&nodal).map(|(x, f)| x.coords.cross(f)).sum();
        (moment.z + 2e-3).abs() / 2e-3
    };
    let published = lost(Scheme::InverseDistance(InverseDistance { neighbours: 4, power: 2.0 }));
    // The error is 3 % of the couple.
    assert!(published > 0.01, "{published}");
    assert!(lost(Scheme::NaturalNeighbour(NaturalNeighbour)) < 1e-12);
}

#[test]
fn forces_do_the_work_of_the_displacements_they_meet() {
    let mesh = mesh();
    let (targets, forces) = forces();
    let u: Vec<Vector3<f64>> =
        mesh.points().iter().map(|x| Vector3::new(x.y, (90.0 * x.x).sin(), x.z * x.x)).collect();
    let work = |f: &[Vector3<f64>], u: &[Vector3<f64>]| f.iter().zip(u).map(|(f, u)| f.dot(u)).sum::<f64>();
    for scheme in schemes() {
        let rows = rows(scheme, &mesh, &targets);
        let (there, here) = (work(&forces, &rows.apply(&u)), work(&rows.apply_transposed(&forces), &u));
        assert!((there - here).abs() < 1e-13 * forces.len() as f64, "{scheme:?}: {there} {here}");
    }
}
