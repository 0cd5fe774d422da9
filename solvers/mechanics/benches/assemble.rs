//! Pattern, rigid-motion check and assembly.

mod common;

use common::{Pressed, cloud};
use criterion::{Criterion, criterion_group, criterion_main};
use mechanics::*;

fn benches(c: &mut Criterion) {
    let mut group = c.benchmark_group("assemble");
    group.sample_size(20);
    for n in [10, 21] {
        let pressed = Pressed::new(n);
        let loads = pressed.loads();
        let dofs = 3 * (n + 1).pow(3);
        for (name, projected) in [("tet4", false), ("tet4 nodal dilation", true)] {
            group.bench_function(format!("{name}, {dofs} dofs"), |b| {
                b.iter(|| assemble(&pressed.problem(&loads, projected)).unwrap())
            });
        }
    }
    let material = [LinearElastic::new(20e3, 0.495).unwrap()];
    for (nodes, points, neighbours) in [(83, 4000, 30), (1331, 24760, 30)] {
        let volume = cloud(nodes, points, neighbours);
        let at: Vec<Point3> =
            (0..nodes).map(|i| Point3::new((i % 7) as f64, (i / 7 % 7) as f64, (i / 49) as f64)).collect();
        let body = Body { nodes: &at, volume: &volume, materials: &material, region: &[], dilation: None };
        let fixed: Vec<_> = (0..3 * nodes as u32)
            .map(|k| FixedDof { node: k / 3, axis: (k % 3) as u8, value: 0.0 })
            .collect();
        let problem = LinearProblem { body, loads: &[], fixed: &fixed, constraints: &[], weak: &[] };
        group.bench_function(format!("cloud, {nodes} nodes, {points} points of {neighbours}"), |b| {
            b.iter(|| assemble(&problem).unwrap())
        });
    }
    group.finish();
}

criterion_group!(stage, benches);
criterion_main!(stage);
