//! Bodies of the benchmarks.

use geometry::CellKind;
use geometry::generate::{Jitter, box_mesh};
use shape::{DilationGroups, GradRows, HourglassModulus, Point3, Rows, Unity, Vector3, VolumeRows};

/// Returns a box of `cells` cubed cells, its dilation groups, and displacements with strains near 0.1.
pub fn solid(kind: CellKind, cells: usize) -> (VolumeRows, DilationGroups, Vec<Vector3>) {
    let jitter = Some(Jitter { fraction: 0.1, seed: 1 });
    let max = Point3::new(0.04, 0.04, 0.04);
    let mesh = box_mesh(kind, Point3::origin(), max, [cells; 3], [1.0; 3], jitter).unwrap();
    let rule = fem::VolumeRule::STANDARD;
    let volume = fem::volume_rows(&mesh, &rule).unwrap();
    let groups = match kind {
        CellKind::Tet4 => DilationGroups::nodal(&volume).unwrap(),
        _ => fem::element_dilation(&mesh, &rule).unwrap(),
    };
    let field = |x: &Point3| Vector3::new(0.05 * x.y, -0.04 * x.z, 0.1 * x.x);
    let u = mesh.points().iter().map(field).collect();
    (volume, groups, u)
}

/// Returns a box of `cells` cubed hexahedra with one point and hourglass control, and displacements as in
/// [`solid`].
#[allow(dead_code)] // not of every benchmark
pub fn one_point(cells: usize) -> (VolumeRows, Vec<Vector3>) {
    let jitter = Some(Jitter { fraction: 0.1, seed: 1 });
    let max = Point3::new(0.04, 0.04, 0.04);
    let mesh = box_mesh(CellKind::Hex8, Point3::origin(), max, [cells; 3], [1.0; 3], jitter).unwrap();
    let field = |x: &Point3| Vector3::new(0.05 * x.y, -0.04 * x.z, 0.1 * x.x);
    let u = mesh.points().iter().map(field).collect();
    (fem::uniform_rows(&mesh, 0.05, HourglassModulus::PWave).unwrap(), u)
}

/// Returns points spread over the cells of a grid, each with its (up to) 31 nearest grid nodes, like the
/// counts and the locality of a meshless cloud. The gradients are smooth, of realistic size and without
/// further meaning.
#[allow(dead_code)] // not of every benchmark
pub fn cloud(cells: usize, per_cell: usize) -> (VolumeRows, Vec<Vector3>) {
    let (n, h) = (cells + 1, 0.04 / cells as f64);
    let (mut points, mut offsets, mut nodes, mut grads) = (Vec::new(), vec![0], Vec::new(), Vec::new());
    for cell in 0..cells * cells * cells {
        let c = [cell % cells, cell / cells % cells, cell / cells / cells];
        for k in 0..per_cell {
            let t = (k as f64 + 0.5) / per_cell as f64;
            let p = Point3::new(c[0] as f64 + t, c[1] as f64 + 0.4, c[2] as f64 + 1.0 - t);
            let around = |axis: usize| c[axis].saturating_sub(1)..(c[axis] + 3).min(n);
            let mut near = Vec::new();
            for z in around(2) {
                for y in around(1) {
                    for x in around(0) {
                        let distance = (Point3::new(x as f64, y as f64, z as f64) - p).norm();
                        near.push((distance, (x + n * (y + n * z)) as u32));
                    }
                }
            }
            near.sort_by(|a, b| a.0.total_cmp(&b.0));
            near.truncate(31);
            near.sort_by_key(|a| a.1);
            for (i, (_, node)) in near.iter().enumerate() {
                let s = i as f64;
                nodes.push(*node);
                grads.push(Vector3::new(s.sin(), s.cos(), (2.0 * s).sin()) / h);
            }
            offsets.push(nodes.len());
            points.push(p * h);
        }
    }
    let count = points.len();
    let values = vec![0.0; nodes.len()];
    let rows = Rows::new(n * n * n, offsets, nodes, values, Unity::NotPromised).unwrap();
    let volume = VolumeRows::new(GradRows::new(points, rows, grads).unwrap(), vec![1e-9; count]).unwrap();
    // Displacements of the order of the grid spacing times a strain of 0.01.
    let wave =
        |i: usize| Vector3::new((i as f64).sin(), 0.3, (0.5 * i as f64).cos()) * (4e-4 / cells as f64 / 31.0);
    (volume, (0..n * n * n).map(wave).collect())
}
