//! The boundary of a mesh as a surface.

use super::Surface;
use super::error::SurfaceProblem;
use super::soup::Soup;
use crate::cell::FaceKind;
use crate::mesh::{Facet, Mesh};

/// The boundary of a mesh as a surface, with the mesh face of each triangle.
pub struct BoundaryFaces {
    /// The boundary as a closed surface of triangles, with positions in metres.
    pub surface: Surface,
    /// Face of the mesh to which each triangle belongs.
    pub faces: Vec<Facet>,
}

impl BoundaryFaces {
    /// Builds the surface from the faces that belong to only one cell, each divided into triangles through
    /// its nodes.
    ///
    /// # Errors
    /// A boundary that branches or crosses itself. The error counts the faces of the boundary from 1 and has
    /// positions in metres.
    pub fn new(mesh: &Mesh) -> Result<BoundaryFaces, SurfaceProblem> {
        let boundary = mesh.boundary();
        let mut soup = Soup { points: mesh.points().to_vec(), ..Soup::default() };
        let mut faces = Vec::new();
        for (at, &facet) in boundary.iter().enumerate() {
            let nodes: Vec<u32> = mesh.facet_nodes(facet).collect();
            let kind = mesh.facet_kind(facet);
            for triangle in triangles_of(kind, &nodes) {
                soup.triangles.push(triangle);
                soup.faces.push(at as u32 + 1);
                faces.push(facet);
            }
        }
        // No triangle is dropped, because nodes of a mesh are identical or distinct.
        let surface = Surface::new(soup, 1.0)?;
        debug_assert_eq!(surface.triangles().len(), faces.len());
        Ok(BoundaryFaces { surface, faces })
    }
}

/// Divides a face into triangles through its nodes. The nodes are in the order of the cell as seen from
/// outside: corners, then mid-edge nodes.
pub fn triangles_of(kind: FaceKind, nodes: &[u32]) -> Vec<[u32; 3]> {
    let of = |list: &[[usize; 3]]| list.iter().map(|t| t.map(|local| nodes[local])).collect();
    match kind {
        FaceKind::Tri3 => of(&[[0, 1, 2]]),
        FaceKind::Tri6 => of(&[[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]]),
        // The diagonal starts at the lowest node, which is independent of the cell.
        FaceKind::Quad4 => match (0..4).min_by_key(|&i| nodes[i]) {
            Some(0 | 2) => of(&[[0, 1, 2], [0, 2, 3]]),
            _ => of(&[[0, 1, 3], [1, 2, 3]]),
        },
        FaceKind::Quad8 => of(&[[0, 4, 7], [4, 1, 5], [5, 2, 6], [6, 3, 7], [4, 5, 7], [5, 6, 7]]),
    }
}
