#![allow(clippy::neg_cmp_op_on_partial_ord)] // !(x > 0) refuses a NaN as well
//! Radial basis functions with a linear polynomial: one dense, positive definite solve for all targets.

use nalgebra::{Cholesky, DMatrix, Matrix4, Matrix4xX, MatrixXx4};
use rayon::prelude::*;
use shape::{Point3, PointRows, Rows, Unity};

use crate::InterpError;
use crate::frame::{FLAT, centre_and_half_extent, thickness};
use crate::neighbours::{check_count, check_finite};

/// Radial function, conditionally positive definite of order 2 in space: unique with a linear polynomial
/// (Wendland 2005, theorems 8.16 and 8.17).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Radial {
    /// `r^2 ln r`, the function commonly called thin plate. It minimises bending energy in the plane; in
    /// space, where that minimiser would be `r`, it is still a valid and smoother choice (C1 at the nodes,
    /// where `r` has a kink). A change of length unit adds a multiple of `r^2`, which the side conditions
    /// cancel.
    ThinPlate,
    /// `r^3`: C2 at the nodes.
    Cubic,
}

impl Radial {
    /// The function of the squared distance.
    #[inline(always)]
    fn eval(self, square: f64) -> f64 {
        match self {
            Radial::ThinPlate if square == 0.0 => 0.0,
            Radial::ThinPlate => 0.5 * square * square.ln(),
            Radial::Cubic => square * square.sqrt(),
        }
    }

    fn name(self) -> &'static str {
        match self {
            Radial::ThinPlate => "thin-plate",
            Radial::Cubic => "cubic",
        }
    }
}

/// Entries of system and table together: 1 GiB of values.
const MOST_ENTRIES: usize = 1 << 27;
/// Targets per parallel task: fixed, so that the bits are the same at any thread count.
const CHUNK: usize = 128;
/// Smallest over largest pivot below which rows are noise between the closest nodes (at 1e-12 some 0.1 of a
/// value; 1e-5 to 1e-2 in sound clouds of up to 2500 nodes).
const SMALLEST_PIVOT: f64 = 1e-12;

/// `u(x) = sum_i c_i phi(|x - x_i|) + d_0 + d . x` with `u(x_i) = u_i` and `sum_i c_i = sum_i c_i x_i = 0`
/// (Wendland 2005, chapter 8). Exact for linear fields; interpolates; every row is full.
///
/// Coordinates are shifted to the centre of the cloud and scaled by its half-extent. After one factorisation all
/// targets are rows of two matrix products, 4 n^2 operations each.
pub fn radial(nodes: &[Point3], radial: Radial, targets: &[Point3]) -> Result<PointRows, InterpError> {
    check_finite(nodes, targets)?;
    let scheme = radial.name();
    check_count(scheme, nodes.len(), 4)?;
    let (n, m) = (nodes.len(), targets.len());
    let entries = n.saturating_mul(n.saturating_add(m));
    if entries > MOST_ENTRIES {
        let limit = MOST_ENTRIES;
        return Err(InterpError::TooLarge { scheme, nodes: n, targets: m, entries, limit });
    }
    let system = System::new(scheme, nodes, radial)?;
    let rows = Rows::new(
        n,
        (0..=m).map(|row| row * n).collect(),
        (0..m).flat_map(|_| 0..n as u32).collect(),
        system.table(targets),
        Unity::Within(1e-9),
    )?;
    Ok(PointRows::new(targets.to_vec(), rows)?)
}

/// With `P` (n, 4) the polynomial at the nodes, `P = Y R`, `Pi = I - Y Y^T`, `phi` (n) and `p` (4) the
/// functions at a target, a row is
///
/// `w = Pi K^-1 (phi - Phi B p) + B p`, `B = Y R^-T` (n, 4), `K = Pi Phi Pi + tau Y Y^T` (n, n).
///
/// `K` is positive definite (the bordered system of the textbook is not), so that its Cholesky pivots tell a
/// singular cloud. `B p` alone carries every linear field, and the worse conditioned part is projected off
/// them last, so that its rounding never reaches them.
struct System {
    radial: Radial,
    centre: Point3,
    scale: f64,
    nodes: Vec<Point3>,
    l_inverse: DMatrix<f64>,
    /// A copy: the library's product with a transpose is a loop of dot products, three times slower.
    l_inverse_transposed: DMatrix<f64>,
    phi_b: MatrixXx4<f64>,
    y: MatrixXx4<f64>,
    b: MatrixXx4<f64>,
}

