//! Linear algebra of solid mechanics: symmetric matrices of 3x3 blocks and their solvers.
//!
//! A [`BlockPattern`] lists the pairs of nodes that share a row of a table. A [`Stiffness`] stores their
//! blocks and is assembled row by row. A [`Symmetric`] is the part of a stiffness over the unknowns.
//! [`factor`] turns it into a [`Factorization`]: dense, or sparse with faer's kernels in METIS
//! nested-dissection order. [`Multigrid`] solves iteratively with a stiffness. [`Unsymmetric`] adds a few
//! unsymmetric entries and borders; it solves by GMRES or, failing that, by LU. [`eigen`] solves
//! eigenproblems. [`Cholesky`] factors full matrices for many right-hand sides.
//!
//! ```
//! use tissuebench_algebra::{DENSE_LIMIT, FactorError, Symmetric, factor};
//! // [4 1; 1 3] by its upper triangle.
//! let matrix = Symmetric {
//!     offsets: vec![0, 1, 3],
//!     rows: vec![0, 0, 1],
//!     values: vec![4.0, 1.0, 3.0],
//!     multipliers: 2,
//!     vertices: vec![0, 2],
//! };
//! let factored = factor(matrix, DENSE_LIMIT)?;
//! let mut x = [6.0, 7.0];
//! let residual = factored.solve(&mut x)?;
//! assert!((x[0] - 1.0).abs() + (x[1] - 2.0).abs() < 1e-15 && residual < 1e-15);
//! assert_eq!(factored.path().name(), "dense-llt");
//! # Ok::<(), FactorError>(())
//! ```

mod error;
mod linear_solver;
mod multigrid;
mod nonnegative;
mod pattern;
mod row_parts;
mod stiffness;
mod vectors;

pub use error::AlgebraError;
pub use linear_solver::eigen;
pub use linear_solver::{
    Border, Cholesky, Curvature, DENSE_LIMIT, Factor, FactorError, Factorization, Kind, Solved, SolverPath,
    Symbolic, Symmetric, Unsymmetric, analyse, factor, factor_as, factor_roughly, reserve_workspaces,
};
pub use multigrid::{Iterations, Multigrid, PressureGroup, TangentLevels};
pub use nonnegative::nonnegative_weights;
pub use pattern::{BlockPattern, Connectivity, Incidence};
pub use stiffness::Stiffness;
