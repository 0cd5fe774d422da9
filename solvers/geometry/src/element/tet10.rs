use catalogue::element as listed;

use super::entry::{Element, Entry, FileCodes, Points, in_order};
use super::tet4::Tet4;
use super::tetrahedron::TETRAHEDRON;

/// 10-node quadratic tetrahedron: the corners of [`Tet4`], then mid-edges 01, 12, 20, 03, 13, 23.
///
/// With the barycentric coordinates `L` of the corners, `N_a = L_a (2 L_a - 1)` at corner `a` and `N_ab = 4
/// L_a L_b` at the middle of edge `ab`. The basis is complete to degree 2.
pub struct Tet10;

impl Element<10> for Tet10 {
    const ENTRY: Entry = Entry {
        listed: &listed::TET10,
        cell: &TETRAHEDRON,
        nodes: &Self::NODES,
        faces: &[&[0, 2, 1, 6, 5, 4], &[0, 1, 3, 4, 8, 7], &[1, 2, 3, 5, 9, 8], &[0, 3, 2, 7, 9, 6]],
        points: Points { full: 4, reduced: None, fine: 24, volume: 8 },
        files: FileCodes {
            gmsh: 11,
            gmsh_order: &[0, 1, 2, 3, 4, 5, 6, 7, 9, 8],
            abaqus: "C3D10",
            abaqus_order: &in_order::<10>(),
            vtk: 24,
            vtk_order: &in_order::<10>(),
        },
    };
    const NODES: [[f64; 3]; 10] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.5, 0.0, 0.0],
        [0.5, 0.5, 0.0],
        [0.0, 0.5, 0.0],
        [0.0, 0.0, 0.5],
        [0.5, 0.0, 0.5],
        [0.0, 0.5, 0.5],
    ];

    #[inline]
    fn shape(xi: [f64; 3]) -> [f64; 10] {
        let l = Tet4::shape(xi);
        std::array::from_fn(|node| match node {
            0..4 => l[node] * (2.0 * l[node] - 1.0),
            _ => {
                let [a, b] = TETRAHEDRON.edges[node - 4];
                4.0 * l[a] * l[b]
            }
        })
    }

    #[inline]
    fn shape_grad(xi: [f64; 3]) -> [[f64; 3]; 10] {
        let l = Tet4::shape(xi);
        let dl = Tet4::shape_grad(xi);
        std::array::from_fn(|node| match node {
            0..4 => dl[node].map(|d| (4.0 * l[node] - 1.0) * d),
            _ => {
                let [a, b] = TETRAHEDRON.edges[node - 4];
                std::array::from_fn(|i| 4.0 * (l[a] * dl[b][i] + l[b] * dl[a][i]))
            }
        })
    }
}
