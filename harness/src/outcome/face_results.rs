//! Forces on the supports and mean displacements of the faces at the end of a run.

use geometry::Vector3;
use shape::Resultant;

/// Support of the scene and its force on the body.
#[derive(Clone, Debug, PartialEq)]
pub struct SupportForce {
    /// Name of the region in the scene.
    pub name: String,
    /// Constrained components: x, y, z.
    pub axes: [bool; 3],
    /// Force on the body, N, and its moment.
    pub resultant: Resultant,
}

/// Face of the body and its mean displacement.
#[derive(Clone, Debug, PartialEq)]
pub struct FaceMean {
    /// Name of the region in the scene.
    pub name: String,
    /// Area-weighted mean displacement, m.
    pub u: Vector3,
}
