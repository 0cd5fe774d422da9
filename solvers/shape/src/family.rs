//! Families of methods over a mesh, as named in scenes.

use std::sync::Arc;

use catalogue::{Entry, Problem, Values};
use geometry::{CellKind, Mesh};

use crate::{RowSource, SourceError};

/// Catalogue entry of a family that scenes select by `family = NAME`, with its parameters.
pub type FamilyEntry = Entry<fn(&Values) -> Result<MeshFamily, Problem>>;

/// Function that builds the source of a family's tables over a mesh.
pub type OverMesh = Arc<dyn Fn(Arc<Mesh>) -> Result<Box<dyn RowSource>, SourceError> + Send + Sync>;

/// A family of methods over a mesh, with the parameters of a scene. Its nodes are those of the mesh.
#[derive(Clone)]
pub struct MeshFamily {
    /// Cell kind that the family uses.
    pub cells: CellKind,
    /// Whether the basis has the Kronecker property, so that nodal parameters are displacements. Otherwise
    /// essential conditions are enforced by penalty.
    pub interpolates: bool,
    /// Description of the shape functions and their evaluation points, for the plan of a run.
    pub shape_functions: String,
    /// Builds the source of the family's tables.
    pub over: OverMesh,
}
