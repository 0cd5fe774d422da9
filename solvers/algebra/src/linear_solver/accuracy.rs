//! Accuracy of a solution: backward error and condition number.
//!
//! The residual relative to the right-hand side says little if a solution is large for its load, as for a
//! slender beam or nearly incompressible tissue. Rounding alone then leaves 1e-7 of the load, although the
//! solution is as good as the matrix allows. A solution is therefore judged by the smallest relative change
//! of matrix and right-hand side that makes it exact. This is the normwise backward error
//! `|b - A x| / (|A| |x| + |b|)` (Rigal & Gaches, J. ACM 14 (1967) 543-548; Higham, Accuracy and Stability of
//! Numerical Algorithms, 2nd ed. 2002, theorem 7.1). The number of correct digits follows from the backward
//! error times the condition number. All norms are maximum norms.

use super::symmetric::Symmetric;
use crate::error::AlgebraError;

/// Backward error above which a solution is refused. A stable solve of a million unknowns leaves less (2e-16
/// times the square root of their number). Contradictory constraints leave at least a tenth of the
/// regularisation.
pub(super) const BACKWARD_LIMIT: f64 = 1e-12;
/// Number of correct digits below which a solution is refused.
pub(super) const FEWEST_DIGITS: f64 = 1.0;
/// Largest number of iterations of the norm estimate, which ends after two or three.
const ROUNDS: usize = 5;

/// Outcome of a solve: its residual, and the norms for its backward error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Solved {
    /// Relative residual `|b - A x| / |b|`, Euclidean.
    pub residual: f64,
    /// Maximum norms of `b - A x`, `x` and `b`.
    norms: [f64; 3],
}

impl Solved {
    pub(super) fn new(residual: f64, rest: &[f64], x: &[f64], b: &[f64]) -> Solved {
        Solved { residual, norms: [largest(rest), largest(x), largest(b)] }
    }

    /// Returns the normwise backward error of the solution of a system with this matrix.
    pub(super) fn backward_error(&self, matrix: &Symmetric) -> f64 {
        let [rest, x, b] = self.norms;
        if rest == 0.0 { 0.0 } else { rest / (matrix.norm() * x + b) }
    }
}

impl Symmetric {
    /// Maximum norm, equal to the 1-norm by symmetry: the largest sum of the absolute values of a row.
    pub fn norm(&self) -> f64 {
        let mut sums = vec![0.0; self.dim()];
        for j in 0..self.dim() {
            for k in self.offsets[j]..self.offsets[j + 1] {
                let (i, a) = (self.rows[k], self.values[k].abs());
                sums[j] += a;
                if i != j {
                    sums[i] += a;
                }
            }
        }
        largest(&sums)
    }
}

/// Estimates the 1-norm of the inverse of a symmetric matrix from a few solves (Hager, SIAM J. Sci. Stat.
/// Comput. 5 (1984) 311-316; Higham 2002, algorithm 15.1, with the alternating vector of LAPACK's `lacn2`,
/// algorithm 15.5).
pub(super) fn inverse_norm(
    n: usize,
    solve: impl Fn(&mut [f64]) -> Result<(), AlgebraError>,
) -> Result<f64, AlgebraError> {
    let mut x = vec![1.0 / n as f64; n];
    let mut found = 0.0f64;
    let mut last = usize::MAX;
    for _ in 0..ROUNDS {
        solve(&mut x)?;
        let size: f64 = x.iter().map(|x| x.abs()).sum();
        if !size.is_finite() {
            return Ok(f64::INFINITY);
        }
        if size <= found {
            break;
        }
        found = size;
        x.iter_mut().for_each(|x| *x = if *x < 0.0 { -1.0 } else { 1.0 });
        solve(&mut x)?;
        let steepest = (0..n).fold(0, |best, i| if x[i].abs() > x[best].abs() { i } else { best });
        if steepest == last {
            break;
        }
        last = steepest;
        x.fill(0.0);
        x[steepest] = 1.0;
    }
    let slope = 1.0 / (n.max(2) - 1) as f64;
    let alternating = (0..n).map(|i| if i % 2 == 0 { 1.0 } else { -1.0 } * (1.0 + i as f64 * slope));
    let mut x: Vec<f64> = alternating.collect();
    solve(&mut x)?;
    let size: f64 = x.iter().map(|x| x.abs()).sum();
    Ok(if size.is_finite() { found.max(2.0 * size / (3 * n) as f64) } else { f64::INFINITY })
}

