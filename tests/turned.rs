//! A body rotated as a whole, with its mesh, loads and supports, has the rotated displacement: no axis is
//! special to any element or cloud.

mod common;

use common::*;
use efg::{Approximation, Basis, CubicSpline, Kernel, Smoothing, Support};
use fem::{SurfaceRule, VolumeRule};
use geometry::{CellKind, Mesh, cloud_from_mesh};
use shape::{DilationGroups, FluxRows, SurfaceRows, TraceRows, VolumeRows};
use shape::{Matrix3, Point3, Vector3};
use statics::{LinearBody, LinearProblem, Load, Weak, WeakSupport};

/// Rotations by one degree about an oblique axis, by a third of a turn, and by nearly half a turn.
fn turns() -> impl Iterator<Item = Matrix3> {
    let axis = nalgebra::Unit::new_normalize(Vector3::new(0.3, -0.8, 0.5));
    [1f64, 120.0, 179.0]
        .into_iter()
        .map(move |degrees| nalgebra::Rotation3::from_axis_angle(&axis, degrees.to_radians()).into_inner())
}

/// Tables of a method on a mesh.
struct Tables {
    volume: VolumeRows,
    held: FluxRows,
    pulled: SurfaceRows,
    trace: Option<TraceRows>,
}

fn elements(mesh: &Mesh) -> Tables {
    let on = |side| mesh.group(side).unwrap();
    Tables {
        volume: fem::volume_rows(mesh, &VolumeRule::STANDARD).unwrap(),
        held: fem::flux_rows(mesh, on("x-min"), &SurfaceRule::STANDARD).unwrap(),
        pulled: fem::surface_rows(mesh, on("x-max"), &SurfaceRule::STANDARD).unwrap(),
        trace: None,
    }
}

fn cloud(mesh: &Mesh, functions: &Approximation, smoothed: bool) -> Tables {
    let on = |side| mesh.group(side).unwrap();
    let volume = if smoothed {
        efg::smoothed_rows(functions, mesh, Smoothing::Constant, 1)
    } else {
        efg::gauss_rows(functions, mesh, 4)
    };
    let trace = || efg::smoothed_trace(mesh, on("x-min"), Smoothing::Constant, 1).unwrap();
    Tables {
        volume: volume.unwrap().0,
        held: efg::flux_rows(functions, mesh, on("x-min"), 1).unwrap().0,
        pulled: efg::surface_rows(functions, mesh, on("x-max"), 3).unwrap().0,
        trace: smoothed.then(trace),
    }
}

/// Solves a body with an asymmetric field prescribed on one side and a traction on the other. Both are given
/// in the frame of the body, which `turn` rotates.
fn solve(mesh: &Mesh, tables: &Tables, dilation: Option<&DilationGroups>, turn: &Matrix3) -> Vec<Vector3> {
    let materials = [tissue(0.45)];
    let body = LinearBody {
        nodes: mesh.points(),
        volume: &tables.volume,
        materials: &materials,
        region: &[],
        dilation,
    };
    let back = |x: &Point3| Point3::from(turn.tr_mul(&x.coords));
    let field = |x: &Point3| turn * (affine(&back(x)) + Vector3::new(0.0, 3.0, -2.0) * back(x).z * back(x).y);
    let weak = [WeakSupport {
        flux: &tables.held,
        axes: [true; 3],
        values: tables.held.points().iter().map(field).collect(),
        region: &[],
        method: Weak::Nitsche { gamma: 200.0 },
        h: 0.005,
        trace: tables.trace.as_ref(),
    }];
    let pull = tables.pulled.points().iter().map(|x| turn * Vector3::new(40.0, -300.0 * back(x).z, 90.0));
    let loads = [Load::Traction { surface: &tables.pulled, values: pull.collect() }];
    let problem = LinearProblem { body, loads: &loads, fixed: &[], constraints: &[], weak: &weak };
    statics::assemble(&problem).unwrap().factor().unwrap().solve(1.0).unwrap().u
}

/// Builds tables and dilation groups again on the rotated mesh and compares the solutions.
fn check(name: &str, mesh: &Mesh, make: impl Fn(&Mesh) -> (Tables, Option<DilationGroups>)) {
    let (tables, groups) = make(mesh);
    let straight = solve(mesh, &tables, groups.as_ref(), &Matrix3::identity());
    for turn in turns() {
        let turned = mesh.moved(|x| Point3::from(turn * x.coords)).unwrap();
        let (tables, groups) = make(&turned);
        let found = solve(&turned, &tables, groups.as_ref(), &turn);
        let expected: Vec<Vector3> = straight.iter().map(|u| turn * u).collect();
        let error = relative_error(&found, &expected);
        assert!(error < 1e-10, "{name}: {error:e}");
    }
}

#[test]
fn elements_know_no_axis() {
    for kind in CellKind::ALL {
        let mesh = jittered_box(kind, 2);
        check(kind.name(), &mesh, |mesh| (elements(mesh), None));
        let groups = |mesh: &Mesh| fem::element_dilation(mesh, &VolumeRule::STANDARD).unwrap();
        check(kind.name(), &mesh, |mesh| (elements(mesh), Some(groups(mesh))));
    }
}

#[test]
fn clouds_know_no_axis() {
    let mesh = jittered_box(CellKind::Tet4, 3);
    let spacing = cloud_from_mesh(&mesh).spacing;
    let least_squares = |mesh: &Mesh| {
        let radii = Support::Dilatation { factor: 1.6 }.radii(mesh.points(), &spacing).unwrap();
        let kernel = Kernel::CubicSpline(CubicSpline);
        Approximation::new(mesh.points().to_vec(), radii, kernel, Basis::Linear).unwrap()
    };
    let entropy =
        |mesh: &Mesh| Approximation::maximum_entropy(mesh.points().to_vec(), &spacing, 1.8).unwrap();
    for smoothed in [false, true] {
        check("least squares", &mesh, |mesh| (cloud(mesh, &least_squares(mesh), smoothed), None));
        check("maximum entropy", &mesh, |mesh| (cloud(mesh, &entropy(mesh), smoothed), None));
    }
    check("nodal dilation", &mesh, |mesh| {
        let tables = cloud(mesh, &least_squares(mesh), true);
        let groups = DilationGroups::nodal(&tables.volume).unwrap();
        (tables, Some(groups))
    });
}
