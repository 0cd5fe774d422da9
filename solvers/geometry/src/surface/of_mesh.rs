//! The boundary of a mesh as a surface.

use super::{Soup, Surface, SurfaceProblem};
use crate::{FaceKind, Facet, Mesh};

/// The boundary of a mesh, and which of its faces each triangle is a part of.
pub struct BoundaryFaces {
    /// The surface.
    pub surface: Surface,
    /// Face of each triangle.
    pub faces: Vec<Facet>,
}

impl BoundaryFaces {
    /// Of all faces that one cell has.
    ///
    /// # Errors
    /// A boundary that branches or crosses itself: triangles are numbered by the faces of the boundary, in metres.
    pub fn new(mesh: &Mesh) -> Result<BoundaryFaces, SurfaceProblem> {
        let boundary = mesh.boundary();
        let mut soup = Soup { points: mesh.points().to_vec(), ..Soup::default() };
        let mut faces = Vec::new();
        for (at, &facet) in boundary.iter().enumerate() {
            let nodes: Vec<u32> = mesh.facet_nodes(facet).collect();
            let kind = mesh.kind(facet.cell as usize).face_kind();
            for triangle in triangles_of(kind, &nodes) {
                soup.triangles.push(triangle);
                soup.faces.push(at as u32 + 1);
                faces.push(facet);
            }
        }
        // Nothing is left out: corners of a mesh are one or apart.
        let surface = Surface::new(soup, 1.0)?;
        debug_assert_eq!(surface.triangles().len(), faces.len());
        Ok(BoundaryFaces { surface, faces })
    }
}

/// A face cut in triangles through its nodes, which are those of its cell from outside: corners, then middles of edges.
pub fn triangles_of(kind: FaceKind, nodes: &[u32]) -> Vec<[u32; 3]> {
    let of = |list: &[[usize; 3]]| list.iter().map(|t| t.map(|local| nodes[local])).collect();
    match kind {
        FaceKind::Tri3 => of(&[[0, 1, 2]]),
        FaceKind::Tri6 => of(&[[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]]),
        // The diagonal at the lowest node, whichever cell is asked.
        FaceKind::Quad4 => match (0..4).min_by_key(|&i| nodes[i]) {
            Some(0 | 2) => of(&[[0, 1, 2], [0, 2, 3]]),
            _ => of(&[[0, 1, 3], [1, 2, 3]]),
        },
        FaceKind::Quad8 => of(&[[0, 4, 7], [4, 1, 5], [5, 2, 6], [6, 3, 7], [4, 5, 7], [5, 6, 7]]),
    }
}
