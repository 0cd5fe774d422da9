//! `A = L D L^T` of a small symmetric matrix, with a pivot check.

/// Factors of an `M` x `M` symmetric positive definite matrix.
pub(crate) struct Ldlt<const M: usize> {
    /// Unit lower triangle; the diagonal and the upper part are unused.
    lower: [[f64; M]; M],
    inverse_pivots: [f64; M],
}

impl<const M: usize> Ldlt<M> {
    /// Factors `a` (lower triangle read). `None` if a pivot falls below `tolerance` times its own diagonal entry
    /// (a test no scaling of rows and columns changes) or is not a number.
    #[inline(always)]
    pub(crate) fn new(a: &[[f64; M]; M], tolerance: f64) -> Option<Ldlt<M>> {
        let mut lower = *a;
        let mut inverse_pivots = [0.0; M];
        for j in 0..M {
            let pivot = lower[j][j];
            // `!(>)` and not `<=`: a NaN must not pass.
            if !(pivot > tolerance * a[j][j] && pivot < f64::INFINITY) {
                return None;
            }
            inverse_pivots[j] = 1.0 / pivot;
            for i in j + 1..M {
                let l = lower[i][j] * inverse_pivots[j];
                for k in j + 1..=i {
                    lower[i][k] -= l * lower[k][j];
                }
            }
            // Only now: the update above needs L D of this column, the solve needs L.
            for i in j + 1..M {
                lower[i][j] *= inverse_pivots[j];
            }
        }
        Some(Ldlt { lower, inverse_pivots })
    }

    /// Solves for `K` right-hand sides at once, in place: `b[row][column]`.
    #[inline(always)]
    pub(crate) fn solve<const K: usize>(&self, b: &mut [[f64; K]; M]) {
        for i in 1..M {
            for j in 0..i {
                for k in 0..K {
                    b[i][k] -= self.lower[i][j] * b[j][k];
                }
            }
        }
        for i in 0..M {
            for k in 0..K {
                b[i][k] *= self.inverse_pivots[i];
            }
        }
        for i in (0..M).rev() {
            for j in i + 1..M {
                for k in 0..K {
                    b[i][k] -= self.lower[j][i] * b[j][k];
                }
            }
        }
    }

    /// Largest column sum of `|A^-1|`, from `M` solves in one go.
    #[inline(always)]
    pub(crate) fn inverse_norm(&self) -> f64 {
        let mut inverse = [[0.0; M]; M];
        for i in 0..M {
            inverse[i][i] = 1.0;
        }
        self.solve(&mut inverse);
        norm(&inverse)
    }
}

/// Largest column sum of absolute values (the 1-norm) of a full symmetric matrix.
#[inline(always)]
pub(crate) fn norm<const M: usize>(a: &[[f64; M]; M]) -> f64 {
    let mut sums = [0.0; M];
    for row in a {
        for (sum, value) in sums.iter_mut().zip(row) {
            *sum += value.abs();
        }
    }
    sums.into_iter().fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_and_measures_a_known_matrix() {
        // A = [[4, 2, 0], [2, 5, 1], [0, 1, 3]]; det = 44; inverse by cofactors.
        let a = [[4.0, 2.0, 0.0], [2.0, 5.0, 1.0], [0.0, 1.0, 3.0]];
        let ldlt = Ldlt::new(&a, 1e-12).unwrap();
        let mut b = [[1.0, 8.0], [0.0, 15.0], [0.0, 11.0]];
        ldlt.solve(&mut b);
        let exact = [[14.0 / 44.0, 1.0], [-6.0 / 44.0, 2.0], [2.0 / 44.0, 3.0]];
        for i in 0..3 {
            for k in 0..2 {
                assert!((b[i][k] - exact[i][k]).abs() < 1e-14, "{i} {k}: {}", b[i][k]);
            }
        }
        assert_eq!(norm(&a), 8.0);
        assert!((ldlt.inverse_norm() - 22.0 / 44.0).abs() < 1e-14, "{}", ldlt.inverse_norm());
    }

    #[test]
    fn refuses_singular_indefinite_and_nan() {
        assert!(Ldlt::new(&[[1.0, 1.0], [1.0, 1.0]], 1e-10).is_none());
        assert!(Ldlt::new(&[[1.0, 2.0], [2.0, 1.0]], 1e-10).is_none());
        assert!(Ldlt::new(&[[f64::NAN, 0.0], [0.0, 1.0]], 1e-10).is_none());
        // The test is relative to each diagonal: units of the basis do not matter.
        assert!(Ldlt::new(&[[1.0, 0.0], [0.0, 1e-30]], 1e-10).is_some());
    }
}
