//! Shepard's method with compact kernels: moving least squares of order zero.

use catalogue::{Build, Entry};
use efg::{CubicSpline, Kernel, Support};
use geometry::Cloud;
use shape::{Point3, PointRows, Unity};

use crate::error::InterpError;
use crate::neighbours::{check_count, check_finite, squared_distances};
use crate::table::{Batch, in_chunks};
use crate::transfer::{Source, Transfer, TransferInfo, scaled, support_scale};

/// Factor by which all supports are enlarged beyond the nearest node if no node covers a target.
const ENLARGE: f64 = 1.25;
/// Relative distance up to which a node counts as covering a target. Beyond this distance its kernel is below
/// 1e-8, and a row of such weights alone is noise.
const RIM: f64 = 0.999;

/// The scheme of [`shepard`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shepard {
    /// Ratio of support radius to mean spacing.
    pub support_scale: f64,
}

pub(crate) const ENTRY: Entry<Build<Shepard>> = Entry {
    name: "shepard",
    meaning: "mean of the nodes whose supports contain the target, weighted by cubic splines; smooth",
    source: "Shepard (1968), with compact kernels",
    parameters: &[support_scale(1.6)],
    build: |values| Ok(Shepard { support_scale: values.number("support_scale")? }),
};

impl Transfer for Shepard {
    fn name(&self) -> &'static str {
        ENTRY.name
    }

    fn exact_degree(&self) -> Option<usize> {
        Some(0)
    }

    fn interpolates(&self) -> bool {
        false
    }

    fn rows(&self, source: Source, targets: &[Point3]) -> Result<(PointRows, TransferInfo), InterpError> {
        shepard(source.nodes, scaled(self.support_scale), targets)
    }
}

/// Builds the table of Shepard's method, `u(x) = sum_i w(d_i / R_i) u_i / sum_i w(d_i / R_i)` with the cubic
/// spline `w`, the distance `d_i` of node `i` and the node's support radius `R_i`.
///
/// The scheme is exact for constants, does not interpolate, and is smooth (C2). For a target outside all
/// supports, all supports are enlarged by the factor `1.25 min_i(d_i / R_i)`. Such targets are counted in
/// [`TransferInfo::fallbacks`].
pub fn shepard(
    nodes: &[Point3],
    support: Support,
    targets: &[Point3],
) -> Result<(PointRows, TransferInfo), InterpError> {
    check_finite(nodes, targets)?;
    check_count("shepard", nodes.len(), 2)?;
    let radii = support.radii(nodes, &Cloud::from_points(nodes.to_vec())?.spacing)?;
    let inverse_squares: Vec<f64> = radii.iter().map(|r| 1.0 / (r * r)).collect();
    let axes: [Vec<f64>; 3] = std::array::from_fn(|axis| nodes.iter().map(|p| p[axis]).collect());
    in_chunks(nodes.len(), targets, Unity::Within(1e-12), |targets| {
        let mut batch = Batch::default();
        // Squares of d / R: roots are computed only for the nodes that contribute, a third of all.
        let mut squares = vec![0.0; nodes.len()];
        for x in targets {
            squared_distances(&axes, x, &mut squares);
            squares.iter_mut().zip(&inverse_squares).for_each(|(square, inverse)| *square *= inverse);
            let start = batch.start();
            batch.keep_below_one(&squares);
            let first = |squares: &[f64]| squares.iter().copied().fold(f64::INFINITY, f64::min);
            if !(first(&batch.values[start..]) < RIM * RIM) {
                batch.info.fallbacks += 1;
                let scale = 1.0 / (ENLARGE * ENLARGE * first(&squares));
                squares.iter_mut().for_each(|square| *square *= scale);
                batch.nodes.truncate(start);
                batch.values.truncate(start);
                batch.keep_below_one(&squares);
            }
            for value in &mut batch.values[start..] {
                *value = Kernel::CubicSpline(CubicSpline).eval(value.sqrt()).0;
            }
            batch.close_over_sum();
        }
        batch
    })
}

impl Batch {
    /// Appends the nodes whose numbers are below one, with these numbers.
    fn keep_below_one(&mut self, numbers: &[f64]) {
        let mut n = self.nodes.len();
        self.nodes.resize(n + numbers.len(), 0);
        self.values.resize(n + numbers.len(), 0.0);
        // Every entry is written and counted only if it is below one, because a branch would be mispredicted.
        for (node, &number) in numbers.iter().enumerate() {
            (self.nodes[n], self.values[n]) = (node as u32, number);
            n += usize::from(number < 1.0);
        }
        self.nodes.truncate(n);
        self.values.truncate(n);
    }
}
