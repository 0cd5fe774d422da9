//! Rows of cells with gradients smoothed by their moments. One table of face points serves both sides of
//! every face.

use geometry::Mesh;
use geometry::quadrature::{self, Rule};
use rayon::prelude::*;
use shape::{Point3, PointRows, Vector3};

use crate::approximation::Approximation;
use crate::cells::tet_measure;
use crate::error::EfgError;
use crate::facets::{canonical, triangle_points, triangle_rule, vector_area};
use crate::info::MlsInfo;
use crate::row_list::{RowList, sample_step};

/// Cells per parallel task. The number is fixed, so results have the same bits at any number of threads.
const CHUNK: usize = 128;

/// Cells per wave and thread. The rows of a wave are stored twice while they are appended to the others.
const WAVE: usize = 4 * CHUNK;

/// Rows of every cell of a tet4 mesh, with P points per cell: values and smoothed gradients at these points.
#[derive(Default)]
pub(crate) struct CellRows {
    pub rows: RowList,
    /// Weights, m^3.
    pub weights: Vec<f64>,
    pub points: Vec<Point3>,
}

/// Shape values at points other than those of the cells, such as vertices, evaluated in the same call.
pub(crate) struct Beside {
    at: PointRows,
    first: usize,
}

/// Components of the cells: the points of their faces and their own points, as rows of one table.
struct Parts<'a, const P: usize> {
    mesh: &'a Mesh,
    faces: Faces,
    areas: Vec<Vector3>,
    rule: Rule<2>,
    /// Face points first, then cell points.
    at: PointRows,
    first_inner: usize,
    volumes: Vec<f64>,
    basis: [[f64; P]; P],
}

impl CellRows {
    pub fn new<const P: usize>(
        approximation: &Approximation,
        mesh: &Mesh,
        face_points: usize,
    ) -> Result<(CellRows, MlsInfo), EfgError> {
        let (rows, _, info) = CellRows::with::<P>(approximation, mesh, face_points, &[])?;
        Ok((rows, info))
    }

    /// Computes the rows of all cells and, in the same call, shape values at the points of `beside`. Each of
    /// these has a position (m) and a cell that contains it.
    pub fn with<const P: usize>(
        approximation: &Approximation,
        mesh: &Mesh,
        face_points: usize,
        beside: &[(Point3, u32)],
    ) -> Result<(CellRows, Beside, MlsInfo), EfgError> {
        let rule = triangle_rule(face_points)?;
        let count = mesh.cell_count();
        let (mut volumes, mut inner) = (Vec::with_capacity(count), Vec::with_capacity(P * count));
        for cell in 0..count {
            let (volume, centroid) = tet_measure(mesh, cell)?;
            volumes.push(volume);
            for b in &volume_basis::<P>() {
                // Offset from the centroid: for P = 1 the point is the centroid itself.
                let offset: Vector3 = if P == 1 {
                    Vector3::zeros()
                } else {
                    mesh.cell_points(cell).zip(b).map(|(p, b)| (p - centroid) * *b).sum()
                };
                inner.push(centroid + offset);
            }
        }
        let faces = faces(mesh);
        let mut points = Vec::with_capacity(faces.corners.len() * rule.len() + inner.len() + beside.len());
        for &corners in &faces.corners {
            triangle_points(mesh, corners, &rule, &mut points);
        }
        let first_inner = points.len();
        points.extend_from_slice(&inner);
        points.extend(beside.iter().map(|(at, _)| *at));
        let cells = || {
            let of_faces = faces.cell.iter().flat_map(|&cell| std::iter::repeat_n(cell, rule.len()));
            let of_cells = (0..P * count).map(|q| (q / P) as u32);
            of_faces.chain(of_cells).chain(beside.iter().map(|(_, cell)| *cell)).collect()
        };
        let (at, info) = approximation.point_rows_in(points, Some(&cells))?;
        let areas: Vec<Vector3> = faces.corners.iter().map(|&c| vector_area(mesh, c)).collect();
        let parts = Parts::<P> { mesh, faces, areas, rule, at, first_inner, volumes, basis: volume_basis() };

        let entries = parts.expected_entries(approximation.nodes().len());
        let mut rows = RowList::with_capacity(P * count, entries, entries);
        let cells: Vec<usize> = (0..count).collect();
        for wave in cells.chunks(WAVE * rayon::current_num_threads()) {
            // A sum has a place for every node of the cloud. A sum per chunk would make the total cost
            // quadratic.
            let sum = || Sum::<P>::new(approximation.nodes().len());
            let work = |sum: &mut Sum<P>, chunk: &[usize]| {
                let mut batch = RowList::default();
                chunk.iter().for_each(|&cell| parts.add(cell, sum, &mut batch));
                batch
            };
            let batches: Vec<RowList> = wave.par_chunks(CHUNK).map_init(sum, work).collect();
            batches.iter().for_each(|batch| rows.append(batch));
        }
        let first = first_inner + inner.len();
        let weights = parts.volumes.iter().flat_map(|v| [v / P as f64; P]).collect();
        Ok((CellRows { rows, weights, points: inner }, Beside { at: parts.at, first }, info))
    }
}

