//! Sparse factorisation: METIS order, then faer's supernodal kernels.

use std::sync::{Arc, Mutex, MutexGuard};

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{
    LdltRef, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering, factorize_symbolic_cholesky,
    supernodal::SupernodalLltRef,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::traits::ComplexField;
use faer::{Conj, MatMut, Par, Side};

use super::failure::{FactorError, check_pivots};
use super::ordering;
use super::symmetric::{Kind, Symmetric};
use super::workspace::zeroed;
use crate::error::AlgebraError;

/// Number of multiplications above which a factorisation uses all threads; below, threads cost more than they
/// save. Threads divide the blocks of dense products and split no sum, so the bits do not change (faer 0.24;
/// a test below checks this).
const FOR_THREADS: f64 = 4e9;

/// Order and symbolic structure of a factor, shared by matrices of one pattern.
pub struct Symbolic {
    cholesky: SymbolicCholesky<usize>,
    forward: Vec<usize>,
    multiplications: f64,
    /// Value arrays of dropped factors, to be reused. With fresh memory the operating system took a tenth of
    /// the time of a load path with 4000 unknowns.
    spare: Mutex<Vec<Vec<f64>>>,
    /// The same for factors in single precision.
    spare_single: Mutex<Vec<Vec<f32>>>,
    /// Workspace of the last factorisation, kept from the second factorisation on.
    workspace: Mutex<Option<MemBuffer>>,
}

impl Symbolic {
    /// Orders a matrix by nested dissection and finds the entries of its factor.
    ///
    /// # Errors
    ///
    /// [`AlgebraError::Ordering`] if METIS fails, [`AlgebraError::TooLarge`] if the factor cannot be indexed.
    pub fn new(matrix: &Symmetric) -> Result<Symbolic, AlgebraError> {
        let n = matrix.dim();
        let (forward, inverse) = ordering::nested_dissection(matrix)?;
        let order = SymmetricOrdering::Custom(PermRef::new_checked(&forward, &inverse, n));
        let cholesky = factorize_symbolic_cholesky(pattern(matrix), Side::Upper, order, Default::default())
            .map_err(|e| too_large(n, &e))?;
        let multiplications = multiplications(&cholesky);
        Ok(Symbolic {
            cholesky,
            forward,
            multiplications,
            spare: Mutex::default(),
            spare_single: Mutex::default(),
            workspace: Mutex::default(),
        })
    }

    /// Whether the factorisation is large enough for threads.
    fn large(&self) -> bool {
        self.multiplications > FOR_THREADS
    }

    /// Cost ratio of a factorisation to a solve with the factor, in multiplications.
    pub fn solutions(&self) -> f64 {
        self.multiplications / (2.0 * self.cholesky.len_val() as f64)
    }

    fn spare(&self) -> MutexGuard<'_, Vec<Vec<f64>>> {
        locked(&self.spare)
    }

    /// Returns a workspace for `scratch`: the previous workspace if it is large enough, else a new workspace
    /// of zeros. The previous factorisation left numbers there, or data of the same kinds in the same places,
    /// so no zeros are needed.
    fn workspace(&self, scratch: StackReq) -> Result<MemBuffer, AlgebraError> {
        let kept =
            locked(&self.workspace).take().filter(|kept| kept.len() >= scratch.unaligned_bytes_required());
        match kept {
            Some(kept) => Ok(kept),
            None => {
                let memory = MemBuffer::try_new(scratch);
                Ok(zeroed(memory.map_err(|_| too_large(self.forward.len(), &"no memory for the workspace"))?))
            }
        }
    }
}

fn locked<T>(of: &Mutex<T>) -> MutexGuard<'_, T> {
    of.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

/// Number of multiplications of the numeric factorisation: `w^3/6 + w^2 r/2 + w r^2/2` for a supernode of w
/// columns with r rows below. A simplicial factor counts as 0: it needs few.
fn multiplications(cholesky: &SymbolicCholesky<usize>) -> f64 {
    let SymbolicCholeskyRaw::Supernodal(s) = cholesky.raw() else { return 0.0 };
    (0..s.n_supernodes())
        .map(|k| {
            let w = (s.supernode_end()[k] - s.supernode_begin()[k]) as f64;
            let r = s.supernode(k).pattern().len() as f64;
            w * (w * w / 6.0 + w * r / 2.0 + r * r / 2.0)
        })
        .sum()
}

