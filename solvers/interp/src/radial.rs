#![allow(clippy::neg_cmp_op_on_partial_ord)] // !(x > 0) also rejects NaN
//! Radial basis functions, with or without a linear polynomial: a single dense, positive definite system for
//! all targets.

use algebra::Cholesky;
use catalogue::{Build, Dimension, Entry, Kind, Parameter, Range};
use geometry::Cloud;
use nalgebra::{DMatrix, DVector, Matrix4, Matrix4xX, MatrixXx4};
use rayon::prelude::*;
use shape::{GradRows, Point3, PointRows, Rows, Unity, Vector3};

use crate::error::InterpError;
use crate::frame::{FLAT, centre_and_half_extent, thickness};
use crate::neighbours::{check_count, check_finite};
use crate::transfer::{Source, Transfer, TransferInfo, support_scale};

/// Radial functions, positive definite in space together with a linear polynomial (Wendland 2005, theorems
/// 8.5, 8.16 and 8.17). [`Radial::Gaussian`] and [`Radial::WendlandC2`] are positive definite even without a
/// polynomial (theorems 6.10 and 9.13). Widths are multiples of the cloud's mean spacing, the mean distance
/// to a node's 14 nearest neighbours, so units do not matter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Radial {
    /// `r^2 ln r`, commonly called thin plate. This function minimises bending energy in the plane. In space
    /// the minimiser would be `r`, but `r^2 ln r` is still valid and smoother (C1 at the nodes, at which `r`
    /// has a kink). A change of length unit adds a multiple of `r^2`, which the side conditions cancel.
    ThinPlate,
    /// `r^3`: C2 at the nodes.
    Cubic,
    /// `-sqrt(r^2 + c^2)` (Hardy 1971): smooth.
    Multiquadric {
        /// `c`, as a multiple of the mean spacing.
        shape: f64,
    },
    /// `exp(-(r / c)^2)`: smooth.
    Gaussian {
        /// `c`, as a multiple of the mean spacing.
        shape: f64,
        /// Whether the linear polynomial is included; without it not even constants are exact.
        polynomial: bool,
    },
    /// `(1 - q)^4 (4q + 1)` with `q = r / R` (Wendland 1995): C2, zero from `R` on.
    WendlandC2 {
        /// `R`, as a multiple of the mean spacing.
        support: f64,
        /// Whether the linear polynomial is included; without it not even constants are exact.
        polynomial: bool,
    },
}

impl Radial {
    /// Returns the function of the squared distance; `inverse_square` is the inverse square of the width.
    #[inline(always)]
    fn eval(self, square: f64, inverse_square: f64) -> f64 {
        match self {
            Radial::ThinPlate if square == 0.0 => 0.0,
            Radial::ThinPlate => 0.5 * square * square.ln(),
            Radial::Cubic => square * square.sqrt(),
            Radial::Multiquadric { .. } => -(1.0 + square * inverse_square).sqrt(),
            Radial::Gaussian { .. } => (-square * inverse_square).exp(),
            Radial::WendlandC2 { .. } => {
                let q = (square * inverse_square).sqrt();
                let rest = (1.0 - q).max(0.0) * (1.0 - q).max(0.0);
                rest * rest * (4.0 * q + 1.0)
            }
        }
    }

    /// Returns the derivative of the function with respect to the squared distance. It is bounded except for
    /// `r^2 ln r` at a node; the gradient is zero there.
    #[inline(always)]
    fn slope(self, square: f64, inverse_square: f64) -> f64 {
        match self {
            Radial::ThinPlate if square == 0.0 => 0.0,
            Radial::ThinPlate => 0.5 * square.ln() + 0.5,
            Radial::Cubic => 1.5 * square.sqrt(),
            Radial::Multiquadric { .. } => -0.5 * inverse_square / (1.0 + square * inverse_square).sqrt(),
            Radial::Gaussian { .. } => -inverse_square * (-square * inverse_square).exp(),
            Radial::WendlandC2 { .. } => {
                let rest = (1.0 - (square * inverse_square).sqrt()).max(0.0);
                -10.0 * inverse_square * rest * rest * rest
            }
        }
    }

    /// Returns the name used in scene files and tables.
    pub fn name(self) -> &'static str {
        match self {
            Radial::ThinPlate => "thin-plate",
            Radial::Cubic => "cubic",
            Radial::Multiquadric { .. } => "multiquadric",
            Radial::Gaussian { .. } => "gaussian",
            Radial::WendlandC2 { .. } => "wendland-c2",
        }
    }

    /// Whether the linear polynomial is included.
    pub fn polynomial(self) -> bool {
        match self {
            Radial::Gaussian { polynomial, .. } | Radial::WendlandC2 { polynomial, .. } => polynomial,
            Radial::ThinPlate | Radial::Cubic | Radial::Multiquadric { .. } => true,
        }
    }

    /// Returns the name of the width, and the width as a multiple of the mean spacing.
    fn width(self) -> Option<(&'static str, f64)> {
        match self {
            Radial::ThinPlate | Radial::Cubic => None,
            Radial::Multiquadric { shape } | Radial::Gaussian { shape, .. } => Some(("shape", shape)),
            Radial::WendlandC2 { support, .. } => Some(("support", support)),
        }
    }
}