impl<const P: usize> Parts<'_, P> {
    /// Appends the rows of a cell.
    fn add(&self, cell: usize, sum: &mut Sum<P>, rows: &mut RowList) {
        for (face, &(number, sign)) in self.faces.of_cell[cell].iter().enumerate() {
            let flow = self.areas[number as usize] * (sign / self.volumes[cell]);
            let corners = local_corners(self.mesh, cell, face);
            for (q, xi) in self.rule.points.iter().enumerate() {
                // The rule's weights sum to 1/2, the area of the reference triangle.
                let flow = flow * (2.0 * self.rule.weights[q]);
                let flows = face_basis::<P>(corners, xi).map(|b| flow * b);
                sum.add_flow(&self.at, number as usize * self.rule.len() + q, &flows);
            }
        }
        let slopes = basis_slopes::<P>(self.mesh, cell);
        for q in 0..P {
            sum.add_inner(&self.at, self.first_inner + P * cell + q, q, &slopes);
        }
        sum.drain_into(&self.basis, rows);
    }

    /// Estimates the number of entries of all rows from those of a few cells.
    fn expected_entries(&self, nodes: usize) -> usize {
        let count = self.volumes.len();
        let mut sum = Sum::<P>::new(nodes);
        let mut batch = RowList::default();
        for cell in (0..count).step_by(sample_step(count)) {
            self.add(cell, &mut sum, &mut batch);
        }
        batch.expected_entries(P * count)
    }
}

fn combine<const P: usize>(slopes: &[Vector3; P], basis: &[f64; P]) -> Vector3 {
    let mut g = slopes[0] * basis[0];
    for j in 1..P {
        g += slopes[j] * basis[j];
    }
    g
}

/// Returns the basis at the P integration points of a cell.
pub(crate) fn volume_basis<const P: usize>() -> [[f64; P]; P] {
    let rule: Rule<3> = quadrature::tet(P).expect("1 and 4 points are tabulated");
    std::array::from_fn(|q| {
        let [x, y, z] = rule.points[q];
        of_barycentric([1.0 - x - y - z, x, y, z])
    })
}

/// Returns the basis at a point of the face whose canonical corners are the given corners of the cell.
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

/// Returns the gradients (1/m) of the basis over a cell.
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

/// Returns the corners of a cell that correspond to the canonical corners of one of its faces.
pub(crate) fn local_corners(mesh: &Mesh, cell: usize, face: usize) -> [usize; 3] {
    let nodes = mesh.cell(cell);
    let local = mesh.kind(cell).faces()[face];
    let mut corners = [local[0], local[1], local[2]];
    corners.sort_unstable_by_key(|&c| nodes[c]);
    corners
}

