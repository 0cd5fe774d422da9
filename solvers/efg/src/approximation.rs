//! The approximation over a cloud: which neighbours, which fit, and what to do where neighbours are too few.

use rayon::prelude::*;
use shape::{GradRows, Point3, PointRows, Rows, Unity, Vector3};

use crate::buckets::Buckets;
use crate::info::Outcome;
use crate::mls::{Ball, Workspace};
use crate::{Basis, EfgError, Kernel, MlsInfo, support};

/// Points per parallel task: fixed, so that results are the same bits at any thread count.
const CHUNK: usize = 128;
/// Rows sum to one within this; those of sound supports do within 1e-15.
const UNITY: Unity = Unity::Within(1e-8);
/// Supports are enlarged to this much beyond the neighbour that makes twice as many as the basis has terms.
const BEYOND_NEIGHBOUR: f64 = 1.4;
/// Supports are enlarged no further: beyond, the point is not near the cloud at all.
const MOST_ENLARGEMENT: f64 = 3.0;
/// Regularisation of the quadratic block on the ladder, relative to the sum of the weights.
const REGULARISATION: f64 = 1e-7;

/// Moving-least-squares shape functions over a cloud of nodes, each with a support radius of its own.
///
/// Node `I` counts at `x` if `|x - x_I| < R_I`. Where the neighbours do not determine the basis, a ladder is
/// climbed and every rung counted in [`MlsInfo`]: enlarge all supports seen from that point (to 1.4 times the
/// `2m`-th neighbour's relative distance, at most 3 times); regularise the quadratic block; fall back from the
/// quadratic basis to the linear one. The linear basis gives way to nothing: a point it fails at is an error.
pub struct Approximation {
    nodes: Vec<Point3>,
    balls: Vec<Ball>,
    kernel: Kernel,
    basis: Basis,
    buckets: Buckets,
}

/// Rows of one chunk of points.
#[derive(Default)]
struct Batch {
    lengths: Vec<usize>,
    nodes: Vec<u32>,
    values: Vec<f64>,
    grads: Vec<Vector3>,
    outcomes: Vec<Outcome>,
}

impl Approximation {
    /// Checks and wraps: positions (m) and support radii (m), one per node.
    pub fn new(
        nodes: Vec<Point3>,
        radii: Vec<f64>,
        kernel: Kernel,
        basis: Basis,
    ) -> Result<Approximation, EfgError> {
        kernel.check()?;
        if radii.len() != nodes.len() {
            return Err(EfgError::Length {
                what: "support radii",
                found: radii.len(),
                expected: nodes.len(),
            });
        }
        if nodes.len() < basis.terms() {
            return Err(EfgError::TooFewNodes { found: nodes.len(), needed: basis.terms() });
        }
        if let Some(node) = nodes.iter().position(|p| !p.coords.iter().all(|c| c.is_finite())) {
            return Err(EfgError::NotFinite { node });
        }
        support::check(&radii)?;
        let balls =
            nodes.iter().zip(&radii).map(|(p, &radius)| Ball { at: p.coords.into(), radius }).collect();
        let buckets = Buckets::new(&nodes, &radii);
        Ok(Approximation { nodes, balls, kernel, basis, buckets })
    }

    /// Node positions, m.
    pub fn nodes(&self) -> &[Point3] {
        &self.nodes
    }

    /// Support radius of one node, m.
    pub fn radius(&self, node: usize) -> f64 {
        self.balls[node].radius
    }

    /// The kernel.
    pub fn kernel(&self) -> Kernel {
        self.kernel
    }

    /// The basis asked for.
    pub fn basis(&self) -> Basis {
        self.basis
    }

    /// Values at points; nodes of a row by ascending index.
    pub fn point_rows(&self, points: &[Point3]) -> Result<(PointRows, MlsInfo), EfgError> {
        let (rows, _, info) = self.table::<false>(points)?;
        Ok((PointRows::new(points.to_vec(), rows)?, info))
    }

    /// Values and gradients (1/m) at points; nodes of a row by ascending index.
    pub fn grad_rows(&self, points: &[Point3]) -> Result<(GradRows, MlsInfo), EfgError> {
        let (rows, grads, info) = self.table::<true>(points)?;
        Ok((GradRows::new(points.to_vec(), rows, grads)?, info))
    }

