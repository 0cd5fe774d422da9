//! Element-free Galerkin of second order: linearly smoothed gradients pass the quadratic patch test to
//! rounding, as no Gauss rule does.

mod common;

use cases::exact::{Elastic, exact_by_name};
use common::*;
use efg::{Approximation, Basis, CubicSpline, Kernel, Smoothing, Support};
use geometry::generate::{Jitter, box_mesh};
use geometry::{CellKind, cloud_from_mesh};
use shape::VolumeRows;
use shape::{Point3, Vector3};
use statics::{LinearBody, LinearProblem, Load, Weak, WeakSupport};

/// Returns the relative errors of displacement and stress over the integration points.
fn errors(dilatation: f64, gauss: Option<usize>, face_points: usize, poisson: f64) -> [f64; 2] {
    let exact = exact_by_name("quadratic-patch", &Elastic::new(20e3, poisson).unwrap().into(), &[]).unwrap();
    let jitter = Some(Jitter { fraction: 0.2, seed: 1 });
    let high = Point3::new(0.05, 0.05, 0.05);
    let mesh = box_mesh(CellKind::Tet4, Point3::origin(), high, [3; 3], [1.0; 3], jitter).unwrap();
    let cloud = cloud_from_mesh(&mesh);
    let radii = Support::Dilatation { factor: dilatation }.radii(&cloud.points, &cloud.spacing).unwrap();
    let mls =
        Approximation::new(cloud.points, radii, Kernel::CubicSpline(CubicSpline), Basis::Quadratic).unwrap();
    let (volume, info): (VolumeRows, _) = match gauss {
        Some(points) => efg::gauss_rows(&mls, &mesh, points).unwrap(),
        None => efg::smoothed_rows(&mls, &mesh, Smoothing::Linear, face_points).unwrap(),
    };
    assert_eq!(info.fallbacks(), 0);
    let materials = [tissue(poisson)];
    let held = mesh.boundary();
    let (flux, _) = efg::flux_rows(&mls, &mesh, &held, face_points).unwrap();
    let trace = efg::smoothed_trace(&mesh, &held, Smoothing::Linear, face_points).unwrap();
    let (trace, gamma) = if gauss.is_some() { (None, 100.0) } else { (Some(&trace), 4.0) };
    let weak = [WeakSupport {
        flux: &flux,
        axes: [true; 3],
        values: flux.points().iter().map(|x| exact.displacement(x)).collect(),
        region: &[],
        method: Weak::Nitsche { gamma },
        h: 0.05 / 3.0,
        trace,
    }];
    let loads = [Load::Body { values: volume.points().iter().map(|x| exact.body_force(x)).collect() }];
    let body = LinearBody {
        nodes: mls.nodes(),
        volume: &volume,
        materials: &materials,
        region: &[],
        dilation: None,
    };
    let problem = LinearProblem { body, loads: &loads, fixed: &[], constraints: &[], weak: &weak };
    let u = statics::assemble(&problem).unwrap().factor().unwrap().solve(1.0).unwrap().u;
    let known: Vec<Vector3> = volume.points().iter().map(|x| exact.displacement(x)).collect();
    let stress = statics::body_stress(&body, &u).unwrap();
    let (mut off, mut whole) = (0.0, 0.0);
    for (q, x) in volume.points().iter().enumerate() {
        let s = exact.stress(x);
        off += volume.weights()[q] * (stress[q] - s).norm_squared();
        whole += volume.weights()[q] * s.norm_squared();
    }
    [relative_error(&volume.rows().apply(&u), &known), (off / whole).sqrt()]
}

#[test]
fn linear_smoothing_passes_the_quadratic_patch_test() {
    for (dilatation, face_points, poisson) in
        [(1.8, 6, 0.3), (2.0, 6, 0.3), (2.0, 12, 0.3), (2.5, 6, 0.3), (2.0, 6, 0.495), (2.5, 6, 0.4999)]
    {
        let [u, stress] = errors(dilatation, None, face_points, poisson);
        println!("dilatation {dilatation}, {face_points} per face, nu = {poisson}: {u:.1e} / {stress:.1e}");
        assert!(u < 1e-12 && stress < 1e-11, "see the last line");
    }
    // Three points per face have only degree 2, and Gauss points sample rational functions.
    for (gauss, face_points) in [(None, 3), (Some(4), 6), (Some(46), 6)] {
        let [u, _] = errors(2.0, gauss, face_points, 0.3);
        assert!(u > 1e-6, "{gauss:?}, {face_points} per face: {u:e}");
    }
}
