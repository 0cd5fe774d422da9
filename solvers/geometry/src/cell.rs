//! Faces of cells. Node order is that of VTK and Abaqus. The corner nodes of each face are ordered so that
//! its normal, by the right-hand rule, points outwards.

use crate::element::CellKind;

/// The shapes of a cell's faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FaceKind {
    /// 3-node triangle.
    Tri3,
    /// 6-node triangle: corners, then mid-edges 01, 12, 20.
    Tri6,
    /// 4-node quadrilateral.
    Quad4,
    /// 8-node quadrilateral: corners, then mid-edges 01, 12, 23, 30.
    Quad8,
}

impl FaceKind {
    /// All kinds, in the order of the variants.
    pub const ALL: [FaceKind; 4] = [FaceKind::Tri3, FaceKind::Tri6, FaceKind::Quad4, FaceKind::Quad8];

    /// Name in messages.
    pub fn name(self) -> &'static str {
        match self {
            FaceKind::Tri3 => "tri3",
            FaceKind::Tri6 => "tri6",
            FaceKind::Quad4 => "quad4",
            FaceKind::Quad8 => "quad8",
        }
    }

    /// Number of nodes of a face of this kind.
    pub fn node_count(self) -> usize {
        match self {
            FaceKind::Tri3 => 3,
            FaceKind::Tri6 => 6,
            FaceKind::Quad4 => 4,
            FaceKind::Quad8 => 8,
        }
    }

    /// Number of corner nodes of a face of this kind: 3 or 4.
    pub fn corner_count(self) -> usize {
        if self.is_triangle() { 3 } else { 4 }
    }

    /// Whether the kind is a triangle.
    pub fn is_triangle(self) -> bool {
        matches!(self, FaceKind::Tri3 | FaceKind::Tri6)
    }

    /// Reference coordinates of the middle: on the triangle (0,0), (1,0), (0,1) or the square `[-1, 1]^2`.
    pub fn centre(self) -> [f64; 2] {
        if self.is_triangle() { [1.0 / 3.0; 2] } else { [0.0; 2] }
    }

    /// Element type of Gmsh.
    pub fn gmsh(self) -> u64 {
        match self {
            FaceKind::Tri3 => 2,
            FaceKind::Tri6 => 9,
            FaceKind::Quad4 => 3,
            FaceKind::Quad8 => 16,
        }
    }

    /// Cell type of VTK.
    pub fn vtk(self) -> u8 {
        match self {
            FaceKind::Tri3 => 5,
            FaceKind::Tri6 => 22,
            FaceKind::Quad4 => 9,
            FaceKind::Quad8 => 23,
        }
    }
}

impl CellKind {
    /// Shape of a face.
    pub fn face_kind(self, face: usize) -> FaceKind {
        let nodes = self.faces()[face].len();
        let found = FaceKind::ALL.into_iter().find(|kind| kind.node_count() == nodes);
        found.expect("faces have the nodes of a kind")
    }

    /// Local indices of a face's corners, seen counter-clockwise from outside.
    pub fn face_corners(self, face: usize) -> &'static [usize] {
        &self.faces()[face][..self.face_kind(face).corner_count()]
    }
}
