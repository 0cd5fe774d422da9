//! Shape functions of the elements, one file each, used by quality checks, point location, tables and
//! kernels. A new element needs a file, a line in `with_element` and a [`CellKind`].

mod hex20;
mod hex8;
mod tet10;
mod tet4;

pub use hex8::Hex8;
pub use hex20::Hex20;
pub use tet4::Tet4;
pub use tet10::Tet10;

use crate::{CellKind, Matrix3, Point3, Vector3};

/// A Lagrange element of `N` nodes on its reference cell: the tetrahedron (0,0,0), (1,0,0), (0,1,0), (0,0,1)
/// or the cube `[-1, 1]^3`. The same functions map the reference cell to space: `x(xi) = sum_a N_a(xi) x_a`.
pub trait Element<const N: usize> {
    /// Kind of mesh cell, which also defines the node order.
    const KIND: CellKind;
    /// Reference coordinates of the nodes, (N, 3).
    const NODES: [[f64; 3]; N];

    /// Shape functions at `xi`, (N), dimensionless.
    fn shape(xi: [f64; 3]) -> [f64; N];

    /// Gradients of the shape functions with respect to `xi`, (N, 3), dimensionless.
    fn shape_grad(xi: [f64; 3]) -> [[f64; 3]; N];
}

/// Corners of the reference cube in VTK order, which is the node order of hex8: bottom counter-clockwise,
/// then top.
pub const HEX_CORNERS: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// Runs `$body` with `$E` bound to the element type of a cell kind and `$N` to its number of nodes.
#[macro_export]
macro_rules! with_element {
    ($kind:expr, $E:ident, $N:ident => $body:expr) => {
        match $kind {
            $crate::CellKind::Tet4 => $crate::with_element!(@ $crate::element::Tet4, 4, $E, $N, $body),
            $crate::CellKind::Tet10 => $crate::with_element!(@ $crate::element::Tet10, 10, $E, $N, $body),
            $crate::CellKind::Hex8 => $crate::with_element!(@ $crate::element::Hex8, 8, $E, $N, $body),
            $crate::CellKind::Hex20 => $crate::with_element!(@ $crate::element::Hex20, 20, $E, $N, $body),
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
pub use crate::with_element;

/// Distance of `xi` outside the reference cell of a kind, in reference units; negative inside.
pub fn excess(kind: CellKind, xi: [f64; 3]) -> f64 {
    let [x, y, z] = xi;
    if kind.is_tet() {
        (-x).max(-y).max(-z).max(x + y + z - 1.0)
    } else {
        x.abs().max(y.abs()).max(z.abs()) - 1.0
    }
}

/// Reference coordinates of the cell's middle.
pub fn centre(kind: CellKind) -> [f64; 3] {
    if kind.is_tet() { [0.25; 3] } else { [0.0; 3] }
}

/// Reference coordinates of all nodes of a kind, in its node order.
pub fn nodes(kind: CellKind) -> &'static [[f64; 3]] {
    with_element!(kind, E, N => {
        const NODES: [[f64; 3]; N] = <E as Element<N>>::NODES;
        &NODES
    })
}

/// Position of the reference point `xi` and Jacobian `J_ij = dx_i / dxi_j` (m), for a cell with the given
/// nodes (m).
pub(crate) fn map(kind: CellKind, nodes: &[Point3], xi: [f64; 3]) -> (Point3, Matrix3) {
    with_element!(kind, E, N => {
        let (values, grads) = (<E as Element<N>>::shape(xi), <E as Element<N>>::shape_grad(xi));
        let mut position = Point3::origin();
        let mut jacobian = Matrix3::zeros();
        for ((node, value), grad) in nodes.iter().zip(values).zip(grads) {
            position += value * node.coords;
            jacobian += node.coords * Vector3::from(grad).transpose();
        }
        (position, jacobian)
    })
}