fn pattern(matrix: &Symmetric) -> SymbolicSparseColMatRef<'_, usize> {
    let n = matrix.dim();
    SymbolicSparseColMatRef::new_checked(n, n, &matrix.offsets, None, &matrix.rows)
}

fn too_large(dofs: usize, why: &dyn std::fmt::Display) -> AlgebraError {
    AlgebraError::TooLarge { dofs, why: why.to_string() }
}

/// Factor `L L^T`, or `L D L^T` of a matrix that is not definite, in double precision.
pub struct Sparse {
    symbolic: Arc<Symbolic>,
    values: Vec<f64>,
    definite: bool,
}

impl Drop for Sparse {
    fn drop(&mut self) {
        self.symbolic.spare().push(std::mem::take(&mut self.values));
    }
}

impl Sparse {
    pub fn new(symbolic: Arc<Symbolic>, matrix: &Symmetric, kind: Kind) -> Result<Sparse, FactorError> {
        let n = matrix.dim();
        let cholesky = &symbolic.cholesky;
        let definite = kind == Kind::Definite;
        let mut values = symbolic.spare().pop().unwrap_or_default();
        let repeats = !values.is_empty();
        values.try_reserve_exact(cholesky.len_val()).map_err(|e| too_large(n, &e))?;
        values.resize(cholesky.len_val(), 0.0);
        let par = if symbolic.large() { Par::rayon(0) } else { Par::Seq };
        if definite {
            let a = SparseColMatRef::new(pattern(matrix), &matrix.values);
            let params = Default::default();
            let scratch = cholesky.factorize_numeric_llt_scratch::<f64>(par, params);
            let mut memory = symbolic.workspace(scratch)?;
            let stack = MemStack::new(&mut memory);
            let side = Side::Upper;
            let done =
                cholesky.factorize_numeric_llt(&mut values, a, side, Default::default(), par, stack, params);
            if repeats {
                *locked(&symbolic.workspace) = Some(memory);
            }
            if done.is_err() {
                symbolic.spare().push(values);
                return Err(FactorError::NotDefinite);
            }
            let forward = &symbolic.forward;
            check_pivots(pivots(cholesky, &values).map(|(k, l)| l * l / matrix.diagonal(forward[k])))?;
        } else {
            let regularised = (kind == Kind::Saddle).then(|| matrix.regularised());
            let a = SparseColMatRef::new(pattern(matrix), regularised.as_ref().unwrap_or(&matrix.values));
            let params = Default::default();
            let scratch = cholesky.factorize_numeric_ldlt_scratch::<f64>(par, params);
            let mut memory = symbolic.workspace(scratch)?;
            let stack = MemStack::new(&mut memory);
            let side = Side::Upper;
            let done =
                cholesky.factorize_numeric_ldlt(&mut values, a, side, Default::default(), par, stack, params);
            if repeats {
                *locked(&symbolic.workspace) = Some(memory);
            }
            done.map_err(|_| AlgebraError::ZeroPivot)?;
        }
        Ok(Sparse { symbolic, values, definite })
    }

    pub fn solve(&self, b: &mut [f64]) -> Result<(), AlgebraError> {
        let n = b.len();
        self.solve_columns(MatMut::from_column_major_slice_mut(b, n, 1))
    }

    pub fn solve_columns(&self, rhs: MatMut<f64>) -> Result<(), AlgebraError> {
        let n = rhs.nrows();
        let scratch = self.symbolic.cholesky.solve_in_place_scratch::<f64>(rhs.ncols(), Par::Seq);
        let mut memory = MemBuffer::try_new(scratch).map_err(|_| too_large(n, &"no memory for the solve"))?;
        let stack = MemStack::new(&mut memory);
        let cholesky = &self.symbolic.cholesky;
        if !self.definite {
            LdltRef::new(cholesky, &self.values).solve_in_place_with_conj(Conj::No, rhs, Par::Seq, stack);
        } else {
            LltRef::new(cholesky, &self.values).solve_in_place_with_conj(Conj::No, rhs, Par::Seq, stack);
        }
        Ok(())
    }

    pub fn negative_pivots(&self) -> usize {
        if self.definite {
            return 0;
        }
        pivots(&self.symbolic.cholesky, &self.values).filter(|p| p.1 < 0.0).count()
    }

    pub fn nonzeros(&self) -> usize {
        self.symbolic.cholesky.len_val()
    }
}

