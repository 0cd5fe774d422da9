//! Factorisation: the dense and the sparse solver at small sizes, the sparse solver alone at larger sizes.

mod common;

use common::Pressed;
use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use tissuebench_statics::assemble;

fn benches(c: &mut Criterion) {
    let mut group = c.benchmark_group("factor");
    group.sample_size(20);
    // `projected` couples neighbours of neighbours, as a meshless cloud does. This gives more fill and a
    // later crossover.
    for projected in [false, true] {
        let kind = if projected { "wide" } else { "tet4" };
        for n in [3, 4, 5, 6, 7] {
            let pressed = Pressed::new(n);
            let loads = pressed.loads();
            let free = 3 * n * (n + 1) * (n + 1);
            for (path, limit) in [("dense", usize::MAX), ("sparse", 0)] {
                group.bench_function(format!("{kind} {free} free dofs, {path}"), |b| {
                    b.iter_batched(
                        || assemble(&pressed.problem(&loads, projected)).unwrap(),
                        |a| a.factor_with(limit).unwrap(),
                        BatchSize::LargeInput,
                    )
                });
            }
        }
    }
    group.sample_size(10);
    for n in [10, 21] {
        let pressed = Pressed::new(n);
        let loads = pressed.loads();
        group.bench_function(format!("tet4 {} dofs", 3 * (n + 1).pow(3)), |b| {
            b.iter_batched(
                || assemble(&pressed.problem(&loads, false)).unwrap(),
                |a| a.factor().unwrap(),
                BatchSize::LargeInput,
            )
        });
    }
    group.finish();
}

criterion_group!(stage, benches);
criterion_main!(stage);
