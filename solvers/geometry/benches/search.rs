//! Benchmarks neighbour search at the size of the paper's mesh (1331 nodes), and the generation of a cloud of
//! 83 nodes. Large clouds and many threads are not covered.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use tissuebench_geometry::{Cloud, Kidney, Search, cloud};

fn search(c: &mut Criterion) {
    let Cloud { points, spacing } = cloud(&Kidney, 1331, 1, &[]).unwrap();
    let tree = Search::new(&points).unwrap();
    c.bench_function("search/build, 1331 nodes", |b| b.iter(|| Search::new(black_box(&points)).unwrap()));
    c.bench_function("search/14 nearest of each of 1331 nodes", |b| {
        b.iter(|| points.iter().map(|p| tree.nearest(black_box(p), 14).len()).sum::<usize>())
    });
    c.bench_function("search/within 1.6 spacings of each of 1331 nodes", |b| {
        let mut found = Vec::new();
        b.iter(|| {
            let mut total = 0;
            for (p, h) in points.iter().zip(&spacing) {
                tree.within_into(black_box(p), 1.6 * h, &mut found);
                total += found.len();
            }
            total
        })
    });
    let few = cloud(&Kidney, 83, 1, &[]).unwrap().points;
    let small = Search::new(&few).unwrap();
    c.bench_function("search/14 nearest of each of 83 nodes", |b| {
        b.iter(|| few.iter().map(|p| small.nearest(black_box(p), 14).len()).sum::<usize>())
    });
    c.bench_function("cloud/kidney, 83 nodes", |b| b.iter(|| cloud(&Kidney, black_box(83), 1, &[]).unwrap()));
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(30).measurement_time(std::time::Duration::from_secs(2));
    targets = search
}
criterion_main!(benches);
