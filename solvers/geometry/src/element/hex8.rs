use crate::CellKind;

use super::Element;

/// 8-node trilinear hexahedron on the cube `[-1, 1]^3`: bottom 0123 counter-clockwise seen from above, 4567
/// above.
///
/// `N_a = (1 + x x_a)(1 + y y_a)(1 + z z_a) / 8`, where `(x_a, y_a, z_a)` are the coordinates of node `a`.
pub struct Hex8;

impl Element<8> for Hex8 {
    const KIND: CellKind = CellKind::Hex8;
    const NODES: [[f64; 3]; 8] = super::HEX_CORNERS;

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
