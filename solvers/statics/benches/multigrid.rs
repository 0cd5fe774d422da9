//! Multigrid against a direct factorisation: the setup of each, and one solution with each.

#[path = "common/cloud.rs"]
mod cloud;
mod common;

use cloud::{CloudCube, Settings};
use common::Pressed;
use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use material::LinearElastic;
use tissuebench_statics::{Assembled, Solution, assemble};

fn iterated(assembled: Assembled) -> Solution {
    let levels = assembled.multigrid(None).unwrap();
    assembled.iterated(levels, 1e-8).unwrap().solve(1.0).unwrap()
}

fn benches(c: &mut Criterion) {
    let mut group = c.benchmark_group("multigrid");
    group.sample_size(10);
    for n in [9, 14, 21, 32] {
        let pressed = Pressed::new(n);
        let loads = pressed.loads();
        let assembled = || assemble(&pressed.problem(&loads, false)).unwrap();
        let dofs = 3 * (n + 1).pow(3);
        group.bench_function(format!("tet4 {dofs} dofs, iterated"), |b| {
            b.iter_batched(assembled, iterated, BatchSize::LargeInput)
        });
        group.bench_function(format!("tet4 {dofs} dofs, factored"), |b| {
            b.iter_batched(assembled, |a| a.factor().unwrap().solve(1.0).unwrap(), BatchSize::LargeInput)
        });
    }
    let material = [LinearElastic::new(20e3, 0.3).unwrap()];
    for cells in [9, 13, 21] {
        let cube = CloudCube::new(Settings::of(cells));
        let dofs = 3 * cube.nodes.len();
        cube.with(&material, |problem| {
            let assembled = || assemble(problem).unwrap();
            group.bench_function(format!("cloud {dofs} dofs, iterated"), |b| {
                b.iter_batched(assembled, iterated, BatchSize::LargeInput)
            });
        });
    }
    group.finish();
}

criterion_group!(stage, benches);
criterion_main!(stage);
