//! Nodes of block-structured meshes. Nodes of adjoining blocks are merged by their integer lattice positions.

use std::collections::HashMap;

use crate::Point3;
use crate::element::CellKind;
use crate::mesh::{Facet, Mesh, MeshError};

/// Lattice offsets of a hexahedron's corners, in node order.
pub(super) const CORNERS: [(usize, usize, usize); 8] =
    [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)];

/// Lattice key of a node, the same in every block.
pub(super) type Key = [u32; 4];

/// Name of a facet group, and the predicate that holds at all corners of its facets.
pub(super) type Group<'a> = (&'a str, &'a dyn Fn(&Point3) -> bool);

/// A hexahedral mesh under construction.
#[derive(Default)]
pub(super) struct Lattice {
    number: HashMap<Key, u32>,
    points: Vec<Point3>,
    nodes: Vec<u32>,
}

impl Lattice {
    /// Adds a hexahedron by its corner keys. `place` returns the position of a new key.
    pub(super) fn hexahedron(&mut self, corners: [Key; 8], place: impl Fn(Key) -> Point3) {
        for key in corners {
            let node = *self.number.entry(key).or_insert_with(|| {
                self.points.push(place(key));
                self.points.len() as u32 - 1
            });
            self.nodes.push(node);
        }
    }

    /// Returns the mesh with its facet groups. A boundary facet belongs to every group whose predicate holds
    /// at all its corners.
    pub(super) fn finish(self, groups: &[Group]) -> Result<Mesh, MeshError> {
        let mut mesh = Mesh::from_flat(self.points, vec![CellKind::Hex8; self.nodes.len() / 8], self.nodes)?;
        let boundary = mesh.boundary();
        for (name, holds) in groups {
            let facets: Vec<Facet> = (boundary.iter().copied())
                .filter(|&f| mesh.facet_nodes(f).all(|n| holds(&mesh.points()[n as usize])))
                .collect();
            mesh = mesh.with_group(name, facets)?;
        }
        Ok(mesh)
    }
}

/// Iterates over all (i, j, k) below the counts, i fastest.
pub(super) fn triples(counts: [usize; 3]) -> impl Iterator<Item = (usize, usize, usize)> {
    let [nx, ny, nz] = counts;
    (0..nz).flat_map(move |k| (0..ny).flat_map(move |j| (0..nx).map(move |i| (i, j, k))))
}

/// Lattice position (0 to `n` in each coordinate) of cell corner (i, j) on a side of the cube. Sides are x-,
/// x+, y-, y+, z-, z+, and (i, j, outwards) is right-handed on each.
pub(super) fn on_cube_side(side: usize, n: [usize; 3], i: usize, j: usize) -> [usize; 3] {
    match side {
        0 => [0, j, i],
        1 => [n[0], i, j],
        2 => [i, 0, j],
        3 => [j, n[1], i],
        4 => [j, i, 0],
        _ => [i, j, n[2]],
    }
}

/// Number of cells along i and j on a side of the cube.
pub(super) fn side_cells(side: usize, n: [usize; 3]) -> [usize; 2] {
    match side {
        0 => [n[2], n[1]],
        1 => [n[1], n[2]],
        2 => [n[0], n[2]],
        3 => [n[2], n[0]],
        4 => [n[1], n[0]],
        _ => [n[0], n[1]],
    }
}

/// Maps the surface of the cube [-1, 1]^3 onto the unit sphere by equal angles (the equiangular cubed sphere:
/// Ronchi, Iacono & Paolucci 1996). Neighbouring cells differ less in size than under a central projection.
pub(super) fn onto_sphere(u: &crate::Vector3) -> crate::Vector3 {
    u.map(|c| if c.abs() == 1.0 { c } else { (std::f64::consts::FRAC_PI_4 * c).tan() }).normalize()
}
