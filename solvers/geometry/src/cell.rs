//! Cell and face topology. Node order is that of VTK and Abaqus. The corner nodes of each face are ordered so
//! that its normal, by the right-hand rule, points outwards.

/// Shapes that cells of a mesh may have, in any mixture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum CellKind {
    /// 4-node tetrahedron: corners.
    Tet4,
    /// 10-node tetrahedron: corners, then mid-edges 01, 12, 20, 03, 13, 23.
    Tet10,
    /// 8-node hexahedron: bottom 0123 counter-clockwise seen from above, top 4567 above them.
    Hex8,
    /// 20-node hexahedron: corners, then mid-edges 01 12 23 30, 45 56 67 74, 04 15 26 37.
    Hex20,
}

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

const TET_EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];
const HEX_EDGES: [[usize; 2]; 12] =
    [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]];
const TET4_FACES: [&[usize]; 4] = [&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[0, 3, 2]];
const TET10_FACES: [&[usize]; 4] =
    [&[0, 2, 1, 6, 5, 4], &[0, 1, 3, 4, 8, 7], &[1, 2, 3, 5, 9, 8], &[0, 3, 2, 7, 9, 6]];
const HEX8_FACES: [&[usize]; 6] =
    [&[0, 3, 2, 1], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]];
const HEX20_FACES: [&[usize]; 6] = [
    &[0, 3, 2, 1, 11, 10, 9, 8],
    &[4, 5, 6, 7, 12, 13, 14, 15],
    &[0, 1, 5, 4, 8, 17, 12, 16],
    &[1, 2, 6, 5, 9, 18, 13, 17],
    &[2, 3, 7, 6, 10, 19, 14, 18],
    &[3, 0, 4, 7, 11, 16, 15, 19],
];

impl CellKind {
    /// All kinds, in the order tables list them.
    pub const ALL: [CellKind; 4] = [CellKind::Tet4, CellKind::Tet10, CellKind::Hex8, CellKind::Hex20];

    /// The name used in scene files and tables.
    pub fn name(self) -> &'static str {
        match self {
            CellKind::Tet4 => "tet4",
            CellKind::Tet10 => "tet10",
            CellKind::Hex8 => "hex8",
            CellKind::Hex20 => "hex20",
        }
    }

    /// Number of nodes of a cell of this kind.
    pub fn node_count(self) -> usize {
        match self {
            CellKind::Tet4 => 4,
            CellKind::Tet10 => 10,
            CellKind::Hex8 => 8,
            CellKind::Hex20 => 20,
        }
    }

    /// Number of corner nodes of a cell of this kind; they come first in the cell's node list.
    pub fn corner_count(self) -> usize {
        if self.is_tet() { 4 } else { 8 }
    }

    /// Whether the kind is tet4 or tet10.
    pub fn is_tet(self) -> bool {
        matches!(self, CellKind::Tet4 | CellKind::Tet10)
    }

    /// Polynomial order of the kind's complete basis: 1 or 2.
    pub fn order(self) -> usize {
        if matches!(self, CellKind::Tet4 | CellKind::Hex8) { 1 } else { 2 }
    }

    /// Corner pairs of the edges. The mid-edge nodes of the quadratic kinds follow this order.
    pub fn edges(self) -> &'static [[usize; 2]] {
        if self.is_tet() { &TET_EDGES } else { &HEX_EDGES }
    }

    /// Local node indices of each face, corners first, seen counter-clockwise from outside.
    pub fn faces(self) -> &'static [&'static [usize]] {
        match self {
            CellKind::Tet4 => &TET4_FACES,
            CellKind::Tet10 => &TET10_FACES,
            CellKind::Hex8 => &HEX8_FACES,
            CellKind::Hex20 => &HEX20_FACES,
        }
    }

    /// Shape of every face.
    pub fn face_kind(self) -> FaceKind {
        match self {
            CellKind::Tet4 => FaceKind::Tri3,
            CellKind::Tet10 => FaceKind::Tri6,
            CellKind::Hex8 => FaceKind::Quad4,
            CellKind::Hex20 => FaceKind::Quad8,
        }
    }
}

impl FaceKind {
    /// Number of corner nodes of a face of this kind: 3 or 4.
    pub fn corner_count(self) -> usize {
        if matches!(self, FaceKind::Tri3 | FaceKind::Tri6) { 3 } else { 4 }
    }
}
