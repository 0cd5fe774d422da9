//! Pattern, rigid-motion check and assembly.

mod common;

use common::Pressed;
use criterion::{Criterion, criterion_group, criterion_main};
use efg::{Approximation, Basis, CubicSpline, Kernel};
use geometry::generate::kidney_mesh;
use geometry::{CellKind, Cloud, Kidney};
use material::LinearElastic;
use shape::DilationGroups;
use shape::FixedDof;
use tissuebench_statics::{LinearBody, LinearProblem, assemble};

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
    let pressed = Pressed::of(CellKind::Tet10, 10);
    let loads = pressed.loads();
    group.bench_function("tet10, 27783 dofs", |b| {
        b.iter(|| assemble(&pressed.problem(&loads, false)).unwrap())
    });
    // Clouds of the kidney over its 6288 tetrahedra, with one point each. Only assembly is timed, so all
    // parameters are constrained.
    let background = kidney_mesh(CellKind::Tet4, 8).unwrap();
    let material = [LinearElastic::new(20e3, 0.495).unwrap()];
    for nodes in [83, 1331] {
        let Cloud { points, spacing, .. } = geometry::cloud(&Kidney, nodes, 1, &[]).unwrap();
        let radii = spacing.iter().map(|h| 1.6 * h).collect();
        let mls = Approximation::new(points.clone(), radii, Kernel::CubicSpline(CubicSpline), Basis::Linear)
            .unwrap();
        let volume = efg::gauss_rows(&mls, &background, 1).unwrap().0;
        let nodal = DilationGroups::nodal(&volume).unwrap();
        let fixed: Vec<_> = (0..3 * nodes as u32)
            .map(|k| FixedDof { node: k / 3, axis: (k % 3) as u8, value: 0.0 })
            .collect();
        for (name, dilation) in [("cloud", None), ("cloud nodal dilation", Some(&nodal))] {
            let body =
                LinearBody { nodes: &points, volume: &volume, materials: &material, region: &[], dilation };
            let problem = LinearProblem { body, loads: &[], fixed: &fixed, constraints: &[], weak: &[] };
            let entries = volume.rows().nodes().len() / volume.rows().len();
            group.bench_function(
                format!("{name}, {nodes} nodes, {} points of {entries}", volume.rows().len()),
                |b| b.iter(|| assemble(&problem).unwrap()),
            );
        }
    }
    group.finish();
}

criterion_group!(stage, benches);
criterion_main!(stage);
