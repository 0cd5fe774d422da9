use catalogue::element as listed;

use super::entry::{Element, Entry, FileCodes, Points, in_order};
use super::tetrahedron::TETRAHEDRON;

/// 4-node linear tetrahedron: corners (0,0,0), (1,0,0), (0,1,0), (0,0,1).
///
/// `N = (1 - x - y - z, x, y, z)`. Gradients are constant over the cell, so one point integrates the
/// stiffness exactly. The element locks in nearly incompressible materials.
pub struct Tet4;

impl Element<4> for Tet4 {
    const ENTRY: Entry = Entry {
        listed: &listed::TET4,
        cell: &TETRAHEDRON,
        nodes: &Self::NODES,
        faces: &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[0, 3, 2]],
        points: Points { full: 1, reduced: None, fine: 14, volume: 1 },
        files: FileCodes {
            gmsh: 4,
            gmsh_order: &in_order::<4>(),
            abaqus: "C3D4",
            abaqus_order: &in_order::<4>(),
            vtk: 10,
            vtk_order: &in_order::<4>(),
        },
    };
    const NODES: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    #[inline]
    fn shape([x, y, z]: [f64; 3]) -> [f64; 4] {
        [1.0 - x - y - z, x, y, z]
    }

    #[inline]
    fn shape_grad(_: [f64; 3]) -> [[f64; 3]; 4] {
        [[-1.0, -1.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    }
}