    fn table<const GRAD: bool>(&self, points: &[Point3]) -> Result<(Rows, Vec<Vector3>, MlsInfo), EfgError> {
        let batches: Vec<Result<Batch, EfgError>> =
            points.par_chunks(CHUNK).map(|chunk| self.batch::<GRAD>(chunk)).collect();
        let batches = batches.into_iter().collect::<Result<Vec<Batch>, EfgError>>()?;
        let entries = batches.iter().map(|b| b.nodes.len()).sum();
        let mut offsets = Vec::with_capacity(points.len() + 1);
        offsets.push(0);
        let (mut nodes, mut values) = (Vec::with_capacity(entries), Vec::with_capacity(entries));
        let mut grads = Vec::with_capacity(if GRAD { entries } else { 0 });
        let mut outcomes = Vec::with_capacity(points.len());
        for batch in batches {
            for length in batch.lengths {
                offsets.push(offsets[offsets.len() - 1] + length);
            }
            nodes.extend_from_slice(&batch.nodes);
            values.extend_from_slice(&batch.values);
            grads.extend_from_slice(&batch.grads);
            outcomes.extend_from_slice(&batch.outcomes);
        }
        let rows = Rows::new(self.nodes.len(), offsets, nodes, values, UNITY)?;
        Ok((rows, grads, MlsInfo::new(&outcomes)))
    }

    fn batch<const GRAD: bool>(&self, points: &[Point3]) -> Result<Batch, EfgError> {
        let mut workspace = Workspace::default();
        let mut batch = Batch::default();
        for x in points {
            let outcome = self.evaluate::<GRAD>(x, &mut workspace)?;
            batch.lengths.push(workspace.nodes.len());
            batch.nodes.extend_from_slice(&workspace.nodes);
            batch.values.extend_from_slice(&workspace.values);
            if GRAD {
                batch.grads.extend_from_slice(&workspace.grads);
            }
            batch.outcomes.push(outcome);
        }
        Ok(batch)
    }

    #[inline]
    fn evaluate<const GRAD: bool>(&self, x: &Point3, at: &mut Workspace) -> Result<Outcome, EfgError> {
        at.gather(x, self.buckets.candidates(x).iter().copied(), &self.balls, 1.0);
        let neighbours = at.nodes.len();
        match self.fit::<GRAD>(self.basis, 0.0, at) {
            Some(condition) => {
                Ok(Outcome { neighbours, condition, enlarged: false, regularised: false, reduced: false })
            }
            None => self.climb::<GRAD>(x, at),
        }
    }

    #[inline]
    fn fit<const GRAD: bool>(&self, basis: Basis, mu: f64, at: &mut Workspace) -> Option<f64> {
        if mu == 0.0 && at.nodes.len() < basis.terms() {
            return None;
        }
        match basis {
            Basis::Linear => at.fit::<4, GRAD>(self.kernel, mu),
            Basis::Quadratic => at.fit::<10, GRAD>(self.kernel, mu),
        }
    }

    /// The ladder, for a point at which the plain fit failed.
    #[cold]
    fn climb<const GRAD: bool>(&self, x: &Point3, at: &mut Workspace) -> Result<Outcome, EfgError> {
        let needed = self.basis.terms();
        let enlargement = self.enlargement(x, 2 * needed);
        at.gather(x, 0..self.balls.len() as u32, &self.balls, enlargement);
        let found = at.nodes.len();
        let mut outcome = Outcome {
            neighbours: found,
            condition: 0.0,
            enlarged: enlargement > 1.0,
            regularised: false,
            reduced: false,
        };
        let rungs: &[(Basis, f64)] = match self.basis {
            Basis::Linear => &[(Basis::Linear, 0.0)],
            Basis::Quadratic => {
                &[(Basis::Quadratic, 0.0), (Basis::Quadratic, REGULARISATION), (Basis::Linear, 0.0)]
            }
        };
        for &(basis, mu) in rungs {
            if let Some(condition) = self.fit::<GRAD>(basis, mu, at) {
                outcome.condition = condition;
                outcome.regularised = mu > 0.0;
                outcome.reduced = basis != self.basis;
                return Ok(outcome);
            }
        }
        let point = *x;
        if found < Basis::Linear.terms() {
            Err(EfgError::TooFewNeighbours { point, found, needed, enlargement })
        } else {
            Err(EfgError::SingularMoment { point, found, needed, enlargement })
        }
    }

    /// Factor on all support radii by which `count` nodes (all, if there are fewer) cover `x` comfortably.
    fn enlargement(&self, x: &Point3, count: usize) -> f64 {
        let mut ratios: Vec<f64> =
            self.nodes.iter().zip(&self.balls).map(|(p, ball)| (p - x).norm() / ball.radius).collect();
        let last = count.min(ratios.len()) - 1;
        let (_, &mut ratio, _) = ratios.select_nth_unstable_by(last, f64::total_cmp);
        (BEYOND_NEIGHBOUR * ratio).clamp(1.0, MOST_ENLARGEMENT)
    }
}
