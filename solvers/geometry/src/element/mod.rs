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

pub use cube::HEX_CORNERS;
pub use entry::{Element, Entry, FileCodes, Points, ReferenceCell};
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

impl CellKind {
    /// The name used in scene files and tables.
    pub fn name(self) -> &'static str {
        self.entry().listed.name
    }

    /// Polynomial order of the kind's complete basis: 1 or 2.
    pub fn order(self) -> usize {
        self.entry().listed.degree
    }

    /// Number of nodes.
    pub fn node_count(self) -> usize {
        self.entry().nodes.len()
    }

    /// Number of corner nodes; they come first in the cell's node list.
    pub fn corner_count(self) -> usize {
        self.entry().cell.corners
    }

    /// Corner pairs of the edges. The mid-edge nodes of the quadratic kinds follow this order.
    pub fn edges(self) -> &'static [[usize; 2]] {
        self.entry().cell.edges
    }

    /// Local node indices of each face, corners first, seen counter-clockwise from outside.
    pub fn faces(self) -> &'static [&'static [usize]] {
        self.entry().faces
    }

    /// Kind of the same shape with a basis of another order; `None` if there is none.
    pub fn of_order(self, order: usize) -> Option<CellKind> {
        let alike = |kind: &CellKind| std::ptr::eq(kind.entry().cell, self.entry().cell);
        CellKind::ALL.into_iter().find(|kind| kind.order() == order && alike(kind))
    }

    /// Node order that mirrors a cell: every mid-edge node keeps its edge.
    pub fn mirrored(self) -> Vec<usize> {
        let corners = self.entry().cell.mirrored;
        let middle = |&[a, b]: &[usize; 2]| {
            let ends = [corners[a], corners[b]];
            let edge = self.edges().iter().position(|edge| ends.iter().all(|end| edge.contains(end)));
            self.corner_count() + edge.expect("a mirrored cell has the same edges")
        };
        let middles = self.edges().iter().map(middle).take(self.node_count() - self.corner_count());
        corners.iter().copied().chain(middles).collect()
    }
}

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

/// Position of the reference point `xi` and Jacobian `J_ij = dx_i / dxi_j` (m), for a cell with the given
/// nodes (m).
pub fn map(kind: CellKind, nodes: &[Point3], xi: [f64; 3]) -> (Point3, Matrix3) {
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
