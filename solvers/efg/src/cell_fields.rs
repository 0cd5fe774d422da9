//! Smoothed gradients of cells by their moments: one table of face points serves both sides of every face.

use geometry::Mesh;
use geometry::quadrature::{self, Rule};
use rayon::prelude::*;
use shape::{Point3, PointRows, Vector3};

use crate::cells::tet_measure;
use crate::facets::{canonical, triangle_points, triangle_rule, vector_area};
use crate::{Approximation, EfgError, MlsInfo};

/// Cells per parallel task: fixed, so that results are the same bits at any thread count.
const CHUNK: usize = 128;

/// Smoothed gradients of some cells by coefficients: `grad~_I(x) = sum_j slopes_j b_j(x)`, with `b = 1` (P = 1) or the
/// barycentric coordinates of the cell (P = 4).
pub(crate) struct CellFields<const P: usize> {
    pub offsets: Vec<usize>,
    /// Nodes of each cell, ascending.
    pub nodes: Vec<u32>,
    /// Coefficients, 1/m.
    pub slopes: Vec<[Vector3; P]>,
    /// Values at the cell's P points.
    pub values: Vec<[f64; P]>,
    /// Volumes, m^3.
    pub volumes: Vec<f64>,
    /// P points per cell.
    pub points: Vec<Point3>,
}

/// Fields of one chunk of cells.
struct Batch<const P: usize> {
    lengths: Vec<usize>,
    nodes: Vec<u32>,
    slopes: Vec<[Vector3; P]>,
    values: Vec<[f64; P]>,
}

impl<const P: usize> CellFields<P> {
    pub fn new(
        approximation: &Approximation,
        mesh: &Mesh,
        cells: &[usize],
        face_points: usize,
    ) -> Result<(CellFields<P>, MlsInfo), EfgError> {
        let rule = triangle_rule(face_points)?;
        let (mut volumes, mut inner) = (Vec::with_capacity(cells.len()), Vec::with_capacity(P * cells.len()));
        for &cell in cells {
            let (volume, centroid) = tet_measure(mesh, cell)?;
            volumes.push(volume);
            for b in &volume_basis::<P>() {
                // About the centroid: the point of P = 1 is the centroid itself.
                let offset: Vector3 = if P == 1 {
                    Vector3::zeros()
                } else {
                    mesh.cell_points(cell).zip(b).map(|(p, b)| (p - centroid) * *b).sum()
                };
                inner.push(centroid + offset);
            }
        }
        let faces = faces(mesh, cells);
        // Face points first, cell points after: one table, one report.
        let mut points = Vec::with_capacity(faces.corners.len() * rule.len() + inner.len());
        for &corners in &faces.corners {
            triangle_points(mesh, corners, &rule, &mut points);
        }
        let first_inner = points.len();
        points.extend_from_slice(&inner);
        let (at, info) = approximation.point_rows(&points)?;
        let areas: Vec<Vector3> = faces.corners.iter().map(|&c| vector_area(mesh, c)).collect();
        let order: Vec<usize> = (0..cells.len()).collect();
        let batches: Vec<Batch<P>> = order
            .par_chunks(CHUNK)
            .map(|chunk| {
                let mut batch =
                    Batch { lengths: Vec::new(), nodes: Vec::new(), slopes: Vec::new(), values: Vec::new() };
                let mut sum = Sum::<P>::new(approximation.nodes().len());
                for &index in chunk {
                    let volume = volumes[index];
                    for (face, &(number, sign)) in faces.of_cell[index].iter().enumerate() {
                        let flow = areas[number as usize] * (sign / volume);
                        let corners = local_corners(mesh, cells[index], face);
                        for (q, xi) in rule.points.iter().enumerate() {
                            // The rule's weights sum to 1/2, the area of the reference triangle.
                            let flow = flow * (2.0 * rule.weights[q]);
                            let flows = face_basis::<P>(corners, xi).map(|b| flow * b);
                            sum.add_flow(&at, number as usize * rule.len() + q, &flows);
                        }
                    }
                    let slopes = basis_slopes::<P>(mesh, cells[index]);
                    for q in 0..P {
                        sum.add_inner(&at, first_inner + P * index + q, q, &slopes);
                    }
                    sum.drain_into(&mut batch);
                }
                batch
            })
            .collect();
        let mut fields = CellFields {
            offsets: vec![0],
            nodes: Vec::new(),
            slopes: Vec::new(),
            values: Vec::new(),
            volumes,
            points: inner,
        };
        for batch in batches {
            for length in batch.lengths {
                fields.offsets.push(fields.offsets[fields.offsets.len() - 1] + length);
            }
            fields.nodes.extend_from_slice(&batch.nodes);
            fields.slopes.extend_from_slice(&batch.slopes);
            fields.values.extend_from_slice(&batch.values);
        }
        Ok((fields, info))
    }
}

pub(crate) fn combine<const P: usize>(slopes: &[Vector3; P], basis: &[f64; P]) -> Vector3 {
    let mut g = slopes[0] * basis[0];
    for j in 1..P {
        g += slopes[j] * basis[j];
    }
    g
}

/// The basis at the P integration points of a cell.
pub(crate) fn volume_basis<const P: usize>() -> [[f64; P]; P] {
    let rule: Rule<3> = quadrature::tet(P).expect("1 and 4 points are tabulated");
    std::array::from_fn(|q| {
        let [x, y, z] = rule.points[q];
        of_barycentric([1.0 - x - y - z, x, y, z])
    })
}

