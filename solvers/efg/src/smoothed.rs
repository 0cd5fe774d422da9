//! Conforming cell smoothing: one integration point per tet4, its gradient the mean over the cell by Gauss's theorem.

use geometry::Mesh;
use rayon::prelude::*;
use shape::{GradRows, Point3, PointRows, Rows, Unity, Vector3, VolumeRows};

use crate::cells::tet_measure;
use crate::facets::{canonical, triangle_points, triangle_rule, vector_area};
use crate::{Approximation, EfgError, MlsInfo};

/// Cells per parallel task: fixed, so that results are the same bits at any thread count.
const CHUNK: usize = 128;

/// The distinct faces of a mesh of tet4, each once.
struct Faces {
    /// Canonical corners of each face.
    corners: Vec<[u32; 3]>,
    /// The four faces of each cell, and -1 where the cell's outward normal opposes the canonical one.
    of_cell: Vec<[(u32, f64); 4]>,
}

/// Rows of one chunk of cells.
#[derive(Default)]
struct Batch {
    lengths: Vec<usize>,
    nodes: Vec<u32>,
    values: Vec<f64>,
    grads: Vec<Vector3>,
}

/// One row per cell of a tet4 background: values at the centroid, weight the cell's volume `V`, and gradients
/// smoothed over the cell, `grad~_I = (1/V) sum_faces sum_q w_q phi_I(x_q) n` (1/m).
///
/// Each interior face's points are evaluated once and serve both sides with opposite normals, so that
/// `sum_cells V grad~_I = sum_boundary w phi_I n` to rounding with [`crate::surface_rows`] at the same
/// `face_points`: linear patch tests pass to rounding. One point per cell with a linear field inside: locks near
/// incompressibility unless the dilation is projected. Source: Chen, Wu, Yoon and You (2001), smoothing on the
/// background's cells.
pub fn smoothed_rows(
    approximation: &Approximation,
    background: &Mesh,
    face_points: usize,
) -> Result<(VolumeRows, MlsInfo), EfgError> {
    let rule = triangle_rule(face_points)?;
    let measures = (0..background.cell_count()).map(|cell| tet_measure(background, cell));
    let (volumes, centroids): (Vec<f64>, Vec<Point3>) =
        measures.collect::<Result<Vec<_>, _>>()?.into_iter().unzip();
    let faces = faces(background);
    // Face points first, centroids after: one table, one report.
    let mut points = Vec::with_capacity(faces.corners.len() * rule.len() + centroids.len());
    for &corners in &faces.corners {
        triangle_points(background, corners, &rule, &mut points);
    }
    let first_centroid = points.len();
    points.extend_from_slice(&centroids);
    let (at, info) = approximation.point_rows(&points)?;
    let areas: Vec<Vector3> = faces.corners.iter().map(|&c| vector_area(background, c)).collect();
    let cells: Vec<usize> = (0..volumes.len()).collect();
    let batches: Vec<Batch> = cells
        .par_chunks(CHUNK)
        .map(|chunk| {
            let mut batch = Batch::default();
            let mut sum = Sum::new(approximation.nodes().len());
            for &cell in chunk {
                for (face, sign) in faces.of_cell[cell] {
                    let flow = areas[face as usize] * (sign / volumes[cell]);
                    for q in 0..rule.len() {
                        // The rule's weights sum to 1/2, the area of the reference triangle.
                        sum.add_gradient(&at, face as usize * rule.len() + q, flow * (2.0 * rule.weights[q]));
                    }
                }
                sum.add_value(&at, first_centroid + cell);
                sum.drain_into(&mut batch);
            }
            batch
        })
        .collect();

    let mut offsets = vec![0];
    let (mut nodes, mut values, mut grads) = (Vec::new(), Vec::new(), Vec::new());
    for batch in batches {
        for length in batch.lengths {
            offsets.push(offsets[offsets.len() - 1] + length);
        }
        nodes.extend_from_slice(&batch.nodes);
        values.extend_from_slice(&batch.values);
        grads.extend_from_slice(&batch.grads);
    }
    let rows = Rows::new(approximation.nodes().len(), offsets, nodes, values, Unity::Within(1e-8))?;
    let volume = VolumeRows::new(GradRows::new(centroids, rows, grads)?, volumes)?;
    Ok((volume, info))
}

/// Region of the background at every point of [`smoothed_rows`].
pub fn smoothed_regions(background: &Mesh) -> Vec<u16> {
    (0..background.cell_count()).map(|cell| background.region(cell)).collect()
}

/// A row being summed, dense over the nodes with a list of those touched.
struct Sum {
    value: Vec<f64>,
    grad: Vec<Vector3>,
    seen: Vec<bool>,
    touched: Vec<u32>,
}

impl Sum {
    fn new(nodes: usize) -> Sum {
        let (value, grad) = (vec![0.0; nodes], vec![Vector3::zeros(); nodes]);
        Sum { value, grad, seen: vec![false; nodes], touched: Vec::new() }
    }

    fn touch(&mut self, node: u32) {
        if !std::mem::replace(&mut self.seen[node as usize], true) {
            self.touched.push(node);
        }
    }

    fn add_gradient(&mut self, at: &PointRows, row: usize, flow: Vector3) {
        let (nodes, values) = at.rows().row(row);
        for (&node, &value) in nodes.iter().zip(values) {
            self.touch(node);
            self.grad[node as usize] += flow * value;
        }
    }

    fn add_value(&mut self, at: &PointRows, row: usize) {
        let (nodes, values) = at.rows().row(row);
        for (&node, &value) in nodes.iter().zip(values) {
            self.touch(node);
            self.value[node as usize] += value;
        }
    }

    /// Appends the row by ascending node and clears.
    fn drain_into(&mut self, batch: &mut Batch) {
        self.touched.sort_unstable();
        batch.lengths.push(self.touched.len());
        for &node in &self.touched {
            let i = node as usize;
            batch.nodes.push(node);
            batch.values.push(std::mem::take(&mut self.value[i]));
            batch.grads.push(std::mem::take(&mut self.grad[i]));
            self.seen[i] = false;
        }
        self.touched.clear();
    }
}

fn faces(mesh: &Mesh) -> Faces {
    let mut all: Vec<([u32; 3], u32, u8, bool)> = Vec::with_capacity(4 * mesh.cell_count());
    for cell in 0..mesh.cell_count() {
        for (face, local) in mesh.kind(cell).faces().iter().enumerate() {
            let nodes = mesh.cell(cell);
            let (corners, turned) = canonical([nodes[local[0]], nodes[local[1]], nodes[local[2]]]);
            all.push((corners, cell as u32, face as u8, turned));
        }
    }
    all.sort_unstable();
    let mut corners: Vec<[u32; 3]> = Vec::with_capacity(all.len() / 2);
    let mut of_cell = vec![[(0, 1.0); 4]; mesh.cell_count()];
    for (triangle, cell, face, turned) in all {
        if corners.last() != Some(&triangle) {
            corners.push(triangle);
        }
        let sign = if turned { -1.0 } else { 1.0 };
        of_cell[cell as usize][face as usize] = (corners.len() as u32 - 1, sign);
    }
    Faces { corners, of_cell }
}
