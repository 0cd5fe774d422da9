//! Mean displacements over parts of the surface.

use cases::scene::Place;
use geometry::Mesh;
use shape::SurfaceRows;

use super::Prepared;
use super::surfaces::cut_surface;
use crate::discretise::{node_set, place};
use crate::error::Failure;

/// Returns the scene key of a surface for means.
fn key(index: usize) -> String {
    format!("output.means[{index}]")
}

/// Refuses surfaces that the mesh does not have, before anything is solved.
///
/// # Errors
/// Returns an error for the first surface that contains nothing of the body or has an unknown name.
pub fn check_means(mesh: &Mesh, places: &[Place]) -> Result<(), Failure> {
    for (index, place) in places.iter().enumerate() {
        node_set::refuse(&key(index), place, mesh)?;
        let patch = place::patch(&key(index), place, mesh)?;
        if patch.whole.is_empty() && patch.cut.is_empty() {
            return Err(place::empty(&key(index), place, mesh));
        }
    }
    Ok(())
}

impl Prepared {
    /// Returns, for each surface, the nodal weights of its area mean displacement: the integrals of the shape
    /// functions over the surface, divided by its area. A facet cut by a comparison counts with the part
    /// inside.
    ///
    /// # Errors
    /// Returns an error if a surface has an unknown name or its shape functions cannot be evaluated.
    pub fn means(&self, places: &[Place]) -> Result<Vec<Vec<(u32, f64)>>, Failure> {
        let each = places.iter().enumerate().map(|(index, place)| {
            let patch = place::patch(&key(index), place, self.source.mesh())?;
            let mut weights = vec![0.0; self.volume.rows.rows().node_count()];
            let mut area = 0.0;
            if !patch.whole.is_empty() {
                area += add(&self.source.field_surface(&patch.whole)?, &mut weights);
            }
            if !patch.cut.is_empty() {
                area += add(&cut_surface(&*self.source, &patch.cut)?, &mut weights);
            }
            let used = (0u32..).zip(weights).filter(|(_, weight)| *weight != 0.0);
            Ok(used.map(|(node, weight)| (node, weight / area)).collect())
        });
        each.collect()
    }
}

/// Adds the integrals of the shape functions over a surface to `weights` and returns the area, m^2.
fn add(surface: &SurfaceRows, weights: &mut [f64]) -> f64 {
    for (q, w) in surface.weights().iter().enumerate() {
        let (nodes, values) = surface.rows().row(q);
        nodes.iter().zip(values).for_each(|(&node, value)| weights[node as usize] += w * value);
    }
    surface.weights().iter().sum()
}
