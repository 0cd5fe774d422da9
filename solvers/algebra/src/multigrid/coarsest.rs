//! Direct solution of a small level, or of a part of a level.

use super::lower_triangle::LowerRows;
use super::operator::Entry;
use crate::linear_solver::{FactorError, Factorization, Symmetric, factor};

/// Largest number of degrees of freedom that are solved directly. The dense factor has 6 MB and is read twice
/// in each solve.
pub(super) const COARSEST: usize = 1200;

/// Matrix that is solved by a direct factor.
pub(super) struct Coarsest<const B: usize> {
    /// Factor of the matrix, without `scale`.
    factor: Factorization,
    scale: f64,
}

impl<const B: usize> Coarsest<B> {
    /// Factors a matrix, of which the level has `scale` times.
    pub fn new(lower: &impl LowerRows<B>, scale: f64) -> Result<Coarsest<B>, FactorError> {
        let dim = B * lower.nodes();
        let mut matrix = Symmetric {
            offsets: vec![0],
            rows: Vec::new(),
            values: Vec::new(),
            multipliers: dim,
            vertices: (0..=lower.nodes()).map(|i| B * i).collect(),
        };
        for i in 0..lower.nodes() {
            let columns = lower.columns(i);
            for a in 0..B {
                for (at, &j) in columns.iter().enumerate() {
                    let block = lower.block(i, at);
                    let width = if j as usize == i { a + 1 } else { B };
                    for (b, column) in block.iter().enumerate().take(width) {
                        matrix.rows.push(B * j as usize + b);
                        matrix.values.push(column[a]);
                    }
                }
                matrix.offsets.push(matrix.rows.len());
            }
        }
        Ok(Coarsest { factor: factor(matrix, COARSEST)?, scale })
    }

    /// Number of degrees of freedom.
    pub fn dim(&self) -> usize {
        self.factor.dim()
    }

    /// Sets `x` to the solution for `b` with the level's matrix.
    pub fn solve(&self, b: &[Entry<B>], x: &mut [Entry<B>]) {
        let mut values: Vec<f64> = b.iter().flatten().map(|&b| f64::from(b) / self.scale).collect();
        // A definite factor always solves. If it failed, conjugate gradients would stop at the first NaN
        // product.
        if self.factor.solve_once(&mut values).is_err() {
            values.fill(f64::NAN);
        }
        for (x, value) in x.iter_mut().flatten().zip(values) {
            *x = value as f32;
        }
    }

    /// Solves in place with the matrix without `scale`, in double precision. Returns whether the factor
    /// solves.
    pub fn solve_unscaled(&self, values: &mut [f64]) -> bool {
        self.factor.solve_once(values).is_ok()
    }
}
