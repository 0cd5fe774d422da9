use super::lagrange::Face;

/// 8-node serendipity quadrilateral, the face of a hex20: corners, then mid-edges 01, 12, 23, 30.
///
/// Corners `(1 + X)(1 + Y)(X + Y - 1) / 4` with `X = x x_a`; mid-edges `(1 - x^2)(1 + Y) / 2` and alike.
pub(crate) struct Quad8;

impl Face<8> for Quad8 {
    const NODES: [[f64; 2]; 8] = [
        [-1.0, -1.0],
        [1.0, -1.0],
        [1.0, 1.0],
        [-1.0, 1.0],
        [0.0, -1.0],
        [1.0, 0.0],
        [0.0, 1.0],
        [-1.0, 0.0],
    ];

    #[inline]
    fn shape([x, y]: [f64; 2]) -> [f64; 8] {
        Self::NODES.map(|[a, b]| {
            if a == 0.0 {
                0.5 * (1.0 - x * x) * (1.0 + b * y)
            } else if b == 0.0 {
                0.5 * (1.0 + a * x) * (1.0 - y * y)
            } else {
                0.25 * (1.0 + a * x) * (1.0 + b * y) * (a * x + b * y - 1.0)
            }
        })
    }

    #[inline]
    fn shape_grad([x, y]: [f64; 2]) -> [[f64; 2]; 8] {
        Self::NODES.map(|[a, b]| {
            if a == 0.0 {
                [-x * (1.0 + b * y), 0.5 * b * (1.0 - x * x)]
            } else if b == 0.0 {
                [0.5 * a * (1.0 - y * y), -y * (1.0 + a * x)]
            } else {
                let (fx, fy) = (1.0 + a * x, 1.0 + b * y);
                [0.25 * a * fy * (2.0 * a * x + b * y), 0.25 * b * fx * (a * x + 2.0 * b * y)]
            }
        })
    }
}
