//! Isosurface stuffing: fills a closed surface with tetrahedra (Labelle and Shewchuk 2007).
//!
//! A body-centred lattice of cubes is laid over the surface. If the surface cuts an edge close to its end,
//! the end is moved to the cut. Tetrahedra that are still cut are replaced by their parts inside. All
//! tetrahedra along the surface have the same size, so the angles between faces are proven to lie between
//! 10.7 and 164.8 degrees. Inside, tetrahedra may be larger. Nodes then move to sharp edges as far as
//! these angles allow. Walls between regions are cut in the same way, with the same angles.

mod cuts;
mod edges;
mod fill;
mod fitted;
mod lattice;
mod measure;
mod names;
mod nodes;
mod octree;
mod parts;
mod sharp;
mod stencil;
mod walls;

use crate::mesh::Mesh;

pub use fill::{stuff, stuff_quadratic};
pub use fitted::fitted;
pub use measure::{Fit, fit};
pub use nodes::{stuff_quadratic_with_nodes, stuff_with_nodes};

/// Mean edge length of the lattice over the edge of its cubes: each node has six edges of a full edge length
/// and eight of half a diagonal.
pub const MEAN_EDGE: f64 = (6.0 + 4.0 * 1.732_050_807_568_877_2) / 14.0;
/// Largest number of doublings: cubes inside are at most 2^3 times as large as at the surface.
pub const LARGEST: u32 = 3;

/// Parameters of [`stuff`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stuffing {
    /// Mean edge length at the surface, m.
    pub spacing: f64,
    /// Largest number of doublings of the cell size towards the inside; 0 gives cells of one size. Numbers
    /// above [`LARGEST`] count as [`LARGEST`].
    pub doublings: u32,
}

/// Tetrahedra inside a surface.
#[derive(Clone, Debug)]
pub struct Stuffed {
    /// The mesh, with its boundary as the group "surface". Groups of the surface become facet groups, and one
    /// named "surface" replaces the boundary. A group much smaller than the cells may have no facets.
    /// Regions of the surface become regions of the mesh.
    pub mesh: Mesh,
    /// Number of omitted parts with fewer than eight lattice nodes inside, tips that the surface cuts off
    /// from the rest.
    pub left_out: usize,
}

/// Errors of filling a surface.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StuffingError {
    /// A spacing that is not positive and finite.
    #[error("the spacing is {spacing} m; it has to be positive and finite")]
    Spacing {
        /// Spacing, m.
        spacing: f64,
    },
    /// Too many nodes.
    #[error("a spacing of {spacing} m gives about {nodes:.1e} nodes, which is too many")]
    TooFine {
        /// Spacing, m.
        spacing: f64,
        /// Estimated number of nodes.
        nodes: f64,
    },
    /// Cells larger than the thickness of the body.
    #[error("a spacing of {spacing} m is too large for the surface: no part of the mesh has eight nodes")]
    TooCoarse {
        /// Spacing, m.
        spacing: f64,
    },
    /// Cells larger than a region.
    #[error("a spacing of {spacing} m is too large for the region '{region}': it gets no cell")]
    RegionTooSmall {
        /// Name of the region.
        region: String,
        /// Spacing, m.
        spacing: f64,
    },
}

/// Estimates the number of nodes of a tet4 mesh by [`stuff`] with cells of uniform size, from the volume
/// (m^3) and surface area (m^2) of the body. `spacing` (m) is the mean edge length.
pub fn expected_nodes(volume: f64, area: f64, spacing: f64) -> f64 {
    let edge = spacing / MEAN_EDGE;
    // Two nodes per cube, and half a layer at the surface.
    2.0 * volume / edge.powi(3) + area / edge.powi(2)
}
