//! Families of methods over a mesh, as scenes name them.

use std::sync::Arc;

use catalogue::{Entry, Problem, Values};
use geometry::{CellKind, Mesh};

use crate::{RowSource, SourceError};

/// A family that scenes name by `family = NAME`, with its parameters beside it.
pub type FamilyEntry = Entry<fn(&Values) -> Result<MeshFamily, Problem>>;

/// Makes the source of a family's tables over a mesh.
pub type OverMesh = Arc<dyn Fn(Arc<Mesh>) -> Result<Box<dyn RowSource>, SourceError> + Send + Sync>;

/// A family of methods whose nodes are the vertices of a mesh, with its parameters.
#[derive(Clone)]
pub struct MeshFamily {
    /// Cells that it takes.
    pub cells: CellKind,
    /// Whether its basis is Kronecker: nodal parameters are displacements. Where they are not, essential conditions are enforced
    /// by penalty.
    pub interpolates: bool,
    /// How its shape functions are made and where they are evaluated, for plans.
    pub shape_functions: String,
    /// The source of its tables.
    pub over: OverMesh,
}
