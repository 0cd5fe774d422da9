//! Direct solution of symmetric systems: the only module that uses faer and METIS.
//!
//! The bits of a result do not depend on the number of threads. Only large factorisations use several. Every
//! solve ends with its residual.

mod accuracy;
mod curvature;
mod dense;
pub mod eigen;
mod failure;
mod full;
mod lanczos;
mod ordering;
mod refine;
mod sparse;
mod symmetric;
mod unsymmetric;
mod workspace;

use std::sync::Arc;

use faer::MatMut;

use crate::error::AlgebraError;

pub use accuracy::Solved;
use accuracy::{BACKWARD_LIMIT, FEWEST_DIGITS, inverse_norm};
pub use curvature::Curvature;
pub use failure::FactorError;
pub use full::Cholesky;
use refine::{RESIDUAL_LIMIT, Refined, refine};
pub use sparse::Symbolic;
pub use symmetric::{Kind, Symmetric};
pub use unsymmetric::{Border, Unsymmetric};
pub use workspace::reserve_workspaces;

/// Largest number of unknowns for which the dense factorisation is used.
///
/// Measured times (dense / sparse, ms, `benches/factor.rs`): on boxes of tet4, 0.30 / 0.67 at 300 unknowns,
/// 1.45 / 1.05 at 540, 5.4 / 1.6 at 882; on rows as wide as those of a meshless cloud, 0.34 / 1.03 at 300,
/// 1.46 / 1.98 at 540, 5.4 / 4.3 at 882. The crossovers lie near 430 and 750.
pub const DENSE_LIMIT: usize = 480;

/// Relative residual up to which a step of an iteration is accepted if rounding explains the residual. The
/// iteration still gains two digits.
const STEP_LIMIT: f64 = 1e-2;
/// Ratio of pivot to diagonal entry in single precision above which a matrix is definite despite rounding of
/// about 1e-6.
const CLEAR_PIVOT: f64 = 1e-4;

/// Factorisation or iterative solver that was used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SolverPath {
    /// No system: no unknown was free.
    None,
    /// Dense Cholesky `L L^T`.
    DenseLlt,
    /// Dense `L D L^T` with static regularisation and refinement.
    DenseLdlt,
    /// Supernodal Cholesky in METIS nested-dissection order.
    SparseLlt,
    /// Supernodal `L D L^T` in METIS order, with static regularisation and refinement.
    SparseLdlt,
    /// Conjugate gradients with smoothed aggregation as preconditioner.
    Multigrid,
    /// GCR for displacements and pressures, with smoothed aggregation in the preconditioner.
    MultigridPressures,
}

impl SolverPath {
    /// Returns the name used in records.
    pub fn name(self) -> &'static str {
        match self {
            SolverPath::None => "none",
            SolverPath::DenseLlt => "dense-llt",
            SolverPath::DenseLdlt => "dense-ldlt",
            SolverPath::SparseLlt => "sparse-llt",
            SolverPath::SparseLdlt => "sparse-ldlt",
            SolverPath::Multigrid => "multigrid",
            SolverPath::MultigridPressures => "multigrid-pressures",
        }
    }
}

/// Numeric values of a factor.
pub struct Factor(Numbers);

enum Numbers {
    Empty,
    Dense(dense::Dense),
    Sparse(Box<sparse::Sparse>),
    Single(Box<sparse::Single>),
}

impl Factor {
    /// Number of negative pivots. For a saddle matrix it equals the number of multipliers if the rest is
    /// definite on their kernel (Sylvester's law of inertia).
    pub fn negative_pivots(&self) -> usize {
        match &self.0 {
            Numbers::Empty => 0,
            Numbers::Dense(factor) => factor.negative_pivots(),
            Numbers::Sparse(factor) => factor.negative_pivots(),
            Numbers::Single(factor) => factor.negative_pivots(),
        }
    }

    /// Factors `matrix` in double precision if this factor is in single precision (of a nearby matrix).
    /// Returns `None` otherwise.
    fn exact(&self, matrix: &Symmetric) -> Result<Option<Factor>, AlgebraError> {
        let Numbers::Single(factor) = &self.0 else { return Ok(None) };
        let numbers = |kind| sparse::Sparse::new(factor.symbolic().clone(), matrix, kind);
        let numbers = numbers(Kind::Definite).or_else(|_| numbers(Kind::Indefinite));
        match numbers {
            Ok(numbers) => Ok(Some(Factor(Numbers::Sparse(Box::new(numbers))))),
            Err(FactorError::Other(error)) => Err(error),
            Err(FactorError::NotDefinite) => Err(AlgebraError::ZeroPivot),
        }
    }

    /// Whether this single-precision factor proves that its matrix is definite: no pivot is near rounding.
    /// `false` for any other factor.
    pub fn is_clear(&self, matrix: &Symmetric) -> bool {
        matches!(&self.0, Numbers::Single(factor) if factor.least_pivot(matrix) > CLEAR_PIVOT)
    }

