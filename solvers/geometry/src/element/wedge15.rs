use catalogue::element as listed;

use super::entry::{Element, Entry, FileCodes, Points, in_order};
use super::prism::PRISM;
use super::wedge6::SLOPES;

/// 15-node serendipity wedge: the corners of [`super::Wedge6`], then mid-edges 01 12 20, 34 45 53, 03 14 25.
///
/// With the barycentric coordinates `L` of the triangle and `Z = z z_a`, the shape functions are:
///
/// - at the corners `N_a = L_a ((2 L_a - 1)(1 + Z) - (1 - z^2)) / 2`;
/// - at the middle of a triangle's edge `N_ab = 2 L_a L_b (1 + Z)`;
/// - at the middle of an edge along z `N_a = L_a (1 - z^2)`.
///
/// The space contains all quadratics on cells with an affine map. Source: Zienkiewicz & Taylor, The Finite
/// Element Method, vol. 1, section on triangular prisms.
pub struct Wedge15;

impl Element<15> for Wedge15 {
    const ENTRY: Entry = Entry {
        listed: &listed::WEDGE15,
        cell: &PRISM,
        nodes: &Self::NODES,
        faces: &[
            &[0, 2, 1, 8, 7, 6],
            &[3, 4, 5, 9, 10, 11],
            &[0, 1, 4, 3, 6, 13, 9, 12],
            &[1, 2, 5, 4, 7, 14, 10, 13],
            &[2, 0, 3, 5, 8, 12, 11, 14],
        ],
        points: Points { full: 18, reduced: Some((9, "3x3")), fine: 48, volume: 18 },
        files: FileCodes {
            gmsh: 18,
            // Mid-edges 01 02 03 12 14 25 34 35 45 (Gmsh reference manual, section "Node ordering").
            gmsh_order: &[0, 1, 2, 3, 4, 5, 6, 8, 12, 7, 13, 14, 9, 11, 10],
            abaqus: "C3D15",
            abaqus_order: &in_order::<15>(),
            vtk: 26,
            // Mid-edges 01 12 20 34 45 53 03 14 25 (VTK, class vtkQuadraticWedge).
            vtk_order: &in_order::<15>(),
        },
    };
    const NODES: [[f64; 3]; 15] = [
        [0.0, 0.0, -1.0],
        [1.0, 0.0, -1.0],
        [0.0, 1.0, -1.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 1.0],
        [0.0, 1.0, 1.0],
        [0.5, 0.0, -1.0],
        [0.5, 0.5, -1.0],
        [0.0, 0.5, -1.0],
        [0.5, 0.0, 1.0],
        [0.5, 0.5, 1.0],
        [0.0, 0.5, 1.0],
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
    ];

    #[inline]
    fn shape([x, y, z]: [f64; 3]) -> [f64; 15] {
        let l = [1.0 - x - y, x, y];
        let bubble = 1.0 - z * z;
        std::array::from_fn(|node| {
            let k = node % 3;
            let next = (node + 1) % 3;
            let height = 1.0 + side(node) * z;
            match node {
                0..6 => 0.5 * l[k] * ((2.0 * l[k] - 1.0) * height - bubble),
                6..12 => 2.0 * l[k] * l[next] * height,
                _ => l[k] * bubble,
            }
        })
    }

    #[inline]
    fn shape_grad([x, y, z]: [f64; 3]) -> [[f64; 3]; 15] {
        let l = [1.0 - x - y, x, y];
        let bubble = 1.0 - z * z;
        std::array::from_fn(|node| {
            let k = node % 3;
            let next = (node + 1) % 3;
            let s = side(node);
            let height = 1.0 + s * z;
            // Derivatives with respect to L_k, L_next and z.
            let [a, b, along] = match node {
                0..6 => [
                    0.5 * ((4.0 * l[k] - 1.0) * height - bubble),
                    0.0,
                    0.5 * l[k] * ((2.0 * l[k] - 1.0) * s + 2.0 * z),
                ],
                6..12 => [2.0 * l[next] * height, 2.0 * l[k] * height, 2.0 * l[k] * l[next] * s],
                _ => [bubble, 0.0, -2.0 * l[k] * z],
            };
            let across = |i: usize| a * SLOPES[k][i] + b * SLOPES[next][i];
            [across(0), across(1), along]
        })
    }
}

/// Side of a corner, or of a node on a triangle's edge: -1 below, 1 above.
fn side(node: usize) -> f64 {
    if (node / 3).is_multiple_of(2) { -1.0 } else { 1.0 }
}
