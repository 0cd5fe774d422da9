//! The map from reference coordinates to positions, for each cell kind: what quality checks and point location need.
//!
//! Reference cells: unit simplex with corners 0, e_x, e_y, e_z; cube [-1, 1]^3 with corners in VTK order.

use crate::{CellKind, Matrix3, Point3};

/// Corners of the reference cube in VTK order, which is the node order of hex8: bottom counter-clockwise, then top.
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

/// Reference coordinates of every node of a kind.
pub(crate) fn reference_nodes(kind: CellKind) -> Vec<[f64; 3]> {
    let mut nodes: Vec<[f64; 3]> = if kind.is_tet() {
        vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    } else {
        HEX_CORNERS.to_vec()
    };
    if kind.order() == 2 {
        for &[a, b] in kind.edges() {
            nodes.push(std::array::from_fn(|d| 0.5 * (nodes[a][d] + nodes[b][d])));
        }
    }
    nodes
}

/// Calls `visit(node, value, gradient)` for every shape function at `xi`.
fn shapes(kind: CellKind, xi: [f64; 3], mut visit: impl FnMut(usize, f64, [f64; 3])) {
    let [x, y, z] = xi;
    if kind.is_tet() {
        let l = [1.0 - x - y - z, x, y, z];
        const DL: [[f64; 3]; 4] = [[-1.0, -1.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        for a in 0..4 {
            if kind == CellKind::Tet4 {
                visit(a, l[a], DL[a]);
            } else {
                visit(a, l[a] * (2.0 * l[a] - 1.0), DL[a].map(|d| (4.0 * l[a] - 1.0) * d));
            }
        }
        if kind == CellKind::Tet10 {
            for (e, &[a, b]) in kind.edges().iter().enumerate() {
                let grad = std::array::from_fn(|d| 4.0 * (l[a] * DL[b][d] + l[b] * DL[a][d]));
                visit(4 + e, 4.0 * l[a] * l[b], grad);
            }
        }
        return;
    }
    for (a, s) in HEX_CORNERS.iter().enumerate() {
        let f: [f64; 3] = std::array::from_fn(|d| 1.0 + s[d] * xi[d]);
        let product = 0.125 * f[0] * f[1] * f[2];
        let plain = [0.125 * s[0] * f[1] * f[2], 0.125 * s[1] * f[0] * f[2], 0.125 * s[2] * f[0] * f[1]];
        if kind == CellKind::Hex8 {
            visit(a, product, plain);
        } else {
            let t = s[0] * x + s[1] * y + s[2] * z - 2.0;
            visit(a, product * t, std::array::from_fn(|d| plain[d] * t + product * s[d]));
        }
    }
    if kind == CellKind::Hex20 {
        for (e, &[a, b]) in kind.edges().iter().enumerate() {
            let s: [f64; 3] = std::array::from_fn(|d| 0.5 * (HEX_CORNERS[a][d] + HEX_CORNERS[b][d]));
            // Along the edge's own axis (s = 0) the factor is 1 - xi^2, across it 1 + s xi.
            let f: [f64; 3] =
                std::array::from_fn(|d| if s[d] == 0.0 { 1.0 - xi[d] * xi[d] } else { 1.0 + s[d] * xi[d] });
            let df: [f64; 3] = std::array::from_fn(|d| if s[d] == 0.0 { -2.0 * xi[d] } else { s[d] });
            let grad = [df[0] * f[1] * f[2], f[0] * df[1] * f[2], f[0] * f[1] * df[2]].map(|g| 0.25 * g);
            visit(8 + e, 0.25 * f[0] * f[1] * f[2], grad);
        }
    }
}

/// Position of the reference point `xi` and the Jacobian `J_ij = dx_i / dxi_j` (m) there.
pub(crate) fn map(kind: CellKind, nodes: &[Point3], xi: [f64; 3]) -> (Point3, Matrix3) {
    let mut position = Point3::origin();
    let mut jacobian = Matrix3::zeros();
    shapes(kind, xi, |a, value, grad| {
        position += value * nodes[a].coords;
        for j in 0..3 {
            for i in 0..3 {
                jacobian[(i, j)] += nodes[a][i] * grad[j];
            }
        }
    });
    (position, jacobian)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shape_functions_are_kronecker_and_their_gradients_match_differences() {
        for kind in CellKind::ALL {
            for (n, &xi) in reference_nodes(kind).iter().enumerate() {
                let mut count = 0;
                shapes(kind, xi, |a, value, _| {
                    count += 1;
                    let kronecker = if a == n { 1.0 } else { 0.0 };
                    assert!(
                        (value - kronecker).abs() < 1e-15,
                        "{} node {n}, function {a}: {value}",
                        kind.name()
                    );
                });
                assert_eq!(count, kind.node_count());
            }
            let (xi, h) = ([0.21, 0.13, 0.37], 1e-6);
            let mut grads = vec![[0.0; 3]; kind.node_count()];
            shapes(kind, xi, |a, _, grad| grads[a] = grad);
            for d in 0..3 {
                let mut differences = vec![0.0; kind.node_count()];
                for side in [1.0, -1.0] {
                    let mut at = xi;
                    at[d] += side * h;
                    shapes(kind, at, |a, value, _| differences[a] += side * value / (2.0 * h));
                }
                for (a, difference) in differences.iter().enumerate() {
                    assert!((grads[a][d] - difference).abs() < 1e-9, "{} {a} {d}", kind.name());
                }
            }
        }
    }
}
