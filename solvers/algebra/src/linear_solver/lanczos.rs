//! Block Lanczos for the largest eigenvalues of `M x = theta A x`: the lowest vibrations of a large body.

use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{ComputeEigenvectors, self_adjoint_evd, self_adjoint_evd_scratch};
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};

use super::eigen::Eigen;
use super::failure::FactorError;
use super::refine::dot;
use super::symmetric::Symmetric;
use super::workspace::zeroed;
use super::{DENSE_LIMIT, Factorization, factor};
use crate::error::AlgebraError;

/// Vectors per block. A block finds as many equal eigenvalues as it has vectors: symmetry gives at most
/// three, and rigid motions are six. A block costs little more than a single vector, because the factor is
/// read once for all of them.
const BLOCK: usize = 8;
/// Largest error of a converged pair in the norm of `A`, relative to its `theta`, which is then exact to
/// about the square.
const CONVERGED: f64 = 1e-9;
/// Largest number of blocks, in addition to four vectors for each requested pair.
const BLOCKS: usize = 40;
/// Relative length below which only rounding is left of a vector: its length after orthogonalisation over the
/// largest length before.
const DEPENDENT: f64 = 1e-12;

/// Computes the `count` largest eigenvalues of `M x = theta A x`, and all others that converge with them.
/// `A = K + shift M` must be positive definite. A matrix of fewer than `count` unknowns gives all its
/// eigenvalues.
///
/// The method is block Lanczos with the factor of `A` (Grimes, Lewis & Simon, SIAM J. Matrix Anal. Appl. 15
/// (1994) 228-272). Every vector is made orthogonal to all earlier vectors in the metric of `A`, which stays
/// definite if the mass matrix is singular. Orthogonalisation is done twice, because a single pass leaves
/// rounding behind. The basis starts from fixed numbers and is never restarted. Only the factorisation uses
/// several threads, and the bits do not depend on their number.
///
/// # Errors
///
/// [`FactorError::NotDefinite`] if `A` is not positive definite, [`AlgebraError::NoEigenvalues`] if too few
/// pairs converge.
pub fn largest(
    stiffness: &Symmetric,
    mass: &Symmetric,
    shift: f64,
    count: usize,
) -> Result<Eigen, FactorError> {
    let n = stiffness.dim();
    let operator = Operator { factor: factor(stiffness.plus(mass, shift), DENSE_LIMIT)?, mass };
    let mut basis = Basis { blocks: Vec::new(), projected: Mat::zeros(0, 0) };
    let start = operator.apply(&Mat::from_fn(n, BLOCK.min(n), start))?;
    let mut next = normalised(start, 0.0).0;
    let mut due = count / BLOCK;
    for made in 1..=BLOCKS + (4 * count).div_ceil(BLOCK) {
        basis.blocks.push(next);
        let last = basis.blocks.last().expect("just pushed");
        let applied = operator.apply(&last.v)?;
        let (block, coupling) = basis.extend(applied, &operator.factor.matrix);
        next = block;
        if made < due && coupling.nrows() > 0 {
            continue;
        }
        due = made + made.div_ceil(10);
        let pairs = basis.pairs(&coupling)?;
        if pairs.converged >= count || coupling.nrows() == 0 {
            return Ok(basis.eigen(&pairs));
        }
    }
    Err(AlgebraError::NoEigenvalues { dofs: n }.into())
}

/// Returns a fixed number between -1 and 1 for each entry of the first block (SplitMix64; Steele, Lea & Flood
/// 2014).
fn start(i: usize, j: usize) -> f64 {
    let mut z = ((i * BLOCK + j) as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// The operator `A^-1 M`.
struct Operator<'a> {
    factor: Factorization,
    mass: &'a Symmetric,
}

/// Vectors `v` by columns, and `A v`.
struct Block {
    v: Mat<f64>,
    av: Mat<f64>,
}

impl Operator<'_> {
    /// Applies the operator to `v`. The product of `A` with the result needs no computation: it is `M v`.
    fn apply(&self, v: &Mat<f64>) -> Result<Block, AlgebraError> {
        let av = product(self.mass, v);
        let mut v = av.clone();
        self.factor.solve_columns(v.as_mut())?;
        Ok(Block { v, av })
    }
}

