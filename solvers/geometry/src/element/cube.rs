//! The cube `[-1, 1]^3`.

use super::entry::ReferenceCell;
use crate::quadrature::{self, Rule};

/// Largest number of Gauss points along an axis; a larger number is taken for a typing error.
const MOST_PER_AXIS: usize = 16;

/// Corners of the reference cube in VTK order, which is the node order of hex8: bottom counter-clockwise,
/// then top.
pub const HEX_CORNERS: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

pub(super) static CUBE: ReferenceCell = ReferenceCell {
    edges: &[[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]],
    corners: 8,
    centre: [0.0; 3],
    excess: |[x, y, z]| x.abs().max(y.abs()).max(z.abs()) - 1.0,
    abaqus_faces: &[&[0, 1, 2, 3], &[4, 7, 6, 5], &[0, 4, 5, 1], &[1, 5, 6, 2], &[2, 6, 7, 3], &[3, 7, 4, 0]],
    vtk_either: false,
    mirrored: &[0, 3, 2, 1, 4, 7, 6, 5],
    rule: gauss,
    rules: "1, 8, 27, ... 4096 (n along each axis, n^3 in all)",
    per_cube: 1,
    diagonals: [0; 4],
    regular_volume: 1.0,
    regular_aspect: 6.0,
    // The four functions along each axis sum to at most 1.
    bulge: 3.0,
};

/// The Gauss rule with a number of points that is a cube.
fn gauss(points: usize) -> Option<Rule<3>> {
    (1..=MOST_PER_AXIS).find(|n| n.pow(3) == points).map(quadrature::hex)
}
