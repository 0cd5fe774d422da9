//! An element: its shape functions, and the entry of all other facts.

use crate::quadrature::Rule;

/// A Lagrange element of `N` nodes on its reference cell: the tetrahedron (0,0,0), (1,0,0), (0,1,0), (0,0,1),
/// the cube `[-1, 1]^3`, or the triangle (0,0), (1,0), (0,1) between z = -1 and z = 1. The same functions map
/// the reference cell to space: `x(xi) = sum_a N_a(xi) x_a`.
pub trait Element<const N: usize> {
    /// Facts of the element.
    const ENTRY: Entry;
    /// Reference coordinates of the nodes, (N, 3).
    const NODES: [[f64; 3]; N];

    /// Shape functions at `xi`, (N), dimensionless.
    fn shape(xi: [f64; 3]) -> [f64; N];

    /// Gradients of the shape functions with respect to `xi`, (N, 3), dimensionless.
    fn shape_grad(xi: [f64; 3]) -> [[f64; 3]; N];
}

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

/// The node order of a file that lists the nodes as the cell does.
pub(super) const fn in_order<const N: usize>() -> [usize; N] {
    let mut order = [0; N];
    let mut at = 0;
    while at < N {
        order[at] = at;
        at += 1;
    }
    order
}