impl Transfer for Radial {
    fn name(&self) -> &'static str {
        Radial::name(*self)
    }

    fn exact_degree(&self) -> Option<usize> {
        self.polynomial().then_some(1)
    }

    fn interpolates(&self) -> bool {
        true
    }

    fn rows(&self, source: Source, targets: &[Point3]) -> Result<(PointRows, TransferInfo), InterpError> {
        Ok((radial(source.nodes, *self, targets)?, TransferInfo::default()))
    }

    fn grad_rows(&self, source: Source, targets: &[Point3]) -> Result<(GradRows, TransferInfo), InterpError> {
        Ok((radial_gradients(source.nodes, *self, targets)?, TransferInfo::default()))
    }
}

const fn width(default: f64) -> Parameter {
    Parameter::default("shape", Dimension::None, default, "ratio of width c to mean node spacing")
        .within(Range::Positive)
}

const POLYNOMIAL: Parameter =
    Parameter::default("polynomial", Dimension::None, 1.0, "with a linear polynomial").of(Kind::Flag);

pub(crate) const THIN_PLATE: Entry<Build<Radial>> = Entry {
    name: "thin-plate",
    meaning: "radial basis r^2 ln r with a linear polynomial",
    source: "Wendland (2005), chapter 8",
    parameters: &[],
    build: |_| Ok(Radial::ThinPlate),
};

pub(crate) const CUBIC: Entry<Build<Radial>> = Entry {
    name: "cubic",
    meaning: "radial basis r^3 with a linear polynomial",
    source: "Wendland (2005), chapter 8",
    parameters: &[],
    build: |_| Ok(Radial::Cubic),
};

pub(crate) const MULTIQUADRIC: Entry<Build<Radial>> = Entry {
    name: "multiquadric",
    meaning: "radial basis -sqrt(r^2 + c^2) with a linear polynomial",
    source: "Hardy (1971)",
    parameters: &[width(1.0)],
    build: |values| Ok(Radial::Multiquadric { shape: values.number("shape")? }),
};

pub(crate) const GAUSSIAN: Entry<Build<Radial>> = Entry {
    name: "gaussian",
    meaning: "radial basis exp(-(r / c)^2)",
    source: "Wendland (2005), theorem 6.10",
    parameters: &[width(1.5), POLYNOMIAL],
    build: |values| {
        let shape = values.number("shape")?;
        let polynomial = values.flag("polynomial");
        Ok(Radial::Gaussian { shape, polynomial })
    },
};

pub(crate) const WENDLAND_C2: Entry<Build<Radial>> = Entry {
    name: "wendland-c2",
    meaning: "radial basis (1 - q)^4 (4q + 1), zero beyond the support radius",
    source: "Wendland (1995)",
    parameters: &[support_scale(4.0), POLYNOMIAL],
    build: |values| {
        let support = values.number("support_scale")?;
        let polynomial = values.flag("polynomial");
        Ok(Radial::WendlandC2 { support, polynomial })
    },
};

/// Largest number of entries of system and table together: 1 GiB of values.
const MOST_ENTRIES: usize = 1 << 27;
/// Targets per parallel task. The number is fixed, so results have the same bits at any number of threads.
const CHUNK: usize = 128;
/// Ratio of the smallest to the largest pivot below which rows are noise between the closest nodes (at 1e-12
/// about 0.1 of a value; 1e-5 to 1e-2 in sound clouds of up to 2500 nodes).
const SMALLEST_PIVOT: f64 = 1e-12;
/// Largest accepted error at the nodes for functions with a width, which may be too wide for any nodes.
/// Pivots alone do not reveal this (multiquadrics eight spacings wide have an error of 1e-4 at a ratio of
/// 1e-9).
const LARGEST_MISS: f64 = 1e-6;
/// Distance, in spacings, below which a singular system is attributed to the closest nodes rather than to the
/// width.
const APART: f64 = 1e-2;

/// Builds the table of radial basis functions, `u(x) = sum_i c_i phi(|x - x_i|) + d_0 + d . x` with
/// `u(x_i) = u_i` and `sum_i c_i = sum_i c_i x_i = 0` (Wendland 2005, chapter 8).
///
/// The scheme is exact for linear fields with the polynomial `d_0 + d . x`, and for no field without. It
/// interpolates. Every row contains all nodes. Coordinates are shifted to the centre of the cloud and scaled
/// by its half-extent. The matrix is factored once; each target then takes two triangular solutions, 2 n^2
/// operations.
///
/// # Errors
/// Functions so wide that the system is singular to working precision, coincident nodes, a flat cloud, and
/// tables that are too large.
pub fn radial(nodes: &[Point3], radial: Radial, targets: &[Point3]) -> Result<PointRows, InterpError> {
    let system = System::checked(nodes, radial, targets, 1)?;
    Ok(PointRows::new(targets.to_vec(), system.rows(targets)?)?)
}

