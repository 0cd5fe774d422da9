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
//! What each kernel waits for, from its measured distance to these bounds: tet4 for the gather and scatter of 16 nodes'
//! quads per lane pair (11 ns, 2.4 times the arithmetic; nodal dilation 21 ns, 2.2 times); hex8 for products, of which 950
//! vectors of eight elements (mean dilation 1200) at one per cycle of 3.7 GHz are 32 ns (40), for sums and differences and
//! the scatter of its nodes (20 ns), and outside the kernel for copies of nodes and their sums (5 ns): kernel alone 52 ns (62),
//! whole evaluation 58 (68), beside busy neighbours the least of 20 samples; out of cache for memory, 130 (130); EFG for
//! loads, eight per neighbour (53 ns in cache, 90 out of it).
//! Other laws: flops of the law alone per point, estimated, and measured time of the whole kernel over the neo-Hookean's (one run,
//! one thread, in cache, AVX2 on EPYC of family 23, model 1):
//!
//! | law | flops | tet4 | tet4 nodal | hex8 | hex8 mean | rows |
//! |---|---|---|---|---|---|---|
//! | neo-Hookean | 90 | 1 | 1 | 1 | 1 | 1 |
//! | linear | 20 | 1.63 | - | 1.30 | - | 0.79 |
//! | St. Venant-Kirchhoff | 110 | 1.77 | - | 1.48 | - | 0.88 |
//! | isochoric neo-Hookean | 150 | 1.92 | 1.52 | 1.84 | 1.74 | 0.93 |
//! | Mooney-Rivlin | 260 | 2.08 | 1.57 | 2.09 | 1.97 | 0.98 |
//! | Hencky | 300 | 2.27 | 1.60 | 2.26 | 1.98 | 1.01 |
//! | Ogden, three terms | 370 | 2.32 | 1.69 | 2.27 | 2.19 | 1.00 |
//!
//! The linear law shows what it costs to pass strain and stress through memory between the kernel and the law: tet4 has
//! 26 ns per element of it, more than most laws themselves.
//! Not covered: quadratic elements (they take the EFG kernel), and what takes the plain loop: dilation of EFG rows, and
//! of the linear and the St. Venant-Kirchhoff law.

use std::time::Duration;

use criterion::{
    BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main, measurement::WallTime,
};
use explicit::{ExplicitBody, InternalForce};
use geometry::CellKind;
use geometry::generate::{Jitter, box_mesh};
use lanes::LanePath;
use material::{Law, NeoHookean};
use shape::{DilationGroups, GradRows, Rows, Unity, VolumeRows};
use shape::{Point3, Vector3};

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

/// All laws on one table in turn, for their time over the neo-Hookean's: `laws` of the benchmark.
fn every_law(
    group: &mut BenchmarkGroup<WallTime>,
    name: &str,
    body: ExplicitBody,
    u: &[Vector3],
    items: usize,
) {
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let mut f = vec![Vector3::zeros(); u.len()];
    group.throughput(Throughput::Elements(items as u64));
    for law in Law::all(20e3, 0.495).unwrap() {
        let laws = [law];
        let mut force = InternalForce::new(ExplicitBody { laws: &laws, ..body }, LanePath::best()).unwrap();
        if force.info().kernel.is_parallel() {
            let name = format!("{name}, {items}, {}", laws[0].name());
            group.bench_function(name, |b| one.install(|| b.iter(|| force.evaluate(u, &mut f).unwrap())));
        }
    }
}

/// Points spread over the cells of a grid, each with its (up to) 31 nearest grid nodes: the counts and the locality of
/// a meshless cloud. The gradients are smooth nonsense of the right size.
fn cloud(cells: usize, per_cell: usize) -> (VolumeRows, usize) {
    let (n, h) = (cells + 1, 0.04 / cells as f64);
    let (mut points, mut offsets, mut nodes, mut grads) = (Vec::new(), vec![0], Vec::new(), Vec::new());
    for cell in 0..cells * cells * cells {
        let c = [cell % cells, cell / cells % cells, cell / cells / cells];
        for k in 0..per_cell {
            let t = (k as f64 + 0.5) / per_cell as f64;
            let p = Point3::new(c[0] as f64 + t, c[1] as f64 + 0.4, c[2] as f64 + 1.0 - t);
            let around = |axis: usize| c[axis].saturating_sub(1)..(c[axis] + 3).min(n);
            let mut near = Vec::new();
            for z in around(2) {
                for y in around(1) {
                    for x in around(0) {
                        let distance = (Point3::new(x as f64, y as f64, z as f64) - p).norm();
                        near.push((distance, (x + n * (y + n * z)) as u32));
                    }
                }
            }
            near.sort_by(|a, b| a.0.total_cmp(&b.0));
            near.truncate(31);
            near.sort_by_key(|a| a.1);
            for (i, (_, node)) in near.iter().enumerate() {
                let s = i as f64;
                nodes.push(*node);
                grads.push(Vector3::new(s.sin(), s.cos(), (2.0 * s).sin()) / h);
            }
            offsets.push(nodes.len());
            points.push(p * h);
        }
    }
    let count = points.len();
    let values = vec![0.0; nodes.len()];
    let rows = Rows::new(n * n * n, offsets, nodes, values, Unity::NotPromised).unwrap();
    (VolumeRows::new(GradRows::new(points, rows, grads).unwrap(), vec![1e-9; count]).unwrap(), n * n * n)
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
        let rule = fem::VolumeRule::STANDARD;
        let volume = fem::volume_rows(&mesh, &rule).unwrap();
        let groups = match kind {
            CellKind::Tet4 => DilationGroups::nodal(&volume).unwrap(),
            _ => fem::element_dilation(&mesh, &rule).unwrap(),
        };
        let field = |x: &Point3| Vector3::new(0.05 * x.y, -0.04 * x.z, 0.1 * x.x);
        let u: Vec<Vector3> = mesh.points().iter().map(field).collect();
        for groups in [None, Some(&groups)] {
            let body = ExplicitBody { volume: &volume, laws: &laws, region: &[], groups };
            let items = cells * cells * cells * per_cell;
            compare(&mut group, body, &u, items);
            let kernel = InternalForce::new(body, LanePath::best()).unwrap().info().kernel;
            every_law(&mut group, kernel.name(), body, &u, items);
        }
    }
    for (cells, per_cell) in [(6, 28), (18, 18)] {
        let (volume, nodes) = cloud(cells, per_cell);
        // Of the order of the grid spacing times a strain of 0.01.
        let wave = |i: usize| {
            Vector3::new((i as f64).sin(), 0.3, (0.5 * i as f64).cos()) * (4e-4 / cells as f64 / 31.0)
        };
        let u: Vec<Vector3> = (0..nodes).map(wave).collect();
        let body = ExplicitBody { volume: &volume, laws: &laws, region: &[], groups: None };
        compare(&mut group, body, &u, volume.weights().len());
        every_law(&mut group, "rows", body, &u, volume.weights().len());
    }
    group.finish();
}

criterion_group!(stage, benches);
criterion_main!(stage);
