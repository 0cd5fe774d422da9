//! Reproducible bits at any number of threads: tables, solution and transfer of both families.

mod common;

use common::*;
use efg::{Approximation, Basis, CubicSpline, Kernel, Support};
use fem::{SurfaceRule, VolumeRule};
use geometry::{CellKind, Mesh, Point3, cloud_from_mesh};
use interp::Scheme;
use shape::Vector3;
use shape::{DilationGroups, FluxRows, PointRows, SurfaceRows, VolumeRows};
use statics::{LinearBody, LinearProblem, Load, Weak, WeakSupport};

/// All results of a run.
#[derive(PartialEq)]
struct Run {
    volume: VolumeRows,
    flux: FluxRows,
    surface: SurfaceRows,
    u: Vec<Vector3>,
    transfers: Vec<PointRows>,
}

fn run(mesh: &Mesh, tables: impl Fn(&Mesh) -> (VolumeRows, FluxRows, SurfaceRows)) -> Run {
    let (volume, flux, surface) = tables(mesh);
    let materials = [tissue(0.495)];
    let groups = DilationGroups::nodal(&volume).unwrap();
    let body = LinearBody {
        nodes: mesh.points(),
        volume: &volume,
        materials: &materials,
        region: &[],
        dilation: Some(&groups),
    };
    let values = vec![Vector3::zeros(); flux.weights().len()];
    let method = Weak::Penalty { factor: 1e4 };
    let weak =
        [WeakSupport { flux: &flux, axes: [true; 3], values, region: &[], method, h: 5e-3, trace: None }];
    let loads = [Load::Pressure { surface: &surface, values: vec![2e3; surface.weights().len()] }];
    let problem = LinearProblem { body, loads: &loads, fixed: &[], constraints: &[], weak: &weak };
    let u = statics::assemble(&problem).unwrap().factor().unwrap().solve(1.0).unwrap().u;
    let targets: Vec<Point3> = volume.points().iter().step_by(3).copied().collect();
    let transfers =
        Scheme::all().map(|scheme| scheme.rows(mesh.points(), Some(mesh), &targets).unwrap().0).collect();
    Run { volume, flux, surface, u, transfers }
}

/// A mesh with more nodes than the dense limit and more points than a parallel task.
fn mesh() -> Mesh {
    jittered_box(CellKind::Tet4, 4)
}

fn elements(mesh: &Mesh) -> (VolumeRows, FluxRows, SurfaceRows) {
    let (held, loaded) = (mesh.group("z-min").unwrap(), mesh.group("z-max").unwrap());
    (
        fem::volume_rows(mesh, &VolumeRule::STANDARD).unwrap(),
        fem::flux_rows(mesh, held, &SurfaceRule::STANDARD).unwrap(),
        fem::surface_rows(mesh, loaded, &SurfaceRule::STANDARD).unwrap(),
    )
}

fn cloud(mesh: &Mesh) -> (VolumeRows, FluxRows, SurfaceRows) {
    let cloud = cloud_from_mesh(mesh);
    let radii = Support::Dilatation { factor: 1.6 }.radii(&cloud.points, &cloud.spacing).unwrap();
    let mls =
        Approximation::new(cloud.points, radii, Kernel::CubicSpline(CubicSpline), Basis::Linear).unwrap();
    let (held, loaded) = (mesh.group("z-min").unwrap(), mesh.group("z-max").unwrap());
    (
        efg::smoothed_rows(&mls, mesh, efg::Smoothing::Constant, 3).unwrap().0,
        efg::flux_rows(&mls, mesh, held, 3).unwrap().0,
        efg::surface_rows(&mls, mesh, loaded, 3).unwrap().0,
    )
}

#[test]
fn at_one_two_and_five_threads_and_again() {
    let mesh = mesh();
    for (name, tables) in [("elements", elements as fn(&Mesh) -> _), ("cloud", cloud)] {
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| run(&mesh, tables))
        };
        let first = on(1);
        for threads in [1, 2, 5] {
            let again = on(threads);
            assert!(first.volume == again.volume, "{name}: volume rows at {threads} threads");
            assert!(first.flux == again.flux && first.surface == again.surface, "{name}: boundary rows");
            assert!(first.u == again.u, "{name}: solution at {threads} threads");
            assert!(first.transfers == again.transfers, "{name}: transfers at {threads} threads");
        }
    }
}
