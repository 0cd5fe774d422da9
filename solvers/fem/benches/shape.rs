//! Benchmark of the shape stage: volume rows of boxes of about 6,000 tet4, 6,000 tet10 and 1,000 hex20, and
//! rows at 1,331 points of the tet4 box. Surface and flux rows and points outside are not covered.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use geometry::generate::box_mesh;
use geometry::{CellKind, Mesh, Point3};
use tissuebench_fem::{VolumeRule, point_rows, volume_rows};

fn cube(kind: CellKind, n: usize) -> Mesh {
    box_mesh(kind, Point3::origin(), Point3::new(0.1, 0.1, 0.1), [n; 3], [1.0; 3], None).unwrap()
}

fn shape(c: &mut Criterion) {
    let mut group = c.benchmark_group("shape");
    for (kind, n) in [(CellKind::Tet4, 10), (CellKind::Tet10, 10), (CellKind::Hex20, 10)] {
        let mesh = cube(kind, n);
        let name = format!("volume-rows/{}-{}", kind.name(), mesh.cell_count());
        group.bench_function(name, |b| {
            b.iter(|| volume_rows(black_box(&mesh), &VolumeRule::STANDARD).unwrap())
        });
    }
    let mesh = cube(CellKind::Tet4, 10);
    let targets = cube(CellKind::Tet4, 10).points().iter().map(|p| p * 0.999).collect::<Vec<_>>();
    group.bench_function(format!("point-rows/tet4-{}", targets.len()), |b| {
        b.iter(|| point_rows(black_box(&mesh), &targets).unwrap())
    });
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .warm_up_time(std::time::Duration::from_millis(300))
        .measurement_time(std::time::Duration::from_secs(1));
    targets = shape
}
criterion_main!(benches);
