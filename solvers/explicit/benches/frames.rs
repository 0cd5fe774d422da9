//! Benchmark of one time step of frames: a sweep of vertex block descent, a sweep of extended position-based
//! dynamics, and an iteration of conjugate gradients, on a cube of tetrahedra, on one thread and on two.

use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use geometry::generate::box_mesh;
use geometry::{CellKind, Point3};
use material::{Law, StableNeoHookean};
use shape::Vector3;
use tissuebench_explicit::{ExplicitBody, FrameParams, Frames, Lumping, lumped_mass};

/// Cells along an edge of the cube.
const CELLS: usize = 12;

fn benches(criterion: &mut Criterion) {
    let max = Point3::new(0.04, 0.04, 0.04);
    let mesh = box_mesh(CellKind::Tet4, Point3::origin(), max, [CELLS; 3], [1.0; 3], None).unwrap();
    let volume = fem::volume_rows(&mesh, &fem::VolumeRule::STANDARD).unwrap();
    let laws = [Law::StableNeoHookean(StableNeoHookean::new(20e3, 0.45).unwrap())];
    let mass = lumped_mass(&volume, &[1000.0], &[], Lumping::RowSum).unwrap();
    let body = ExplicitBody { volume: &volume, laws: &laws, region: &[], axes: &[], groups: None };
    let params = FrameParams { dt: 1e-3, damping: 0.0, inertia: true, sweeps: 1 };
    let mut load = |_: f64, f: &mut [Vector3]| f.iter_mut().for_each(|f| f.z -= 1e-5);
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut group = criterion.benchmark_group(format!("frames on {threads}"));
        group.measurement_time(Duration::from_secs(3)).throughput(Throughput::Elements(mass.len() as u64));
        let mut run = |name: &str, mut frames: Frames| {
            group.bench_function(name, |bencher| {
                bencher.iter(|| pool.install(|| frames.step(&mut load).unwrap()));
            });
        };
        run("vbd", Frames::vertex_descent(body, &mass, &[], params).unwrap());
        run("xpbd", Frames::constraints(body, &mass, &[], params).unwrap());
        run("implicit-cg", Frames::conjugate_gradients(body, &mass, &[], params, [0.0, 0.0]).unwrap());
        group.finish();
    }
}

criterion_group!(frames, benches);
criterion_main!(frames);
