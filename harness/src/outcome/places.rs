//! What the supports and faces of a scene come to at the end of a run.

use geometry::Vector3;

/// A support, and the force with which it holds the body.
#[derive(Clone, Debug, PartialEq)]
pub struct SupportForce {
    /// Where it is, in the words of the scene.
    pub name: String,
    /// Which of x, y, z it holds.
    pub axes: [bool; 3],
    /// On the body, N.
    pub force: Vector3,
}

/// A face, and how far it moves on average.
#[derive(Clone, Debug, PartialEq)]
pub struct FaceMean {
    /// Where it is, in the words of the scene.
    pub name: String,
    /// Mean displacement by area, m.
    pub u: Vector3,
}
