//! Benchmark of contact over a surface: skipped, near without touching, touching; with and without tangents.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use geometry::CellKind;
use geometry::generate::box_mesh;
use shape::{Matrix3, Point3, Vector3};
use tissuebench_contact::{
    ContactCounts, ContactHistory, ContactLaw, ContactSurface, Plate, RoundedBox, Slip, Tool, ToolShape,
};

fn benches(c: &mut Criterion) {
    let max = Point3::new(0.04, 0.03, 0.02);
    let mesh = box_mesh(CellKind::Tet4, Point3::origin(), max, [20, 16, 10], [1.0; 3], None).unwrap();
    let sides = ["x-min", "x-max", "y-min", "y-max", "z-min", "z-max"];
    let facets: Vec<_> = sides.iter().flat_map(|s| mesh.group(s).unwrap().to_vec()).collect();
    let rows = fem::surface_rows(&mesh, &facets, &fem::SurfaceRule::STANDARD).unwrap();
    let surface = ContactSurface::new(&rows);
    let u = vec![Vector3::new(1e-5, 2e-5, 0.0); mesh.points().len()];
    let law = ContactLaw::coulomb(5e8, 0.15, 1e8).unwrap();
    let down = -Vector3::z();
    let jaw = ToolShape::RoundedBox(RoundedBox { half: [5e-3, 10e-3, 4e-3], radius: 1.5e-3 });
    let tool = |shape, turn| Tool::new(shape, Point3::new(0.02, 0.015, 0.024), turn, down, law).unwrap();
    let plate = tool(ToolShape::Plate(Plate), Tool::turned_to(&down));
    let jaw = tool(jaw, Matrix3::identity());

    let mut group = c.benchmark_group("contact");
    for (name, tool, closure) in [
        ("jaw, far", &jaw, -0.1),
        ("jaw, near, none touch", &jaw, -1e-4),
        ("jaw, 0.1 mm in", &jaw, 1e-4),
        ("plate, 0.1 mm in", &plate, 4.1e-3),
    ] {
        let mut history = ContactHistory::new(tool, rows.points().len());
        let mut counts = ContactCounts::default();
        let first = surface.evaluate(tool, closure, &u, &history, &mut counts).unwrap();
        history.commit(first.as_ref());
        let name = format!(
            "{name}: {} of {} points looked at, {} touch",
            counts.distances,
            rows.points().len(),
            counts.active
        );
        group.bench_function(format!("{name}, tangents"), |b| {
            b.iter(|| surface.evaluate(tool, closure, black_box(&u), &history, &mut counts).unwrap())
        });
        group.bench_function(format!("{name}, tractions"), |b| {
            b.iter(|| surface.tractions(tool, closure, black_box(&u), &history, &mut counts).unwrap())
        });
    }
    let slip = jaw.contact(0.0, &Point3::new(0.02, 0.015, 0.0201), &Slip::NONE, 0.0).slip;
    for (name, z) in [("inactive", 0.0199), ("active, sticking", 0.0201)] {
        let x = Point3::new(0.02002, 0.015, z);
        group.bench_function(format!("one point, {name}"), |b| {
            b.iter(|| black_box(&jaw).contact(0.0, black_box(&x), black_box(&slip), 0.0))
        });
    }
    group.finish();
}

criterion_group!(stage, benches);
criterion_main!(stage);