fn largest(x: &[f64]) -> f64 {
    // A NaN counts as the largest value and is kept.
    x.iter().fold(0.0, |m: f64, x| if m.is_nan() || x.abs() <= m { m } else { x.abs() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{DENSE_LIMIT, FactorError, factor};

    /// Returns a full matrix, stored as its upper triangle.
    fn full(n: usize, entry: impl Fn(usize, usize) -> f64) -> Symmetric {
        Symmetric {
            offsets: (0..=n).map(|j| j * (j + 1) / 2).collect(),
            rows: (0..n).flat_map(|j| 0..=j).collect(),
            values: (0..n).flat_map(|j| (0..=j).map(|i| entry(i, j)).collect::<Vec<_>>()).collect(),
            multipliers: n,
            vertices: (0..=n).collect(),
        }
    }

    fn string(i: usize, j: usize) -> f64 {
        if i == j { 2.0 } else { -f64::from(u8::from(i + 1 == j)) }
    }

    /// Second differences: `|A^-1| = (n + 1)^2 / 8` for odd n, reached in the middle row.
    #[test]
    fn the_condition_of_a_string_is_known() {
        for n in [1, 3, 99, 501] {
            let norm = if n == 1 { 2.0 } else { 4.0f64.min(n as f64 + 1.0) };
            let exact = norm * (n as f64 + 1.0).powi(2) / 8.0;
            for limit in [0, DENSE_LIMIT] {
                let found = factor(full(n, string), limit).unwrap().condition().unwrap();
                assert!((found / exact - 1.0).abs() < 1e-9, "{n}: {found} for {exact}");
            }
        }
    }

    /// The second pivot decides whether a 2x2 matrix is refused, in a dense and in a sparse factor.
    #[test]
    fn pivots_of_rounding_are_refused() {
        for limit in [0, DENSE_LIMIT] {
            let leaving = |rest: f64| {
                let matrix = full(2, |i, j| if i + j == 2 { 1.0 + rest } else { 1.0 });
                factor(matrix, limit).map(|_| ())
            };
            assert!(leaving(2f64.powi(-40)).is_ok());
            let refused = leaving(2f64.powi(-48));
            let near = matches!(refused, Err(FactorError::Other(AlgebraError::NearlySingular { .. })));
            assert!(near, "{refused:?}");
        }
    }

    /// Hilbert's matrix of order 7 has a condition number of 1e9 and keeps seven digits. At order 14 it is
    /// singular to rounding.
    #[test]
    fn digits_are_those_of_the_error_and_none_are_refused() {
        let hilbert = |i: usize, j: usize| 1.0 / (i + j + 1) as f64;
        let solve = |n: usize| -> Result<(f64, f64), FactorError> {
            let factored = factor(full(n, hilbert), DENSE_LIMIT)?;
            let mut x: Vec<f64> = (0..n).map(|i| (0..n).map(|j| hilbert(i, j)).sum()).collect();
            let solved = factored.solve_judged(&mut x)?;
            let error = x.iter().map(|x| (x - 1.0).abs()).fold(0.0, f64::max);
            Ok((factored.digits(&solved)?, error))
        };
        let (digits, error) = solve(7).unwrap();
        assert!((6.0..8.0).contains(&digits) && error < 10f64.powf(-digits), "{digits} {error:e}");
        let refused = solve(14);
        assert!(
            matches!(
                refused,
                Err(FactorError::NotDefinite | FactorError::Other(AlgebraError::NearlySingular { .. }))
            ),
            "{refused:?}"
        );
    }

    /// A string with free ends can move rigidly. If the ground stiffness is next to nothing, the response
    /// along that motion is noise.
    #[test]
    fn a_matrix_that_is_singular_but_for_rounding_is_refused() {
        let n = 500;
        let loose = |stiffness: f64| {
            full(n, move |i, j| match i == j {
                true => 2.0 - f64::from(u8::from(i == 0 || i + 1 == n)) + stiffness,
                false => string(i, j),
            })
        };
        let held = factor(loose(1e-6), DENSE_LIMIT).unwrap();
        assert!(held.solve_judged(&mut vec![1.0; n]).is_ok());
        for stiffness in [0.0, 1e-16] {
            let end = factor(loose(stiffness), DENSE_LIMIT)
                .map_err(|_| ())
                .and_then(|factored| factored.solve_judged(&mut vec![1.0; n]).map_err(|_| ()));
            assert!(end.is_err(), "{stiffness}: {end:?}");
        }
    }

    #[test]
    fn a_backward_error_is_that_of_rigal_and_gaches() {
        let matrix = full(2, |i, j| [[4.0, 1.0], [1.0, 3.0]][i][j]);
        // |A| = 5, |x| = 2, |b| = 3.
        let factored = factor(matrix, DENSE_LIMIT).unwrap();
        let error =
            |rest: &[f64], x: &[f64], b: &[f64]| factored.backward_error(&Solved::new(1.0, rest, x, b));
        assert_eq!(error(&[0.13, -0.26], &[1.0, 2.0], &[3.0, 1.0]), 0.02);
        assert_eq!(error(&[0.0, 0.0], &[0.0, 0.0], &[0.0, 0.0]), 0.0);
        assert!(error(&[f64::NAN, 0.0], &[1.0, 2.0], &[3.0, 1.0]).is_nan());
    }
}
