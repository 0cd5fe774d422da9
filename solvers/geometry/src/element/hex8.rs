use catalogue::element as listed;

use super::cube::{CUBE, HEX_CORNERS};
use super::entry::{Element, Entry, FileCodes, Points, in_order};

/// 8-node trilinear hexahedron on the cube `[-1, 1]^3`: bottom 0123 counter-clockwise seen from above, 4567
/// above.
///
/// `N_a = (1 + x x_a)(1 + y y_a)(1 + z z_a) / 8`, where `(x_a, y_a, z_a)` are the coordinates of node `a`.
pub struct Hex8;

impl Element<8> for Hex8 {
    const ENTRY: Entry = Entry {
        listed: &listed::HEX8,
        cell: &CUBE,
        nodes: &Self::NODES,
        faces: &[&[0, 3, 2, 1], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]],
        points: Points { full: 8, reduced: Some((1, "1")), fine: 27, volume: 8 },
        files: FileCodes {
            gmsh: 5,
            gmsh_order: &in_order::<8>(),
            abaqus: "C3D8",
            abaqus_order: &in_order::<8>(),
            vtk: 12,
            vtk_order: &in_order::<8>(),
        },
    };
    const NODES: [[f64; 3]; 8] = HEX_CORNERS;

    #[inline]
    fn shape([x, y, z]: [f64; 3]) -> [f64; 8] {
        Self::NODES.map(|[a, b, c]| 0.125 * (1.0 + a * x) * (1.0 + b * y) * (1.0 + c * z))
    }

    #[inline]
    fn shape_grad([x, y, z]: [f64; 3]) -> [[f64; 3]; 8] {
        Self::NODES.map(|[a, b, c]| {
            let (fx, fy, fz) = (1.0 + a * x, 1.0 + b * y, 1.0 + c * z);
            [0.125 * a * fy * fz, 0.125 * b * fx * fz, 0.125 * c * fx * fy]
        })
    }
}
