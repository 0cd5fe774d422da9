//! Supports adapted to the cloud: an ellipsoid at every node, i.e. a ball in the metric in which the
//! surrounding cells are isotropic.
//!
//! The second moment of the cells is `S_I = mean_c mean_e (e e^T)`: the mean over the edges of a cell,
//! averaged over the cells around node `I`. Lengths are measured in the metric `S_I^-1`:
//! `|e|_I = sqrt(e^T S_I^-1 e)`. An affine map of body and cloud transforms `S` accordingly. Lengths, weights
//! and shape values therefore do not change, however flat the cells become. If `S_I` is a multiple of the
//! identity, the ellipsoid is the ball given by [`Support::radii`].

use geometry::{Mesh, Search, edges};
use nalgebra::{Matrix3, SymmetricEigen};
use rayon::prelude::*;
use shape::Point3;

use crate::error::EfgError;
use crate::support::Support;

/// Ratio of the longest to the shortest extent of a cell above which the cell counts as flat: only rounding
/// of coordinates is left.
const FLAT: f64 = 1e7;

/// The support `(x - x_I)^T M_I (x - x_I) < 1` of a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid {
    /// `M_I`, 1/m^2: xx, yy, zz, xy, yz, zx.
    pub(crate) metric: [f64; 6],
    /// Longest semi-axis, m.
    pub(crate) radius: f64,
}

impl Ellipsoid {
    /// Longest semi-axis, m.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Returns `M_I e` (1/m) for an offset `e` (m).
    #[inline(always)]
    pub(crate) fn normal(&self, e: [f64; 3]) -> [f64; 3] {
        let [xx, yy, zz, xy, yz, zx] = self.metric;
        [
            xx * e[0] + xy * e[1] + zx * e[2],
            xy * e[0] + yy * e[1] + yz * e[2],
            zx * e[0] + yz * e[1] + zz * e[2],
        ]
    }

    /// Returns the squared relative distance of an offset (m), below 1 inside.
    #[inline(always)]
    pub(crate) fn square(&self, e: [f64; 3]) -> f64 {
        let n = self.normal(e);
        n[0] * e[0] + n[1] * e[1] + n[2] * e[2]
    }

    /// Builds the ball of radius `length` in `metric` (1/m^2), whose unit ball has the longest semi-axis
    /// `widest` (m).
    fn new(metric: &Matrix3<f64>, widest: f64, length: f64) -> Ellipsoid {
        let m = metric / (length * length);
        let metric = [m[(0, 0)], m[(1, 1)], m[(2, 2)], m[(0, 1)], m[(1, 2)], m[(2, 0)]];
        // The margin exceeds the rounding of the metric: the ball must contain the whole ellipsoid.
        Ellipsoid { metric, radius: widest * length * (1.0 + 1e-9) }
    }
}

impl Support {
    /// Computes supports of the nodes of a mesh that are adapted to its cells. [`Support::Dilatation`] uses
    /// the mean length of the edges at a node, [`Support::Neighbours`] the distance of the `count`-th nearest
    /// other node, both in the node's own metric.
    ///
    /// # Errors
    /// Invalid parameters, and nodes whose cells are flat or missing.
    pub fn ellipsoids(self, mesh: &Mesh) -> Result<Vec<Ellipsoid>, EfgError> {
        let nodes = mesh.points();
        self.check(nodes)?;
        let metrics = metrics(mesh)?;
        let lengths = match self {
            Support::Dilatation { factor } => {
                mean_edges(mesh, &metrics).into_iter().map(|length| factor * length).collect()
            }
            Support::Neighbours { count, factor } => {
                let search = Search::new(nodes)
                    .map_err(|_| EfgError::TooFewNodes { found: nodes.len(), needed: count + 1 })?;
                let at = |(node, metric): (usize, &Metric)| {
                    factor * kth_length(nodes, &search, node, metric, count)
                };
                metrics.par_iter().enumerate().map(at).collect::<Vec<f64>>()
            }
        };
        let ellipsoids: Vec<Ellipsoid> = metrics
            .iter()
            .zip(lengths)
            .map(|(m, length)| Ellipsoid::new(&m.inverse, m.widest, length))
            .collect();
        match ellipsoids.iter().position(|e| !(e.radius > 0.0 && e.radius.is_finite())) {
            Some(node) => Err(EfgError::BadRadius { node, radius: ellipsoids[node].radius }),
            None => Ok(ellipsoids),
        }
    }
}

