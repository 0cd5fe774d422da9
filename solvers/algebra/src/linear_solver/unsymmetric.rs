//! Unsymmetric systems: the tangent of a body with sliding friction, or with tools driven by force.

use faer::MatMut;
use faer::prelude::Solve;
use faer::sparse::linalg::solvers::{Lu, SymbolicLu};
use faer::sparse::{SparseColMat, Triplet};
use nalgebra::{DMatrix, DVector, Dyn, LU};

use super::refine::{dot, norm, refined};
use super::symmetric::Symmetric;
use super::{Factor, Factorization};
use crate::error::AlgebraError;

/// Largest number of Krylov vectors. The rank of the skew part is at most that of the sliding points, and a
/// coefficient of friction of 0.15 needs about 10 vectors.
const KRYLOV: usize = 40;
/// Iteration from which the convergence rate decides whether a kept factor suffices.
const JUDGED: usize = 3;

/// Row and column that border a matrix, for a tool driven by force, whose displacement is unknown.
pub struct Border {
    /// Bordering column `C`, without the corner.
    pub column: Vec<f64>,
    /// Bordering row `R`, without the corner.
    pub row: Vec<f64>,
    /// Entry on the diagonal, common to the bordering row and column.
    pub corner: f64,
}

/// Factored symmetric matrix S with a few unsymmetric entries U, `(row, column, value)`, and borders:
/// `[S + U, C; R, D]`, D diagonal.
///
/// Solved by GMRES (Saad & Schultz 1986), preconditioned with the factor of `[S, C; R, D]`. If GMRES does not
/// converge, the system is solved by sparse LU with partial pivoting. On 1331 nodes one LU took as long as
/// forty factorisations of the symmetric part.
pub struct Unsymmetric {
    symmetric: Factorization,
    extra: Vec<(usize, usize, f64)>,
    borders: Vec<Border>,
    /// Columns of `S^-1 C`.
    solved: Vec<Vec<f64>>,
    /// LU factors of the Schur complement `D - R S^-1 C`.
    schur: LU<f64, Dyn, Dyn>,
    /// Whether the symmetric part of the Schur complement is positive definite.
    stable: bool,
}

impl Unsymmetric {
    /// Builds `[S + U, C; R, D]` from the factored matrix `S`, the entries (row, column, value) of `U` in
    /// `extra`, and the `borders`. Entries of `extra` with the same row and column add up.
    ///
    /// # Errors
    ///
    /// [`AlgebraError::TooLarge`] if there is no memory for a solve.
    pub fn new(
        symmetric: Factorization,
        extra: Vec<(usize, usize, f64)>,
        borders: Vec<Border>,
    ) -> Result<Unsymmetric, AlgebraError> {
        let mut solved: Vec<Vec<f64>> = borders.iter().map(|b| b.column.clone()).collect();
        solved.iter_mut().try_for_each(|x| symmetric.solve_once(x))?;
        let schur = DMatrix::from_fn(borders.len(), borders.len(), |i, j| {
            let corner = if i == j { borders[i].corner } else { 0.0 };
            corner - dot(&borders[i].row, &solved[j])
        });
        let stable = (&schur + schur.transpose()).cholesky().is_some();
        Ok(Unsymmetric { symmetric, extra, borders, solved, schur: schur.lu(), stable })
    }

    /// Whether the borders keep the matrix positive definite, provided that the matrix without borders is
    /// positive definite.
    pub fn stable(&self) -> bool {
        self.stable
    }

    fn subtract_product(&self, x: &[f64], y: &mut [f64]) {
        let (x, moves) = x.split_at(self.symmetric.dim());
        let (y, lacks) = y.split_at_mut(x.len());
        self.symmetric.matrix.subtract_product(x, y);
        for &(i, j, a) in &self.extra {
            y[i] -= a * x[j];
        }
        for ((border, d), lack) in self.borders.iter().zip(moves).zip(lacks) {
            y.iter_mut().zip(&border.column).for_each(|(y, c)| *y -= c * d);
            *lack -= border.corner * d + dot(&border.row, x);
        }
    }

