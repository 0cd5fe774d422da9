//! One more right-hand side, including its residual check.

mod common;

use common::Pressed;
use criterion::{Criterion, criterion_group, criterion_main};
use tissuebench_statics::assemble;

fn benches(c: &mut Criterion) {
    let mut group = c.benchmark_group("solve");
    group.sample_size(20);
    for n in [4, 10, 21] {
        let pressed = Pressed::new(n);
        let loads = pressed.loads();
        let factored = assemble(&pressed.problem(&loads, false)).unwrap().factor().unwrap();
        group.bench_function(format!("{} dofs", 3 * (n + 1).pow(3)), |b| {
            b.iter(|| factored.solve(1.0).unwrap())
        });
    }
    group.finish();
}

criterion_group!(stage, benches);
criterion_main!(stage);
