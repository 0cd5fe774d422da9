//! Sparse factorisation: METIS order, then faer's supernodal kernels.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{
    LdltRef, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering, factorize_symbolic_cholesky,
    supernodal::SupernodalLltRef,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

use super::{FactorError, Symmetric, check_pivots, ordering};
use crate::SolveError;

/// Symbolic structure and numbers of `L L^T`, or of `L D L^T` of a saddle matrix.
pub(super) struct Sparse {
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
    saddle: bool,
}

impl Sparse {
    pub fn new(matrix: &Symmetric) -> Result<Sparse, FactorError> {
        let n = matrix.dim();
        let too_large = |why: &dyn std::fmt::Display| SolveError::TooLarge { dofs: n, why: why.to_string() };
        let (forward, inverse) = ordering::nested_dissection(matrix)?;
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, &matrix.offsets, None, &matrix.rows);
        let order = SymmetricOrdering::Custom(PermRef::new_checked(&forward, &inverse, n));
        let symbolic = factorize_symbolic_cholesky(pattern, Side::Upper, order, Default::default())
            .map_err(|e| too_large(&e))?;
        let saddle = matrix.is_saddle();
        let mut values = Vec::new();
        values.try_reserve_exact(symbolic.len_val()).map_err(|e| too_large(&e))?;
        values.resize(symbolic.len_val(), 0.0);
        let par = Par::Seq;
        if saddle {
            let regularised = matrix.regularised();
            let a = SparseColMatRef::new(pattern, &regularised);
            let params = Default::default();
            let scratch = symbolic.factorize_numeric_ldlt_scratch::<f64>(par, params);
            let mut memory =
                MemBuffer::try_new(scratch).map_err(|_| too_large(&"no memory for the workspace"))?;
            let stack = MemStack::new(&mut memory);
            symbolic
                .factorize_numeric_ldlt(&mut values, a, Side::Upper, Default::default(), par, stack, params)
                .map_err(|_| SolveError::ZeroPivot)?;
        } else {
            let a = SparseColMatRef::new(pattern, &matrix.values);
            let params = Default::default();
            let scratch = symbolic.factorize_numeric_llt_scratch::<f64>(par, params);
            let mut memory =
                MemBuffer::try_new(scratch).map_err(|_| too_large(&"no memory for the workspace"))?;
            let stack = MemStack::new(&mut memory);
            symbolic
                .factorize_numeric_llt(&mut values, a, Side::Upper, Default::default(), par, stack, params)
                .map_err(|_| FactorError::NotDefinite)?;
            check_pivots(pivots(&symbolic, &values).map(|(k, l)| l * l / matrix.diagonal(forward[k])))?;
        }
        Ok(Sparse { symbolic, values, saddle })
    }

    pub fn solve(&self, b: &mut [f64]) -> Result<(), SolveError> {
        let n = b.len();
        let scratch = self.symbolic.solve_in_place_scratch::<f64>(1, Par::Seq);
        let mut memory = MemBuffer::try_new(scratch)
            .map_err(|_| SolveError::TooLarge { dofs: n, why: "no memory for the solve".into() })?;
        let stack = MemStack::new(&mut memory);
        let rhs = MatMut::from_column_major_slice_mut(b, n, 1);
        if self.saddle {
            LdltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
                Conj::No,
                rhs,
                Par::Seq,
                stack,
            );
        } else {
            LltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
                Conj::No,
                rhs,
                Par::Seq,
                stack,
            );
        }
        Ok(())
    }

    pub fn nonzeros(&self) -> usize {
        self.symbolic.len_val()
    }
}

/// Diagonal of `L` with its place in the elimination order.
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