    /// Solves without the unsymmetric entries, as a preconditioner; the borders by block elimination.
    fn precondition(&self, factor: &Factor, b: &mut [f64]) -> Result<(), AlgebraError> {
        let (x, moves) = b.split_at_mut(self.symmetric.dim());
        factor.solve(x)?;
        if moves.is_empty() {
            return Ok(());
        }
        let lacks = moves.iter().zip(&self.borders).map(|(lack, border)| lack - dot(&border.row, x));
        let mut found = DVector::from_iterator(moves.len(), lacks);
        if !self.schur.solve_mut(&mut found) {
            return Err(AlgebraError::ZeroPivot);
        }
        moves.copy_from_slice(found.as_slice());
        for (column, d) in self.solved.iter().zip(found.iter()) {
            x.iter_mut().zip(column).for_each(|(x, c)| *x -= c * d);
        }
        Ok(())
    }

    /// Returns the symmetric matrix `S` and the unsymmetric entries `U`. The borders are dropped.
    pub fn into_parts(self) -> (Symmetric, Vec<(usize, usize, f64)>) {
        (self.symmetric.matrix, self.extra)
    }

    /// Whether the factor, if it belongs to the symmetric matrix, proves this matrix definite.
    pub fn is_clear(&self) -> bool {
        self.symmetric.factor.is_clear(self.matrix())
    }

    /// The symmetric matrix.
    pub fn matrix(&self) -> &Symmetric {
        &self.symmetric.matrix
    }

    /// Solves in place to a relative residual of `goal` in at most `most` iterations, with the factor of a
    /// nearby matrix.
    ///
    /// Returns the number of iterations and whether the system is solved; `b` is unchanged if not. The solve
    /// ends early as soon as the convergence rate shows that `most` iterations do not suffice.
    ///
    /// # Errors
    ///
    /// [`AlgebraError::ZeroPivot`] if the borders make the preconditioner singular.
    pub fn solve_within(&self, b: &mut [f64], goal: f64, most: usize) -> Result<(usize, bool), AlgebraError> {
        let size = norm(b);
        if size == 0.0 {
            return Ok((0, true));
        }
        let (x, count) = self.gmres(&self.symmetric.factor, b, goal, most, true)?;
        let mut rest = b.to_vec();
        self.subtract_product(&x, &mut rest);
        let solved = norm(&rest) <= goal * size;
        if solved {
            b.copy_from_slice(&x);
        }
        Ok((count, solved))
    }

    /// Solves in place to a relative residual of `goal`, or at worst ten times `goal`, and returns the number
    /// of iterations.
    ///
    /// If this fails with a factor in single precision, the matrix is factored in double precision. If that
    /// fails too, the system is solved by LU.
    ///
    /// # Errors
    ///
    /// [`AlgebraError::Residual`] or [`AlgebraError::ZeroPivot`] if LU fails too, [`AlgebraError::TooLarge`]
    /// if there is no memory.
    pub fn solve(&self, b: &mut [f64], goal: f64) -> Result<usize, AlgebraError> {
        let factor = &self.symmetric.factor;
        let (mut iterations, mut solved) = self.cycles(factor, b, goal)?;
        if solved {
            return Ok(iterations);
        }
        if let Some(exact) = factor.exact(self.matrix())? {
            let more;
            (more, solved) = self.cycles(&exact, b, goal)?;
            iterations += more;
        }
        if !solved {
            self.direct(b)?;
        }
        Ok(iterations)
    }

    /// Runs up to three cycles of GMRES. Returns the number of iterations and whether the system is solved;
    /// `b` is unchanged if not.
    fn cycles(&self, factor: &Factor, b: &mut [f64], goal: f64) -> Result<(usize, bool), AlgebraError> {
        let size = norm(b);
        if size == 0.0 {
            return Ok((0, true));
        }
        let mut x = vec![0.0; b.len()];
        let (mut residual, mut iterations) = (1.0, 0);
        // Two restarts: a cycle works on the residual that rounding, or the number of vectors, left behind.
        for _ in 0..3 {
            let mut rest = b.to_vec();
            self.subtract_product(&x, &mut rest);
            residual = norm(&rest) / size;
            if residual <= goal || !residual.is_finite() {
                break;
            }
            let (step, count) = self.gmres(factor, &rest, goal / residual, KRYLOV, false)?;
            iterations += count;
            x.iter_mut().zip(&step).for_each(|(x, s)| *x += s);
        }
        let solved = residual <= 10.0 * goal;
        if solved {
            b.copy_from_slice(&x);
        }
        Ok((iterations, solved))
    }

