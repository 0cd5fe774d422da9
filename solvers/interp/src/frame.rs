//! Position, size and thickness of a cloud.

use nalgebra::Matrix3;
use shape::{Point3, Vector3};

/// Thickness of a cloud relative to its half-extent below which it counts as flat.
pub(crate) const FLAT: f64 = 1e-7;

/// Returns the centre of the bounding box and half its longest side, m.
pub(crate) fn centre_and_half_extent(nodes: &[Point3]) -> (Point3, f64) {
    let (mut low, mut high) = (nodes[0], nodes[0]);
    for x in nodes {
        low = low.inf(x);
        high = high.sup(x);
    }
    let half = (high - low) * 0.5;
    (low + half, half.max())
}

/// Returns the root-mean-square distance of the nodes from their best plane, m.
pub(crate) fn thickness(nodes: &[Point3]) -> f64 {
    let n = nodes.len() as f64;
    let mean = nodes.iter().map(|x| x.coords).sum::<Vector3>() / n;
    let moment: Matrix3<f64> = nodes.iter().map(|x| (x.coords - mean) * (x.coords - mean).transpose()).sum();
    (moment / n).symmetric_eigenvalues().min().max(0.0).sqrt()
}
