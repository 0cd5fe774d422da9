//! Shepard's method with compact kernels: moving least squares of order zero.

use efg::{Kernel, Support};
use geometry::Cloud;
use shape::{Point3, PointRows, Rows, Unity};

use crate::neighbours::{check_count, check_finite};
use crate::{InterpError, TransferInfo};

/// Where no node reaches a target, all supports are enlarged to this multiple of what the first node would
/// need.
const ENLARGE: f64 = 1.25;
/// Relative distance up to which a node counts as covering a target: beyond, its kernel is below 1e-8, and a
/// row of such weights alone is noise.
const RIM: f64 = 0.999;

/// `u(x) = sum_i w(d_i / R_i) u_i / sum_i w(d_i / R_i)`, `w` the cubic spline, `R_i` the node's support
/// radius.
///
/// Exact for constants; does not interpolate; smooth (C2). A target that no support covers takes all supports
/// enlarged until 1.25 times past the first node, and is counted in [`TransferInfo::fallbacks`].
pub fn shepard(
    nodes: &[Point3],
    support: Support,
    targets: &[Point3],
) -> Result<(PointRows, TransferInfo), InterpError> {
    check_finite(nodes, targets)?;
    check_count("shepard", nodes.len(), 2)?;
    let radii = support.radii(nodes, &Cloud::from_points(nodes.to_vec())?.spacing)?;
    let mut info = TransferInfo::default();
    let (mut offsets, mut entries, mut values) = (vec![0], Vec::new(), Vec::new());
    let inverse_squares: Vec<f64> = radii.iter().map(|r| 1.0 / (r * r)).collect();
    // Squares of d / R: roots are taken of those that count, a tenth of all.
    let mut squares = vec![0.0; nodes.len()];
    for x in targets {
        for ((square, node), inverse) in squares.iter_mut().zip(nodes).zip(&inverse_squares) {
            *square = (node - x).norm_squared() * inverse;
        }
        let first = squares.iter().copied().fold(f64::INFINITY, f64::min);
        let scale = if first < RIM * RIM {
            1.0
        } else {
            info.fallbacks += 1;
            1.0 / (ENLARGE * ENLARGE * first)
        };
        let start = values.len();
        for (node, square) in squares.iter().enumerate() {
            if square * scale < 1.0 {
                entries.push(node as u32);
                values.push(Kernel::CubicSpline.eval((square * scale).sqrt()).0);
            }
        }
        let sum: f64 = values[start..].iter().sum();
        values[start..].iter_mut().for_each(|w| *w /= sum);
        offsets.push(values.len());
    }
    let rows = Rows::new(nodes.len(), offsets, entries, values, Unity::Within(1e-12))?;
    Ok((PointRows::new(targets.to_vec(), rows)?, info))
}