impl From<Sparse> for Single {
    fn from(factor: Sparse) -> Single {
        let mut values = locked(&factor.symbolic.spare_single).pop().unwrap_or_default();
        values.clear();
        values.extend(factor.values.iter().map(|v| *v as f32));
        Single { symbolic: factor.symbolic.clone(), values, definite: factor.definite }
    }
}

/// Factor in single precision.
pub struct Single {
    symbolic: Arc<Symbolic>,
    values: Vec<f32>,
    definite: bool,
}

impl Drop for Single {
    fn drop(&mut self) {
        locked(&self.symbolic.spare_single).push(std::mem::take(&mut self.values));
    }
}

impl Single {
    /// Computes `L L^T`, or `L D L^T` of a matrix that is not definite. The matrix must have no multipliers,
    /// because their regularisation is lost in rounding.
    pub fn new(symbolic: Arc<Symbolic>, matrix: &Symmetric, definite: bool) -> Result<Single, FactorError> {
        let n = matrix.dim();
        let cholesky = &symbolic.cholesky;
        let mut values = locked(&symbolic.spare_single).pop().unwrap_or_default();
        values.try_reserve_exact(cholesky.len_val()).map_err(|e| too_large(n, &e))?;
        values.resize(cholesky.len_val(), 0.0);
        let par = if symbolic.large() { Par::rayon(0) } else { Par::Seq };
        let rounded: Vec<f32> = matrix.values.iter().map(|v| *v as f32).collect();
        let a = SparseColMatRef::new(pattern(matrix), &rounded);
        let side = Side::Upper;
        let scratch = match definite {
            true => cholesky.factorize_numeric_llt_scratch::<f32>(par, Default::default()),
            false => cholesky.factorize_numeric_ldlt_scratch::<f32>(par, Default::default()),
        };
        let mut memory = symbolic.workspace(scratch)?;
        let stack = MemStack::new(&mut memory);
        let none = Default::default();
        let done = match definite {
            true => cholesky
                .factorize_numeric_llt(&mut values, a, side, none, par, stack, Default::default())
                .map(|_| ())
                .map_err(|_| FactorError::NotDefinite),
            false => cholesky
                .factorize_numeric_ldlt(
                    &mut values,
                    a,
                    side,
                    Default::default(),
                    par,
                    stack,
                    Default::default(),
                )
                .map(|_| ())
                .map_err(|_| FactorError::Other(AlgebraError::ZeroPivot)),
        };
        *locked(&symbolic.workspace) = Some(memory);
        let factor = Single { symbolic, values, definite };
        done.map(|_| factor)
    }

    /// Solves `A x = b` in place in single precision, with `b` scaled by its largest entry.
    pub fn solve(&self, b: &mut [f64]) -> Result<(), AlgebraError> {
        let n = b.len();
        let largest = b.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        if largest == 0.0 {
            return Ok(());
        }
        let cholesky = &self.symbolic.cholesky;
        let scratch = cholesky.solve_in_place_scratch::<f32>(1, Par::Seq);
        let mut memory = MemBuffer::try_new(scratch).map_err(|_| too_large(n, &"no memory for the solve"))?;
        let stack = MemStack::new(&mut memory);
        let mut x: Vec<f32> = b.iter().map(|v| (v / largest) as f32).collect();
        let rhs = MatMut::from_column_major_slice_mut(&mut x, n, 1);
        if self.definite {
            LltRef::new(cholesky, &self.values).solve_in_place_with_conj(Conj::No, rhs, Par::Seq, stack);
        } else {
            LdltRef::new(cholesky, &self.values).solve_in_place_with_conj(Conj::No, rhs, Par::Seq, stack);
        }
        b.iter_mut().zip(&x).for_each(|(b, x)| *b = f64::from(*x) * largest);
        Ok(())
    }

    pub fn symbolic(&self) -> &Arc<Symbolic> {
        &self.symbolic
    }

    /// Smallest ratio of a pivot of `L L^T` to the diagonal entry of its matrix; 0 for `L D L^T`.
    pub fn least_pivot(&self, matrix: &Symmetric) -> f64 {
        if !self.definite {
            return 0.0;
        }
        let forward = &self.symbolic.forward;
        let ratio = |(k, l): (usize, f32)| f64::from(l).powi(2) / matrix.diagonal(forward[k]);
        // A NaN ratio counts as 0.
        let least = |least: f64, ratio: f64| if ratio >= least { least } else { ratio.max(0.0) };
        pivots(&self.symbolic.cholesky, &self.values).map(ratio).fold(f64::INFINITY, least)
    }

