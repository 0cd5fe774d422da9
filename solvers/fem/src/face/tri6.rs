use super::lagrange::Face;
use super::tri3::Tri3;

/// 6-node triangle, the face of a tet10: corners `L_a (2 L_a - 1)`, mid-edges 01, 12, 20 `4 L_a L_b`.
pub(crate) struct Tri6;

impl Face<6> for Tri6 {
    const NODES: [[f64; 2]; 6] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]];

    #[inline]
    fn shape(s: [f64; 2]) -> [f64; 6] {
        let l = Tri3::shape(s);
        std::array::from_fn(|node| match node {
            0..3 => l[node] * (2.0 * l[node] - 1.0),
            _ => 4.0 * l[node - 3] * l[(node - 2) % 3],
        })
    }

    #[inline]
    fn shape_grad(s: [f64; 2]) -> [[f64; 2]; 6] {
        let l = Tri3::shape(s);
        let dl = Tri3::shape_grad(s);
        std::array::from_fn(|node| match node {
            0..3 => dl[node].map(|d| (4.0 * l[node] - 1.0) * d),
            _ => {
                let (a, b) = (node - 3, (node - 2) % 3);
                std::array::from_fn(|i| 4.0 * (l[a] * dl[b][i] + l[b] * dl[a][i]))
            }
        })
    }
}
