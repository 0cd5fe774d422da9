//! A load step at large strain: tangents factored, and iterated with multigrid.

mod common;

use common::Pressed;
use criterion::{Criterion, criterion_group, criterion_main};
use geometry::CellKind;
use material::{Law, NeoHookean};
use tissuebench_statics::{
    Active, Curves, LinearSystems, NewtonParams, Solid, SolidDilation, StaticParams, StaticProblem,
    solve_static,
};

fn benches(c: &mut Criterion) {
    let mut group = c.benchmark_group("newton");
    group.sample_size(10);
    let newton = NewtonParams {
        tolerance: 1e-9,
        iterations: 25,
        chords: true,
        keeps: NewtonParams::KEEPS,
        loosest: Some(NewtonParams::LOOSEST),
    };
    let params =
        StaticParams { steps: 1, smallest: 1.0 / 64.0, newton, augmentations: 0, limit_within: None };
    let laws = [Law::NeoHookean(NeoHookean::new(20e3, 0.49).unwrap())];
    for (name, kind, n, nodal) in
        [("tet10", CellKind::Tet10, 7, false), ("tet4-nodal", CellKind::Tet4, 14, true)]
    {
        let pressed = Pressed::of(kind, n);
        let loads = pressed.loads();
        let linear = fem::linear_nodes(&pressed.mesh).unwrap();
        let dilation = if nodal { SolidDilation::Groups(&pressed.nodal) } else { SolidDilation::Standard };
        let iterated = LinearSystems::Iterated { linear: linear.as_ref() };
        for (how, systems) in [("factored", LinearSystems::Factored), ("iterated", iterated)] {
            let problem = StaticProblem {
                nodes: pressed.mesh.points(),
                solid: Solid {
                    volume: &pressed.volume,
                    laws: &laws,
                    region: &[],
                    axes: &[],
                    active: Active::default(),
                    dilation,
                },
                loads: &loads,
                following: &[],
                fixed: &pressed.fixed,
                penalties: &[],
                contact: None,
                tools: &[],
                curves: Curves::proportional(),
                systems,
            };
            group.bench_function(format!("{name} {} dofs, {how}", 3 * pressed.mesh.points().len()), |b| {
                b.iter(|| {
                    let path = solve_static(&problem, &params, |_, _| {}).unwrap();
                    assert!(path.failure.is_none());
                    path
                })
            });
        }
    }
    group.finish();
}

criterion_group!(stage, benches);
criterion_main!(stage);
