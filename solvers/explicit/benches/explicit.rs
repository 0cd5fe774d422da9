//! Internal forces: one evaluation of each kernel beside the plain loop of the same run, which is what to compare with
//! on a machine that is not quiet. Strains near 0.1, neo-Hookean, nodes and points of a structured grid.
//!
//! Per element and evaluation (per point for EFG; a fused product counts two flops, `ln` and the cube root some 30):
//!
//! | kernel | bytes | flops | memory at 20 GB/s | arithmetic at 40 Gflop/s |
//! |---|---|---|---|---|
//! | tet4 | 88 (9 gradients, weight, 4 short nodes) | 180 | 4.4 ns | 4.5 ns |
//! | tet4 nodal dilation | 176 (two passes) | 380 | 8.8 ns | 9.5 ns |
//! | hex8 | 656 (8 x 9 map, 8 weights, 8 short nodes) | 2100 | 33 ns | 53 ns |
//! | hex8 mean dilation | 656 (one pass) | 2500 | 33 ns | 63 ns |
//! | EFG, 31 neighbours | 806 (31 x (3 gradients + short node)) | 860 | 40 ns | 22 ns |
//!
//! What each kernel waits for, from its measured distance to these bounds: tet4 for gather and scatter (see the benchmark
//! `tet4`); hex8 for products, of which 950 vectors of eight elements (mean dilation 1200) at one per cycle of 3.7 GHz are 32 ns (40), for sums and differences and
//! the scatter of its nodes (20 ns), and outside the kernel for copies of nodes and their sums (5 ns): kernel alone 52 ns (62),
//! whole evaluation 58 (68), beside busy neighbours the least of 20 samples; out of cache for memory, 130 (130); EFG for
//! loads, eight per neighbour (53 ns in cache, 90 out of it).
//! Other laws: the benchmark `laws`.
//! Not covered: quadratic elements (they take the EFG kernel), and what takes the plain loop: dilation of EFG rows, and
//! of the linear and the St. Venant-Kirchhoff law.

mod common;

use std::time::Duration;

use common::{cloud, solid};
use criterion::{
    BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main, measurement::WallTime,
};
use explicit::{ExplicitBody, InternalForce};
use geometry::CellKind;
use lanes::LanePath;
use material::{Law, NeoHookean};
use shape::Vector3;

fn compare(group: &mut BenchmarkGroup<WallTime>, body: ExplicitBody, u: &[Vector3], items: usize) {
    let threads = |n| rayon::ThreadPoolBuilder::new().num_threads(n).build().unwrap();
    let (one, two) = (threads(1), threads(2));
    let mut f = vec![Vector3::zeros(); u.len()];
    group.throughput(Throughput::Elements(items as u64));
    let mut plain = InternalForce::plain(body).unwrap();
    let mut lanes: Vec<_> =
        LanePath::available().into_iter().map(|path| InternalForce::new(body, path).unwrap()).collect();
    let kernel = lanes[0].info().kernel.name();
    group.bench_function(format!("{kernel}, {items}, plain loop"), |b| {
        one.install(|| b.iter(|| plain.evaluate(u, &mut f).unwrap()))
    });
    for force in &mut lanes {
        let name = format!("{kernel}, {items}, {}, 1 thread", force.path().name());
        group.bench_function(name, |b| one.install(|| b.iter(|| force.evaluate(u, &mut f).unwrap())));
    }
    let best = lanes.last_mut().unwrap();
    let name = format!("{kernel}, {items}, {}, 2 threads", best.path().name());
    group.bench_function(name, |b| two.install(|| b.iter(|| best.evaluate(u, &mut f).unwrap())));
}

fn benches(c: &mut Criterion) {
    let mut group = c.benchmark_group("explicit");
    group.sample_size(20).measurement_time(Duration::from_secs(2)).warm_up_time(Duration::from_millis(300));
    let laws = [Law::NeoHookean(NeoHookean::new(20e3, 0.495).unwrap())];
    for (kind, cells, per_cell) in
        [(CellKind::Tet4, 10, 6), (CellKind::Tet4, 26, 6), (CellKind::Hex8, 18, 1), (CellKind::Hex8, 46, 1)]
    {
        let (volume, groups, u) = solid(kind, cells);
        for groups in [None, Some(&groups)] {
            let body = ExplicitBody { volume: &volume, laws: &laws, region: &[], groups };
            let items = cells * cells * cells * per_cell;
            compare(&mut group, body, &u, items);
        }
    }
    for (cells, per_cell) in [(6, 28), (18, 18)] {
        let (volume, u) = cloud(cells, per_cell);
        let body = ExplicitBody { volume: &volume, laws: &laws, region: &[], groups: None };
        compare(&mut group, body, &u, volume.weights().len());
    }
    group.finish();
}

criterion_group!(stage, benches);
criterion_main!(stage);
