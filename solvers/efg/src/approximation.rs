//! The approximation over a cloud: which neighbours, which fit, and what to do where neighbours are too few.

use rayon::prelude::*;
use shape::{GradRows, Point3, PointRows, Rows, Unity, Vector3};

use crate::buckets::Buckets;
use crate::info::Outcome;
use crate::mls::{Ball, Workspace};
use crate::{Basis, EfgError, Kernel, MlsInfo, support};

/// Points per parallel task: fixed, so that results are the same bits at any thread count.
const CHUNK: usize = 128;
/// About so many points, or one in [`SPARING`], give an estimate of a table's size: to a standard error of 0.5 % where neighbours
/// scatter by a third. Growing by doubling would take up to three times the memory while it copies, and touch pages anew.
pub(crate) const SAMPLES: usize = 4000;
/// Of small tables one point in so many is enough.
pub(crate) const SPARING: usize = 25;
/// Taken times that estimate.
pub(crate) const MARGIN: f64 = 1.01;
/// Rows sum to one within this; those of sound supports do within 1e-14.
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
    /// Regularisation of the quadratic block, relative to the sum of the weights.
    mu: f64,
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
    workspace: Workspace,
}

impl Batch {
    fn clear(&mut self) {
        self.lengths.clear();
        self.nodes.clear();
        self.values.clear();
        self.grads.clear();
        self.outcomes.clear();
    }
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
        Ok(Approximation { nodes, balls, kernel, basis, mu: 0.0, buckets })
    }

    /// With the quadratic block of the moment matrix regularised at every point, by `mu` times the sum of the weights (modified
    /// moving least squares; Joldes et al. 2015): linear fields stay exact, quadratic ones are almost. The linear
    /// basis has no such block.
    pub fn regularised(self, mu: f64) -> Result<Approximation, EfgError> {
        if !(0.0..=1.0).contains(&mu) {
            let what = "regularisation";
            return Err(EfgError::BadParameter { what, value: mu, allowed: "a value from 0 to 1" });
        }
        Ok(Approximation { mu, ..self })
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
        self.grad_rows_at(points.to_vec())
    }

    /// As [`Approximation::grad_rows`], of points that are kept.
    pub(crate) fn grad_rows_at(&self, points: Vec<Point3>) -> Result<(GradRows, MlsInfo), EfgError> {
        let (rows, grads, info) = self.table::<true>(&points)?;
        Ok((GradRows::new(points, rows, grads)?, info))
    }

    fn table<const GRAD: bool>(&self, points: &[Point3]) -> Result<(Rows, Vec<Vector3>, MlsInfo), EfgError> {
        // In waves that reuse their buffers: all chunks at once would touch twice the memory, and in a single call
        // fresh pages cost as much as the arithmetic. Results do not depend on the length of a wave.
        let wave = 4 * CHUNK * rayon::current_num_threads();
        let mut batches: Vec<Batch> = Vec::new();
        let mut offsets = Vec::with_capacity(points.len() + 1);
        offsets.push(0);
        let entries = self.expected_entries(points);
        let (mut nodes, mut values) = (Vec::with_capacity(entries), Vec::with_capacity(entries));
        let mut grads = Vec::with_capacity(if GRAD { entries } else { 0 });
        let mut outcomes = Vec::with_capacity(points.len());
        for wave in points.chunks(wave) {
            let chunks = wave.par_chunks(CHUNK);
            batches.resize_with(chunks.len(), Batch::default);
            let done: Vec<Result<(), EfgError>> = batches
                .par_iter_mut()
                .zip(chunks)
                .map(|(batch, chunk)| self.batch::<GRAD>(chunk, batch))
                .collect();
            for (done, batch) in done.into_iter().zip(&batches) {
                done?;
                for length in &batch.lengths {
                    offsets.push(offsets[offsets.len() - 1] + length);
                }
                nodes.extend_from_slice(&batch.nodes);
                values.extend_from_slice(&batch.values);
                grads.extend_from_slice(&batch.grads);
                outcomes.extend_from_slice(&batch.outcomes);
            }
        }
        let rows = Rows::new(self.nodes.len(), offsets, nodes, values, UNITY)?;
        Ok((rows, grads, MlsInfo::new(&outcomes)))
    }

    /// Entries of a table by the neighbours of a few of its points, with a margin.
    fn expected_entries(&self, points: &[Point3]) -> usize {
        let step = (points.len() / SAMPLES).max(SPARING);
        let mut at = Workspace::default();
        let (mut sampled, mut found) = (0, 0);
        for x in points.iter().step_by(step) {
            at.gather(x, self.buckets.candidates(x).iter().copied(), &self.balls, 1.0);
            (sampled, found) = (sampled + 1, found + at.nodes.len());
        }
        (MARGIN * found as f64 * points.len() as f64 / sampled.max(1) as f64) as usize
    }

    /// The same arithmetic in the same order on either path, so the same bits; wide registers take 0.8 of the time.
    /// Fused multiply-add is left off on purpose: it would change last bits from machine to machine.
    fn batch<const GRAD: bool>(&self, points: &[Point3], batch: &mut Batch) -> Result<(), EfgError> {
        #[cfg(target_arch = "x86_64")]
        if std::is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has AVX2, just checked; that is all the function requires.
            return unsafe { self.batch_avx2::<GRAD>(points, batch) };
        }
        self.batch_plain::<GRAD>(points, batch)
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn batch_avx2<const GRAD: bool>(&self, points: &[Point3], batch: &mut Batch) -> Result<(), EfgError> {
        self.batch_plain::<GRAD>(points, batch)
    }

    #[inline(always)]
    fn batch_plain<const GRAD: bool>(&self, points: &[Point3], batch: &mut Batch) -> Result<(), EfgError> {
        let mut workspace = std::mem::take(&mut batch.workspace);
        batch.clear();
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
        batch.workspace = workspace;
        Ok(())
    }

    #[inline(always)]
    fn evaluate<const GRAD: bool>(&self, x: &Point3, at: &mut Workspace) -> Result<Outcome, EfgError> {
        at.gather(x, self.buckets.candidates(x).iter().copied(), &self.balls, 1.0);
        let neighbours = at.nodes.len() as u32;
        match self.fit::<GRAD>(self.basis, self.mu, at) {
            Some(condition) => {
                Ok(Outcome { neighbours, condition, enlarged: false, regularised: false, reduced: false })
            }
            None => self.climb::<GRAD>(x, at),
        }
    }

    #[inline(always)]
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
            neighbours: found as u32,
            condition: 0.0,
            enlarged: enlargement > 1.0,
            regularised: false,
            reduced: false,
        };
        let rungs: &[(Basis, f64)] = match self.basis {
            Basis::Linear => &[(Basis::Linear, 0.0)],
            Basis::Quadratic => &[
                (Basis::Quadratic, self.mu),
                (Basis::Quadratic, self.mu.max(REGULARISATION)),
                (Basis::Linear, 0.0),
            ],
        };
        for &(basis, mu) in rungs {
            if let Some(condition) = self.fit::<GRAD>(basis, mu, at) {
                outcome.condition = condition;
                outcome.regularised = mu > self.mu;
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wide_registers_give_the_same_bits() {
        let nodes: Vec<Point3> = (0..216)
            .map(|i| Point3::new((i % 6) as f64, (i / 6 % 6) as f64 + 0.1 * (i % 5) as f64, (i / 36) as f64))
            .collect();
        let points: Vec<Point3> =
            (0..64).map(|q| Point3::new(0.077, 0.053, 0.061) * q as f64 + Vector3::repeat(0.1)).collect();
        for kernel in Kernel::ALL {
            for basis in Basis::ALL {
                let mls = Approximation::new(nodes.clone(), vec![2.6; 216], kernel, basis).unwrap();
                let (mut chosen, mut plain) = (Batch::default(), Batch::default());
                mls.batch::<true>(&points, &mut chosen).unwrap();
                mls.batch_plain::<true>(&points, &mut plain).unwrap();
                let label = format!("{} {}", kernel.name(), basis.name());
                assert!(chosen.values.len() > 640 && chosen.nodes == plain.nodes, "{label}");
                assert!(chosen.values == plain.values && chosen.grads == plain.grads, "{label}");
                assert_eq!(chosen.outcomes, plain.outcomes, "{label}");
            }
        }
    }
}
