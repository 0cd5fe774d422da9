//! Dense factorisation of small systems.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::{ldlt, llt};
use faer::{Conj, Mat, MatMut, Par};

use super::failure::{FactorError, check_pivots};
use super::symmetric::{Kind, Symmetric};
use super::workspace::zeroed;
use crate::error::AlgebraError;

/// Dense factor `L L^T`, or `L D L^T` (D on the diagonal of `lower`) if the matrix is not definite.
pub struct Dense {
    lower: Mat<f64>,
    definite: bool,
}

impl Dense {
    pub fn new(matrix: &Symmetric, kind: Kind) -> Result<Dense, FactorError> {
        let n = matrix.dim();
        let definite = kind == Kind::Definite;
        let regularised = (kind == Kind::Saddle).then(|| matrix.regularised());
        let values = regularised.as_ref().unwrap_or(&matrix.values);
        // Columns are padded to whole registers, as they would lie anyway: below row n there are zeros (see
        // `zeroed`).
        let mut lower = Mat::zeros(n.next_multiple_of(8), n);
        for j in 0..n {
            for k in matrix.offsets[j]..matrix.offsets[j + 1] {
                lower[(j, matrix.rows[k])] = values[k];
            }
        }
        let par = Par::Seq;
        let params = Default::default();
        if !definite {
            let scratch = ldlt::factor::cholesky_in_place_scratch::<f64>(n, par, params);
            let mut memory = zeroed(MemBuffer::new(scratch));
            let stack = MemStack::new(&mut memory);
            ldlt::factor::cholesky_in_place(lower.subrows_mut(0, n), Default::default(), par, stack, params)
                .map_err(|_| AlgebraError::ZeroPivot)?;
        } else {
            let params = Default::default();
            let scratch = llt::factor::cholesky_in_place_scratch::<f64>(n, par, params);
            let mut memory = zeroed(MemBuffer::new(scratch));
            let stack = MemStack::new(&mut memory);
            llt::factor::cholesky_in_place(lower.subrows_mut(0, n), Default::default(), par, stack, params)
                .map_err(|_| FactorError::NotDefinite)?;
            check_pivots((0..n).map(|j| lower[(j, j)].powi(2) / matrix.diagonal(j)))?;
        }
        Ok(Dense { lower, definite })
    }

    pub fn negative_pivots(&self) -> usize {
        (0..self.lower.ncols()).filter(|&j| !self.definite && self.lower[(j, j)] < 0.0).count()
    }

    pub fn solve(&self, b: &mut [f64]) {
        let n = b.len();
        let rhs = MatMut::from_column_major_slice_mut(b, n, 1);
        let stack = MemStack::new(&mut []);
        let lower = self.lower.subrows(0, n);
        if !self.definite {
            ldlt::solve::solve_in_place_with_conj(lower, lower.diagonal(), Conj::No, rhs, Par::Seq, stack);
        } else {
            llt::solve::solve_in_place_with_conj(lower, Conj::No, rhs, Par::Seq, stack);
        }
    }
}
