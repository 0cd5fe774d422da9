//! Symmetric eigenproblems `M x = theta A x`.
//!
//! A dense decomposition finds all eigenvalues of a small problem. Lanczos finds the largest of a large
//! problem.

use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt;
use faer::linalg::evd::{ComputeEigenvectors, self_adjoint_evd, self_adjoint_evd_scratch};
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::{Mat, Par};

use super::failure::{FactorError, check_pivots};
use super::symmetric::Symmetric;
use super::workspace::zeroed;
use crate::error::AlgebraError;

pub use super::lanczos::largest;

/// Eigenvalues `theta` of `M x = theta A x`, largest first, with eigenvectors scaled to `x^T A x = 1`.
pub struct Eigen {
    /// Eigenvalues `theta`, largest first.
    pub values: Vec<f64>,
    /// Eigenvectors with `x^T A x = 1`, one for each eigenvalue.
    pub vectors: Vec<Vec<f64>>,
}

/// Solves `M x = theta A x` for all eigenvalues, where `A = K + shift M` must be positive definite.
///
/// With the Cholesky factor `L` of `A`, the eigenvalues are those of `L^-1 M L^-T`. They are exact to
/// rounding of the largest, and `M` may be any symmetric matrix. The solve runs on one thread, so that its
/// bits are always the same. 1000 unknowns take 1 s; the time grows with their cube.
///
/// # Errors
///
/// [`FactorError::NotDefinite`] if `A` is not positive definite, [`AlgebraError::NoEigenvalues`] if the
/// decomposition does not converge.
pub fn shifted(stiffness: &Symmetric, mass: &Symmetric, shift: f64) -> Result<Eigen, FactorError> {
    let n = stiffness.dim();
    let par = Par::Seq;
    let mut lower = Mat::zeros(n, n);
    add(stiffness, 1.0, &mut lower);
    add(mass, shift, &mut lower);
    let diagonal: Vec<f64> = (0..n).map(|j| lower[(j, j)]).collect();
    let scratch = llt::factor::cholesky_in_place_scratch::<f64>(n, par, Default::default());
    let mut memory = zeroed(MemBuffer::new(scratch));
    let stack = MemStack::new(&mut memory);
    llt::factor::cholesky_in_place(lower.as_mut(), Default::default(), par, stack, Default::default())
        .map_err(|_| FactorError::NotDefinite)?;
    check_pivots((0..n).map(|j| lower[(j, j)].powi(2) / diagonal[j]))?;

    let mut inner = Mat::zeros(n, n);
    add(mass, 1.0, &mut inner);
    for j in 0..n {
        (j + 1..n).for_each(|i| inner[(j, i)] = inner[(i, j)]);
    }
    solve_lower_triangular_in_place(lower.as_ref(), inner.as_mut(), par);
    solve_lower_triangular_in_place(lower.as_ref(), inner.transpose_mut(), par);
    // The decomposition takes small values for rounding, whatever their unit: eigenvalues of about 1 have
    // none.
    let most = (0..n).map(|j| inner[(j, j)]).fold(0.0, f64::max);
    let unit = if most > 0.0 { most.log2().round().exp2() } else { 1.0 };
    (0..n).for_each(|j| (0..n).for_each(|i| inner[(i, j)] /= unit));

    let mut values = Diag::<f64>::zeros(n);
    let mut vectors = Mat::zeros(n, n);
    let scratch = self_adjoint_evd_scratch::<f64>(n, ComputeEigenvectors::Yes, par, Default::default());
    let mut memory = zeroed(MemBuffer::new(scratch));
    let stack = MemStack::new(&mut memory);
    self_adjoint_evd(inner.as_ref(), values.as_mut(), Some(vectors.as_mut()), par, stack, Default::default())
        .map_err(|_| AlgebraError::NoEigenvalues { dofs: n })?;
    solve_upper_triangular_in_place(lower.transpose(), vectors.as_mut(), par);
    let column = |c: usize| (0..n).map(|i| vectors[(i, c)]).collect();
    let values = (0..n).rev().map(|k| values.column_vector()[k] * unit).collect();
    Ok(Eigen { values, vectors: (0..n).rev().map(column).collect() })
}

/// Adds `factor` times the matrix to a lower triangle.
fn add(matrix: &Symmetric, factor: f64, lower: &mut Mat<f64>) {
    for j in 0..matrix.dim() {
        for k in matrix.offsets[j]..matrix.offsets[j + 1] {
            lower[(j, matrix.rows[k])] += factor * matrix.values[k];
        }
    }
}
