//! Closed surfaces of treated triangles.

use super::Surface;
use super::change::Change;

/// A closed surface, and what was done to get it.
pub struct Treated {
    /// The closed surface.
    pub surface: Surface,
    /// Changes of the triangles.
    pub changes: Vec<Change>,
    /// Distances of a wrap from the given triangles.
    pub gaps: Option<Gaps>,
}

/// Distances between a wrap and the given triangles, at sample points of both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gaps {
    /// The largest distance of points on the wrap from the triangles, m: across holes.
    pub from_wrap: f64,
    /// The largest distance of points on the triangles from the wrap, m: details that are lost.
    pub from_triangles: f64,
}
