//! Build and apply per scheme, at the size of the paper: 83 nodes to about 1330 points of the kidney.

use criterion::{Criterion, criterion_group, criterion_main};
use geometry::generate::kidney_mesh;
use geometry::{CellKind, Kidney, cloud};
use interp::Scheme;
use shape::{RowBlocks, Vector3};
use std::hint::black_box;

fn transfer(criterion: &mut Criterion) {
    let nodes = cloud(&Kidney, 83, 1, &[]).unwrap().points;
    let targets = cloud(&Kidney, 1331, 2, &[]).unwrap().points;
    // Barycentric transfer wants a mesh over its nodes: a coarse one, of 321 nodes and 1536 cells.
    let mesh = kidney_mesh(CellKind::Tet4, 4).unwrap();
    let mut group = criterion.benchmark_group("transfer");
    for scheme in Scheme::ALL {
        let (nodes, mesh) =
            if scheme == Scheme::Barycentric { (mesh.points(), Some(&mesh)) } else { (&nodes[..], None) };
        let build = || scheme.rows(nodes, mesh, &targets).expect("a sound cloud");
        group.bench_function(format!("build/{}", scheme.name()), |b| b.iter(|| black_box(build())));
        let (rows, _) = build();
        group.bench_function(format!("pack/{}", scheme.name()), |b| {
            b.iter(|| RowBlocks::new(black_box(rows.rows())))
        });
        let blocks = RowBlocks::new(rows.rows());
        let field: Vec<Vector3> = nodes.iter().map(|x| 0.1 * x.coords).collect();
        let mut out = vec![Vector3::zeros(); targets.len()];
        group.bench_function(format!("apply/{}", scheme.name()), |b| {
            b.iter(|| blocks.apply_into(black_box(&field), &mut out))
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20).measurement_time(std::time::Duration::from_secs(1));
    targets = transfer
}
criterion_main!(benches);
