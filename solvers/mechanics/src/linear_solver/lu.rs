//! Unsymmetric systems: the tangent of a body on which friction slides.

use faer::prelude::Solve;
use faer::sparse::linalg::solvers::{Lu, SymbolicLu};
use faer::sparse::{SparseColMat, Triplet};
use faer::MatMut;

use super::{Symmetric, refined};
use crate::SolveError;

/// A symmetric matrix plus a few unsymmetric entries, factored with partial pivoting. faer's column order (COLAMD) is
/// used and its fill is more than that of METIS on the symmetric part: only steps with sliding friction come here.
pub(crate) struct Unsymmetric {
    matrix: SparseColMat<usize, f64>,
    lu: Lu<usize, f64>,
}

impl Unsymmetric {
    /// Factors `symmetric + extra`; entries `(row, column, value)` of one place add up.
    pub fn new(symmetric: &Symmetric, extra: &[(usize, usize, f64)]) -> Result<Unsymmetric, SolveError> {
        let n = symmetric.dim();
        let mut triplets = Vec::with_capacity(2 * symmetric.rows.len() + extra.len());
        for j in 0..n {
            for k in symmetric.offsets[j]..symmetric.offsets[j + 1] {
                let (i, value) = (symmetric.rows[k], symmetric.values[k]);
                triplets.push(Triplet::new(i, j, value));
                if i != j {
                    triplets.push(Triplet::new(j, i, value));
                }
            }
        }
        triplets.extend(extra.iter().map(|&(i, j, v)| Triplet::new(i, j, v)));
        let failed = |why: String| SolveError::TooLarge { dofs: n, why };
        let matrix = SparseColMat::try_new_from_triplets(n, n, &triplets).map_err(|e| failed(format!("{e:?}")))?;
        let symbolic = SymbolicLu::try_new(matrix.symbolic()).map_err(|e| failed(format!("{e:?}")))?;
        // A singular matrix shows in the residual of the solve.
        let lu = Lu::try_new_with_symbolic(symbolic, matrix.as_ref()).map_err(|_| SolveError::ZeroPivot)?;
        Ok(Unsymmetric { matrix, lu })
    }

    /// Solves in place and returns the relative residual.
    pub fn solve(&self, b: &mut [f64]) -> Result<f64, SolveError> {
        let once = |x: &mut [f64]| {
            let n = x.len();
            self.lu.solve_in_place(MatMut::from_column_major_slice_mut(x, n, 1));
            Ok(())
        };
        refined(b, once, |x, y| {
            let pattern = self.matrix.symbolic();
            for j in 0..x.len() {
                for (&i, a) in pattern.row_idx_of_col_raw(j).iter().zip(self.matrix.val_of_col(j)) {
                    y[i] -= a * x[j];
                }
            }
        })
    }
}
