#![allow(non_snake_case)] // C, D, M, R as in the formulas
//! The dense tangent of the coefficients of a few modes.

use algebra::Border;
use nalgebra::{DMatrix, DVector, Dyn, LU};

use crate::error::SolveError;

/// Factored tangent `[M, C; R, D]` of the coefficients and of the tools driven by force.
pub(super) struct Modal(LU<f64, Dyn, Dyn>);

impl Modal {
    pub(super) fn new(M: DMatrix<f64>, borders: &[Border]) -> Modal {
        let modes = M.nrows();
        let mut whole = M.resize(modes + borders.len(), modes + borders.len(), 0.0);
        for (k, border) in borders.iter().enumerate() {
            for i in 0..modes {
                whole[(i, modes + k)] = border.column[i];
                whole[(modes + k, i)] = border.row[i];
            }
            whole[(modes + k, modes + k)] = border.corner;
        }
        Modal(whole.lu())
    }

    /// Solves in place.
    pub(super) fn solve(&self, b: &mut [f64]) -> Result<(), SolveError> {
        let x = self.0.solve(&DVector::from_column_slice(b)).filter(|x| x.iter().all(|x| x.is_finite()));
        b.copy_from_slice(x.ok_or(SolveError::NotPositiveDefinite)?.as_slice());
        Ok(())
    }
}

/// Whether the symmetric part of a matrix is positive definite.
pub(super) fn is_definite(M: &DMatrix<f64>) -> bool {
    (0.5 * (M + M.transpose())).cholesky().is_some()
}
