//! Factorisation `A = L D L^T` of small symmetric matrices, one per lane, with a pivot check.

use lanes::{LANES, Lanes};

/// `M` x `K` matrices, one per lane.
pub(crate) type Matrices<const M: usize, const K: usize> = [[Lanes; K]; M];

/// Factors of `M` x `M` symmetric positive definite matrices.
pub(crate) struct Ldlt<const M: usize> {
    /// Unit lower triangle; the diagonal and the upper part are unused.
    lower: Matrices<M, M>,
    inverse_pivots: [Lanes; M],
    /// Positive in lanes whose factors are valid.
    sound: Lanes,
}

impl<const M: usize> Ldlt<M> {
    /// Factors `a` (lower triangle read). A lane is invalid if a pivot is NaN or falls below `tolerance`
    /// times its own diagonal entry. This test is invariant to scaling of rows and columns.
    #[inline(always)]
    pub(crate) fn new(a: &Matrices<M, M>, tolerance: f64) -> Ldlt<M> {
        let mut lower = *a;
        let mut inverse_pivots = [[0.0; LANES]; M];
        let mut sound = [1.0; LANES];
        for j in 0..M {
            for l in 0..LANES {
                let pivot = lower[j][j][l];
                // NaN is rejected.
                let passes = pivot > tolerance * a[j][j][l] && pivot < f64::INFINITY;
                sound[l] = if passes { sound[l] } else { 0.0 };
                inverse_pivots[j][l] = 1.0 / pivot;
            }
            for i in j + 1..M {
                let mut factor = [0.0; LANES];
                for l in 0..LANES {
                    factor[l] = lower[i][j][l] * inverse_pivots[j][l];
                }
                for k in j + 1..=i {
                    for l in 0..LANES {
                        lower[i][k][l] -= factor[l] * lower[k][j][l];
                    }
                }
            }
            // The scaling follows here because the update above needs L D of this column, whereas the solve
            // needs L.
            for i in j + 1..M {
                for l in 0..LANES {
                    lower[i][j][l] *= inverse_pivots[j][l];
                }
            }
        }
        Ldlt { lower, inverse_pivots, sound }
    }

    /// Whether the factors of a lane are valid.
    pub(crate) fn is_sound(&self, lane: usize) -> bool {
        self.sound[lane] > 0.0
    }

    /// Solves for `K` right-hand sides at once, in place; indices are `b[row][column]`.
    #[inline(always)]
    pub(crate) fn solve<const K: usize>(&self, b: &mut Matrices<M, K>) {
        for i in 1..M {
            for j in 0..i {
                self.subtract(b, i, j, &self.lower[i][j]);
            }
        }
        for i in 0..M {
            for k in 0..K {
                for l in 0..LANES {
                    b[i][k][l] *= self.inverse_pivots[i][l];
                }
            }
        }
        for i in (0..M).rev() {
            for j in i + 1..M {
                self.subtract(b, i, j, &self.lower[j][i]);
            }
        }
    }

    /// Subtracts `factor` times row `j` from row `i`.
    #[inline(always)]
    fn subtract<const K: usize>(&self, b: &mut Matrices<M, K>, i: usize, j: usize, factor: &Lanes) {
        for k in 0..K {
            for l in 0..LANES {
                b[i][k][l] -= factor[l] * b[j][k][l];
            }
        }
    }

    /// Returns the largest column sum of `|A^-1|`, from `A^-1 = L^-T D^-1 L^-1`: a third of the products of
    /// `M` solves.
    #[inline(always)]
    pub(crate) fn inverse_norm(&self) -> Lanes {
        // L^-1 below its unit diagonal.
        let mut x = [[[0.0; LANES]; M]; M];
        for j in 0..M {
            for i in j + 1..M {
                let mut sum = self.lower[i][j];
                for k in j + 1..i {
                    for l in 0..LANES {
                        sum[l] += self.lower[i][k][l] * x[k][j][l];
                    }
                }
                for l in 0..LANES {
                    x[i][j][l] = -sum[l];
                }
            }
        }
        let mut scaled = x;
        for k in 0..M {
            for i in 0..k {
                for l in 0..LANES {
                    scaled[k][i][l] *= self.inverse_pivots[k][l];
                }
            }
        }
        let mut columns = [[0.0; LANES]; M];
        for i in 0..M {
            for j in 0..=i {
                let mut entry = if i == j { self.inverse_pivots[i] } else { scaled[i][j] };
                for k in i + 1..M {
                    for l in 0..LANES {
                        entry[l] += scaled[k][i][l] * x[k][j][l];
                    }
                }
                add_symmetric(&mut columns, i, j, &entry);
            }
        }
        largest(&columns)
    }
}

