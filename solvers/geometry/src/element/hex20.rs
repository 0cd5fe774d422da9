use catalogue::element as listed;

use super::cube::CUBE;
use super::entry::{Element, Entry, FileCodes, Points, in_order};

/// 20-node serendipity hexahedron on the cube `[-1, 1]^3`: the corners of [`super::Hex8`], then mid-edges
/// 01 12 23 30, 45 56 67 74, 04 15 26 37.
///
/// With `X = x x_a` and so on, the shape functions are:
///
/// - at the corners `N_a = (1 + X)(1 + Y)(1 + Z)(X + Y + Z - 2) / 8`;
/// - at the middle of an edge along x `N_a = (1 - x^2)(1 + Y)(1 + Z) / 4`, and likewise along y and z.
///
/// The space contains all quadratics on cells with an affine map. Source: Zienkiewicz & Taylor, The Finite
/// Element Method, vol. 1, section on serendipity families.
pub struct Hex20;

impl Element<20> for Hex20 {
    const ENTRY: Entry = Entry {
        listed: &listed::HEX20,
        cell: &CUBE,
        nodes: &Self::NODES,
        faces: &[
            &[0, 3, 2, 1, 11, 10, 9, 8],
            &[4, 5, 6, 7, 12, 13, 14, 15],
            &[0, 1, 5, 4, 8, 17, 12, 16],
            &[1, 2, 6, 5, 9, 18, 13, 17],
            &[2, 3, 7, 6, 10, 19, 14, 18],
            &[3, 0, 4, 7, 11, 16, 15, 19],
        ],
        points: Points { full: 27, reduced: Some((8, "2x2x2")), fine: 64, volume: 27 },
        files: FileCodes {
            gmsh: 17,
            gmsh_order: &[0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 16, 9, 17, 10, 18, 19, 12, 15, 13, 14],
            abaqus: "C3D20",
            abaqus_order: &in_order::<20>(),
            vtk: 25,
            vtk_order: &in_order::<20>(),
        },
    };
    const NODES: [[f64; 3]; 20] = [
        [-1.0, -1.0, -1.0],
        [1.0, -1.0, -1.0],
        [1.0, 1.0, -1.0],
        [-1.0, 1.0, -1.0],
        [-1.0, -1.0, 1.0],
        [1.0, -1.0, 1.0],
        [1.0, 1.0, 1.0],
        [-1.0, 1.0, 1.0],
        [0.0, -1.0, -1.0],
        [1.0, 0.0, -1.0],
        [0.0, 1.0, -1.0],
        [-1.0, 0.0, -1.0],
        [0.0, -1.0, 1.0],
        [1.0, 0.0, 1.0],
        [0.0, 1.0, 1.0],
        [-1.0, 0.0, 1.0],
        [-1.0, -1.0, 0.0],
        [1.0, -1.0, 0.0],
        [1.0, 1.0, 0.0],
        [-1.0, 1.0, 0.0],
    ];

    #[inline]
    fn shape([x, y, z]: [f64; 3]) -> [f64; 20] {
        Self::NODES.map(|[a, b, c]| {
            // The coordinate of a mid-edge node along its edge is 0; the bubble replaces the linear factor.
            let (fx, fy, fz) = (factor(a, x), factor(b, y), factor(c, z));
            if a * b * c == 0.0 {
                0.25 * fx * fy * fz
            } else {
                0.125 * fx * fy * fz * (a * x + b * y + c * z - 2.0)
            }
        })
    }

    #[inline]
    fn shape_grad([x, y, z]: [f64; 3]) -> [[f64; 3]; 20] {
        Self::NODES.map(|[a, b, c]| {
            let (fx, fy, fz) = (factor(a, x), factor(b, y), factor(c, z));
            let (dx, dy, dz) = (slope(a, x), slope(b, y), slope(c, z));
            if a * b * c == 0.0 {
                [0.25 * dx * fy * fz, 0.25 * fx * dy * fz, 0.25 * fx * fy * dz]
            } else {
                let s = a * x + b * y + c * z - 2.0;
                [
                    0.125 * fy * fz * (dx * s + fx * a),
                    0.125 * fx * fz * (dy * s + fy * b),
                    0.125 * fx * fy * (dz * s + fz * c),
                ]
            }
        })
    }
}

/// `1 + a x` for an end node (`a` = +-1), the bubble `1 - x^2` for a mid-edge node (`a` = 0).
#[inline]
fn factor(a: f64, x: f64) -> f64 {
    if a == 0.0 { 1.0 - x * x } else { 1.0 + a * x }
}

/// Derivative of [`factor`] with respect to x.
#[inline]
fn slope(a: f64, x: f64) -> f64 {
    if a == 0.0 { -2.0 * x } else { a }
}