    /// Runs one cycle, until the residual is `goal` times the initial residual. Returns the x in the Krylov
    /// space of `A M^-1` that minimises `|rest - A x|`, and the dimension of that space. If `judged`, the
    /// cycle ends as soon as the convergence rate does not reach `goal` in `most` iterations.
    fn gmres(
        &self,
        factor: &Factor,
        rest: &[f64],
        goal: f64,
        most: usize,
        judged: bool,
    ) -> Result<(Vec<f64>, usize), AlgebraError> {
        let size = norm(rest);
        let mut basis: Vec<Vec<f64>> = vec![rest.iter().map(|r| r / size).collect()];
        let mut preconditioned: Vec<Vec<f64>> = Vec::new();
        // Columns of the Hessenberg matrix made upper triangular by rotations, and the rotated right-hand
        // side.
        let mut columns: Vec<Vec<f64>> = Vec::new();
        let mut rotations: Vec<(f64, f64)> = Vec::new();
        let mut right = vec![size];
        for k in 0..most {
            let mut z = basis[k].clone();
            self.precondition(factor, &mut z)?;
            let mut w = vec![0.0; z.len()];
            self.subtract_product(&z, &mut w);
            w.iter_mut().for_each(|w| *w = -*w);
            preconditioned.push(z);
            let mut h = Vec::with_capacity(k + 2);
            for v in &basis {
                let along = dot(v, &w);
                w.iter_mut().zip(v).for_each(|(w, v)| *w -= along * v);
                h.push(along);
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
            if right[k + 1].abs() <= 0.5 * goal * size || !(next > 0.0) {
                break;
            }
            let fallen = right[k + 1].abs() / size;
            if judged && k + 1 >= JUDGED && goal.ln() / fallen.ln() * (k + 1) as f64 > most as f64 {
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
        Ok((x, m))
    }

    fn direct(&self, b: &mut [f64]) -> Result<f64, AlgebraError> {
        let matrix = &self.symmetric.matrix;
        let n = b.len();
        let mut triplets = Vec::with_capacity(2 * matrix.rows.len() + self.extra.len());
        for j in 0..matrix.dim() {
            for k in matrix.offsets[j]..matrix.offsets[j + 1] {
                let (i, value) = (matrix.rows[k], matrix.values[k]);
                triplets.push(Triplet::new(i, j, value));
                if i != j {
                    triplets.push(Triplet::new(j, i, value));
                }
            }
        }
        triplets.extend(self.extra.iter().map(|&(i, j, v)| Triplet::new(i, j, v)));
        for (k, border) in (matrix.dim()..).zip(&self.borders) {
            let entries = border
                .row
                .iter()
                .zip(&border.column)
                .enumerate()
                .filter(|(_, (r, c))| **r != 0.0 || **c != 0.0);
            triplets.extend(entries.flat_map(|(i, (&r, &c))| [Triplet::new(k, i, r), Triplet::new(i, k, c)]));
            triplets.push(Triplet::new(k, k, border.corner));
        }
        let failed = |why: String| AlgebraError::TooLarge { dofs: n, why };
        let full =
            SparseColMat::try_new_from_triplets(n, n, &triplets).map_err(|e| failed(format!("{e:?}")))?;
        let symbolic = SymbolicLu::try_new(full.symbolic()).map_err(|e| failed(format!("{e:?}")))?;
        let lu = Lu::try_new_with_symbolic(symbolic, full.as_ref()).map_err(|_| AlgebraError::ZeroPivot)?;
        let once = |x: &mut [f64]| {
            lu.solve_in_place(MatMut::from_column_major_slice_mut(x, n, 1));
            Ok(())
        };
        refined(b, once, |x, y| self.subtract_product(x, y))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear_solver::{Kind, analyse, factor_as, factor_roughly};
    use std::sync::Arc;

    const SIDE: usize = 12;

    /// Membrane of SIDE x SIDE nodes on springs, whose stiffness varies from node to node by `uneven`.
    fn membrane(uneven: f64) -> Symmetric {
        let n = SIDE * SIDE;
        let mut rows = Vec::new();
        let mut values = Vec::new();
        let mut offsets = vec![0];
        for j in 0..n {
            for i in [j.checked_sub(SIDE), (j % SIDE > 0).then(|| j - 1)].into_iter().flatten() {
                rows.push(i);
                values.push(-1.0);
            }
            rows.push(j);
            values.push(4.01 + uneven * (1.0 + (j as f64).sin()));
            offsets.push(rows.len());
        }
        Symmetric { offsets, rows, values, multipliers: n, vertices: (0..=n).collect() }
    }

    /// Membrane with skew entries, with the factor of an even membrane.
    fn near(uneven: f64, roughly: bool) -> Unsymmetric {
        let (matrix, even) = (membrane(uneven), membrane(0.0));
        let symbolic = analyse(&matrix, 0).unwrap();
        let make = if roughly { factor_roughly } else { factor_as };
        let factor = Arc::new(make(symbolic.as_ref(), &even, Kind::Definite).unwrap());
        let skew = vec![(3, 40, 0.1), (40, 3, -0.1)];
        Unsymmetric::new(Factorization { matrix, factor, kind: Kind::Definite }, skew, Vec::new()).unwrap()
    }

    fn residual(of: &Unsymmetric, x: &[f64]) -> f64 {
        let mut rest = vec![1.0; x.len()];
        of.subtract_product(x, &mut rest);
        norm(&rest) / (x.len() as f64).sqrt()
    }

    #[test]
    fn a_factor_of_a_matrix_near_to_it_solves_in_few_iterations() {
        for roughly in [false, true] {
            let system = near(0.05, roughly);
            let mut x = vec![1.0; SIDE * SIDE];
            let (iterations, solved) = system.solve_within(&mut x, 1e-4, 12).unwrap();
            assert!(solved && (2..=8).contains(&iterations), "{iterations}");
            assert!(residual(&system, &x) <= 1e-4);
            let mut x = vec![1.0; SIDE * SIDE];
            system.solve(&mut x, 1e-10).unwrap();
            assert!(residual(&system, &x) <= 1e-9, "{}", residual(&system, &x));
        }
    }

    #[test]
    fn a_factor_of_another_matrix_is_given_up_soon_and_leaves_the_right_side() {
        let system = near(40.0, true);
        let mut x = vec![1.0; SIDE * SIDE];
        let (iterations, solved) = system.solve_within(&mut x, 1e-8, 12).unwrap();
        assert!(!solved && iterations < 8 && x.iter().all(|x| *x == 1.0), "{iterations}");
        // The double-precision factor belongs to the matrix itself.
        assert!(system.symmetric.factor.exact(system.matrix()).unwrap().is_some());
    }

    #[test]
    fn three_columns_at_once_make_the_same_bits_as_one_by_one() {
        // All rows of other nodes are shared, as in the columns of a node.
        let full = |vertices: &[usize]| {
            let n = 9;
            Symmetric {
                offsets: (0..=n).map(|j| j * (j + 1) / 2).collect(),
                rows: (0..n).flat_map(|j| 0..=j).collect(),
                values: (0..n * (n + 1) / 2).map(|k| (k as f64).sin()).collect(),
                multipliers: n,
                vertices: vertices.to_vec(),
            }
        };
        let product = |matrix: &Symmetric| {
            let x: Vec<f64> = (0..matrix.dim()).map(|i| (0.7 * i as f64).cos()).collect();
            let mut y = vec![0.25; matrix.dim()];
            matrix.subtract_product(&x, &mut y);
            y.iter().map(|y| y.to_bits()).collect::<Vec<_>>()
        };
        let one: Vec<usize> = (0..=9).collect();
        assert_eq!(product(&full(&one)), product(&full(&[0, 3, 6, 9])));
    }
}
