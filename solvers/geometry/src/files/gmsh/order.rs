//! Gmsh's element types and node orders, compared with [`CellKind`].
//!
//! Gmsh lists the mid-edge nodes of a tet10 on edges 01 12 02 03 23 13 ([`CellKind`]: .. 03 13 23). It lists
//! those of a hex20 on edges 01 03 04 12 15 23 26 37 45 47 56 67 (Gmsh reference manual, section "Node
//! ordering").

use crate::CellKind;

const TET10: [usize; 10] = [0, 1, 2, 3, 4, 5, 6, 7, 9, 8];
const HEX20: [usize; 20] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 16, 9, 17, 10, 18, 19, 12, 15, 13, 14];
const PLAIN: [usize; 8] = [0, 1, 2, 3, 4, 5, 6, 7];

/// Class of an element of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::files) enum Element {
    Cell(CellKind),
    /// A face, with its numbers of corners and nodes.
    Face {
        corners: usize,
        nodes: usize,
    },
    /// A point or line, which is skipped.
    Ignored {
        nodes: usize,
    },
}

pub(super) fn element(kind: u64) -> Option<Element> {
    Some(match kind {
        4 => Element::Cell(CellKind::Tet4),
        5 => Element::Cell(CellKind::Hex8),
        11 => Element::Cell(CellKind::Tet10),
        17 => Element::Cell(CellKind::Hex20),
        2 => Element::Face { corners: 3, nodes: 3 },
        3 => Element::Face { corners: 4, nodes: 4 },
        9 => Element::Face { corners: 3, nodes: 6 },
        16 => Element::Face { corners: 4, nodes: 8 },
        1 => Element::Ignored { nodes: 2 },
        8 => Element::Ignored { nodes: 3 },
        15 => Element::Ignored { nodes: 1 },
        _ => return None,
    })
}

impl Element {
    /// Topological dimension, from 0 (point) to 3 (solid).
    pub(super) fn dimension(self) -> i64 {
        match self {
            Element::Cell(_) => 3,
            Element::Face { .. } => 2,
            Element::Ignored { nodes: 1 } => 0,
            Element::Ignored { .. } => 1,
        }
    }

    pub(super) fn node_count(self) -> usize {
        match self {
            Element::Cell(kind) => kind.node_count(),
            Element::Face { nodes, .. } | Element::Ignored { nodes } => nodes,
        }
    }
}

/// Gmsh's type numbers of a cell and of its faces.
pub(super) fn type_numbers(kind: CellKind) -> (u64, u64) {
    match kind {
        CellKind::Tet4 => (4, 2),
        CellKind::Hex8 => (5, 3),
        CellKind::Tet10 => (11, 9),
        CellKind::Hex20 => (17, 16),
    }
}

/// Permutation from Gmsh's node order: node g of Gmsh's list is node `order[g]` of the cell.
pub(super) fn order(kind: CellKind) -> &'static [usize] {
    match kind {
        CellKind::Tet4 => &PLAIN[..4],
        CellKind::Hex8 => &PLAIN,
        CellKind::Tet10 => &TET10,
        CellKind::Hex20 => &HEX20,
    }
}
