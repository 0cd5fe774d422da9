//! Meshes shared by the table tests: every kind, straight and curved, and a mixture of all.
#![allow(dead_code)]

use geometry::generate::{Jitter, ball_mesh, box_mesh};
use geometry::{CellKind, Facet, Mesh, Point3};

/// Returns the box [0, 2] x [0, 1] x [0, 1] with its inner corner nodes shifted.
pub fn jittered(kind: CellKind, seed: u64) -> Mesh {
    let jitter = Some(Jitter { fraction: 0.2, seed });
    box_mesh(kind, Point3::origin(), Point3::new(2.0, 1.0, 1.0), [4, 2, 2], [1.0; 3], jitter).unwrap()
}

/// Returns a box of cells with affine maps: sheared and stretched, off the origin.
pub fn affine(kind: CellKind) -> Mesh {
    box_mesh(kind, Point3::origin(), Point3::new(1.0, 1.0, 1.0), [2, 2, 2], [1.0; 3], None)
        .unwrap()
        .moved(|p| Point3::new(3.0 + p.x + 0.3 * p.y, -1.0 + 0.7 * p.y - 0.2 * p.z, 2.0 * p.z + 0.1 * p.x))
        .unwrap()
}

/// Returns a ball of radius 2 cm, with curved cells for the quadratic kinds.
pub fn ball(kind: CellKind) -> Mesh {
    ball_mesh(kind, 0.02, 3).unwrap()
}

/// Returns one body of each kind side by side in one mesh, regions 0 to 3, cells of all kinds interleaved.
pub fn mixed() -> Mesh {
    let parts = CellKind::ALL.map(ball);
    let mut points = Vec::new();
    let mut cells = Vec::new();
    for (i, part) in parts.iter().enumerate() {
        let first = points.len() as u32;
        points.extend(part.points().iter().map(|p| Point3::new(p.x + 0.1 * i as f64, p.y, p.z)));
        for cell in 0..part.cell_count() {
            let nodes = part.cell(cell).iter().map(|n| n + first).collect();
            cells.push((cell, i as u16, part.kind(cell), nodes));
        }
    }
    cells.sort_by_key(|c| (c.0, c.1));
    let regions = cells.iter().map(|c| c.1).collect();
    let cells: Vec<(CellKind, Vec<u32>)> = cells.into_iter().map(|c| (c.2, c.3)).collect();
    let names = CellKind::ALL.map(|k| k.name().to_string()).to_vec();
    Mesh::new(points, &cells).unwrap().with_regions(regions, names)
}

/// Returns every mesh of the list, with its name.
pub fn all() -> Vec<(String, Mesh)> {
    let mut list = Vec::new();
    for kind in CellKind::ALL {
        list.push((format!("jittered {}", kind.name()), jittered(kind, 7)));
        list.push((format!("affine {}", kind.name()), affine(kind)));
        list.push((format!("ball {}", kind.name()), ball(kind)));
    }
    list.push(("mixed".into(), mixed()));
    list
}

/// Returns the middle of a facet's corners and of its cell's corners.
pub fn middles(mesh: &Mesh, facet: Facet) -> (Point3, Point3) {
    let mean = |nodes: Vec<u32>| {
        let sum = nodes.iter().fold(shape::Vector3::zeros(), |s, &n| s + mesh.points()[n as usize].coords);
        Point3::from(sum / nodes.len() as f64)
    };
    let kind = mesh.kind(facet.cell as usize);
    (
        mean(mesh.facet_corners(facet).collect()),
        mean(mesh.cell(facet.cell as usize)[..kind.corner_count()].to_vec()),
    )
}
