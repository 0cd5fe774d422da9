//! The elements: one file each. A new one is a file, a line in `with_element` and a kind in `geometry`.

mod hex20;
mod hex8;
mod tet10;
mod tet4;

pub use hex8::Hex8;
pub use hex20::Hex20;
pub use tet4::Tet4;
pub use tet10::Tet10;

use geometry::CellKind;

/// A Lagrange element of `N` nodes on its reference cell: the tetrahedron (0,0,0), (1,0,0), (0,1,0), (0,0,1) or
/// the cube `[-1, 1]^3`. The same functions map the reference cell to space: `x(xi) = sum_a N_a(xi) x_a`.
pub trait Element<const N: usize> {
    /// The mesh cell it belongs to; node order is that of the kind.
    const KIND: CellKind;
    /// Reference coordinates of the nodes, (N, 3).
    const NODES: [[f64; 3]; N];

    /// Shape functions at `xi`, (N), dimensionless.
    fn shape(xi: [f64; 3]) -> [f64; N];

    /// Their gradients by `xi`, (N, 3), dimensionless.
    fn shape_grad(xi: [f64; 3]) -> [[f64; 3]; N];
}

/// Runs `$body` with `$E` the element type of a cell kind and `$N` its number of nodes.
macro_rules! with_element {
    ($kind:expr, $E:ident, $N:ident => $body:expr) => {
        match $kind {
            geometry::CellKind::Tet4 => with_element!(@ $crate::element::Tet4, 4, $E, $N, $body),
            geometry::CellKind::Tet10 => with_element!(@ $crate::element::Tet10, 10, $E, $N, $body),
            geometry::CellKind::Hex8 => with_element!(@ $crate::element::Hex8, 8, $E, $N, $body),
            geometry::CellKind::Hex20 => with_element!(@ $crate::element::Hex20, 20, $E, $N, $body),
        }
    };
    (@ $type:ty, $count:literal, $E:ident, $N:ident, $body:expr) => {{
        #[allow(dead_code)]
        type $E = $type;
        #[allow(dead_code)]
        const $N: usize = $count;
        $body
    }};
}
pub(crate) use with_element;

/// How far `xi` lies outside the reference cell of a kind, in reference units; negative inside.
pub(crate) fn excess(kind: CellKind, xi: [f64; 3]) -> f64 {
    let [x, y, z] = xi;
    if kind.is_tet() {
        (-x).max(-y).max(-z).max(x + y + z - 1.0)
    } else {
        x.abs().max(y.abs()).max(z.abs()) - 1.0
    }
}

/// Reference coordinates of the cell's middle.
pub(crate) fn centre(kind: CellKind) -> [f64; 3] {
    if kind.is_tet() { [0.25; 3] } else { [0.0; 3] }
}

/// Reference coordinates of all nodes of a kind, in its node order.
pub(crate) fn nodes(kind: CellKind) -> &'static [[f64; 3]] {
    with_element!(kind, E, N => {
        const NODES: [[f64; 3]; N] = <E as Element<N>>::NODES;
        &NODES
    })
}

#[cfg(test)]
mod tests;
