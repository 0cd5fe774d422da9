//! Facts of an element beyond its shape functions. All other code asks the entry of a kind for them.

use crate::CellKind;
use crate::quadrature::Rule;

/// Facts of one kind of cell, next to its shape functions.
pub struct Entry {
    /// Name, meaning and degree.
    pub listed: &'static catalogue::element::Element,
    /// Shape of the cell.
    pub cell: &'static ReferenceCell,
    /// Reference coordinates of the nodes, in node order.
    pub nodes: &'static [[f64; 3]],
    /// Local node indices of each face, corners first, seen counter-clockwise from outside.
    pub faces: &'static [&'static [usize]],
    /// Quadrature of the cell.
    pub points: Points,
    /// Names and node orders in mesh files.
    pub files: FileCodes,
}

/// Numbers of quadrature points of a cell, each of which [`ReferenceCell::rule`] knows.
#[derive(Clone, Copy)]
pub struct Points {
    /// Full integration, exact for the stiffness of an affine cell.
    pub full: usize,
    /// Reduced integration of the stiffness, if the element is in use with it, and its name in records.
    pub reduced: Option<(usize, &'static str)>,
    /// Integration of at least one order more, for errors against fields that the cell cannot represent.
    pub fine: usize,
    /// Integration that is exact for `det J` of a curved cell.
    pub volume: usize,
}

/// Names and node orders of a cell in mesh files. Entry g of a node order is the node of the cell that a file
/// lists at place g.
pub struct FileCodes {
    /// Element type of Gmsh.
    pub gmsh: u64,
    /// Node order of Gmsh.
    pub gmsh_order: &'static [usize],
    /// Element type of Abaqus, without the letters of its variants.
    pub abaqus: &'static str,
    /// Node order of Abaqus.
    pub abaqus_order: &'static [usize],
    /// Cell type of VTK.
    pub vtk: u8,
    /// Node order of VTK.
    pub vtk_order: &'static [usize],
}

/// Shape that elements of several degrees share.
pub struct ReferenceCell {
    /// Corner pairs of the edges. The mid-edge nodes of quadratic kinds follow this order.
    pub edges: &'static [[usize; 2]],
    /// Number of corners.
    pub corners: usize,
    /// Reference coordinates of the middle.
    pub centre: [f64; 3],
    /// Distance of a point outside the cell, in reference units; negative inside.
    pub excess: fn([f64; 3]) -> f64,
    /// Corners of the faces S1, S2, ... of Abaqus.
    pub abaqus_faces: &'static [&'static [usize]],
    /// Whether programs disagree about the order of VTK files: some write the mirror image.
    pub vtk_either: bool,
    /// Corners in the order that mirrors the cell.
    pub mirrored: &'static [usize],
    /// Quadrature rule with a number of points; `None` if there is none.
    pub rule: fn(usize) -> Option<Rule<3>>,
    /// Numbers of points that have a rule, in words.
    pub rules: &'static str,
    /// Number of cells that fill a cube.
    pub per_cube: usize,
    /// Diagonals that divide a cube into cells: across its faces normal to z, y and x, and through the cube.
    pub diagonals: [usize; 4],
    /// Volume of the regular cell with edges of length 1.
    pub regular_volume: f64,
    /// Longest edge times surface over volume of the regular cell.
    pub regular_aspect: f64,
    /// Largest sum of the shape functions of the mid-edge nodes within the cell, or an upper bound of it.
    pub bulge: f64,
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
