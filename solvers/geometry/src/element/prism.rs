//! The triangle (0,0), (1,0), (0,1) between z = -1 and z = 1.

use super::entry::ReferenceCell;
use crate::quadrature;

pub(super) static PRISM: ReferenceCell = ReferenceCell {
    edges: &[[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3], [0, 3], [1, 4], [2, 5]],
    corners: 6,
    centre: [1.0 / 3.0, 1.0 / 3.0, 0.0],
    excess: |[x, y, z]| (-x).max(-y).max(x + y - 1.0).max(z.abs() - 1.0),
    abaqus_faces: &[&[0, 1, 2], &[3, 5, 4], &[0, 3, 4, 1], &[1, 4, 5, 2], &[2, 5, 3, 0]],
    vtk_either: true,
    mirrored: &[0, 2, 1, 3, 5, 4],
    rule: quadrature::prism,
    rules: "1, 6, 9, 18, 21, 48",
    per_cube: 2,
    diagonals: [1, 0, 0, 0],
    // sqrt 3 / 4, and (2 sqrt 3 / 4 + 3) over it.
    regular_volume: 0.4330127018922193,
    regular_aspect: 8.928203230275509,
    // 4/3 of the triangle's edges, and the three functions along z, which sum to at most 1.
    bulge: 7.0 / 3.0,
};
