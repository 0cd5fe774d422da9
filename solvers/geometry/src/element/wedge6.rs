use catalogue::element as listed;

use super::entry::{Element, Entry, FileCodes, Points, in_order};
use super::prism::PRISM;

/// 6-node wedge on the triangle (0,0), (1,0), (0,1) between z = -1 and z = 1: bottom 012 counter-clockwise
/// seen from above, 345 above.
///
/// `N_a = L_a (1 + z z_a) / 2` with the barycentric coordinates `L` of the triangle. Source: Zienkiewicz &
/// Taylor, The Finite Element Method, vol. 1 (triangular prism elements).
pub struct Wedge6;

impl Element<6> for Wedge6 {
    const ENTRY: Entry = Entry {
        listed: &listed::WEDGE6,
        cell: &PRISM,
        nodes: &Self::NODES,
        faces: &[&[0, 2, 1], &[3, 4, 5], &[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]],
        points: Points { full: 6, reduced: None, fine: 18, volume: 6 },
        files: FileCodes {
            gmsh: 6,
            gmsh_order: &in_order::<6>(),
            abaqus: "C3D6",
            abaqus_order: &in_order::<6>(),
            vtk: 13,
            // The normal of the first triangle points away from the second (VTK, class vtkWedge).
            vtk_order: &[0, 2, 1, 3, 5, 4],
        },
    };
    const NODES: [[f64; 3]; 6] = [
        [0.0, 0.0, -1.0],
        [1.0, 0.0, -1.0],
        [0.0, 1.0, -1.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 1.0],
        [0.0, 1.0, 1.0],
    ];

    #[inline]
    fn shape([x, y, z]: [f64; 3]) -> [f64; 6] {
        let l = [1.0 - x - y, x, y];
        let below = 0.5 * (1.0 - z);
        let above = 0.5 * (1.0 + z);
        [l[0] * below, l[1] * below, l[2] * below, l[0] * above, l[1] * above, l[2] * above]
    }

    #[inline]
    fn shape_grad([x, y, z]: [f64; 3]) -> [[f64; 3]; 6] {
        let l = [1.0 - x - y, x, y];
        std::array::from_fn(|a| {
            let k = a % 3;
            let side = if a < 3 { -1.0 } else { 1.0 };
            let height = 0.5 * (1.0 + side * z);
            [SLOPES[k][0] * height, SLOPES[k][1] * height, 0.5 * side * l[k]]
        })
    }
}

/// Gradients of the triangle's barycentric coordinates.
pub(super) const SLOPES: [[f64; 2]; 3] = [[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]];
