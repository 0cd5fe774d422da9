use super::lagrange::Face;

/// 4-node quadrilateral, the face of a hex8: `N_a = (1 + x x_a)(1 + y y_a) / 4`.
pub(crate) struct Quad4;

impl Face<4> for Quad4 {
    const NODES: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

    #[inline]
    fn shape([x, y]: [f64; 2]) -> [f64; 4] {
        Self::NODES.map(|[a, b]| 0.25 * (1.0 + a * x) * (1.0 + b * y))
    }

    #[inline]
    fn shape_grad([x, y]: [f64; 2]) -> [[f64; 2]; 4] {
        Self::NODES.map(|[a, b]| [0.25 * a * (1.0 + b * y), 0.25 * b * (1.0 + a * x)])
    }
}
