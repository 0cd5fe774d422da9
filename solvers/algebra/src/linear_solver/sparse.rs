//! Sparse factorisation: METIS order, then faer's supernodal kernels.

use std::sync::{Arc, Mutex, MutexGuard};

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{
    LdltRef, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering, factorize_symbolic_cholesky,
    supernodal::SupernodalLltRef,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

use super::{FactorError, Kind, Symmetric, check_pivots, ordering, zeroed};
use crate::AlgebraError;

/// Multiplications of a factorisation from which it takes all threads: below, they cost more than they save. Threads share
/// out blocks of dense products and split no sum, so that the bits stay (faer 0.24; the test below holds it to that).
const FOR_THREADS: f64 = 4e9;

/// Order and symbolic structure of a factor: what matrices of one pattern share.
pub struct Symbolic {
    cholesky: SymbolicCholesky<usize>,
    forward: Vec<usize>,
    /// Whether the factorisation is large enough for threads.
    large: bool,
    /// Numbers of factors that are no more, to be written over: on fresh memory the system took a tenth of the time of
    /// a path with 4000 unknowns.
    spare: Mutex<Vec<Vec<f64>>>,
}

impl Symbolic {
    /// Orders a matrix by nested dissection and finds where its factor has entries.
    pub fn new(matrix: &Symmetric) -> Result<Symbolic, AlgebraError> {
        let n = matrix.dim();
        let (forward, inverse) = ordering::nested_dissection(matrix)?;
        let order = SymmetricOrdering::Custom(PermRef::new_checked(&forward, &inverse, n));
        let cholesky = factorize_symbolic_cholesky(pattern(matrix), Side::Upper, order, Default::default())
            .map_err(|e| too_large(n, &e))?;
        let large = multiplications(&cholesky) > FOR_THREADS;
        Ok(Symbolic { cholesky, forward, large, spare: Mutex::default() })
    }

    fn spare(&self) -> MutexGuard<'_, Vec<Vec<f64>>> {
        self.spare.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }
}

/// Of the numeric factorisation: `w^3/6 + w^2 r/2 + w r^2/2` for a supernode of w columns with r rows below; 0 where columns
/// stand alone, which are few.
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

/// Numbers of `L L^T`, or of `L D L^T` of a matrix that is not definite.
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
        values.try_reserve_exact(cholesky.len_val()).map_err(|e| too_large(n, &e))?;
        values.resize(cholesky.len_val(), 0.0);
        let no_memory = |_| too_large(n, &"no memory for the workspace");
        let par = if symbolic.large { Par::rayon(0) } else { Par::Seq };
        if definite {
            let a = SparseColMatRef::new(pattern(matrix), &matrix.values);
            let params = Default::default();
            let scratch = cholesky.factorize_numeric_llt_scratch::<f64>(par, params);
            let mut memory = zeroed(MemBuffer::try_new(scratch).map_err(no_memory)?);
            let stack = MemStack::new(&mut memory);
            cholesky
                .factorize_numeric_llt(&mut values, a, Side::Upper, Default::default(), par, stack, params)
                .map_err(|_| FactorError::NotDefinite)?;
            let forward = &symbolic.forward;
            check_pivots(pivots(cholesky, &values).map(|(k, l)| l * l / matrix.diagonal(forward[k])))?;
        } else {
            let regularised = (kind == Kind::Saddle).then(|| matrix.regularised());
            let a = SparseColMatRef::new(pattern(matrix), regularised.as_ref().unwrap_or(&matrix.values));
            let params = Default::default();
            let scratch = cholesky.factorize_numeric_ldlt_scratch::<f64>(par, params);
            let mut memory = zeroed(MemBuffer::try_new(scratch).map_err(no_memory)?);
            let stack = MemStack::new(&mut memory);
            cholesky
                .factorize_numeric_ldlt(&mut values, a, Side::Upper, Default::default(), par, stack, params)
                .map_err(|_| AlgebraError::ZeroPivot)?;
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

/// Diagonal of `L` (of `D` in `L D L^T`) with its place in the elimination order.
fn pivots<'a>(
    symbolic: &'a SymbolicCholesky<usize>,
    values: &'a [f64],
) -> Box<dyn Iterator<Item = (usize, f64)> + 'a> {
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

    /// A full matrix in sparse form, as a cloud's is, large enough for threads.
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
        assert!(symbolic.large);
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
}