/// The basis at a point of the face whose canonical corners are these corners of the cell.
pub(crate) fn face_basis<const P: usize>(corners: [usize; 3], xi: &[f64; 2]) -> [f64; P] {
    let mut barycentric = [0.0; 4];
    for (corner, b) in corners.into_iter().zip([1.0 - xi[0] - xi[1], xi[0], xi[1]]) {
        barycentric[corner] = b;
    }
    of_barycentric(barycentric)
}

fn of_barycentric<const P: usize>(barycentric: [f64; 4]) -> [f64; P] {
    std::array::from_fn(|j| if P == 1 { 1.0 } else { barycentric[j] })
}

/// Gradients (1/m) of the basis over a cell.
fn basis_slopes<const P: usize>(mesh: &Mesh, cell: usize) -> [Vector3; P] {
    if P == 1 {
        return [Vector3::zeros(); P];
    }
    let p: Vec<&Point3> = mesh.cell_points(cell).collect();
    std::array::from_fn(|j| {
        let [a, b, c] = std::array::from_fn(|k| p[(j + 1 + k) % 4]);
        let normal = (b - a).cross(&(c - a));
        normal / normal.dot(&(p[j] - a))
    })
}

/// Which corners of the cell the canonical corners of one of its faces are.
pub(crate) fn local_corners(mesh: &Mesh, cell: usize, face: usize) -> [usize; 3] {
    let (nodes, local) = (mesh.cell(cell), mesh.kind(cell).faces()[face]);
    let mut corners = [local[0], local[1], local[2]];
    corners.sort_unstable_by_key(|&c| nodes[c]);
    corners
}

/// A cell being summed, dense over the nodes with a list of those touched.
struct Sum<const P: usize> {
    values: Vec<[f64; P]>,
    /// Moments `integral grad~_I b_j / V`, 1/m.
    moments: Vec<[Vector3; P]>,
    seen: Vec<bool>,
    touched: Vec<u32>,
}

impl<const P: usize> Sum<P> {
    fn new(nodes: usize) -> Sum<P> {
        Sum {
            values: vec![[0.0; P]; nodes],
            moments: vec![[Vector3::zeros(); P]; nodes],
            seen: vec![false; nodes],
            touched: Vec::new(),
        }
    }

    fn touch(&mut self, node: u32) {
        if !std::mem::replace(&mut self.seen[node as usize], true) {
            self.touched.push(node);
        }
    }

    fn add_flow(&mut self, at: &PointRows, row: usize, flows: &[Vector3; P]) {
        let (nodes, values) = at.rows().row(row);
        for (&node, &value) in nodes.iter().zip(values) {
            self.touch(node);
            for (moment, flow) in self.moments[node as usize].iter_mut().zip(flows) {
                *moment += flow * value;
            }
        }
    }

    fn add_inner(&mut self, at: &PointRows, row: usize, q: usize, slopes: &[Vector3; P]) {
        let (nodes, values) = at.rows().row(row);
        for (&node, &value) in nodes.iter().zip(values) {
            self.touch(node);
            self.values[node as usize][q] += value;
            if P > 1 {
                for (moment, slope) in self.moments[node as usize].iter_mut().zip(slopes) {
                    *moment -= slope * (value / P as f64);
                }
            }
        }
    }

    /// Appends the cell by ascending node and clears.
    fn drain_into(&mut self, batch: &mut Batch<P>) {
        self.touched.sort_unstable();
        batch.lengths.push(self.touched.len());
        for &node in &self.touched {
            let i = node as usize;
            batch.nodes.push(node);
            batch.values.push(std::mem::replace(&mut self.values[i], [0.0; P]));
            let moments = std::mem::replace(&mut self.moments[i], [Vector3::zeros(); P]);
            batch.slopes.push(if P == 1 { moments } else { solve_moments(moments) });
            self.seen[i] = false;
        }
        self.touched.clear();
    }
}

/// Coefficients from moments. The mass matrix of barycentric coordinates is `V / 20 (I + 1 1^T)`, its inverse
/// `20 / V (I - 1 1^T / 5)`.
fn solve_moments<const P: usize>(moments: [Vector3; P]) -> [Vector3; P] {
    let mean = moments.iter().sum::<Vector3>() / 5.0;
    moments.map(|m| (m - mean) * 20.0)
}

/// The distinct faces of some cells of a mesh of tet4, each once.
struct Faces {
    /// Canonical corners of each face.
    corners: Vec<[u32; 3]>,
    /// The four faces of each cell, and -1 where the cell's outward normal opposes the canonical one.
    of_cell: Vec<[(u32, f64); 4]>,
}

fn faces(mesh: &Mesh, cells: &[usize]) -> Faces {
    let mut all: Vec<([u32; 3], u32, u8, bool)> = Vec::with_capacity(4 * cells.len());
    for (index, &cell) in cells.iter().enumerate() {
        for (face, local) in mesh.kind(cell).faces().iter().enumerate() {
            let nodes = mesh.cell(cell);
            let (corners, turned) = canonical([0, 1, 2].map(|k| nodes[local[k]]));
            all.push((corners, index as u32, face as u8, turned));
        }
    }
    all.sort_unstable();
    let mut corners: Vec<[u32; 3]> = Vec::with_capacity(all.len() / 2);
    let mut of_cell = vec![[(0, 1.0); 4]; cells.len()];
    for (triangle, index, face, turned) in all {
        if corners.last() != Some(&triangle) {
            corners.push(triangle);
        }
        let sign = if turned { -1.0 } else { 1.0 };
        of_cell[index as usize][face as usize] = (corners.len() as u32 - 1, sign);
    }
    Faces { corners, of_cell }
}
