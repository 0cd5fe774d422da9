//! Linear systems of cells that bring their own stiffness, such as hybrid elements on displacements of faces.

use algebra::{
    BlockPattern, Connectivity, DENSE_LIMIT, FactorError, Factorization, Incidence, Stiffness, Symmetric,
    factor,
};
use nalgebra::DMatrix;
use shape::{FixedDof, Matrix3, Vector3};

use crate::body::check_len;
use crate::error::SolveError;
use crate::support::prescribed;

/// Cells with the same number of nodes, and their stiffness.
pub struct Cells<'a, const N: usize> {
    /// Nodes of each cell, ascending.
    pub nodes: &'a [[u32; N]],
    /// Stiffness of each cell by degree of freedom `3 k + axis` of its `k`-th node, N/m.
    pub stiffness: &'a [DMatrix<f64>],
}

/// A factored system of cells, for any number of right-hand sides.
pub struct FactoredCells {
    stiffness: Stiffness,
    factorization: Factorization,
    /// Prescribed displacements, m; zero elsewhere.
    known: Vec<Vector3>,
    /// Free degrees of freedom `3 node + axis`, ascending.
    free: Vec<usize>,
}

/// Assembles and factors the stiffness of all cells on `node_count` nodes.
///
/// # Errors
/// Contradictory supports, motions that cost no energy, and a matrix that is too large.
pub fn factor_cells<const N: usize>(
    node_count: usize,
    cells: &Cells<N>,
    fixed: &[FixedDof],
) -> Result<FactoredCells, SolveError> {
    check_len("cell stiffness", cells.stiffness.len(), cells.nodes.len())?;
    let offsets: Vec<usize> = (0..=cells.nodes.len()).map(|cell| N * cell).collect();
    let table = Connectivity { offsets: &offsets, nodes: cells.nodes.as_flattened(), seen_by: &[] };
    let incidence = Incidence::new(node_count, table, 0..cells.nodes.len());
    let mut stiffness = Stiffness::zeros(BlockPattern::new(node_count, &[(table, &incidence)]));
    stiffness.for_each_row(|i, slot, row| {
        for &(cell, entry) in incidence.of(i) {
            let (cell, k) = (cell as usize, entry as usize % N);
            for (j, &node) in cells.nodes[cell][..=k].iter().enumerate() {
                let block: Matrix3 = cells.stiffness[cell].fixed_view::<3, 3>(3 * k, 3 * j).into_owned();
                row[slot[node as usize] as usize] += block;
            }
        }
    });
    let prescribed = prescribed(node_count, fixed)?;
    let value = |dof: usize| prescribed[dof].unwrap_or(0.0);
    let known = (0..node_count).map(|i| Vector3::from_fn(|axis, _| value(3 * i + axis))).collect();
    let free: Vec<usize> = (0..3 * node_count).filter(|&dof| prescribed[dof].is_none()).collect();
    let mut place = vec![usize::MAX; 3 * node_count];
    free.iter().enumerate().for_each(|(unknown, &dof)| place[dof] = unknown);
    let matrix = Symmetric::displacements(&stiffness, &place, free.len());
    let factorization = factor(matrix, DENSE_LIMIT).map_err(|bad| match bad {
        FactorError::NotDefinite => SolveError::NotPositiveDefinite,
        FactorError::Other(bad) => bad.into(),
    })?;
    Ok(FactoredCells { stiffness, factorization, known, free })
}

impl FactoredCells {
    /// Number of unknowns.
    pub fn dofs(&self) -> usize {
        self.free.len()
    }

    /// Solves for nodal forces (N), with supports at `factor` times their values; returns displacements, m.
    ///
    /// # Errors
    /// An answer without correct digits.
    pub fn solve(&self, forces: &[Vector3], factor: f64) -> Result<Vec<Vector3>, SolveError> {
        check_len("nodal forces", forces.len(), self.known.len())?;
        let mut u: Vec<Vector3> = self.known.iter().map(|value| value * factor).collect();
        let internal = self.stiffness.multiply(&u);
        let mut x: Vec<f64> =
            self.free.iter().map(|&dof| (forces[dof / 3] - internal[dof / 3])[dof % 3]).collect();
        self.factorization.solve_judged(&mut x)?;
        self.free.iter().zip(x).for_each(|(&dof, x)| u[dof / 3][dof % 3] = x);
        Ok(u)
    }
}