/// Returns `A v` for all columns at a time, so that the matrix is read once.
fn product(matrix: &Symmetric, v: &Mat<f64>) -> Mat<f64> {
    let (n, width) = (v.nrows(), v.ncols());
    let mut x = vec![[0.0; BLOCK]; n];
    for j in 0..width {
        v.col_as_slice(j).iter().zip(&mut x).for_each(|(v, x)| x[j] = *v);
    }
    let mut y = vec![[0.0; BLOCK]; n];
    for j in 0..n {
        let mut sum = [0.0; BLOCK];
        for k in matrix.offsets[j]..matrix.offsets[j + 1] {
            let (i, a) = (matrix.rows[k], matrix.values[k]);
            let at = x[i];
            (0..BLOCK).for_each(|c| sum[c] += a * at[c]);
            if i != j {
                let (from, to) = (x[j], &mut y[i]);
                (0..BLOCK).for_each(|c| to[c] += a * from[c]);
            }
        }
        (0..BLOCK).for_each(|c| y[j][c] += sum[c]);
    }
    Mat::from_fn(n, width, |i, j| y[i][j])
}

impl Block {
    fn length(&self, j: usize) -> f64 {
        dot(self.v.col_as_slice(j), self.av.col_as_slice(j)).max(0.0).sqrt()
    }

    fn longest(&self) -> f64 {
        (0..self.v.ncols()).map(|j| self.length(j)).fold(0.0, f64::max)
    }

    /// Adds `factor` times column `k` of `other` to column `j` of this block.
    fn add(&mut self, j: usize, factor: f64, other: &Block, k: usize) {
        for (to, from) in [(&mut self.v, &other.v), (&mut self.av, &other.av)] {
            let (to, from) = (to.col_as_slice_mut(j), from.col_as_slice(k));
            to.iter_mut().zip(from).for_each(|(t, f)| *t += factor * f);
        }
    }

    fn scale(&mut self, j: usize, factor: f64) {
        for part in [&mut self.v, &mut self.av] {
            part.col_as_slice_mut(j).iter_mut().for_each(|x| *x *= factor);
        }
    }
}

/// Returns an orthonormal basis `Q` of a block `W = Q R`, and `R`. Vectors are taken one after another,
/// without those shorter than `least`.
fn normalised(mut block: Block, least: f64) -> (Block, Mat<f64>) {
    let (n, width) = (block.v.nrows(), block.v.ncols());
    let mut made = Block { v: Mat::zeros(n, width), av: Mat::zeros(n, width) };
    let mut r = Mat::zeros(width, width);
    let mut kept = 0;
    for j in 0..width {
        for _ in 0..2 {
            for k in 0..kept {
                let along = dot(made.v.col_as_slice(k), block.av.col_as_slice(j));
                block.add(j, -along, &made, k);
                r[(k, j)] += along;
            }
        }
        let length = block.length(j);
        if length > least {
            block.scale(j, 1.0 / length);
            made.add(kept, 1.0, &block, j);
            r[(kept, j)] = length;
            kept += 1;
        }
    }
    made.v.truncate(n, kept);
    made.av.truncate(n, kept);
    r.truncate(kept, width);
    (made, r)
}

/// All blocks so far, and `M` projected onto their space.
struct Basis {
    blocks: Vec<Block>,
    projected: Mat<f64>,
}

/// Eigenvalues of the projected `M`, largest first, with their coefficients by columns.
struct Pairs {
    values: Vec<f64>,
    coefficients: Mat<f64>,
    /// Number of leading pairs that have converged.
    converged: usize,
}

impl Basis {
    /// Adds the image of the last block under the operator to the projection. Returns the new part of the
    /// image as an orthonormal block, and the coupling of that block to the last.
    fn extend(&mut self, mut applied: Block, metric: &Symmetric) -> (Block, Mat<f64>) {
        let before = self.projected.nrows();
        let width = applied.v.ncols();
        let mut projected = Mat::zeros(before + width, before + width);
        projected.submatrix_mut(0, 0, before, before).copy_from(&self.projected);
        let longest = applied.longest();
        let along = self.take_off(&mut applied);
        for (i, row) in (0..before + width).zip(along.row_iter()) {
            for (j, value) in (before..before + width).zip(row.iter()) {
                projected[(i, j)] = *value;
                projected[(j, i)] = *value;
            }
        }
        self.projected = projected;
        let (mut block, first) = normalised(applied, DEPENDENT * longest);
        // The rounding errors of `v` and `A v` have grown apart in a short vector, so `A v` is computed anew.
        block.av = product(metric, &block.v);
        self.take_off(&mut block);
        // A unit vector that consists of rounding loses most of its length in the second pass and is left out
        // here.
        let (block, second) = normalised(block, 0.1);
        (block, &second * &first)
    }

