//! Numbers of the faces of a mesh of tetrahedra.

use geometry::{Facet, Mesh};

use super::reference::FACES;

/// Faces of a mesh of tetrahedra, in the order of their vertices. Each has three nodes of displacement, one
/// for each vertex: node `3 face + k`.
pub struct FaceNumbers {
    /// Corners of each cell, ascending.
    cells: Vec<[u32; 4]>,
    /// Corners of each face, ascending; the faces ascend too.
    faces: Vec<[u32; 3]>,
}

impl FaceNumbers {
    /// Numbers the faces.
    ///
    /// # Panics
    /// A cell with more or fewer than four corners.
    pub fn new(mesh: &Mesh) -> FaceNumbers {
        let corners = |cell: usize| {
            let mut corners: [u32; 4] = mesh.cell(cell)[..mesh.kind(cell).corner_count()]
                .try_into()
                .expect("a cell is a tetrahedron");
            corners.sort_unstable();
            corners
        };
        let cells: Vec<[u32; 4]> = (0..mesh.cell_count()).map(corners).collect();
        let mut faces: Vec<[u32; 3]> =
            cells.iter().flat_map(|cell| FACES.map(|face| face.map(|k| cell[k]))).collect();
        faces.sort_unstable();
        faces.dedup();
        FaceNumbers { cells, faces }
    }

    /// Number of cells.
    pub fn cell_count(&self) -> usize {
        self.cells.len()
    }

    /// Corners of a cell, ascending.
    pub fn corners(&self, cell: usize) -> [u32; 4] {
        self.cells[cell]
    }

    /// Corners of each face, ascending.
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    /// Number of the face of a facet of the mesh.
    pub fn of(&self, mesh: &Mesh, facet: Facet) -> usize {
        let mut corners: Vec<u32> = mesh.facet_corners(facet).collect();
        corners.sort_unstable();
        self.number(corners.try_into().expect("a facet of a tetrahedron has three corners"))
    }

    /// The twelve nodes of a cell's faces, ascending, in the order of [`super::EquilibriumTet`].
    pub fn nodes(&self, cell: usize) -> [u32; 12] {
        let numbers = FACES.map(|face| self.number(face.map(|k| self.cells[cell][k])));
        std::array::from_fn(|i| 3 * numbers[i / 3] as u32 + (i % 3) as u32)
    }

    fn number(&self, corners: [u32; 3]) -> usize {
        self.faces.binary_search(&corners).expect("a face of the mesh")
    }
}
