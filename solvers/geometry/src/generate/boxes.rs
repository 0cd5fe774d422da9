//! Axis-parallel boxes, graded and jittered.

use super::{GenerateError, check_cells, check_total, graded, into_kind};
use crate::element::CellKind;
use crate::mesh::{Facet, Mesh};
use crate::random::Uniform;
use crate::{Point3, quality};

/// A seeded random shift of inner nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jitter {
    /// Largest shift per axis as a fraction of the local node spacing, in [0, 0.5).
    pub fraction: f64,
    /// Seed of the ChaCha8 stream.
    pub seed: u64,
}

/// Meshes a box from `min` to `max` (m) with `cells` hexahedra along x, y, z, or with six tetrahedra in each
/// of them.
///
/// `grading` is the ratio of the last to the first interval per axis (1: uniform; spacing grows
/// geometrically). `jitter` moves corner nodes inside the box by up to `fraction` of the smaller adjoining
/// interval, per axis. Mid-edge nodes stay halfway. Facet groups: [`surfaces::BOX`](super::surfaces::BOX).
/// Corner nodes are numbered with x fastest.
///
/// # Errors
/// A parameter out of range, or cells that jitter or grading leave inverted or flat.
pub fn box_mesh(
    kind: CellKind,
    min: Point3,
    max: Point3,
    cells: [usize; 3],
    grading: [f64; 3],
    jitter: Option<Jitter>,
) -> Result<Mesh, GenerateError> {
    const COUNT: [&str; 3] =
        ["the number of cells along x", "the number of cells along y", "the number of cells along z"];
    const LENGTH: [&str; 3] =
        ["the box's length along x", "the box's length along y", "the box's length along z"];
    for axis in 0..3 {
        check_cells(COUNT[axis], cells[axis])?;
        super::check_positive(LENGTH[axis], max[axis] - min[axis])?;
        super::check_positive("the grading", grading[axis])?;
    }
    check_total(cells)?;
    let axes: [Vec<f64>; 3] = std::array::from_fn(|axis| {
        let length = max[axis] - min[axis];
        let mut x: Vec<f64> =
            graded(cells[axis], grading[axis]).iter().map(|t| min[axis] + length * t).collect();
        x[cells[axis]] = max[axis];
        x
    });
    let mut points = Vec::with_capacity(cells.iter().map(|n| n + 1).product());
    for &z in &axes[2] {
        for &y in &axes[1] {
            points.extend(axes[0].iter().map(|&x| Point3::new(x, y, z)));
        }
    }
    if let Some(jitter) = jitter {
        shift_inner_nodes(&mut points, &axes, jitter)?;
    }
    let mesh = into_kind(hexahedra(points, cells)?, kind);
    if jitter.is_some() || grading != [1.0; 3] {
        quality::check_inversion(&mesh)?;
    }
    Ok(mesh)
}

fn shift_inner_nodes(
    points: &mut [Point3],
    axes: &[Vec<f64>; 3],
    jitter: Jitter,
) -> Result<(), GenerateError> {
    if !(0.0..0.5).contains(&jitter.fraction) {
        return Err(GenerateError::Value {
            what: "the jitter fraction",
            found: jitter.fraction,
            needed: "at least 0 and below 0.5",
        });
    }
    let mut random = Uniform::new(jitter.seed);
    let inner = |axis: usize| 1..axes[axis].len() - 1;
    for k in inner(2) {
        for j in inner(1) {
            for i in inner(0) {
                let node = (k * axes[1].len() + j) * axes[0].len() + i;
                for (axis, at) in [i, j, k].into_iter().enumerate() {
                    let x = &axes[axis];
                    let h = (x[at] - x[at - 1]).min(x[at + 1] - x[at]);
                    points[node][axis] += h * random.between(-jitter.fraction, jitter.fraction);
                }
            }
        }
    }
    Ok(())
}

fn hexahedra(points: Vec<Point3>, cells: [usize; 3]) -> Result<Mesh, GenerateError> {
    let [nx, ny, nz] = cells;
    let node = |i: usize, j: usize, k: usize| ((k * (ny + 1) + j) * (nx + 1) + i) as u32;
    let mut nodes = Vec::with_capacity(8 * nx * ny * nz);
    let mut groups: [Vec<Facet>; 6] = Default::default();
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                let cell = (nodes.len() / 8) as u32;
                for (di, dj, dk) in super::lattice::CORNERS {
                    nodes.push(node(i + di, j + dj, k + dk));
                }
                // Faces of a hexahedron in the order of `CellKind::faces`: z-, z+, y-, x+, y+, x-.
                let sides = [i == 0, i + 1 == nx, j == 0, j + 1 == ny, k == 0, k + 1 == nz];
                for (group, face) in [5, 3, 2, 4, 0, 1].into_iter().enumerate() {
                    if sides[group] {
                        groups[group].push(Facet { cell, face });
                    }
                }
            }
        }
    }
    let mut mesh = Mesh::from_flat(points, vec![CellKind::Hex8; nx * ny * nz], nodes)?;
    for (name, facets) in super::surfaces::BOX.into_iter().zip(groups) {
        mesh = mesh.with_group(name, facets)?;
    }
    Ok(mesh)
}