/// Returns the largest column sum of absolute values (the 1-norm) of symmetric matrices.
#[inline(always)]
pub(crate) fn norm<const M: usize>(a: &Matrices<M, M>) -> Lanes {
    let mut columns = [[0.0; LANES]; M];
    for i in 0..M {
        for j in 0..=i {
            add_symmetric(&mut columns, i, j, &a[i][j]);
        }
    }
    largest(&columns)
}

#[inline(always)]
fn add_symmetric<const M: usize>(columns: &mut [Lanes; M], i: usize, j: usize, entry: &Lanes) {
    for l in 0..LANES {
        columns[j][l] += entry[l].abs();
    }
    if i != j {
        for l in 0..LANES {
            columns[i][l] += entry[l].abs();
        }
    }
}

#[inline(always)]
fn largest<const M: usize>(columns: &[Lanes; M]) -> Lanes {
    let mut most = [0.0; LANES];
    for column in columns {
        for l in 0..LANES {
            most[l] = if column[l] > most[l] { column[l] } else { most[l] };
        }
    }
    most
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Puts a matrix in lane 5 and other matrices in the remaining lanes.
    fn in_lane_5<const M: usize>(a: [[f64; M]; M]) -> Matrices<M, M> {
        let other = |i: usize, j: usize, l: usize| if i == j { 1.0 + l as f64 } else { 0.01 };
        std::array::from_fn(|i| {
            std::array::from_fn(|j| std::array::from_fn(|l| if l == 5 { a[i][j] } else { other(i, j, l) }))
        })
    }

    #[test]
    fn solves_and_measures_a_known_matrix() {
        // A = [[4, 2, 0], [2, 5, 1], [0, 1, 3]]; det = 44; inverse by cofactors.
        let a = in_lane_5([[4.0, 2.0, 0.0], [2.0, 5.0, 1.0], [0.0, 1.0, 3.0]]);
        let ldlt = Ldlt::new(&a, 1e-12);
        let mut b = [[1.0, 8.0], [0.0, 15.0], [0.0, 11.0]].map(|row| row.map(|v| [v; LANES]));
        ldlt.solve(&mut b);
        let exact = [[14.0 / 44.0, 1.0], [-6.0 / 44.0, 2.0], [2.0 / 44.0, 3.0]];
        for i in 0..3 {
            for k in 0..2 {
                assert!((b[i][k][5] - exact[i][k]).abs() < 1e-14, "{i} {k}: {}", b[i][k][5]);
            }
        }
        assert_eq!(norm(&a)[5], 8.0);
        assert!((ldlt.inverse_norm()[5] - 22.0 / 44.0).abs() < 1e-14, "{}", ldlt.inverse_norm()[5]);
    }

    #[test]
    fn measures_the_inverse_that_solves_give() {
        // Ten rows, as for the quadratic basis: a Hilbert matrix with a different diagonal in every lane.
        let a: Matrices<10, 10> = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let entry = 1.0 / (i + j + 1) as f64;
                std::array::from_fn(|l| entry + if i == j { 0.1 + l as f64 } else { 0.0 })
            })
        });
        let ldlt = Ldlt::new(&a, 1e-12);
        let mut inverse: Matrices<10, 10> =
            std::array::from_fn(|i| std::array::from_fn(|j| [if i == j { 1.0 } else { 0.0 }; LANES]));
        ldlt.solve(&mut inverse);
        for l in 0..LANES {
            let column = |j: usize| (0..10).map(|i| inverse[i][j][l].abs()).sum::<f64>();
            let expected = (0..10).map(column).fold(0.0, f64::max);
            let found = ldlt.inverse_norm()[l];
            // Both have rounding errors times a condition number of at most 20.
            assert!((found / expected - 1.0).abs() < 1e-13, "{l}: {found} {expected}");
        }
    }

    #[test]
    fn refuses_singular_indefinite_and_nan_in_their_lane_alone() {
        let sound = |a: [[f64; 2]; 2]| {
            let ldlt = Ldlt::new(&in_lane_5(a), 1e-10);
            assert!((0..LANES).all(|l| l == 5 || ldlt.is_sound(l)));
            ldlt.is_sound(5)
        };
        assert!(!sound([[1.0, 1.0], [1.0, 1.0]]));
        assert!(!sound([[1.0, 2.0], [2.0, 1.0]]));
        assert!(!sound([[f64::NAN, 0.0], [0.0, 1.0]]));
        // The test is relative to each diagonal entry, so units of the basis do not matter.
        assert!(sound([[1.0, 0.0], [0.0, 1e-30]]));
    }
}