    /// Removes the components along all basis vectors from a block, and returns them.
    fn take_off(&self, block: &mut Block) -> Mat<f64> {
        let width = block.v.ncols();
        let mut all = Mat::zeros(self.blocks.iter().map(|b| b.v.ncols()).sum(), width);
        let mut at = 0;
        for other in &self.blocks {
            let count = other.v.ncols();
            let mut along = all.submatrix_mut(at, 0, count, width);
            matmul(along.as_mut(), Accum::Replace, other.v.transpose(), &block.av, 1.0, Par::Seq);
            matmul(&mut block.v, Accum::Add, &other.v, along.as_ref(), -1.0, Par::Seq);
            matmul(&mut block.av, Accum::Add, &other.av, along.as_ref(), -1.0, Par::Seq);
            at += count;
        }
        all
    }

    /// Solves the projected problem. The residual of a pair is `coupling` times its coefficients along the
    /// last block.
    fn pairs(&self, coupling: &Mat<f64>) -> Result<Pairs, AlgebraError> {
        let m = self.projected.nrows();
        let mut values = Diag::<f64>::zeros(m);
        let mut vectors = Mat::zeros(m, m);
        let scratch =
            self_adjoint_evd_scratch::<f64>(m, ComputeEigenvectors::Yes, Par::Seq, Default::default());
        let mut memory = zeroed(MemBuffer::new(scratch));
        let stack = MemStack::new(&mut memory);
        let failed = |_| AlgebraError::NoEigenvalues { dofs: self.blocks[0].v.nrows() };
        let to = values.as_mut();
        let all = Some(vectors.as_mut());
        self_adjoint_evd(self.projected.as_ref(), to, all, Par::Seq, stack, Default::default())
            .map_err(failed)?;
        let coefficients = vectors.reverse_cols().to_owned();
        let values: Vec<f64> = (0..m).rev().map(|k| values.column_vector()[k]).collect();
        let last = coefficients.subrows(m - coupling.ncols(), coupling.ncols());
        let left = coupling * last;
        let converged = (0..m).take_while(|&k| left.col(k).norm_l2() <= CONVERGED * values[k]).count();
        Ok(Pairs { values, coefficients, converged })
    }

    /// Expands the converged pairs to all unknowns.
    fn eigen(&self, pairs: &Pairs) -> Eigen {
        let mut vectors = Mat::zeros(self.blocks[0].v.nrows(), pairs.converged);
        let mut at = 0;
        for block in &self.blocks {
            let part = pairs.coefficients.submatrix(at, 0, block.v.ncols(), pairs.converged);
            matmul(&mut vectors, Accum::Add, &block.v, part, 1.0, Par::Seq);
            at += block.v.ncols();
        }
        let vectors = (0..pairs.converged).map(|k| vectors.col_as_slice(k).to_vec()).collect();
        Eigen { values: pairs.values[..pairs.converged].to_vec(), vectors }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Kind, analyse, eigen, factor_as};
    use super::*;

    const SIDE: usize = 9;

