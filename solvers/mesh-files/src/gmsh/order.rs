//! Gmsh's element types (Gmsh reference manual, sections "MSH file format" and "Node ordering").

use geometry::{CellKind, FaceKind};

use crate::error::ascending;

/// Class of an element of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Element {
    Cell(CellKind),
    /// A face, with its numbers of corners and nodes.
    Face {
        corners: usize,
        nodes: usize,
    },
    /// A point or line, whose nodes may belong to a named group.
    Curve {
        nodes: usize,
    },
}

pub(super) fn element(kind: u64) -> Option<Element> {
    if let Some(cell) = CellKind::ALL.into_iter().find(|cell| cell.entry().files.gmsh == kind) {
        return Some(Element::Cell(cell));
    }
    if let Some(face) = FaceKind::ALL.into_iter().find(|face| face.gmsh() == kind) {
        return Some(Element::Face { corners: face.corner_count(), nodes: face.node_count() });
    }
    Some(match kind {
        1 => Element::Curve { nodes: 2 },
        8 => Element::Curve { nodes: 3 },
        15 => Element::Curve { nodes: 1 },
        _ => return None,
    })
}

/// Element types that are read, for the message about other types.
pub(super) fn known() -> String {
    let solids = ascending(CellKind::ALL.map(|kind| kind.entry().files.gmsh));
    let faces = ascending(FaceKind::ALL.map(FaceKind::gmsh));
    format!("supported types: {solids} (solids), {faces} (faces), lines and points")
}

impl Element {
    /// Topological dimension, from 0 (point) to 3 (solid).
    pub(super) fn dimension(self) -> i64 {
        match self {
            Element::Cell(_) => 3,
            Element::Face { .. } => 2,
            Element::Curve { nodes: 1 } => 0,
            Element::Curve { .. } => 1,
        }
    }

    pub(super) fn node_count(self) -> usize {
        match self {
            Element::Cell(kind) => kind.node_count(),
            Element::Face { nodes, .. } | Element::Curve { nodes } => nodes,
        }
    }
}