    /// Rounds a sparse factor to single precision, the form that [`factor_roughly`] returns. A dense factor
    /// stays as it is.
    pub fn rounded(self) -> Factor {
        match self.0 {
            Numbers::Sparse(factor) => Factor(Numbers::Single(Box::new((*factor).into()))),
            other => Factor(other),
        }
    }

    /// Solves in place, without refinement.
    fn solve(&self, b: &mut [f64]) -> Result<(), AlgebraError> {
        match &self.0 {
            Numbers::Empty => Ok(()),
            Numbers::Dense(factor) => {
                factor.solve(b);
                Ok(())
            }
            Numbers::Sparse(factor) => factor.solve(b),
            Numbers::Single(factor) => factor.solve(b),
        }
    }
}

/// Factored matrix for any number of right-hand sides.
pub struct Factorization {
    /// The matrix, for residuals.
    pub matrix: Symmetric,
    /// Factor of the matrix, or of a nearby matrix.
    pub factor: Arc<Factor>,
    /// Kind of matrix that the caller declared.
    pub kind: Kind,
}

/// Factors a matrix: dense up to `dense_limit` unknowns, sparse above.
///
/// # Errors
///
/// As [`analyse`] and [`factor_as`].
pub fn factor(matrix: Symmetric, dense_limit: usize) -> Result<Factorization, FactorError> {
    let kind = matrix.kind();
    let symbolic = analyse(&matrix, dense_limit)?;
    let factor = Arc::new(factor_as(symbolic.as_ref(), &matrix, kind)?);
    Ok(Factorization { matrix, factor, kind })
}

/// Returns the symbolic analysis shared by all matrices of one pattern; `None` for a dense factorisation.
///
/// # Errors
///
/// [`AlgebraError::Ordering`] if METIS fails, [`AlgebraError::TooLarge`] if the factor cannot be indexed.
pub fn analyse(matrix: &Symmetric, dense_limit: usize) -> Result<Option<Arc<Symbolic>>, AlgebraError> {
    if matrix.dim() <= dense_limit { Ok(None) } else { Ok(Some(Arc::new(Symbolic::new(matrix)?))) }
}

/// Factors a matrix that has the analysed pattern.
///
/// # Errors
///
/// [`FactorError::NotDefinite`] or [`AlgebraError::NearlySingular`] for a matrix of kind [`Kind::Definite`],
/// [`AlgebraError::ZeroPivot`] for another kind. [`AlgebraError::TooLarge`] if there is no memory.
pub fn factor_as(
    symbolic: Option<&Arc<Symbolic>>,
    matrix: &Symmetric,
    kind: Kind,
) -> Result<Factor, FactorError> {
    Ok(Factor(match symbolic {
        _ if matrix.dim() == 0 => Numbers::Empty,
        None => Numbers::Dense(dense::Dense::new(matrix, kind)?),
        Some(symbolic) => Numbers::Sparse(Box::new(sparse::Sparse::new(symbolic.clone(), matrix, kind)?)),
    }))
}

/// Factors like [`factor_as`], but in single precision, for a preconditioner: half the time and half the
/// memory.
///
/// Dense factors, which are small, and factors with multipliers stay in double precision.
///
/// # Errors
///
/// As [`factor_as`], but small pivots are accepted in single precision; see [`Factor::is_clear`].
pub fn factor_roughly(
    symbolic: Option<&Arc<Symbolic>>,
    matrix: &Symmetric,
    kind: Kind,
) -> Result<Factor, FactorError> {
    match symbolic {
        Some(symbolic) if kind != Kind::Saddle && matrix.multipliers == matrix.dim() => {
            let factor = sparse::Single::new(symbolic.clone(), matrix, kind == Kind::Definite)?;
            Ok(Factor(Numbers::Single(Box::new(factor))))
        }
        _ => factor_as(symbolic, matrix, kind),
    }
}

impl Factorization {
    /// Solves in place for a step of an outer iteration (such as Newton's), and returns the relative
    /// residual.
    ///
    /// A step must solve its own system accurately, so a large residual is refused. A residual that rounding
    /// explains may be larger: near a singular matrix a step is many times longer than its right-hand side.
    ///
    /// # Errors
    ///
    /// [`AlgebraError::Residual`] if the residual is too large.
    pub fn solve(&self, b: &mut [f64]) -> Result<f64, AlgebraError> {
        let Refined { x, rest, residual } = self.refine(b)?;
        let rounding = || self.backward_error(&Solved::new(residual, &rest, &x, b)) <= BACKWARD_LIMIT;
        if !(residual <= RESIDUAL_LIMIT || residual <= STEP_LIMIT && rounding()) {
            return Err(AlgebraError::Residual { residual, limit: RESIDUAL_LIMIT });
        }
        b.copy_from_slice(&x);
        Ok(residual)
    }

