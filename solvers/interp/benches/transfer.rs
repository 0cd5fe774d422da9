//! Build, pack and apply per scheme, at the size of the paper: 83 nodes to about 1330 points of the kidney.
//!
//! Packed, a full table is 0.88 MB of weights, each used for three components. Read from the second-level cache and beyond at 104 GB/s
//! they take 8.4 us; three products and three sums of eight lanes, each kind on two pipes of 256 bits, take 3 cycles per eight
//! weights, 11 us at 3.7 GHz. Measured beside busy neighbours, the least of 800, in us; a full table unpacked takes 80:
//!
//! | scheme | entries | apply |
//! |---|---|---|
//! | nearest | 1 331 | 2.2 |
//! | inverse-distance | 5 324 | 4.0 |
//! | shepard, mls-linear | 33 453 | 9.3 |
//! | mls-quadratic | 73 589 | 15.1 |
//! | mls-modified | 52 282 | 11.8 |
//! | radial bases | 110 473 | 18 |
//! | natural-neighbour | 13 094 | 5.8 |
//! | barycentric | 5 324 | 4.4 |
//!
//! To build and to pack takes, in ms of one processor at 2.5 GHz, itself shared, the least of some 200. Packing is one
//! thread's work. Two threads, where others leave the machine to them, build in the time (the wall's) of the last column:
//!
//! | scheme | build | pack | build, two threads |
//! |---|---|---|---|
//! | nearest | 0.29 | 0.07 | 0.18 |
//! | inverse-distance | 0.57 | 0.09 | 0.38 |
//! | shepard | 0.90 | 0.28 | 0.58 |
//! | mls-linear | 1.3 | 0.34 | 0.81 |
//! | mls-quadratic | 2.0 | 0.53 | 1.35 |
//! | mls-modified | 1.9 | 0.42 | 1.13 |
//! | radial bases | 2.9 to 4.1 | 0.40 | |
//! | natural-neighbour | 2.8 | 0.23 | 1.85 |
//! | barycentric | 1.3 | 0.13 | |

use criterion::{Criterion, criterion_group, criterion_main};
use geometry::generate::kidney_mesh;
use geometry::{CellKind, Kidney, cloud};
use interp::Scheme;
use shape::{RowBlocks, Vector3};
use std::hint::black_box;

fn transfer(criterion: &mut Criterion) {
    let nodes = cloud(&Kidney, 83, 1, &[]).unwrap().points;
    let targets = cloud(&Kidney, 1331, 2, &[]).unwrap().points;
    // Barycentric transfer wants a mesh over its nodes: a coarse one, of 321 nodes and 1536 cells.
    let mesh = kidney_mesh(CellKind::Tet4, 4).unwrap();
    let mut group = criterion.benchmark_group("transfer");
    for scheme in Scheme::ALL {
        let (nodes, mesh) =
            if scheme == Scheme::Barycentric { (mesh.points(), Some(&mesh)) } else { (&nodes[..], None) };
        let build = || scheme.rows(nodes, mesh, &targets).expect("a sound cloud");
        group.bench_function(format!("build/{}", scheme.name()), |b| b.iter(|| black_box(build())));
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
