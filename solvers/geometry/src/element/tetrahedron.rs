//! The tetrahedron (0,0,0), (1,0,0), (0,1,0), (0,0,1).

use super::entry::ReferenceCell;
use crate::quadrature;

pub(super) static TETRAHEDRON: ReferenceCell = ReferenceCell {
    edges: &[[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]],
    corners: 4,
    centre: [0.25; 3],
    excess: |[x, y, z]| (-x).max(-y).max(-z).max(x + y + z - 1.0),
    abaqus_faces: &[&[0, 1, 2], &[0, 3, 1], &[1, 3, 2], &[2, 3, 0]],
    vtk_either: false,
    mirrored: &[0, 2, 1, 3],
    rule: quadrature::tet,
    rules: "1, 4, 8, 14, 15, 24, 35, 46",
    per_cube: 6,
    diagonals: [1; 4],
    // 1 / (6 sqrt 2) and 6 sqrt 6.
    regular_volume: 0.1178511301977579,
    regular_aspect: 14.696938456699067,
    // 4 sum L_a L_b = 2 (1 - sum L_a^2) at the centre.
    bulge: 1.5,
};