    /// Solves in place for a final answer. A large residual alone is accepted if rounding explains it; an
    /// answer without correct digits is refused.
    ///
    /// # Errors
    ///
    /// [`AlgebraError::BackwardError`] or [`AlgebraError::NoDigits`] if the answer is refused.
    pub fn solve_judged(&self, b: &mut [f64]) -> Result<Solved, AlgebraError> {
        let Refined { x, rest, residual } = self.refine(b)?;
        let solved = Solved::new(residual, &rest, &x, b);
        if !(residual <= RESIDUAL_LIMIT) {
            let backward_error = self.backward_error(&solved);
            if !(backward_error <= BACKWARD_LIMIT) {
                return Err(AlgebraError::BackwardError { backward_error, residual, limit: BACKWARD_LIMIT });
            }
            let digits = self.digits(&solved)?;
            if !(digits >= FEWEST_DIGITS) {
                return Err(AlgebraError::NoDigits { digits, backward_error });
            }
        }
        b.copy_from_slice(&x);
        Ok(solved)
    }

    /// Returns the normwise backward error of a solution.
    pub fn backward_error(&self, solved: &Solved) -> f64 {
        solved.backward_error(&self.matrix)
    }

    /// Estimates the condition number `|A| |A^-1|` from below, as a rule within a factor of three.
    ///
    /// # Errors
    ///
    /// [`AlgebraError::TooLarge`] if there is no memory for a solve.
    pub fn condition(&self) -> Result<f64, AlgebraError> {
        let n = self.dim();
        if n == 0 {
            return Ok(1.0);
        }
        // The factor of a saddle matrix belongs to a regularised matrix nearby, so its solutions are refined.
        let solve = |x: &mut [f64]| match self.kind {
            Kind::Definite => self.solve_once(x),
            _ => self.refine(x).map(|found| x.copy_from_slice(&found.x)),
        };
        Ok(self.matrix.norm() * inverse_norm(n, solve)?)
    }

    /// Estimates the correct decimal digits of the largest unknown of a solution,
    /// `-log10(condition * backward error)`.
    ///
    /// This is a bound for the worst rounding; on beams and membranes two or three more digits are right. The
    /// entries of the matrix are rounded themselves, so the backward error counts as at least half a unit in
    /// the last place.
    ///
    /// # Errors
    ///
    /// [`AlgebraError::TooLarge`] if there is no memory for a solve.
    pub fn digits(&self, solved: &Solved) -> Result<f64, AlgebraError> {
        let error = self.backward_error(solved).max(0.5 * f64::EPSILON);
        Ok(-(self.condition()? * error).log10())
    }

    fn refine(&self, b: &[f64]) -> Result<Refined, AlgebraError> {
        refine(b, |x| self.solve_once(x), |x, y| self.matrix.subtract_product(x, y))
    }

    /// Solves in place by the factor alone, without refinement or residual.
    ///
    /// # Errors
    ///
    /// [`AlgebraError::TooLarge`] if there is no memory for the solve.
    pub fn solve_once(&self, b: &mut [f64]) -> Result<(), AlgebraError> {
        self.factor.solve(b)
    }

    /// Solves for all columns, without refinement.
    fn solve_columns(&self, mut b: MatMut<f64>) -> Result<(), AlgebraError> {
        match &self.factor.0 {
            Numbers::Empty => Ok(()),
            Numbers::Sparse(factor) => factor.solve_columns(b),
            Numbers::Dense(_) | Numbers::Single(_) => (0..b.ncols()).try_for_each(|j| {
                let column = b.as_mut().col_mut(j).try_as_col_major_mut().expect("whole columns");
                self.solve_once(column.as_slice_mut())
            }),
        }
    }

    /// Number of unknowns.
    pub fn dim(&self) -> usize {
        self.matrix.dim()
    }

    /// Number of values stored in the factor.
    pub fn nonzeros(&self) -> usize {
        match &self.factor.0 {
            Numbers::Empty => 0,
            Numbers::Dense(_) => self.dim() * (self.dim() + 1) / 2,
            Numbers::Sparse(factor) => factor.nonzeros(),
            Numbers::Single(factor) => factor.nonzeros(),
        }
    }

    /// Returns the kind of factorisation that is used.
    pub fn path(&self) -> SolverPath {
        match (&self.factor.0, self.kind == Kind::Definite) {
            (Numbers::Empty, _) => SolverPath::None,
            (Numbers::Dense(_), true) => SolverPath::DenseLlt,
            (Numbers::Dense(_), false) => SolverPath::DenseLdlt,
            (Numbers::Sparse(_) | Numbers::Single(_), true) => SolverPath::SparseLlt,
            (Numbers::Sparse(_) | Numbers::Single(_), false) => SolverPath::SparseLdlt,
        }
    }
}
