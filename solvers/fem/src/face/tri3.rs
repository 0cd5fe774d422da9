use super::lagrange::Face;

/// 3-node triangle, the face of a tet4: `N = (1 - x - y, x, y)`.
pub(crate) struct Tri3;

impl Face<3> for Tri3 {
    const NODES: [[f64; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];

    #[inline]
    fn shape([x, y]: [f64; 2]) -> [f64; 3] {
        [1.0 - x - y, x, y]
    }

    #[inline]
    fn shape_grad(_: [f64; 2]) -> [[f64; 2]; 3] {
        [[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]]
    }
}
