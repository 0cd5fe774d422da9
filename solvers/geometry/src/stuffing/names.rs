//! Transfers the groups of the surface to the boundary of the mesh.

use rayon::prelude::*;

use crate::mesh::{Facet, Mesh};
use crate::surface::Surface;
use crate::{Point3, Vector3};

/// Smallest number of facets per parallel task.
const CHUNK: usize = 64;

/// Adds each boundary facet to the groups of the surface triangle closest to its centre.
pub(super) fn named(surface: &Surface, mut mesh: Mesh) -> Mesh {
    let groups = surface.groups();
    if groups.names().is_empty() {
        return mesh;
    }
    let boundary = mesh.boundary();
    let triangle = |&facet: &Facet| {
        let corners = mesh.facet_nodes(facet).map(|node| mesh.points()[node as usize].coords);
        surface.closest(&Point3::from(corners.sum::<Vector3>() / 3.0)).1
    };
    let closest: Vec<usize> = boundary.par_iter().with_min_len(CHUNK).map(triangle).collect();
    let mut facets: Vec<Vec<Facet>> = vec![Vec::new(); groups.names().len()];
    for (facet, triangle) in boundary.into_iter().zip(closest) {
        groups.of(triangle).iter().for_each(|&group| facets[group as usize].push(facet));
    }
    for (name, facets) in groups.names().iter().zip(facets) {
        mesh = mesh.with_group(name, facets).expect("faces of the mesh itself");
    }
    mesh
}
