//! Unsymmetric systems: the tangent of a body on which friction slides.

use faer::MatMut;
use faer::prelude::Solve;
use faer::sparse::linalg::solvers::{Lu, SymbolicLu};
use faer::sparse::{SparseColMat, Triplet};

use super::{Factorization, norm, refined};
use crate::SolveError;

/// Krylov vectors kept; the skew part has the rank of the sliding points at most, and a coefficient of friction of
/// 0.15 needs about 10.
const KRYLOV: usize = 40;
/// Relative residual at which the iteration stops: Newton's method gains seven digits per step at most, with sliding
/// friction as everywhere, and 1e-11 took twice as many solves.
const GOAL: f64 = 1e-7;
/// Relative residual that is still taken; above it LU does the step.
const LIMIT: f64 = 1e-6;

/// A factored symmetric matrix and a few unsymmetric entries `(row, column, value)` on top of it.
///
/// Solved by GMRES (Saad & Schultz 1986) with the symmetric factor as the preconditioner; by sparse LU with partial
/// pivoting where that does not converge. On 1331 nodes one LU took as long as forty factorisations of the
/// symmetric part.
pub(crate) struct Unsymmetric {
    symmetric: Factorization,
    extra: Vec<(usize, usize, f64)>,
}

impl Unsymmetric {
    /// `symmetric + extra`; entries of one place add up.
    pub fn new(symmetric: Factorization, extra: Vec<(usize, usize, f64)>) -> Unsymmetric {
        Unsymmetric { symmetric, extra }
    }

    fn subtract_product(&self, x: &[f64], y: &mut [f64]) {
        self.symmetric.matrix.subtract_product(x, y);
        for &(i, j, a) in &self.extra {
            y[i] -= a * x[j];
        }
    }

    /// Solves in place and returns the relative residual.
    pub fn solve(&self, b: &mut [f64]) -> Result<f64, SolveError> {
        let size = norm(b);
        if size == 0.0 {
            return Ok(0.0);
        }
        let mut x = vec![0.0; b.len()];
        let mut residual = 1.0;
        // Restarted once: the second round works on what rounding left of the first.
        for _ in 0..3 {
            let mut rest = b.to_vec();
            self.subtract_product(&x, &mut rest);
            residual = norm(&rest) / size;
            if residual <= GOAL || !residual.is_finite() {
                break;
            }
            let step = self.gmres(&rest)?;
            x.iter_mut().zip(&step).for_each(|(x, s)| *x += s);
        }
        if residual <= LIMIT {
            b.copy_from_slice(&x);
            return Ok(residual);
        }
        self.direct(b)
    }

    /// One cycle: the x in the Krylov space of `A M^-1` that makes `|rest - A x|` least.
    fn gmres(&self, rest: &[f64]) -> Result<Vec<f64>, SolveError> {
        let size = norm(rest);
        let mut basis: Vec<Vec<f64>> = vec![rest.iter().map(|r| r / size).collect()];
        let mut preconditioned: Vec<Vec<f64>> = Vec::new();
        // Columns of the Hessenberg matrix made upper triangular by rotations, and the rotated right-hand side.
        let mut columns: Vec<Vec<f64>> = Vec::new();
        let mut rotations: Vec<(f64, f64)> = Vec::new();
        let mut right = vec![size];
        for k in 0..KRYLOV {
            let mut z = basis[k].clone();
            self.symmetric.solve_once(&mut z)?;
            let mut w = vec![0.0; z.len()];
            self.subtract_product(&z, &mut w);
            w.iter_mut().for_each(|w| *w = -*w);
            preconditioned.push(z);
            let mut h = Vec::with_capacity(k + 2);
            for v in &basis {
                let dot: f64 = v.iter().zip(&w).map(|(a, b)| a * b).sum();
                w.iter_mut().zip(v).for_each(|(w, v)| *w -= dot * v);
                h.push(dot);
            }
            let next = norm(&w);
            for (i, &(c, s)) in rotations.iter().enumerate() {
                (h[i], h[i + 1]) = (c * h[i] + s * h[i + 1], c * h[i + 1] - s * h[i]);
            }
            let length = h[k].hypot(next);
            let (c, s) = (h[k] / length, next / length);
            h[k] = length;
            rotations.push((c, s));
            columns.push(h);
            right.push(-s * right[k]);
            right[k] *= c;
            if right[k + 1].abs() <= GOAL * 0.1 * size || !(next > 0.0) {
                break;
            }
            basis.push(w.iter().map(|w| w / next).collect());
        }
        let m = columns.len();
        let mut y = vec![0.0; m];
        for i in (0..m).rev() {
            let sum: f64 = (i + 1..m).map(|j| columns[j][i] * y[j]).sum();
            y[i] = (right[i] - sum) / columns[i][i];
        }
        let mut x = vec![0.0; rest.len()];
        for (z, y) in preconditioned.iter().zip(&y) {
            x.iter_mut().zip(z).for_each(|(x, z)| *x += y * z);
        }
        Ok(x)
    }

    fn direct(&self, b: &mut [f64]) -> Result<f64, SolveError> {
        let matrix = &self.symmetric.matrix;
        let n = matrix.dim();
        let mut triplets = Vec::with_capacity(2 * matrix.rows.len() + self.extra.len());
        for j in 0..n {
            for k in matrix.offsets[j]..matrix.offsets[j + 1] {
                let (i, value) = (matrix.rows[k], matrix.values[k]);
                triplets.push(Triplet::new(i, j, value));
                if i != j {
                    triplets.push(Triplet::new(j, i, value));
                }
            }
        }
        triplets.extend(self.extra.iter().map(|&(i, j, v)| Triplet::new(i, j, v)));
        let failed = |why: String| SolveError::TooLarge { dofs: n, why };
        let full =
            SparseColMat::try_new_from_triplets(n, n, &triplets).map_err(|e| failed(format!("{e:?}")))?;
        let symbolic = SymbolicLu::try_new(full.symbolic()).map_err(|e| failed(format!("{e:?}")))?;
        let lu = Lu::try_new_with_symbolic(symbolic, full.as_ref()).map_err(|_| SolveError::ZeroPivot)?;
        let once = |x: &mut [f64]| {
            lu.solve_in_place(MatMut::from_column_major_slice_mut(x, n, 1));
            Ok(())
        };
        refined(b, once, |x, y| self.subtract_product(x, y))
    }
}