    /// Sum of second differences along three axes, free at the ends: a cube, with eigenvalues of multiplicity
    /// up to six. Every mass is 1.
    fn cube() -> (Symmetric, Symmetric) {
        let n = SIDE * SIDE * SIDE;
        let (mut offsets, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
        for j in 0..n {
            let mut degree = 0.0;
            for stride in [SIDE * SIDE, SIDE, 1] {
                let at = j / stride % SIDE;
                degree += f64::from(u8::from(at > 0)) + f64::from(u8::from(at + 1 < SIDE));
                if at > 0 {
                    rows.push(j - stride);
                    values.push(-1.0);
                }
            }
            rows.push(j);
            values.push(degree);
            offsets.push(rows.len());
        }
        let vertices: Vec<usize> = (0..=n).collect();
        let diagonal = |values| Symmetric {
            offsets: (0..=n).collect(),
            rows: (0..n).collect(),
            values,
            multipliers: n,
            vertices: vertices.clone(),
        };
        let mass = diagonal(vec![1.0; n]);
        (Symmetric { offsets, rows, values, multipliers: n, vertices: vertices.clone() }, mass)
    }

    const SHIFT: f64 = 0.3;

    #[test]
    fn no_eigenvalue_of_a_cube_is_lost() {
        let (stiffness, mass) = cube();
        let found = largest(&stiffness, &mass, SHIFT, 40).unwrap();
        let wave = |k: usize| 2.0 - 2.0 * (std::f64::consts::PI * k as f64 / SIDE as f64).cos();
        let mut exact: Vec<f64> = (0..SIDE * SIDE * SIDE)
            .map(|k| wave(k % SIDE) + wave(k / SIDE % SIDE) + wave(k / SIDE / SIDE))
            .collect();
        exact.sort_by(f64::total_cmp);
        assert!(found.values.len() >= 40);
        for (theta, exact) in found.values.iter().zip(&exact) {
            assert!((1.0 / theta - SHIFT - exact).abs() < 1e-11, "{} for {exact}", 1.0 / theta - SHIFT);
        }
        // Sylvester's law of inertia counts the eigenvalues below a number.
        let below = 0.5 * (exact[39] + exact[exact.partition_point(|e| *e < exact[39] + 1e-9)]);
        let shifted = stiffness.plus(&mass, -below);
        let symbolic = analyse(&shifted, 0).unwrap();
        let counted =
            factor_as(symbolic.as_ref(), &shifted, Kind::Indefinite).ok().unwrap().negative_pivots();
        assert_eq!(counted, exact.iter().filter(|e| **e < below).count());
        assert!(counted >= 40);
    }

    #[test]
    fn vectors_are_orthonormal_and_what_has_no_mass_is_left_out() {
        let (stiffness, mut mass) = cube();
        let n = mass.dim();
        (0..n).filter(|j| j % 3 == 0).for_each(|j| mass.values[j] = 0.0);
        let (found, all) = (
            largest(&stiffness, &mass, SHIFT, 20).unwrap(),
            eigen::shifted(&stiffness, &mass, SHIFT).unwrap(),
        );
        for (a, b) in found.values.iter().zip(&all.values) {
            assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
        }
        let metric = stiffness.plus(&mass, SHIFT);
        for (i, x) in found.vectors.iter().enumerate() {
            let mut ax = vec![0.0; n];
            metric.subtract_product(x, &mut ax);
            for (j, y) in found.vectors.iter().enumerate() {
                let inner = -super::super::refine::dot(y, &ax);
                assert!((inner - f64::from(u8::from(i == j))).abs() < 1e-10, "{i} {j} {inner}");
            }
        }
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bits() {
        let (stiffness, mass) = cube();
        let on = |threads: usize| -> Vec<u64> {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let found = pool.install(|| largest(&stiffness, &mass, SHIFT, 10)).unwrap();
            found.values.iter().chain(found.vectors.iter().flatten()).map(|v| v.to_bits()).collect()
        };
        let one = on(1);
        assert!(on(2) == one && on(3) == one);
    }

    /// More pairs are requested than there are: all are returned.
    #[test]
    fn a_small_matrix_has_few_eigenvalues() {
        let n = 5;
        let diagonal = |of: fn(usize) -> f64| Symmetric {
            offsets: (0..=n).collect(),
            rows: (0..n).collect(),
            values: (0..n).map(of).collect(),
            multipliers: n,
            vertices: (0..=n).collect(),
        };
        let found = largest(&diagonal(|i| i as f64), &diagonal(|_| 1.0), 1.0, 20).unwrap();
        let expected = [1.0, 1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0, 1.0 / 5.0];
        assert_eq!(found.values.len(), n);
        assert!(
            found.values.iter().zip(expected).all(|(a, b)| (a / b - 1.0).abs() < 1e-12),
            "{:?}",
            found.values
        );
    }
}