impl System {
    fn new(scheme: &'static str, nodes: &[Point3], radial: Radial) -> Result<System, InterpError> {
        let n = nodes.len();
        let (centre, extent) = centre_and_half_extent(nodes);
        let scale = 1.0 / extent;
        let nodes: Vec<Point3> = nodes.iter().map(|x| Point3::from((x - centre) * scale)).collect();
        let (square, first, second) = closest_pair(&nodes);
        let coincident = |pivot_ratio: f64| {
            let distance = if extent > 0.0 { square.sqrt() * extent } else { 0.0 };
            InterpError::CoincidentNodes { scheme, first, second, distance, extent, pivot_ratio }
        };
        // Written so that the NaN of a cloud without extent is refused, too.
        if !(square > 0.0) {
            return Err(coincident(0.0));
        }
        let thickness = thickness(&nodes);
        if !(thickness > FLAT) {
            return Err(InterpError::FlatCloud { scheme, thickness: thickness * extent, extent });
        }

        let (y, b) = polynomial(&nodes);
        let phi = DMatrix::from_fn(n, n, |i, j| radial.eval((nodes[i] - nodes[j]).norm_squared()));
        let mut k = phi.clone();
        project_columns(&y, &mut k);
        k.transpose_mut();
        project_columns(&y, &mut k);
        let mean = k.trace() / (n - 4).max(1) as f64;
        let tau = if n > 4 { mean } else { 1.0 };
        k.gemm(tau, &y, &y.transpose(), 1.0);
        let factor = Cholesky::new(k).ok_or_else(|| coincident(0.0))?;
        let pivots = factor.l_dirty().diagonal().map(|l| l * l);
        let pivot_ratio = pivots.min() / pivots.max();
        if !(pivot_ratio > SMALLEST_PIVOT) {
            return Err(coincident(pivot_ratio));
        }
        let mut l_inverse = DMatrix::identity(n, n);
        if !factor.l_dirty().solve_lower_triangular_mut(&mut l_inverse) {
            return Err(coincident(pivot_ratio));
        }
        let l_inverse_transposed = l_inverse.transpose();
        let phi_b = phi * &b;
        Ok(System { radial, centre, scale, l_inverse, l_inverse_transposed, phi_b, y, b, nodes })
    }

    /// All rows, one after another; parallel over chunks of targets, each of which makes its own rows.
    fn table(&self, targets: &[Point3]) -> Vec<f64> {
        let n = self.nodes.len();
        let mut table = vec![0.0; n * targets.len()];
        table.par_chunks_mut(CHUNK * n).zip(targets.par_chunks(CHUNK)).for_each(|(rows, targets)| {
            rows.copy_from_slice(self.chunk(targets).as_slice());
        });
        table
    }

    /// The rows of some targets as columns (n, targets).
    fn chunk(&self, targets: &[Point3]) -> DMatrix<f64> {
        let (n, m) = (self.nodes.len(), targets.len());
        let mut polynomial = Matrix4xX::zeros(m);
        let mut phi = DMatrix::zeros(n, m);
        for (t, target) in targets.iter().enumerate() {
            let x = Point3::from((target - self.centre) * self.scale);
            polynomial.column_mut(t).copy_from_slice(&[1.0, x.x, x.y, x.z]);
            for (value, node) in phi.column_mut(t).iter_mut().zip(&self.nodes) {
                *value = self.radial.eval((x - node).norm_squared());
            }
        }
        phi.gemm(-1.0, &self.phi_b, &polynomial, 1.0);
        // K^-1 as L^-T L^-1 and not as one matrix, whose rounding grows with the square of the condition: two
        // nodes a millionth of the extent apart spoil a smooth field by 1e-9 this way, and by 1e-3 the other.
        let mut rows = &self.l_inverse_transposed * (&self.l_inverse * phi);
        project_columns(&self.y, &mut rows);
        rows.gemm(1.0, &self.b, &polynomial, 1.0);
        rows
    }
}

/// Squared distance and indices of the closest pair.
fn closest_pair(nodes: &[Point3]) -> (f64, usize, usize) {
    let mut closest = (f64::INFINITY, 0, 1);
    for (j, b) in nodes.iter().enumerate() {
        for (i, a) in nodes[..j].iter().enumerate() {
            let square = (a - b).norm_squared();
            if !(square >= closest.0) {
                closest = (square, i, j);
            }
        }
    }
    closest
}

/// `Y` (n, 4) of `P = Y R` by modified Gram-Schmidt, twice over; and `B = Y R^-T`, for which `P^T B = I`.
fn polynomial(nodes: &[Point3]) -> (MatrixXx4<f64>, MatrixXx4<f64>) {
    let p = MatrixXx4::from_fn(nodes.len(), |i, term| if term == 0 { 1.0 } else { nodes[i][term - 1] });
    let mut y = p.clone();
    for _ in 0..2 {
        for a in 0..4 {
            for b in 0..a {
                let (before, mut column) = y.columns_range_pair_mut(b, a);
                let share = before.dot(&column);
                column.axpy(-share, &before, 1.0);
            }
            let norm = y.column(a).norm();
            y.column_mut(a).unscale_mut(norm);
        }
    }
    let r: Matrix4<f64> = y.tr_mul(&p).upper_triangle();
    // R has a positive diagonal: the cloud is not flat.
    let inverse = r.solve_upper_triangular(&Matrix4::identity()).unwrap_or_else(Matrix4::zeros);
    let b = &y * inverse.transpose();
    (y, b)
}

/// `A <- (I - Y Y^T) A`.
fn project_columns(y: &MatrixXx4<f64>, a: &mut DMatrix<f64>) {
    let share = y.tr_mul(a);
    a.gemm(-1.0, y, &share, 1.0);
}
