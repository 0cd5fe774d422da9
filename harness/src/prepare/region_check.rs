//! Checks that every support and load of a scene touches the body, before any table is filled.

use std::collections::HashSet;

use cases::scene::Place;
use geometry::{Mesh, Point3, quadrature};

use crate::discretise::place::{Patch, tolerance};
use crate::discretise::{Discretisation, Essential, node_set, place};
use crate::error::Failure;
use crate::scenario::setup::{Applied, Foundation, Load, Setup, Support, SurfaceLoad};

/// Fails, as a run would, on the first support or load whose place is empty or names a surface that the mesh
/// does not have. A plan calls only this check: filling the tables costs a thousand times as much.
pub fn check(method: &Discretisation, setup: &Setup) -> Result<(), Failure> {
    let mesh = method.mesh();
    for load in &setup.loads {
        match &load.applied {
            Applied::Surface(SurfaceLoad::Force(_)) if node_set::alone(&load.place, mesh).is_some() => {}
            Applied::Surface(_) => drop(loaded(load, mesh)?),
            Applied::Points { .. } | Applied::Body(_) => {}
        }
    }
    for foundation in &setup.foundations {
        founded(foundation, mesh)?;
    }
    for support in &setup.supports {
        let held_somewhere = match method.essential {
            Essential::Nodal | Essential::Coupling(_) => {
                !node_set::nodes(&support.key, &support.place, mesh)?.is_empty()
            }
            _ => {
                let patch = place::patch(&support.key, &support.place, mesh)?;
                if matches!(method.essential, Essential::Nitsche(_)) {
                    place::outer(&support.key, &support.place, mesh, &patch.whole)?;
                }
                let points = node_set::points(&support.key, &support.place, mesh)?;
                !patch.whole.is_empty() || !points.is_empty() || holds_inside(method, support, &patch)
            }
        };
        if !held_somewhere {
            return Err(place::empty(&support.key, &support.place, mesh));
        }
    }
    Ok(())
}

/// Returns the faces on which a load acts.
pub(crate) fn loaded(load: &Load, mesh: &Mesh) -> Result<Patch, Failure> {
    faces(&load.key, &load.place, load.along_normal, mesh)
}

/// Returns the faces on which springs and dampers act.
pub(super) fn founded(foundation: &Foundation, mesh: &Mesh) -> Result<Patch, Failure> {
    faces(&foundation.key, &foundation.place, foundation.along_normal, mesh)
}

fn faces(key: &str, place: &Place, along_normal: bool, mesh: &Mesh) -> Result<Patch, Failure> {
    node_set::refuse(key, place, mesh)?;
    let mut patch = place::patch(key, place, mesh)?;
    // A wall between two cells may be named from both sides, but is loaded once.
    let mut seen = HashSet::new();
    patch.whole.retain(|facet| {
        let mut nodes: Vec<u32> = mesh.facet_nodes(*facet).collect();
        nodes.sort_unstable();
        seen.insert(nodes)
    });
    if patch.whole.is_empty() && patch.cut.is_empty() {
        return Err(place::empty(key, place, mesh));
    }
    if along_normal {
        place::outer(key, place, mesh, &patch.whole)?;
    }
    Ok(patch)
}

/// Whether the place contains a point at which a cloud is constrained inside its volume.
fn holds_inside(method: &Discretisation, support: &Support, patch: &Patch) -> bool {
    if !matches!(support.place, Place::Where(_)) {
        return false;
    }
    let mesh = method.mesh();
    let tolerance = tolerance(mesh);
    let inside = |x: &Point3| place::holds(&support.place, x, tolerance);
    if matches!(method.essential, Essential::Multipliers | Essential::Elimination(_)) {
        return method.nodes().iter().any(inside);
    }
    let points = method.inner;
    // With a grid, a region without cell centroids is recognised by the facets that it cuts.
    if (points.vertices && mesh.points().iter().any(inside)) || (points.grid && !patch.cut.is_empty()) {
        return true;
    }
    if points.per_cell == 0 {
        return false;
    }
    // A point count without a rule is refused when the tables are filled.
    let Some(rule) = quadrature::tet(points.per_cell) else { return true };
    (0..mesh.cell_count()).any(|cell| {
        let p: Vec<&Point3> = mesh.cell_points(cell).collect();
        let at = |xi: &[f64; 3]| p[0] + (p[1] - p[0]) * xi[0] + (p[2] - p[0]) * xi[1] + (p[3] - p[0]) * xi[2];
        rule.points.iter().any(|xi| inside(&at(xi)))
    })
}
