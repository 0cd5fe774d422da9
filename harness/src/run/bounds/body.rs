//! Tetrahedra that fill the body of a method's mesh exactly.

use std::sync::Arc;

use cases::scene::Dilation;
use geometry::generate::{raise_order, to_tets};
use geometry::{CellKind, Facet, Mesh};

use crate::discretise::Discretisation;
use crate::discretise::place;
use crate::error::{Failure, Key};

/// Distance of a node from its plane or from the middle of its edge above which a face is curved, relative to
/// the diagonal of the body.
const FLAT: f64 = 1e-9;

/// Returns straight tetrahedra of second order with the vertices of a method's mesh.
///
/// # Errors
/// A mesh with curved faces, which tetrahedra fill only approximately.
pub(super) fn tetrahedra(method: &Discretisation) -> Result<Discretisation, Failure> {
    let mesh = method.mesh();
    let border = if method.has_regions() { every_face(mesh) } else { mesh.boundary() };
    let curved = border.iter().filter(|facet| !is_plane(mesh, **facet)).count();
    if curved > 0 {
        let problem = format!(
            "needs plane faces, and {curved} of {} faces of this mesh are curved, so that tetrahedra do not fill its body",
            border.len()
        );
        return Err(Failure::input(
            Key::Scene("output.bounds".into()),
            problem,
            "take a mesh with plane faces",
        ));
    }
    let tets = Arc::new(raise_order(&to_tets(mesh)));
    Ok(Discretisation::of_elements(tets, 2, false, Dilation::Standard))
}

fn every_face(mesh: &Mesh) -> Vec<Facet> {
    let of_cell = |cell: usize| {
        (0..mesh.kind(cell).faces().len()).map(move |face| Facet { cell: cell as u32, face: face as u8 })
    };
    (0..mesh.cell_count()).flat_map(of_cell).collect()
}

/// Whether the corners of a facet are in one plane and its other nodes halfway along its edges.
fn is_plane(mesh: &Mesh, facet: Facet) -> bool {
    let tolerance = FLAT * place::size(mesh);
    let at = |node: u32| mesh.points()[node as usize];
    let corners = place::corners(mesh, facet);
    let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).normalize();
    let plane = corners.iter().all(|x| (x - corners[0]).dot(&normal).abs() <= tolerance);
    let count = corners.len();
    let middles = mesh.facet_nodes(facet).skip(count);
    let straight = middles.enumerate().all(|(k, node)| {
        let middle = nalgebra::center(&corners[k], &corners[(k + 1) % count]);
        (at(node) - middle).norm() <= tolerance
    });
    plane && straight
}

/// Number of corners of the cells.
pub(super) fn vertex_count(mesh: &Mesh) -> usize {
    let corners = (0..mesh.cell_count()).flat_map(|cell| &mesh.cell(cell)[..CellKind::Tet4.node_count()]);
    let mut corners: Vec<u32> = corners.copied().collect();
    corners.sort_unstable();
    corners.dedup();
    corners.len()
}

/// Number of tetrahedra that the mesh of a method gives.
pub(crate) fn cell_count(method: &Discretisation) -> usize {
    to_tets(method.mesh()).cell_count()
}
