//! Isosurface stuffing: fills a closed surface with tetrahedra (Labelle and Shewchuk 2007).
//!
//! A body-centred lattice of cubes is laid over the surface. If the surface cuts an edge close to its end,
//! the end is moved to the cut. Tetrahedra that are still cut are replaced by their parts inside. All
//! tetrahedra along the surface have the same size, so the angles between faces are proven to lie between
//! 10.7 and 164.8 degrees. Inside, tetrahedra may be larger. Sharp edges are rounded off at the size of a
//! cell.

mod cuts;
mod edges;
mod fitted;
mod lattice;
mod measure;
mod names;
mod nodes;
mod octree;
mod parts;
mod stencil;

use rayon::prelude::*;

use crate::Point3;
use crate::element::CellKind;
use crate::generate::raise_order;
use crate::mesh::{Facet, Mesh};
use crate::surface::Surface;
use cuts::Cuts;
use lattice::Lattice;
use names::named;
use octree::{Frame, Octree};
use stencil::{Side, Tet};

pub use measure::{Fit, fit};
pub use nodes::{stuff_quadratic_with_nodes, stuff_with_nodes};

/// Mean edge length of the lattice over the edge of its cubes: each node has six edges of a full edge length
/// and eight of half a diagonal.
pub const MEAN_EDGE: f64 = (6.0 + 4.0 * 1.732_050_807_568_877_2) / 14.0;
/// Largest number of doublings: cubes inside are at most 2^3 times as large as at the surface.
pub const LARGEST: u32 = 3;
/// Smallest number of points per parallel task.
const CHUNK: usize = 64;
/// Largest estimated number of nodes.
const MOST: f64 = 2e7;

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
    pub mesh: Mesh,
    /// Number of omitted parts with fewer than eight lattice nodes inside, tips that the surface cuts off
    /// from the rest.
    pub left_out: usize,
}

/// Errors of filling a surface.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
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
}

/// Estimates the number of nodes of a tet4 mesh by [`stuff`] with cells of uniform size, from the volume
/// (m^3) and surface area (m^2) of the body. `spacing` (m) is the mean edge length.
pub fn expected_nodes(volume: f64, area: f64, spacing: f64) -> f64 {
    let edge = spacing / MEAN_EDGE;
    // Two nodes per cube, and half a layer at the surface.
    2.0 * volume / edge.powi(3) + area / edge.powi(2)
}

/// Fills a surface with linear tetrahedra, which enclose about the volume of the surface.
///
/// # Errors
/// A spacing that is not positive and finite, or too fine or too coarse for the surface.
pub fn stuff(surface: &Surface, how: Stuffing) -> Result<Stuffed, StuffingError> {
    Ok(fill(surface, how)?.linear(surface))
}

/// Fills a surface with quadratic tetrahedra, whose nodes on the boundary lie on the surface. `how.spacing` is that of
/// the corners.
///
/// # Errors
/// As for [`stuff`].
pub fn stuff_quadratic(surface: &Surface, how: Stuffing) -> Result<Stuffed, StuffingError> {
    Ok(fill(surface, how)?.quadratic(surface))
}

impl Stuffed {
    fn linear(self, surface: &Surface) -> Stuffed {
        Stuffed { mesh: fitted::linear(self.mesh, surface), ..self }
    }

    fn quadratic(self, surface: &Surface) -> Stuffed {
        Stuffed { mesh: fitted::quadratic(raise_order(&self.mesh), surface), ..self }
    }
}

/// Fills a surface with linear tetrahedra, whose corners on the boundary lie on the surface.
fn fill(surface: &Surface, how: Stuffing) -> Result<Stuffed, StuffingError> {
    let Stuffing { spacing, doublings } = how;
    if !(spacing > 0.0 && spacing.is_finite()) {
        return Err(StuffingError::Spacing { spacing });
    }
    let coarsest = doublings.min(LARGEST);
    let nodes = if coarsest == 0 { surface.volume() } else { surface.volume() / 8.0 };
    let nodes = expected_nodes(nodes, surface.area(), spacing);
    if nodes > MOST {
        return Err(StuffingError::TooFine { spacing, nodes });
    }
    let [low, high] = surface.bounds();
    let frame = Frame { origin: nalgebra::center(&low, &high), half: 0.5 * spacing / MEAN_EDGE };
    let lattice = Lattice::new(&Octree::new(surface, frame, coarsest as usize));
    let points: Vec<Point3> = lattice.points.iter().map(|&key| frame.place(key)).collect();
    let distances: Vec<f64> =
        points.par_iter().with_min_len(CHUNK).map(|p| surface.signed_distance(p)).collect();
    let Cuts { points, sides, nodes } = Cuts::new(surface, &lattice.regular, points, &distances);
    let mut tets = Vec::new();
    let apart = |a: u32, b: u32| nalgebra::distance(&points[a as usize], &points[b as usize]);
    for corners in lattice.regular {
        let tet = Tet { corners, sides: corners.map(|p| sides[p as usize]) };
        tet.inside(|a, b| nodes[&[a, b]], apart, |part| tets.push(part));
    }
    // No other tetrahedron has a corner on the surface, since they touch only larger cubes.
    let all_inside = |tet: &[u32; 4]| tet.iter().all(|&p| sides[p as usize] == Side::Inside);
    tets.extend(lattice.coarse.into_iter().filter(all_inside));
    let parts = parts::connected(&tets, &sides);
    if parts.tets.is_empty() {
        return Err(StuffingError::TooCoarse { spacing });
    }
    Ok(Stuffed { mesh: named(surface, mesh(&points, &parts)), left_out: parts.left_out })
}

/// Builds the mesh of the parts. Nodes are numbered in the order in which cells use them, and corners are
/// ordered for a positive volume.
fn mesh(points: &[Point3], parts: &parts::Parts) -> Mesh {
    let mut index = std::collections::HashMap::new();
    let (mut kept, mut nodes) = (Vec::new(), Vec::with_capacity(4 * parts.tets.len()));
    for (tet, &part) in parts.tets.iter().zip(&parts.part) {
        let [a, b, c, d] = tet.map(|p| points[p as usize]);
        let turned = (b - a).cross(&(c - a)).dot(&(d - a)) < 0.0;
        let order = if turned { [0, 2, 1, 3] } else { [0, 1, 2, 3] };
        for corner in order {
            // Nodes are separate for each part. Otherwise, parts that touch only at a node or an edge would
            // form a hinge.
            nodes.push(*index.entry((part, tet[corner])).or_insert_with(|| {
                kept.push(points[tet[corner] as usize]);
                kept.len() as u32 - 1
            }));
        }
    }
    let kinds = vec![CellKind::Tet4; parts.tets.len()];
    let mesh = Mesh::from_flat(kept, kinds, nodes).expect("tetrahedra of four nodes each");
    let boundary: Vec<Facet> = mesh.boundary();
    mesh.with_group("surface", boundary).expect("faces of the mesh itself")
}
