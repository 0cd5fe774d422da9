//! Benchmark of internal forces: one evaluation of each kernel next to the plain loop of the same run, which
//! is the value to compare with on a machine that is not idle. Strains are near 0.1, the law is neo-Hookean,
//! nodes and points are those of a structured grid.
//!
//! Cost per element and evaluation (per point for EFG; a fused product counts two flops, `ln` and the cube
//! root some 30):
//!
//! | kernel | bytes | flops | memory at 20 GB/s | arithmetic at 40 Gflop/s |
//! |---|---|---|---|---|
//! | tet4 | 88 (9 gradients, weight, 4 short nodes) | 180 | 4.4 ns | 4.5 ns |
//! | tet4 nodal dilation | 176 (two passes) | 380 | 8.8 ns | 9.5 ns |
//! | hex8 | 656 (8 x 9 map, 8 weights, 8 short nodes) | 2100 | 33 ns | 53 ns |
//! | hex8 mean dilation | 656 (one pass) | 2500 | 33 ns | 63 ns |
//! | hex8 one point | 296 (7 + 4 vectors, weight, stiffness, 8 short nodes) | 700 | 15 ns | 18 ns |
//! | tet10 | 340 (4 x 9 map, 4 weights, 10 short nodes) | 2200 | 17 ns | 55 ns |
//! | hex20 | 2200 (27 x 9 map, 27 weights, 20 short nodes) | 25500 | 110 ns | 640 ns |
//! | EFG, 31 neighbours | 806 (31 x (3 gradients + short node)) | 860 | 40 ns | 22 ns |
//!
//! The measured distance of each kernel to these bounds shows its bottleneck:
//!
//! - tet4: gather and scatter (see the benchmark `tet4`).
//! - hex8: products, sums and copies. Its 950 product vectors of eight elements (mean dilation 1200) at one
//!   per cycle of 3.7 GHz take 32 ns (40). Sums and differences and the scatter of its nodes take 20 ns.
//!   Copies of nodes and their sums, outside the kernel, take 5 ns. The kernel alone takes 52 ns (62), a
//!   whole evaluation 58 ns (68), the best of 20 samples next to busy neighbours. Out of cache, hex8 waits
//!   for memory: 130 ns (130).
//! - hex8 one point: gather, scatter and copies of its eight nodes, which take as long as in hex8. 1,000
//!   elements take 436 instructions each by AVX2, and hex8 with mean dilation 1,032; a whole evaluation takes
//!   33 ns instead of 72 ns (AVX-512).
//! - tet10, hex20: products. The table of reference derivatives takes 19400 of the 25500 flops of hex20. At
//!   two product vectors of eight per cycle of 4 GHz (AMD family 26, AVX-512) these take 150 ns, and the law
//!   at 27 points some 80 ns: measured 260 ns in cache and 350 ns out of cache (AVX2 500 and 560), tet10 38
//!   and 44 ns (65 and 71), next to busy neighbours. The kernel of rows, with 14 KB per element of hex20, takes
//!   770 and 1560 ns (AVX2 950 and 1320).
//! - EFG: loads, eight per neighbour (53 ns in cache, 90 ns out of cache).
//!
//! Single precision halves bytes and arithmetic, but not the loads, sums and stores of nodes, which are one
//! instruction for a node in both. Ratios of an evaluation in double over single precision (AMD family 26),
//! AVX2 / AVX-512: tet4 1.6 / 1.4 (6,000 and 105,456 elements), with nodal means 1.5 / 1.35, hex8 1.8 / 1.6,
//! with means 1.9 / 1.7, tet10 1.7 / 1.5, hex20 1.9 / 1.9.
//!
//! Other laws are covered by the benchmark `laws`. Cases of the plain loop are not covered either: dilation
//! of EFG rows, and of the linear and the St. Venant-Kirchhoff law.

mod common;

use std::time::Duration;

use common::{cloud, one_point, solid};
use criterion::{
    BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main, measurement::WallTime,
};
use geometry::CellKind;
use lanes::LanePath;
use material::{Law, NeoHookean};
use shape::Vector3;
use tissuebench_explicit::{ExplicitBody, InternalForce, Precision};

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
    for path in LanePath::available() {
        let Ok(mut single) = InternalForce::of_precision(body, path, Precision::Single) else { continue };
        let name = format!("{kernel}, {items}, {}, single precision, 1 thread", path.name());
        group.bench_function(name, |b| one.install(|| b.iter(|| single.evaluate(u, &mut f).unwrap())));
    }
    let best = lanes.last_mut().unwrap();
    let name = format!("{kernel}, {items}, {}, 2 threads", best.path().name());
    group.bench_function(name, |b| two.install(|| b.iter(|| best.evaluate(u, &mut f).unwrap())));
}

fn benches(c: &mut Criterion) {
    let mut group = c.benchmark_group("explicit");
    group.sample_size(20).measurement_time(Duration::from_secs(2)).warm_up_time(Duration::from_millis(300));
    let laws = [Law::NeoHookean(NeoHookean::new(20e3, 0.495).unwrap())];
    for (kind, cells, per_cell) in [
        (CellKind::Tet4, 10, 6),
        (CellKind::Tet4, 26, 6),
        (CellKind::Hex8, 18, 1),
        (CellKind::Hex8, 46, 1),
        (CellKind::Tet10, 8, 6),
        (CellKind::Tet10, 16, 6),
        (CellKind::Hex20, 8, 1),
        (CellKind::Hex20, 20, 1),
    ] {
        let (volume, groups, u) = solid(kind, cells);
        for groups in [None, Some(&groups)] {
            let body = ExplicitBody { volume: &volume, laws: &laws, region: &[], axes: &[], groups };
            let items = cells * cells * cells * per_cell;
            compare(&mut group, body, &u, items);
        }
    }
    for cells in [18, 46] {
        let (volume, u) = one_point(cells);
        let body = ExplicitBody { volume: &volume, laws: &laws, region: &[], axes: &[], groups: None };
        compare(&mut group, body, &u, cells * cells * cells);
    }
    for (cells, per_cell) in [(6, 28), (18, 18)] {
        let (volume, u) = cloud(cells, per_cell);
        let body = ExplicitBody { volume: &volume, laws: &laws, region: &[], axes: &[], groups: None };
        compare(&mut group, body, &u, volume.weights().len());
    }
    group.finish();
}

criterion_group!(stage, benches);
criterion_main!(stage);
