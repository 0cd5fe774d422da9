//! Structured meshes: boxes, balls, cylinders, sphere shells, ventricles and the kidney, in every cell kind.
//!
//! Each mesh is laid out as hexahedra in a parameter space and converted there to the requested cell kind
//! (tetrahedra by [`to_tets`], quadratic cells by [`raise_order`]). Only then all nodes are mapped to the
//! body by the same map. So mid-edge nodes lie on the curved body, and quadratic cells keep their order on
//! curved boundaries.

mod ball;
mod bisect;
mod boxes;
mod convert;
mod cylinder;
mod divide;
mod lattice;
mod parts;
mod shell;
pub mod surfaces;
mod ventricle;
mod wedges;

pub use ball::{Drawn, ball_mesh, half_kidney_mesh, kidney_mesh};
pub use bisect::bisect;
pub use boxes::{Jitter, box_mesh};
pub use convert::{converted, is_convertible, raise_order, tets_on_nodes, to_tets, turned};
pub use cylinder::cylinder_mesh;
pub use divide::divide;
pub use shell::{ShellExtent, sphere_shell_mesh};
pub use ventricle::{Ventricle, ventricle_mesh};

use crate::element::CellKind;
use crate::mesh::{Mesh, MeshError};
use crate::quality::InvertedElement;

/// Errors of mesh generation.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GenerateError {
    /// A number of cells that is zero or exceeds the range of 32-bit indices.
    #[error("{what} is {found}; it has to be between 1 and {most}")]
    Cells {
        /// Name of the count.
        what: &'static str,
        /// Value of the count.
        found: usize,
        /// Largest admissible value.
        most: usize,
    },
    /// A length, ratio or fraction outside its range.
    #[error("{what} is {found}; it has to be {needed}")]
    Value {
        /// Name of the parameter.
        what: &'static str,
        /// Value of the parameter.
        found: f64,
        /// Admissible range, in words.
        needed: &'static str,
    },
    /// A cell inverted by too strong jitter or grading.
    #[error(transparent)]
    Inverted(#[from] InvertedElement),
    /// A mesh that violates the invariants of [`Mesh`].
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

/// Largest number of cells along one direction, and in total. Every node index of every generator fits in 32
/// bits.
const MOST_CELLS: usize = 1 << 20;
const MOST_CELLS_IN_ALL: usize = 1 << 25;

fn check_cells(what: &'static str, found: usize) -> Result<(), GenerateError> {
    if (1..=MOST_CELLS).contains(&found) {
        Ok(())
    } else {
        Err(GenerateError::Cells { what, found, most: MOST_CELLS })
    }
}

fn check_total(cells: [usize; 3]) -> Result<(), GenerateError> {
    let found = cells.into_iter().fold(1, usize::saturating_mul);
    if found <= MOST_CELLS_IN_ALL {
        Ok(())
    } else {
        Err(GenerateError::Cells { what: "the number of cells in all", found, most: MOST_CELLS_IN_ALL })
    }
}

fn check_positive(what: &'static str, found: f64) -> Result<(), GenerateError> {
    if found > 0.0 && found.is_finite() {
        Ok(())
    } else {
        Err(GenerateError::Value { what, found, needed: "a positive number" })
    }
}

/// Converts a hex8 mesh to the requested kind, with mid-edge nodes halfway between their corners.
fn into_kind(hexes: Mesh, kind: CellKind) -> Mesh {
    converted(hexes, kind).expect("hexahedra become any kind")
}

/// Positions in [0, 1] of `cells + 1` nodes whose spacing grows geometrically; `ratio` = last / first
/// interval.
fn graded(cells: usize, ratio: f64) -> Vec<f64> {
    let growth = if cells > 1 { ratio.powf(1.0 / (cells as f64 - 1.0)) } else { 1.0 };
    if (growth - 1.0).abs() < 1e-12 {
        return (0..=cells).map(|i| i as f64 / cells as f64).collect();
    }
    let total = growth.powi(cells as i32) - 1.0;
    let mut t: Vec<f64> = (0..=cells).map(|i| (growth.powi(i as i32) - 1.0) / total).collect();
    t[cells] = 1.0;
    t
}
