//! Time to build, pack and apply each scheme, at the size of the paper: 83 nodes to about 1330 points of the
//! kidney.
//!
//! A full packed table has 0.88 MB of weights, each used for three components. From the second-level cache at
//! 104 GB/s they take 8.4 us. Three products and three sums of eight lanes, on two pipes of 512 bits, take 3
//! cycles per eight weights: 16 us at 2.6 GHz. The table below gives medians on a busy machine in us: wall
//! time on two threads for builds, and one thread otherwise. An unpacked full table takes 80 us to apply.
//!
//! | scheme | entries | build | pack | apply |
//! |---|---|---|---|---|
//! | nearest | 1 331 | 115 | 43 | 2.0 |
//! | inverse-distance | 5 324 | 228 | 37 | 4.0 |
//! | shepard | 33 453 | 420 | 175 | 10 |
//! | mls-linear | 33 453 | 480 | 175 | 10 |
//! | mls-quadratic | 73 589 | 745 | 275 | 15.4 |
//! | mls-modified | 52 282 | 630 | 225 | 13.5 |
//! | radial bases | 110 473 | 1150 to 1550 | 198 | 18.8 |
//! | natural-neighbour | 13 094 | 880 to 1050 | 128 | 6.3 |
//! | barycentric | 5 324 | 550 | 42 | 5.2 |
//!
//! One thread builds mls-quadratic in 1200 us and natural-neighbour in 1380 us. A sleeping thread takes 35 us
//! to wake up; some builds have three parallel loops.

use criterion::{Bencher, Criterion, criterion_group, criterion_main};
use geometry::generate::kidney_mesh;
use geometry::{CellKind, Kidney, cloud};
use shape::{RowBlocks, Vector3};
use std::hint::black_box;
use tissuebench_interp::{Barycentric, Scheme};

/// Measures on a thread of the pool, as in a run.
fn on_pool<T>(bencher: &mut Bencher, make: impl Fn() -> T + Send + Sync) {
    rayon::scope(|_| bencher.iter(make));
}

fn transfer(criterion: &mut Criterion) {
    let nodes = cloud(&Kidney, 83, 1, &[]).unwrap().points;
    let targets = cloud(&Kidney, 1331, 2, &[]).unwrap().points;
    // Barycentric transfer needs a mesh over its nodes: a coarse mesh of 321 nodes and 1536 cells.
    let mesh = kidney_mesh(CellKind::Tet4, 4).unwrap();
    let mut group = criterion.benchmark_group("transfer");
    for scheme in Scheme::all() {
        let (nodes, mesh) = if scheme == Scheme::Barycentric(Barycentric) {
            (mesh.points(), Some(&mesh))
        } else {
            (&nodes[..], None)
        };
        let build = || scheme.rows(nodes, mesh, &targets).expect("a sound cloud");
        group.bench_function(format!("build/{}", scheme.name()), |b| on_pool(b, build));
        let (rows, _) = build();
        group.bench_function(format!("pack/{}", scheme.name()), |b| {
            b.iter(|| RowBlocks::new(black_box(rows.rows())))
        });
        let blocks = RowBlocks::new(rows.rows());
        let field: Vec<Vector3> = nodes.iter().map(|x| 0.1 * x.coords).collect();
        let mut out = vec![Vector3::zeros(); targets.len()];
        group.bench_function(format!("apply/{}", scheme.name()), |b| {
            b.iter(|| blocks.apply_into(black_box(&field), &mut out))
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20).measurement_time(std::time::Duration::from_secs(1));
    targets = transfer
}
criterion_main!(benches);