/// Metric of lengths at a node.
struct Metric {
    /// `S^-1`, 1/m^2.
    inverse: Matrix3<f64>,
    /// Longest semi-axis of its unit ball, m.
    widest: f64,
}

impl Metric {
    fn length(&self, from: &Point3, to: &Point3) -> f64 {
        let e = to - from;
        e.dot(&(self.inverse * e)).max(0.0).sqrt()
    }
}

/// Returns one metric per node.
fn metrics(mesh: &Mesh) -> Result<Vec<Metric>, EfgError> {
    let points = mesh.points();
    let mut moments = vec![(Matrix3::zeros(), 0u32); points.len()];
    for cell in 0..mesh.cell_count() {
        let nodes = mesh.cell(cell);
        let ends = mesh.kind(cell).edges();
        let square = |&[a, b]: &[usize; 2]| {
            let e = points[nodes[b] as usize] - points[nodes[a] as usize];
            e * e.transpose()
        };
        let moment = ends.iter().map(square).sum::<Matrix3<f64>>() / ends.len() as f64;
        for &node in nodes {
            let (sum, count) = &mut moments[node as usize];
            *sum += moment;
            *count += 1;
        }
    }
    let metric = |(node, (sum, count)): (usize, &(Matrix3<f64>, u32))| {
        let moment = sum / f64::from(*count);
        let extents = SymmetricEigen::new(moment).eigenvalues;
        // The moment of a node without cells is NaN and fails the test.
        if !(extents.max() < FLAT * FLAT * extents.min()) {
            return Err(EfgError::FlatCells { node });
        }
        let inverse = moment.try_inverse().ok_or(EfgError::FlatCells { node })?;
        Ok(Metric { inverse, widest: extents.max().sqrt() })
    };
    moments.iter().enumerate().map(metric).collect()
}

/// Returns the mean length of the edges that meet at each node, in the node's metric.
fn mean_edges(mesh: &Mesh, metrics: &[Metric]) -> Vec<f64> {
    let points = mesh.points();
    let mut sums = vec![(0.0, 0u32); points.len()];
    for (a, b) in edges(mesh) {
        for node in [a as usize, b as usize] {
            let (sum, count) = &mut sums[node];
            *sum += metrics[node].length(&points[a as usize], &points[b as usize]);
            *count += 1;
        }
    }
    sums.into_iter().map(|(sum, count)| sum / f64::from(count)).collect()
}

/// Returns the length to the `count`-th nearest other node in the node's metric. Nodes within the ellipsoid
/// of this length also lie within the ball around the ellipsoid. The search therefore takes more of the
/// nearest nodes until the ball contains no others.
fn kth_length(nodes: &[Point3], search: &Search, node: usize, metric: &Metric, count: usize) -> f64 {
    let at = &nodes[node];
    let mut taken = count + 1;
    loop {
        taken = (2 * taken).min(nodes.len());
        let near = search.nearest(at, taken);
        let mut lengths: Vec<f64> =
            near.iter().map(|n| metric.length(at, &nodes[n.index as usize])).collect();
        // The first entry is the node itself, at zero.
        let (_, &mut length, _) = lengths.select_nth_unstable_by(count, f64::total_cmp);
        let reached = near.last().map_or(0.0, |n| n.distance);
        if taken == nodes.len() || metric.widest * length <= reached {
            return length;
        }
    }
}