/// Builds the table of [`radial`] with gradients (1/m).
pub fn radial_gradients(
    nodes: &[Point3],
    radial: Radial,
    targets: &[Point3],
) -> Result<GradRows, InterpError> {
    let system = System::checked(nodes, radial, targets, 4)?;
    let [x, y, z] = [0, 1, 2].map(|axis| system.table(targets, Some(axis)));
    let grads = x.into_iter().zip(y).zip(z).map(|((x, y), z)| Vector3::new(x, y, z) * system.scale).collect();
    Ok(GradRows::new(targets.to_vec(), system.rows(targets)?, grads)?)
}

/// The factored system of a cloud.
///
/// With `P` (n, 4) the polynomial at the nodes, `P = Y R`, `Pi = I - Y Y^T`, and `phi` (n) and `p` (4) the
/// functions at a target, a row is
///
/// `w = Pi K^-1 (phi - Phi B p) + B p`, `B = Y R^-T` (n, 4), `K = Pi Phi Pi + tau Y Y^T` (n, n).
///
/// `K` is positive definite (the bordered system of textbooks is not), so its Cholesky pivots reveal a
/// singular cloud. `B p` alone reproduces every linear field. The worse conditioned part is projected off
/// linear fields last, so its rounding never affects them. Without the polynomial `w = Phi^-1 phi`.
struct System {
    radial: Radial,
    inverse_square: f64,
    centre: Point3,
    scale: f64,
    nodes: Vec<Point3>,
    /// Factor of `K`.
    factor: Cholesky,
    tail: Option<Tail>,
}

/// Terms of the polynomial.
struct Tail {
    phi_b: MatrixXx4<f64>,
    y: MatrixXx4<f64>,
    b: MatrixXx4<f64>,
}

impl System {
    /// Checks the input and factors the system, for tables with `tables` times the number of targets as rows.
    fn checked(
        nodes: &[Point3],
        radial: Radial,
        targets: &[Point3],
        tables: usize,
    ) -> Result<System, InterpError> {
        check_finite(nodes, targets)?;
        let scheme = radial.name();
        if let Some((what, value)) = radial.width()
            && !(value > 0.0 && value.is_finite())
        {
            return Err(InterpError::BadParameter { what, value, allowed: "a positive number" });
        }
        check_count(scheme, nodes.len(), if radial.polynomial() { 4 } else { 2 })?;
        let (n, m) = (nodes.len(), targets.len());
        let entries = n.saturating_mul(n.saturating_add(m.saturating_mul(tables)));
        if entries > MOST_ENTRIES {
            let limit = MOST_ENTRIES;
            return Err(InterpError::TooLarge { scheme, nodes: n, targets: m, entries, limit });
        }
        System::new(scheme, nodes, radial)
    }

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
        // The form of the test also rejects the NaN of a cloud without extent.
        if !(square > 0.0) {
            return Err(coincident(0.0));
        }
        let thickness = thickness(&nodes);
        if radial.polynomial() && !(thickness > FLAT) {
            return Err(InterpError::FlatCloud { scheme, thickness: thickness * extent, extent });
        }
        let width = match radial.width() {
            Some((what, width)) => Some((what, width, spacing(&nodes)?)),
            None => None,
        };
        let inverse_square = width.map_or(1.0, |(_, width, spacing)| (width * spacing).powi(-2));
        let singular = |pivot_ratio: f64, miss: f64| match width {
            Some((what, width, spacing)) if square.sqrt() > APART * spacing => {
                InterpError::TooWide { scheme, what, width, miss }
            }
            _ => coincident(pivot_ratio),
        };

