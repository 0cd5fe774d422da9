use crate::CellKind;

use super::Element;

/// 4-node linear tetrahedron: corners (0,0,0), (1,0,0), (0,1,0), (0,0,1).
///
/// `N = (1 - x - y - z, x, y, z)`. Gradients are constant over the cell, so one point integrates the
/// stiffness exactly. The element locks in nearly incompressible materials.
pub struct Tet4;

impl Element<4> for Tet4 {
    const KIND: CellKind = CellKind::Tet4;
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
