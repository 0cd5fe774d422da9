//! Internal forces: ns per element and evaluation of each kernel beside the plain loop of the same run.

mod common;

use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use geometry::CellKind;
use geometry::generate::{Jitter, box_mesh};
use mechanics::{ExplicitBody, InternalForce, LanePath, Law, NeoHookean, Point3, Vector3};
use shape::DilationGroups;

fn threads(n: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(n).build().unwrap()
}

fn benches(c: &mut Criterion) {
    let mut group = c.benchmark_group("explicit");
    group.sample_size(20).measurement_time(Duration::from_secs(2)).warm_up_time(Duration::from_millis(300));
    let laws = [Law::NeoHookean(NeoHookean::new(20e3, 0.495).unwrap())];
    for (kind, cells, per_cell) in
        [(CellKind::Tet4, 10, 6), (CellKind::Tet4, 26, 6), (CellKind::Hex8, 18, 1), (CellKind::Hex8, 46, 1)]
    {
        let jitter = Some(Jitter { fraction: 0.1, seed: 1 });
        let max = Point3::new(0.04, 0.04, 0.04);
        let mesh = box_mesh(kind, Point3::origin(), max, [cells; 3], [1.0; 3], jitter).unwrap();
        let volume = fem::volume_rows(&mesh, &fem::VolumeRule::STANDARD).unwrap();
        let groups = match kind {
            CellKind::Tet4 => DilationGroups::nodal(&volume).unwrap(),
            _ => fem::element_dilation(&mesh, &fem::VolumeRule::STANDARD).unwrap(),
        };
        let u: Vec<Vector3> =
            mesh.points().iter().map(|x| Vector3::new(0.05 * x.y, -0.04 * x.z, 0.1 * x.x)).collect();
        let mut f = vec![Vector3::zeros(); u.len()];
        let elements = cells * cells * cells * per_cell;
        group.throughput(Throughput::Elements(elements as u64));
        for groups in [None, Some(&groups)] {
            let body = ExplicitBody { volume: &volume, laws: &laws, region: &[], groups };
            let mut plain = InternalForce::plain(body).unwrap();
            let mut lanes: Vec<_> =
                LanePath::available().into_iter().map(|p| InternalForce::new(body, p).unwrap()).collect();
            let kernel = lanes[0].kernel();
            let one = threads(1);
            group.bench_function(format!("{kernel}, {elements} elements, plain loop"), |b| {
                one.install(|| b.iter(|| plain.evaluate(&u, &mut f).unwrap()))
            });
            for force in &mut lanes {
                let name = format!("{kernel}, {elements} elements, {}, 1 thread", force.path().name());
                group
                    .bench_function(name, |b| one.install(|| b.iter(|| force.evaluate(&u, &mut f).unwrap())));
            }
            let two = threads(2);
            let force = lanes.last_mut().unwrap();
            let name = format!("{kernel}, {elements} elements, {}, 2 threads", force.path().name());
            group.bench_function(name, |b| two.install(|| b.iter(|| force.evaluate(&u, &mut f).unwrap())));
        }
    }
    group.finish();
}

criterion_group!(stage, benches);
criterion_main!(stage);
