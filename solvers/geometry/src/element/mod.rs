//! Elements, one file each: shape functions, used by quality checks, point location, tables and kernels, and
//! an [`Entry`] of all other facts. A new element needs a file, its lines here, and its name in the
//! catalogue.

mod cube;
mod entry;
mod hex20;
mod hex8;
mod prism;
mod tet10;
mod tet4;
mod tetrahedron;
mod wedge15;
mod wedge6;

pub use entry::{Entry, FileCodes, Points, ReferenceCell};
pub use hex8::Hex8;
pub use hex20::Hex20;
pub use tet4::Tet4;
pub use tet10::Tet10;
pub use wedge6::Wedge6;
pub use wedge15::Wedge15;

use crate::{Matrix3, Point3, Vector3};

/// Declares the kinds of cells with their numbers of nodes.
macro_rules! elements {
    ($($(#[doc = $about:literal])+ $Name:ident = $nodes:literal,)+) => {
        /// Shapes that cells of a mesh may have, in any mixture.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum CellKind {
            $($(#[doc = $about])+ $Name,)+
        }

        impl CellKind {
            /// All kinds, in the order tables list them.
            pub const ALL: [CellKind; [$($nodes),+].len()] = [$(CellKind::$Name),+];

            /// Entry of the element: its nodes, faces, rules, and codes in mesh files.
            pub const fn entry(self) -> &'static Entry {
                match self {
                    $(CellKind::$Name => &<$Name as Element<$nodes>>::ENTRY,)+
                }
            }
        }
    };
}

elements! {
    /// 4-node tetrahedron: corners.
    Tet4 = 4,
    /// 10-node tetrahedron: corners, then mid-edges 01, 12, 20, 03, 13, 23.
    Tet10 = 10,
    /// 8-node hexahedron: bottom 0123 counter-clockwise seen from above, top 4567 above them.
    Hex8 = 8,
    /// 20-node hexahedron: corners, then mid-edges 01 12 23 30, 45 56 67 74, 04 15 26 37.
    Hex20 = 20,
    /// 6-node wedge: bottom 012 counter-clockwise seen from above, top 345 above them.
    Wedge6 = 6,
    /// 15-node wedge: corners, then mid-edges 01 12 20, 34 45 53, 03 14 25.
    Wedge15 = 15,
}

/// A Lagrange element of `N` nodes on its reference cell: the tetrahedron (0,0,0), (1,0,0), (0,1,0), (0,0,1),
/// the cube `[-1, 1]^3`, or the triangle (0,0), (1,0), (0,1) between z = -1 and z = 1. The same functions map
/// the reference cell to space: `x(xi) = sum_a N_a(xi) x_a`.
pub trait Element<const N: usize> {
    /// Kind of mesh cell, which also defines the node order.
    const KIND: CellKind;
    /// Facts of the element.
    const ENTRY: Entry;
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
            $crate::CellKind::Wedge6 => $crate::with_element!(@ $crate::element::Wedge6, 6, $E, $N, $body),
            $crate::CellKind::Wedge15 => $crate::with_element!(@ $crate::element::Wedge15, 15, $E, $N, $body),
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

/// The node order of a file that lists the nodes as the cell does.
const fn in_order<const N: usize>() -> [usize; N] {
    let mut order = [0; N];
    let mut at = 0;
    while at < N {
        order[at] = at;
        at += 1;
    }
    order
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
