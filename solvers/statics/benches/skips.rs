//! Cost of every stage that a plan can skip: the same result is computed with and without the stage. Two
//! kinds of stages are not covered: stages that can be skipped only with another method or problem (supports
//! of clouds, weak supports, contact), and stored runs.

mod common;

use std::hint::black_box;
use std::time::Duration;

use common::Pressed;
use criterion::{Criterion, criterion_group, criterion_main};
use efg::{Approximation, Basis, CubicSpline, Kernel, Support};
use fem::VolumeRule;
use geometry::{CellKind, Kidney, cloud};
use interp::{MlsLinear, Scheme};
use material::LinearElastic;
use shape::Vector3;
use tissuebench_statics::assemble;

/// Volumetric projection up to the assembled stiffness, on an element that does not lock. One dilation per
/// tet10 couples no further nodes, so the factorisation is the same.
fn projection(c: &mut Criterion) {
    let pressed = Pressed::of(CellKind::Tet10, 4);
    let loads = pressed.loads();
    let mut group = c.benchmark_group("volumetric projection");
    group.bench_function("skipped", |b| {
        b.iter(|| drop(black_box(assemble(&pressed.problem(&loads, false)).unwrap())))
    });
    group.bench_function("done", |b| {
        b.iter(|| {
            let groups = fem::element_dilation(&pressed.mesh, &VolumeRule::STANDARD).unwrap();
            let mut problem = pressed.problem(&loads, false);
            problem.body.dilation = Some(&groups);
            black_box(assemble(&problem).unwrap());
        })
    });
    group.finish();
}

/// Look-up of the law of every point in a body with a single law.
fn laws(c: &mut Criterion) {
    let pressed = Pressed::new(10);
    let loads = pressed.loads();
    let two = [pressed.material[0], LinearElastic::new(5e3, 0.3).unwrap()];
    let points = pressed.volume.weights().len();
    let mut group = c.benchmark_group("elasticity tensor per region");
    let assembled = |region: &[u16], materials: &[LinearElastic]| {
        let mut problem = pressed.problem(&loads, false);
        (problem.body.region, problem.body.materials) = (region, materials);
        black_box(assemble(&problem).unwrap());
    };
    group.bench_function("skipped", |b| b.iter(|| assembled(&[], &pressed.material)));
    // Two laws alternate from point to point, so every node meets both.
    group.bench_function("done", |b| {
        b.iter(|| {
            let region: Vec<u16> = (0..points).map(|q| (q % 2) as u16).collect();
            assembled(&region, &two);
        })
    });
    group.finish();
}

/// Ten load sets with one factorisation in all, and with one factorisation each.
fn factorisation(c: &mut Criterion) {
    let pressed = Pressed::new(10);
    let loads = pressed.loads();
    let factored = || assemble(&pressed.problem(&loads, false)).unwrap().factor().unwrap();
    let mut group = c.benchmark_group("factorisation for each of 10 load sets");
    group.bench_function("skipped", |b| {
        b.iter(|| {
            let factored = factored();
            (0..10).for_each(|_| drop(black_box(factored.solve_loads(&loads).unwrap())));
        })
    });
    group.bench_function("done", |b| {
        b.iter(|| (0..10).for_each(|_| drop(black_box(factored().solve_loads(&loads).unwrap()))))
    });
    group.finish();
}

/// Displacement at the nodes of elements, which equals the nodal parameters.
fn own_nodes(c: &mut Criterion) {
    let pressed = Pressed::new(10);
    let u: Vec<Vector3> = pressed.mesh.points().iter().map(|x| 0.1 * x.coords).collect();
    let mut group = c.benchmark_group("transfer from elements to their nodes");
    group.bench_function("skipped", |b| b.iter(|| black_box(&u).clone()));
    group.bench_function("done", |b| {
        b.iter(|| {
            let (rows, _) = fem::nearest_point_rows(&pressed.mesh, pressed.mesh.points()).unwrap();
            rows.rows().apply(black_box(&u))
        })
    });
    group.finish();
}

/// A cloud of 83 nodes in the kidney, evaluated at 1331 points: gradients although values suffice, and a
/// transfer scheme although the method's own shape functions suffice.
fn of_clouds(c: &mut Criterion) {
    let nodes = cloud(&Kidney, 83, 1, &[]).unwrap();
    let targets = cloud(&Kidney, 1331, 2, &[]).unwrap().points;
    let radii = Support::Dilatation { factor: 1.6 }.radii(&nodes.points, &nodes.spacing).unwrap();
    let mls =
        Approximation::new(nodes.points.clone(), radii, Kernel::CubicSpline(CubicSpline), Basis::Linear)
            .unwrap();
    let u: Vec<Vector3> = nodes.points.iter().map(|x| 0.1 * x.coords).collect();
    let mut group = c.benchmark_group("gradients at 1331 points");
    group.bench_function("skipped", |b| b.iter(|| mls.point_rows(&targets).unwrap()));
    group.bench_function("done", |b| b.iter(|| mls.grad_rows(&targets).unwrap()));
    group.finish();

    let mut group = c.benchmark_group("transfer scheme to 1331 points");
    let own = || mls.point_rows(&targets).unwrap().0.rows().apply(&u);
    group.bench_function("skipped", |b| b.iter(own));
    group.bench_function("done (mls-linear)", |b| {
        b.iter(|| {
            let at_nodes = mls.point_rows(&nodes.points).unwrap().0.rows().apply(&u);
            let scheme = Scheme::MlsLinear(MlsLinear { support_scale: 1.6 });
            scheme.rows(&nodes.points, None, &targets).unwrap().0.rows().apply(&at_nodes)
        })
    });
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(2));
    targets = projection, laws, factorisation, own_nodes, of_clouds
}
criterion_main!(benches);
