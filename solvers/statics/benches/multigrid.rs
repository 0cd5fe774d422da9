//! Multigrid against a direct factorisation: the setup of each, and one solution with each.

mod common;

use common::Pressed;
use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use tissuebench_statics::assemble;

fn benches(c: &mut Criterion) {
    let mut group = c.benchmark_group("multigrid");
    group.sample_size(10);
    for n in [9, 14, 21, 32] {
        let pressed = Pressed::new(n);
        let loads = pressed.loads();
        let assembled = || assemble(&pressed.problem(&loads, false)).unwrap();
        let dofs = 3 * (n + 1).pow(3);
        group.bench_function(format!("tet4 {dofs} dofs, iterated"), |b| {
            b.iter_batched(
                assembled,
                |a| {
                    let levels = a.multigrid(None).unwrap();
                    a.iterated(levels, 1e-8).unwrap().solve(1.0).unwrap()
                },
                BatchSize::LargeInput,
            )
        });
        group.bench_function(format!("tet4 {dofs} dofs, factored"), |b| {
            b.iter_batched(assembled, |a| a.factor().unwrap().solve(1.0).unwrap(), BatchSize::LargeInput)
        });
    }
    group.finish();
}

criterion_group!(stage, benches);
criterion_main!(stage);