/// Sums of the cell in progress, dense over the nodes with a list of the touched nodes.
pub(crate) struct Sum<const P: usize> {
    values: Vec<[f64; P]>,
    /// Moments `integral grad~_I b_j / V`, 1/m.
    moments: Vec<[Vector3; P]>,
    seen: Vec<bool>,
    touched: Vec<u32>,
}

impl<const P: usize> Sum<P> {
    pub fn new(nodes: usize) -> Sum<P> {
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

    /// Appends the accumulated sums as the rows of the cell's points, with ascending nodes, and resets them.
    /// `basis` holds the values of the gradients' basis at each point ([`volume_basis`]).
    pub fn drain_into(&mut self, basis: &[[f64; P]; P], rows: &mut RowList) {
        self.touched.sort_unstable();
        for (q, basis) in basis.iter().enumerate() {
            rows.nodes.extend_from_slice(&self.touched);
            rows.close();
            for &node in &self.touched {
                let i = node as usize;
                let moments = self.moments[i];
                let slopes = if P == 1 { moments } else { solve_moments(moments) };
                rows.values.push(self.values[i][q]);
                rows.grads.push(combine(&slopes, basis));
            }
        }
        for &node in &self.touched {
            let i = node as usize;
            (self.values[i], self.moments[i], self.seen[i]) = ([0.0; P], [Vector3::zeros(); P], false);
        }
        self.touched.clear();
    }
}

impl Sum<1> {
    /// Adds the constant gradients of a cell to the sum, multiplied by `share`, the cell's fraction of the
    /// volume.
    pub fn add_share(&mut self, cells: &CellRows, cell: usize, share: f64) {
        for i in cells.rows.range(cell) {
            self.touch(cells.rows.nodes[i]);
            self.moments[cells.rows.nodes[i] as usize][0] += cells.rows.grads[i] * share;
        }
    }

    /// Adds the shape values at the point of `beside` with this index to the sum.
    pub fn add_values(&mut self, beside: &Beside, point: usize) {
        self.add_inner(&beside.at, beside.first + point, 0, &[Vector3::zeros()]);
    }
}

/// Returns coefficients from moments. The mass matrix of barycentric coordinates is `V / 20 (I + 1 1^T)`, its
/// inverse `20 / V (I - 1 1^T / 5)`.
fn solve_moments<const P: usize>(moments: [Vector3; P]) -> [Vector3; P] {
    let mean = moments.iter().sum::<Vector3>() / 5.0;
    moments.map(|m| (m - mean) * 20.0)
}

/// The distinct faces of the cells of a tet4 mesh.
struct Faces {
    /// Canonical corners of each face.
    corners: Vec<[u32; 3]>,
    /// A cell of each face.
    cell: Vec<u32>,
    /// The four faces of each cell with a sign: -1 if the cell's outward normal is opposite to the canonical
    /// normal.
    of_cell: Vec<[(u32, f64); 4]>,
}

fn faces(mesh: &Mesh) -> Faces {
    let mut all: Vec<([u32; 3], u32, u8, bool)> = Vec::with_capacity(4 * mesh.cell_count());
    for cell in 0..mesh.cell_count() {
        for (face, local) in mesh.kind(cell).faces().iter().enumerate() {
            let nodes = mesh.cell(cell);
            let (corners, turned) = canonical([0, 1, 2].map(|k| nodes[local[k]]));
            all.push((corners, cell as u32, face as u8, turned));
        }
    }
    all.sort_unstable();
    let mut corners: Vec<[u32; 3]> = Vec::with_capacity(all.len() / 2);
    let mut first = Vec::with_capacity(all.len() / 2);
    let mut of_cell = vec![[(0, 1.0); 4]; mesh.cell_count()];
    for (triangle, cell, face, turned) in all {
        if corners.last() != Some(&triangle) {
            corners.push(triangle);
            first.push(cell);
        }
        let sign = if turned { -1.0 } else { 1.0 };
        of_cell[cell as usize][face as usize] = (corners.len() as u32 - 1, sign);
    }
    Faces { corners, cell: first, of_cell }
}