    pub fn negative_pivots(&self) -> usize {
        if self.definite {
            return 0;
        }
        pivots(&self.symbolic.cholesky, &self.values).filter(|p| p.1 < 0.0).count()
    }

    pub fn nonzeros(&self) -> usize {
        self.symbolic.cholesky.len_val()
    }
}

/// Diagonal of `L` (of `D` in `L D L^T`), with positions in the elimination order.
fn pivots<'a, T: ComplexField + Copy>(
    symbolic: &'a SymbolicCholesky<usize>,
    values: &'a [T],
) -> Box<dyn Iterator<Item = (usize, T)> + 'a> {
    match symbolic.raw() {
        SymbolicCholeskyRaw::Simplicial(s) => Box::new((0..s.ncols()).map(|j| (j, values[s.col_ptr()[j]]))),
        SymbolicCholeskyRaw::Supernodal(s) => {
            let factor = SupernodalLltRef::new(s, values);
            Box::new((0..s.n_supernodes()).flat_map(move |k| {
                let node = factor.supernode(k);
                let columns = s.supernode_end()[k] - s.supernode_begin()[k];
                (0..columns).map(move |c| (node.start() + c, node.val()[(c, c)]))
            }))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Full matrix in sparse form, like that of a cloud, large enough for several threads.
    fn full(n: usize) -> Symmetric {
        let entry = |i: usize, j: usize| match i == j {
            true => n as f64,
            false => (1.3 * i as f64 + 2.7 * j as f64).sin() / (1.0 + j as f64 - i as f64),
        };
        Symmetric {
            offsets: (0..=n).map(|j| j * (j + 1) / 2).collect(),
            rows: (0..n).flat_map(|j| 0..=j).collect(),
            values: (0..n).flat_map(|j| (0..=j).map(move |i| entry(i, j))).collect(),
            multipliers: n,
            vertices: (0..=n).collect(),
        }
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bits() {
        let matrix = full(3001);
        let symbolic = Arc::new(Symbolic::new(&matrix).unwrap());
        assert!(symbolic.large());
        for kind in [Kind::Definite, Kind::Indefinite] {
            let on = |threads: usize| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                let factor = pool.install(|| Sparse::new(symbolic.clone(), &matrix, kind).ok());
                let factor = factor.expect("the matrix is definite");
                factor.values.iter().map(|v| v.to_bits()).collect::<Vec<_>>()
            };
            let one = on(1);
            for threads in [2, 3] {
                assert!(on(threads) == one, "{kind:?} on {threads} threads");
            }
        }
    }

    /// Pairs of unknowns with coupling `1 - gap`: every second pivot is `1 - (1 - gap)^2`.
    fn pairs(gap: f64) -> Symmetric {
        let count = 40;
        let offsets = |pair: usize| [3 * pair + 1, 3 * pair + 3];
        Symmetric {
            offsets: std::iter::once(0).chain((0..count).flat_map(offsets)).collect(),
            rows: (0..count).flat_map(|pair| [2 * pair, 2 * pair, 2 * pair + 1]).collect(),
            values: (0..count).flat_map(|_| [1.0, 1.0 - gap, 1.0]).collect(),
            multipliers: 2 * count,
            vertices: (0..=2 * count).collect(),
        }
    }

    #[test]
    fn a_factor_in_single_precision_knows_what_rounding_leaves_open() {
        for (gap, clear) in [(0.5, true), (1e-3, true), (1e-5, false), (1e-7, false), (-0.1, false)] {
            let matrix = pairs(gap);
            let symbolic = Some(Arc::new(Symbolic::new(&matrix).unwrap()));
            let factor = super::super::factor_roughly(symbolic.as_ref(), &matrix, Kind::Definite);
            assert_eq!(factor.is_ok_and(|factor| factor.is_clear(&matrix)), clear, "{gap}");
        }
        let matrix = pairs(0.5);
        let single = Single::new(Arc::new(Symbolic::new(&matrix).unwrap()), &matrix, true).ok().unwrap();
        assert!((single.least_pivot(&matrix) - 0.75).abs() < 1e-6);
        let indefinite = Single::new(single.symbolic().clone(), &matrix, false).ok().unwrap();
        assert_eq!(indefinite.least_pivot(&matrix), 0.0);
    }
}
