//! A load step at large strain: tangents factored, and iterated with multigrid; and the same step with a
//! pressure that follows the surface, with fibres, and on springs, relative to a dead pressure.

mod common;

use common::Pressed;
use criterion::{Criterion, criterion_group, criterion_main};
use fem::SurfaceRule;
use geometry::CellKind;
use material::{HolzapfelOgden, Law, NeoHookean};
use shape::{Matrix3, Vector3};
use tissuebench_statics::{
    Active, Curves, FollowingLoad, LinearSystems, Load, NewtonParams, PenaltySurface, Solid, SolidDilation,
    StaticParams, StaticPath, StaticProblem, solve_static,
};

/// Returns the step that presses a cube with one law.
fn problem<'a>(
    pressed: &'a Pressed,
    loads: &'a [Load<'a>],
    laws: &'a [Law],
    dilation: SolidDilation<'a>,
) -> StaticProblem<'a> {
    StaticProblem {
        nodes: pressed.mesh.points(),
        solid: Solid {
            volume: &pressed.volume,
            laws,
            region: &[],
            axes: &[],
            active: Active::default(),
            dilation,
        },
        loads,
        following: &[],
        fixed: &pressed.fixed,
        penalties: &[],
        contact: None,
        tools: &[],
        curves: Curves::proportional(),
        systems: LinearSystems::Factored,
    }
}

fn solve(problem: &StaticProblem) -> StaticPath {
    let newton = NewtonParams {
        tolerance: 1e-9,
        iterations: 25,
        chords: true,
        keeps: NewtonParams::KEEPS,
        loosest: Some(NewtonParams::LOOSEST),
    };
    let params =
        StaticParams { steps: 1, smallest: 1.0 / 64.0, newton, augmentations: 0, limit_within: None };
    let path = solve_static(problem, &params, |_, _| {}).unwrap();
    assert!(path.failure.is_none());
    path
}

fn systems(c: &mut Criterion) {
    let mut group = c.benchmark_group("newton");
    group.sample_size(10);
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
            let problem = StaticProblem { systems, ..problem(&pressed, &loads, &laws, dilation) };
            group.bench_function(format!("{name} {} dofs, {how}", 3 * pressed.mesh.points().len()), |b| {
                b.iter(|| solve(&problem))
            });
        }
    }
    group.finish();
}

/// Steps of hex8, named with the tangents that they take.
fn conditions(c: &mut Criterion) {
    let pressed = Pressed::of(CellKind::Hex8, 12);
    let mesh = &pressed.mesh;
    let values = vec![1e3; pressed.top.weights().len()];
    let loads = [Load::Pressure { surface: &pressed.top, values: values.clone() }];
    let flux = fem::flux_rows(mesh, mesh.group("z-max").unwrap(), &SurfaceRule::STANDARD).unwrap();
    let following = [FollowingLoad::pressure(&flux, &values).unwrap()];
    let ground = fem::surface_rows(mesh, mesh.group("z-min").unwrap(), &SurfaceRule::STANDARD).unwrap();
    let springs = [PenaltySurface {
        axes: [true; 3],
        along_normal: false,
        values: vec![Vector3::zeros(); ground.weights().len()],
        from: Vec::new(),
        beta: 1e6,
        damping: 0.0,
        surface: &ground,
    }];
    let isotropic = [Law::NeoHookean(NeoHookean::new(20e3, 0.45).unwrap())];
    let heart = HolzapfelOgden::new([2e3, 5.0], [4e3, 5.0], [1e3, 5.0], [5e2, 5.0], 2e5).unwrap();
    let fibers = [Law::HolzapfelOgden(heart)];
    let axes = vec![Matrix3::identity(); pressed.volume.weights().len()];

    let dead = problem(&pressed, &loads, &isotropic, SolidDilation::Standard);
    let mut along = problem(&pressed, &loads, &fibers, SolidDilation::Standard);
    along.solid.axes = &axes;
    let follows = StaticProblem { loads: &[], following: &following, ..dead.clone() };
    let held = StaticProblem { fixed: &[], penalties: &springs, ..dead.clone() };
    let mut group = c.benchmark_group("conditions of a step");
    group.sample_size(10);
    let each =
        [("dead pressure", dead), ("following pressure", follows), ("fibers", along), ("springs", held)];
    for (name, problem) in &each {
        let tangents: usize = solve(problem).steps.iter().map(|step| step.iterations.len()).sum();
        group.bench_function(format!("{name}, {tangents} iterations"), |b| b.iter(|| solve(problem)));
    }
    group.finish();
}

criterion_group!(stage, systems, conditions);
criterion_main!(stage);
