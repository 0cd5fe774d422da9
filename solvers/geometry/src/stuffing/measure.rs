//! Distance between a mesh and the surface that it fills.

use crate::mesh::Mesh;
use crate::quality;
use crate::surface::{Surface, Tree, farthest, samples, triangles_of};

/// Largest spacing of sample points on a triangle, as a fraction of the diagonal of the surface's bounding
/// box.
const APART: f64 = 1.0 / 200.0;

/// Difference between a mesh and the surface that it fills.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// Volume of the mesh, m^3.
    pub volume: f64,
    /// Volume within the surface, m^3.
    pub of_surface: f64,
    /// The largest distance of points on the mesh's boundary from the surface, m.
    pub mesh_to_surface: f64,
    /// The largest distance of points on the surface from the mesh's boundary, m.
    pub surface_to_mesh: f64,
}

impl Fit {
    /// Larger of the two distances, m: the Hausdorff distance of the sample points.
    pub fn hausdorff(&self) -> f64 {
        self.mesh_to_surface.max(self.surface_to_mesh)
    }
}

/// Measures both volumes, and the distances between the surface and the mesh's boundary in both directions.
/// Sample points are the corners, centres and grid points of the triangles of each.
pub fn fit(surface: &Surface, mesh: &Mesh) -> Fit {
    let boundary: Vec<[u32; 3]> = (mesh.boundary().iter())
        .flat_map(|&facet| {
            let nodes: Vec<u32> = mesh.facet_nodes(facet).collect();
            triangles_of(mesh.facet_kind(facet), &nodes)
        })
        .collect();
    let tree = Tree::new(mesh.points(), &boundary);
    let [low, high] = surface.bounds();
    let apart = APART * (high - low).norm();
    let of_mesh = samples(mesh.points(), &boundary, apart);
    let of_surface = samples(surface.points(), surface.triangles(), apart);
    Fit {
        volume: quality::volumes(mesh).iter().sum(),
        of_surface: surface.volume(),
        mesh_to_surface: farthest(&of_mesh, &|p| nalgebra::distance(p, &surface.closest(p).0)),
        surface_to_mesh: farthest(&of_surface, &|p| {
            tree.closest(p, f64::INFINITY).map_or(f64::INFINITY, |closest| closest.square.sqrt())
        }),
    }
}