        let phi = functions(&nodes, |square| radial.eval(square, inverse_square));
        let mut k = phi.clone();
        let tail = radial.polynomial().then(|| {
            let (y, b) = polynomial(&nodes);
            project_columns(&y, &mut k);
            k.transpose_mut();
            project_columns(&y, &mut k);
            let mean = k.trace() / (n - 4).max(1) as f64;
            let tau = if n > 4 { mean } else { 1.0 };
            k.gemm(tau, &y, &y.transpose(), 1.0);
            Tail { phi_b: phi * &b, y, b }
        });
        let factor = Cholesky::new(n, k.as_slice()).ok_or_else(|| singular(0.0, f64::INFINITY))?;
        let pivot_ratio = factor.pivot_ratio();
        let sign = DVector::from_fn(n, |i, _| if i % 2 == 0 { 1.0 } else { -1.0 });
        let mut solved = sign.clone();
        factor.solve(solved.as_mut_slice());
        let miss = (k * solved - sign).amax();
        if !(pivot_ratio > SMALLEST_PIVOT) || (width.is_some() && !(miss < LARGEST_MISS)) {
            return Err(singular(pivot_ratio, miss));
        }
        Ok(System { radial, inverse_square, centre, scale, factor, tail, nodes })
    }

    fn rows(&self, targets: &[Point3]) -> Result<Rows, InterpError> {
        let (n, m) = (self.nodes.len(), targets.len());
        let unity = if self.tail.is_some() { Unity::Within(1e-9) } else { Unity::NotPromised };
        let offsets = (0..=m).map(|row| row * n).collect();
        let entries = (0..m).flat_map(|_| 0..n as u32).collect();
        Ok(Rows::new(n, offsets, entries, self.table(targets, None), unity)?)
    }

    /// Computes all rows, one after another, or their derivatives along an axis, in scaled coordinates.
    /// Chunks of targets are processed in parallel, each with its own rows.
    fn table(&self, targets: &[Point3], axis: Option<usize>) -> Vec<f64> {
        let n = self.nodes.len();
        let mut table = vec![0.0; n * targets.len()];
        table.par_chunks_mut(CHUNK * n).zip(targets.par_chunks(CHUNK)).for_each(|(rows, targets)| {
            rows.copy_from_slice(self.chunk(targets, axis).as_slice());
        });
        table
    }

    /// Computes the rows of some targets as columns (n, targets).
    fn chunk(&self, targets: &[Point3], axis: Option<usize>) -> DMatrix<f64> {
        let (n, m) = (self.nodes.len(), targets.len());
        let mut polynomial = Matrix4xX::zeros(m);
        let mut phi = DMatrix::zeros(n, m);
        for (t, target) in targets.iter().enumerate() {
            let x = Point3::from((target - self.centre) * self.scale);
            let terms = match axis {
                None => [1.0, x.x, x.y, x.z],
                Some(axis) => [usize::MAX, 0, 1, 2].map(|term| f64::from(term == axis)),
            };
            polynomial.column_mut(t).copy_from_slice(&terms);
            for (value, node) in phi.column_mut(t).iter_mut().zip(&self.nodes) {
                let offset = x - node;
                let width = self.inverse_square;
                let square = offset.norm_squared();
                *value = match axis {
                    None => self.radial.eval(square, width),
                    Some(axis) => 2.0 * offset[axis] * self.radial.slope(square, width),
                };
            }
        }
        if let Some(tail) = &self.tail {
            phi.gemm(-1.0, &tail.phi_b, &polynomial, 1.0);
        }
        // Solves with the factor instead of K^-1, whose rounding grows with the square of the condition. Two
        // nodes a millionth of the extent apart cause an error of 1e-9 in a smooth field, instead of 1e-3
        // with K^-1.
        let mut rows = phi;
        self.factor.solve(rows.as_mut_slice());
        if let Some(tail) = &self.tail {
            project_columns(&tail.y, &mut rows);
            rows.gemm(1.0, &tail.b, &polynomial, 1.0);
        }
        rows
    }
}

/// Returns the function of the squared distance for each pair of nodes.
fn functions(nodes: &[Point3], of: impl Fn(f64) -> f64) -> DMatrix<f64> {
    let mut phi = DMatrix::zeros(nodes.len(), nodes.len());
    for j in 0..nodes.len() {
        for i in j..nodes.len() {
            phi[(i, j)] = of((nodes[i] - nodes[j]).norm_squared());
        }
    }
    phi.fill_upper_triangle_with_lower_triangle();
    phi
}

/// Returns the mean distance of the nodes to their nearest neighbours.
fn spacing(nodes: &[Point3]) -> Result<f64, InterpError> {
    let spacing = Cloud::from_points(nodes.to_vec())?.spacing;
    Ok(spacing.iter().sum::<f64>() / spacing.len() as f64)
}

/// Returns the squared distance and the indices of the closest pair.
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

/// Returns `Y` (n, 4) of `P = Y R` by modified Gram-Schmidt, repeated twice, and `B = Y R^-T`, for which
/// `P^T B = I`.
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
    // R has a positive diagonal because the cloud is not flat.
    let inverse = r.solve_upper_triangular(&Matrix4::identity()).unwrap_or_else(Matrix4::zeros);
    let b = &y * inverse.transpose();
    (y, b)
}

/// Computes `A <- (I - Y Y^T) A`.
fn project_columns(y: &MatrixXx4<f64>, a: &mut DMatrix<f64>) {
    let share = y.tr_mul(a);
    a.gemm(-1.0, y, &share, 1.0);
}
